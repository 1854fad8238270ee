#!/usr/bin/env python3
"""Each rule of floor_plan.py and banned_words.py goes red when it is broken, on a copy of the project.

usage: floor_plan_can_fail.py PROJECT_FOLDER
"""
import os
import shutil
import sys
import tempfile

sys.dont_write_bytecode = True
import banned_words
import floor_plan

# Rule, file, line that is added to it: a file that does not exist is made.
BROKEN_LINES = [
    ("xsimd", "src/upsampling/gamut.cpp", "#include <xsimd/xsimd.hpp>"),
    ("xsimd", "kernels/convert.inl", "#include <xsimd/xsimd.hpp>"),
    ("intrinsics", "src/lanes/arithmetic.cpp", "#include <immintrin.h>"),
    ("oneTBB", "src/film/add.cpp", "#include <tbb/parallel_for.h>"),
    ("oneTBB", "src/lanes/arithmetic.cpp", "#include <oneapi/tbb/parallel_for.h>"),
    ("OpenEXR", "src/film/add.cpp", "#include <OpenEXR/ImfHeader.h>"),
    ("OpenEXR", "bench/report/html.cpp", "#include <Imath/half.h>"),
    ("libdeflate", "src/io/exr/strips.cpp", "#include <libdeflate.h>"),
    ("Eigen", "src/upsampling/gamut.cpp", "#include <Eigen/Dense>"),
    ("CLI11", "bench/report/html.cpp", "#include <CLI/CLI.hpp>"),
    ("pugixml", "src/io/text/text_file.cpp", "#include <pugixml.hpp>"),
    ("nlohmann-json", "src/io/film/film_file.cpp", "#include <nlohmann/json.hpp>"),
    ("fmt", "kernels/convert.inl", "#include <fmt/format.h>"),
    ("POSIX", "include/spectile/result.hpp", "#include <sys/stat.h>"),
    ("other", "src/film/add.cpp", "#include <boost/any.hpp>"),
    ("public", "include/spectile/spectra/bands.hpp", "#include <fmt/format.h>"),
    ("public", "include/spectile/spectra/bands.hpp", '#include "src/base/errors.hpp"'),
    ("public", "include/spectile/result.hpp", "#include <unistd.h>"),
    ("kernels", "kernels/convert.inl", "#include <vector>"),
    ("private", "src/cli/main.cpp", '#include "src/lanes/tiles.hpp"'),
    ("path", "src/film/add.cpp", '#include "tables.hpp"'),
    ("room", "src/attic/attic.cpp", "#include <spectile/result.hpp>"),
    ("umbrella", "include/spectile/color/new.hpp", "#pragma once"),
    ("prints", "src/film/add.cpp", "void f() { std::exit(1); }"),
    ("prints", "src/film/add.cpp", 'void f() { std::cerr << "x"; }'),
    ("prints", "src/cli/info.cpp", 'void f() { fmt::print("x"); }'),
    ("prints", "bench/report/html.cpp", 'void f() { fmt::print("x"); }'),
    ("lines", "src/film/add.cpp", "\n" * floor_plan.MAX_LINES),
]


class Copy:
    """A copy of the project's sources: what is changed in it is undone after each try."""

    def __init__(self, root, work):
        self.root = work
        for top in ("include", "kernels", "src", "bench"):
            shutil.copytree(os.path.join(root, top), os.path.join(work, top))

    def complaints_with(self, additions):
        saved = {}
        for path, text in additions:
            full = os.path.join(self.root, path)
            saved[full] = open(full, encoding="utf-8").read() if os.path.exists(full) else None
            os.makedirs(os.path.dirname(full), exist_ok=True)
            with open(full, "a", encoding="utf-8") as file:
                file.write(text + "\n")
        complaints = floor_plan.FloorPlan(self.root).check()
        for full, text in saved.items():
            if text is None:
                os.remove(full)
            else:
                with open(full, "w", encoding="utf-8") as file:
                    file.write(text)
        return complaints


def broken_edges(plan):
    """For each room, an include of a header in the next room that it may not include."""
    headers = {}
    sources = {}
    for path in plan.sources:
        room = floor_plan.room_of(path)
        sources.setdefault(room, path)
        if path.endswith(".hpp"):
            headers.setdefault(room, path)
    names = [name for name, _, _ in floor_plan.ROOMS]
    for position, (room, _, allowed) in enumerate(floor_plan.ROOMS):
        others = names[position + 1:] + names[:position]
        other = next(other for other in others if other in headers and other not in allowed.split())
        header = headers[other]
        include = f"<{header.removeprefix('include/')}>" if header.startswith("include/") else f'"{header}"'
        yield room, sources[room], f"#include {include}"


def unnoticed(rule, complaints, place):
    found = any(line.startswith(f"[{rule}] {place}") for line in complaints)
    return [] if found else [f"not noticed: [{rule}] {place}"]


def floor_plan_failures(root, work):
    copy = Copy(root, work)
    clean = copy.complaints_with([])
    failures = [f"not clean to begin with: {line}" for line in clean]
    for rule, path, line in BROKEN_LINES:
        place = "include/spectile/spectile.hpp" if rule == "umbrella" else path
        failures += unnoticed(rule, copy.complaints_with([(path, line)]), place)
    for room, path, line in broken_edges(floor_plan.FloorPlan(copy.root)):
        failures += unnoticed("edge", copy.complaints_with([(path, line)]), path)
    many = [(f"src/film/new_{number}.cpp", "") for number in range(floor_plan.MAX_FILES)]
    failures += unnoticed("files", copy.complaints_with(many), "src/film")
    rooms = floor_plan.ROOMS
    floor_plan.ROOMS = [("base", rooms[0][1], "film")] + rooms[1:]
    failures += unnoticed("order", copy.complaints_with([]), "tests/rules/floor_plan.py: base may not name film")
    floor_plan.ROOMS = rooms
    tried = {rule for rule, _, _ in BROKEN_LINES}
    return failures + [f"no try for {name}" for name, _, _ in floor_plan.LIBRARIES if name not in tried]


def banned_word_failures():
    """Each entry of the list is found in a line made of its own example, and an exception is heeded."""
    failures = []
    words = banned_words.load()
    for entry in words.entries:
        for path, text in banned_words.examples(entry):
            if not any(found is entry for _, found, _ in words.search(path, text)):
                failures.append(f"not noticed: {entry.pattern} in {text!r}")
    return failures


def main():
    with tempfile.TemporaryDirectory() as work:
        failures = floor_plan_failures(sys.argv[1], work) + banned_word_failures()
    print("\n".join(failures) if failures else "every rule can fail")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
