#!/usr/bin/env python3
"""Looks for words that docs/glossary.md replaces, as listed in banned_words.txt. usage: banned_words.py PROJECT_FOLDER

In C++, names and prose (comments and string literals) are looked at separately; every other file is prose as a whole.
Words are compared in lower case, with names split at underscores and capitals: kMaxSpeed is "k max speed".
"""
import fnmatch
import os
import re
import sys

PLACES = ["include", "src", "kernels", "bench", "tests", "examples", "tools", "fuzz", "docs", "README.md", "HACKING.md"]
ENDINGS = (".hpp", ".cpp", ".inl", ".md", ".py", ".sh", ".txt")
CPP_ENDINGS = (".hpp", ".cpp", ".inl")
TOKEN = re.compile(r'(?P<comment>//[^\n]*|/\*.*?\*/)|(?P<raw>R"(?P<mark>\w*)\(.*?\)(?P=mark)")|(?P<string>"(?:\\.|[^"\\\n])*")'
                   r"|(?P<char>(?<![0-9a-zA-Z])'(?:\\.|[^'\\\n])+')", re.DOTALL)


# A test's name is a sentence: prose.
TEST_NAME = re.compile(r"\b(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP|RC_GTEST_FIXTURE_PROP)\(\s*\w+,\s*(\w+)")


class Entry:
    def __init__(self, line):
        fields = [field.strip() for field in line.split(" | ")]
        self.pattern, self.where, self.use = fields[:3]
        self.example = fields[3] if len(fields) > 3 else None
        self.is_regex = self.pattern.startswith("/")
        self.words = [] if self.is_regex else self.pattern.split(", ")
        expression = self.pattern[1:-1] if self.is_regex else r"\b(" + "|".join(map(re.escape, self.words)) + r")\b"
        self.expression = re.compile(expression)
        assert self.where in ("names", "prose", "all"), line
        assert self.example or not self.is_regex, f"a regular expression needs an example: {line}"


class Words:
    def __init__(self, entries, exceptions):
        self.entries = entries
        self.exceptions = exceptions
        self.used = set()

    def excused(self, path, entry):
        for number, (pattern, places, _) in enumerate(self.exceptions):
            if pattern in (entry.pattern, "*") and any(fnmatch.fnmatchcase(path, place) for place in places.split()):
                self.used.add(number)
                return True
        return False

    def search(self, path, text):
        """Line number, entry and match of each banned word in the text of a file."""
        for kind, part in split(path, text).items():
            chosen = [entry for entry in self.entries if entry.where in (kind, "all")]
            plain = [entry for entry in chosen if not entry.is_regex]
            together = re.compile("|".join(entry.expression.pattern for entry in plain) or r"(?!)")
            for number, line in enumerate(part.split("\n"), 1):
                if not line.strip():
                    continue
                normal = words_of(line)
                if together.search(normal):
                    for entry in plain:
                        match = entry.expression.search(normal)
                        if match and not self.excused(path, entry):
                            yield number, entry, match.group(0)
                for entry in chosen:
                    match = entry.is_regex and entry.expression.search(line)
                    if match and not self.excused(path, entry):
                        yield number, entry, match.group(0)


def words_of(line):
    return re.sub(r"([a-z0-9])([A-Z])", r"\1 \2", line).replace("_", " ").lower()


def split(path, text):
    """Names and prose of a file: the same lines, the other kind blanked."""
    if not path.endswith(CPP_ENDINGS):
        return {"prose": text}
    blank = lambda match: re.sub(r"[^\n]", " ", match)
    names, prose, end = [], [], 0
    for token in TOKEN.finditer(text):
        names += [text[end:token.start()], blank(token.group())]
        prose += [blank(text[end:token.start()]), token.group()]
        end = token.end()
    names.append(text[end:])
    prose.append(blank(text[end:]))
    names, prose = "".join(names), "".join(prose)
    for test in TEST_NAME.finditer(names):
        prose = prose[:test.start(1)] + test[1] + prose[test.end(1):]
    names = TEST_NAME.sub(lambda test: blank(test.group()), names)
    includes = re.findall(r'^\s*#\s*include\s*".*"$', text, re.MULTILINE)
    for include in includes:
        prose = prose.replace(include[include.index('"'):], "", 1)
    return {"names": names, "prose": prose}


def load(path=os.path.join(os.path.dirname(os.path.abspath(__file__)), "banned_words.txt")):
    entries, exceptions = [], []
    with open(path, encoding="utf-8") as file:
        for line in file.read().splitlines():
            if line.startswith("except | "):
                exceptions.append(tuple(field.strip() for field in line.split(" | ")[1:4]))
            elif line.strip() and not line.startswith("#"):
                entries.append(Entry(line))
    return Words(entries, exceptions)


def examples(entry):
    """Files and texts that hold each of the entry's words, or its own example."""
    for text in [entry.example] if entry.is_regex else entry.words:
        if entry.where in ("names", "all"):
            yield "src/x.cpp", text if entry.is_regex else text.replace(" ", "_")
            if not entry.is_regex:
                yield "src/x.cpp", "k" + "".join(word.capitalize() for word in text.split())
        if entry.where in ("prose", "all"):
            yield "docs/x.md", text
            yield "src/x.cpp", text if text.startswith("//") else f"// {text}"
            yield "src/x.cpp", text if entry.is_regex else f'"{text}"'


def main():
    root = sys.argv[1]
    words = load()
    complaints = []
    for place in PLACES:
        full = os.path.join(root, place)
        files = [full] if os.path.isfile(full) else [
            os.path.join(folder, name) for folder, _, names in sorted(os.walk(full)) for name in sorted(names)]
        for file in files:
            path = os.path.relpath(file, root)
            if path.endswith(ENDINGS) and path != "tests/rules/banned_words.txt":
                with open(file, encoding="utf-8") as opened:
                    found = words.search(path, opened.read())
                    complaints += [f"{path}:{number}: '{match}'; use: {entry.use}" for number, entry, match in found]
    complaints += [f"tests/rules/banned_words.txt: excuses nothing: {' | '.join(exception)}"
                   for number, exception in enumerate(words.exceptions) if number not in words.used]
    print("\n".join(complaints) if complaints else "no banned words")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
