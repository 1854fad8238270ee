#!/usr/bin/env python3
"""Writes a test file of the C++ blocks of a Markdown file: each becomes a test named after its line.

A block is a whole program if it has a main(), otherwise the inside of a function that returns an int (0: all is well)
after `using namespace spectile;`. A comment <!-- given: C++ --> right above a block declares what it takes as given. A block
below <!-- run: C++ --> is functions, and the comment the inside of one that calls them.
usage: snippets.py MARKDOWN NAME OUTPUT
"""
import re
import sys

BLOCK = re.compile(r"(?:^<!-- (?P<kind>given|run):(?P<given>.*?)-->\n+)?^```cpp\n(?P<code>.*?)^```$", re.DOTALL | re.MULTILINE)
INCLUDE = re.compile(r"^#include .*\n", re.MULTILINE)
MAIN = re.compile(r"^int main\(\)", re.MULTILINE)


def main():
    markdown, name, output = sys.argv[1:4]
    with open(markdown, encoding="utf-8") as file:
        text = file.read()
    includes, bodies = [], []
    for block in BLOCK.finditer(text):
        line = text.count("\n", 0, block.start("code")) + 1
        code = block["code"]
        includes += [include for include in INCLUDE.findall(code) if include not in includes]
        mark = f'#line {line} "{markdown}"\n'
        code = INCLUDE.sub("\n", code)
        if MAIN.search(code):
            snippet = mark + MAIN.sub("int snippet()", code)
        elif block["kind"] == "run":
            snippet = f"{mark}{code}int snippet() {{\n{block['given']}return 0;\n}}\n"
        else:
            snippet = f"using namespace spectile;\nint snippet() {{\n{block['given'] or ''}\n{mark}{code}return 0;\n}}\n"
        bodies.append(f"namespace line_{line} {{\n{snippet}}}\n"
                      f"TEST({name}, Line{line}) {{\n  const spectile::test::SnippetFolder folder;\n"
                      f"  EXPECT_EQ(line_{line}::snippet(), 0);\n}}\n")
    with open(output, "w", encoding="utf-8") as file:
        file.write("".join(includes) + '#include <spectile/spectile.hpp>\n\n#include "tests/docs/snippet.hpp"\n\n'
                   "namespace {\n" + "\n".join(bodies) + "}  // namespace\n")


if __name__ == "__main__":
    main()
