#!/usr/bin/env python3
"""Checks the floor plan: which room includes which, one room per outside library, sizes of files and folders.

Rooms are listed from the ground up. A room may include the rooms named beside it, and only rooms listed above its own
line can be named, so that the graph has no cycle. A public header belongs to a room like any other file.
usage: floor_plan.py PROJECT_FOLDER
"""
import fnmatch
import functools
import os
import re
import sys

# --- rooms from the ground up: name, its files and folders, the rooms that it may include ----------------------------
ROOMS = [
    ("base", "include/spectile/*.hpp src/base", ""),
    ("data", "src/data", "base"),
    ("spectra", "include/spectile/spectra src/spectra", "base data"),
    ("radiometry", "include/spectile/radiometry src/radiometry", "base data spectra"),
    ("abi", "kernels/abi kernels/abi*.hpp kernels/*_constants.hpp", ""),
    ("kernels", "kernels", "abi"),
    ("reference", "src/reference", "base data abi"),
    ("dispatch", "include/spectile/isa.hpp src/dispatch", "base abi reference"),
    ("lanes", "include/spectile/lanes src/lanes", "base data spectra abi dispatch"),
    ("color", "include/spectile/color src/color", "base data spectra abi dispatch lanes"),
    ("upsampling", "include/spectile/upsampling src/upsampling", "base data spectra abi dispatch lanes color"),
    ("oracle", "src/reference/oracle", "base data spectra abi reference lanes color upsampling"),
    ("planner", "include/spectile/plan src/planner", "base data spectra dispatch lanes color upsampling"),
    ("film", "include/spectile/film src/film", "base data spectra abi dispatch lanes color"),
    ("scene", "include/spectile/scene src/scene", "base data spectra lanes color film"),
    ("image", "include/spectile/image", "base spectra lanes color upsampling planner film scene"),
    ("io/deflate", "src/io/deflate", "base"),
    ("io/exr", "src/io/exr", "base abi dispatch lanes image io/deflate"),
    ("io/text", "src/io/text", "base data spectra upsampling planner image"),
    ("io/channels", "src/io/channels", "base spectra upsampling planner image io/exr io/text"),
    ("io/frame", "src/io/convert/frame", "base spectra abi reference dispatch lanes planner image io/exr"),
    ("io/sources", "src/io/convert/sources",
     "base spectra dispatch lanes color upsampling planner image io/exr io/channels io/text io/frame"),
    ("io/stages", "src/io/convert/stages",
     "base spectra abi dispatch lanes color upsampling planner image io/exr io/channels io/frame io/sources"),
    ("io/jobs", "src/io/convert/jobs",
     "base spectra abi reference dispatch lanes color upsampling oracle planner image io/exr io/channels io/frame io/sources io/stages"),
    ("io/average", "src/io/average", "base abi dispatch lanes image io/exr io/channels io/frame io/sources io/stages"),
    ("io/film", "src/io/film",
     "base spectra abi dispatch lanes color film image io/exr io/channels io/frame io/sources io/stages"),
    ("io/texture", "src/io/texture",
     "base spectra abi dispatch lanes color upsampling planner image io/exr io/channels io/frame io/sources io/stages"),
    ("io/write", "src/io/write",
     "base spectra abi dispatch lanes color image io/exr io/channels io/frame io/stages"),
    ("bench", "include/spectile/bench bench",
     "base data spectra radiometry abi reference dispatch lanes color upsampling oracle planner film scene io/texture"),
    ("umbrella", "include/spectile/spectile.hpp",
     "base spectra radiometry dispatch lanes color upsampling planner film scene image"),
    ("cli", "src/cli",
     "base spectra radiometry dispatch lanes color upsampling planner film scene image bench umbrella"),
]
# Rooms that see no other room's private headers.
PUBLIC_HEADERS_ONLY = {"cli", "umbrella"}

# --- outside libraries: name, what is included, the only places that may -------------------------------------------------
LIBRARIES = [
    ("xsimd", r"xsimd/", "kernels/simd*"),
    ("intrinsics", r"([a-z]*mmintrin|immintrin|arm_neon)\.h", "kernels/simd* src/base/eigen.hpp"),
    ("oneTBB", r"(oneapi/)?tbb/", "src/lanes/tiles.cpp"),
    ("OpenEXR", r"(OpenEXR|Imath)/|Imf|Imath", "src/io/exr/* bench/exr_only.cpp"),
    ("libdeflate", r"libdeflate", "src/io/exr/encoders/zip_encoder.cpp"),
    ("xxHash", r"xxhash\.h", "src/io/film/film_checksum.cpp"),
    ("pugixml", r"pugixml", "src/io/text/spectrum_spdx.cpp"),
    ("Eigen", r"Eigen/|base/eigen\.hpp", "src/base/eigen.hpp src/planner/* src/upsampling/quadratic_program.* src/upsampling/grid/learned_nodes.cpp"),
    ("CLI11", r"CLI/", "src/cli/options/command.cpp"),
    ("nlohmann-json", r"nlohmann/", "src/cli/* src/io/text/json/* bench/report/json.cpp"),
    ("fmt", r"fmt/", "src/* bench/*"),
    ("POSIX", r"(sys|linux)/", "src/* bench/*"),
]
KERNEL_HEADERS = "cmath cstddef cstdint cstring xsimd/xsimd.hpp immintrin.h arm_neon.h".split()

# --- what prints or ends the process: Result where an error is taken for a value. The tool's text goes through src/cli/output/
# print.cpp, which escapes it; command.cpp has CLI11 print the help, messages.hpp has a member of that name, main.cpp ends without memory ------------
PRINTS = re.compile(r"\b(v?f?printf|f?puts|putchar|std::(cout|cerr|clog)|fmt::print|(std::)?(abort|_?exit|quick_exit|terminate))"
                    r"\b\s*(\(|<<)")
MAY_PRINT = "src/cli/options/command.cpp src/cli/output/messages.hpp src/cli/main.cpp bench/exr_only.cpp src/base/result.cpp"

MAX_FILES = 20
MAX_LINES = 350
SIZE_EXEMPT = "src/data src/data/*"  # published tables, each as long as its source

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
COMMENT = re.compile(r"//.*")


@functools.cache
def read_source(path, _time, _size):
    """Number of lines of a file, its includes, and the numbers of the lines that print or end the process."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    lines = text.splitlines()
    prints_at_all = PRINTS.search(text)
    includes, prints = [], []
    for number, line in enumerate(lines, 1):
        include = INCLUDE.match(line) if "#" in line else None
        if include:
            includes.append((number, *include.groups()))
        elif prints_at_all and PRINTS.search(COMMENT.sub("", line)):
            prints.append(number)
    return len(lines), includes, prints


@functools.cache
def matches(path, patterns):
    return any(fnmatch.fnmatchcase(path, pattern) for pattern in patterns.split())


@functools.cache
def room_of(path):
    """The room whose pattern is the longest of those that hold the file; None if there is none."""
    best = (-1, None)
    for name, places, _ in ROOMS:
        for place in places.split():
            inside = path.startswith(place + "/") or (
                fnmatch.fnmatchcase(path, place) and path.count("/") == place.count("/"))
            if inside and len(place) > best[0]:
                best = (len(place), name)
    return best[1]


class FloorPlan:
    def __init__(self, root):
        self.root = root
        self.complaints = []
        self.files = []
        for top in ("include", "kernels", "src", "bench", "tests"):
            for folder, _, names in sorted(os.walk(os.path.join(root, top))):
                self.files += [os.path.relpath(os.path.join(folder, name), root) for name in sorted(names)]
        self.sources = [path for path in self.files if path.endswith((".hpp", ".cpp", ".inl"))]

    def complain(self, rule, place, sentence):
        self.complaints.append(f"[{rule}] {place}: {sentence}")

    def check(self):
        self.check_order()
        public = []
        for path in self.sources:
            full = os.path.join(self.root, path)
            lines, includes, prints = read_source(full, os.stat(full).st_mtime_ns, os.stat(full).st_size)
            if lines > MAX_LINES and not matches(path, SIZE_EXEMPT):
                self.complain("lines", path, f"{lines} lines, at most {MAX_LINES}")
            if path.startswith("tests/"):  # no room: sizes only
                continue
            for number, mark, header in includes:
                self.check_include(path, f"{path}:{number}", mark, header)
            if not matches(path, MAY_PRINT):
                for number in prints:
                    self.complain("prints", f"{path}:{number}", "the library neither prints nor exits, and the tool only through src/cli/output/print.hpp")
            if path.startswith("include/spectile/") and not path.startswith("include/spectile/bench/"):
                public.append(path.removeprefix("include/"))
        self.check_umbrella(public)
        self.check_folders()
        return self.complaints

    def check_order(self):
        known = set()
        for name, _, may_include in ROOMS:
            for other in may_include.split():
                if other not in known:
                    self.complain("order", "tests/rules/floor_plan.py", f"{name} may not name {other}, which is not below it")
            known.add(name)

    def check_include(self, path, place, mark, header):
        room = room_of(path)
        if mark == '"' or header.startswith("spectile/"):
            self.check_edge(path, place, room, mark, header)
            return
        library = next((entry for entry in LIBRARIES if re.match(entry[1], header)), None)
        if library:
            name, _, places = library
            if not matches(path, places):
                self.complain(name, place, f"includes {header}; {name} is for {places}")
        elif "/" in header:
            self.complain("other", place, f"includes {header} of a library that no room is for")
        if path.startswith("include/") and ("/" in header or "." in header):
            self.complain("public", place, f"includes {header}; public headers know the standard library and spectile")
        if path.startswith("kernels/") and header not in KERNEL_HEADERS:
            self.complain("kernels", place, f"includes {header}; kernels' units hold raw-pointer code")

    def check_edge(self, path, place, room, mark, header):
        target = "include/" + header if mark == "<" else header
        other = room_of(target)
        if not os.path.isfile(os.path.join(self.root, target)):
            self.complain("path", place, f"{header}: no such file; includes are written from the project's folder")
            return
        if path.startswith("include/") and mark == '"':
            self.complain("public", place, f"includes {header}, which is not installed")
        if room in PUBLIC_HEADERS_ONLY and mark == '"' and other != room:
            self.complain("private", place, f"includes {header}; {room} sees <spectile/...> only")
        allowed = next((may_include.split() for name, _, may_include in ROOMS if name == room), [])
        if room is None or other is None:
            self.complain("room", place, f"{path if room is None else header} is in no room")
        elif other != room and other not in allowed:
            self.complain("edge", place, f"includes {header}; {room} may include {' '.join(allowed) or 'nothing'}, not {other}")

    def check_umbrella(self, public):
        umbrella = "include/spectile/spectile.hpp"
        with open(os.path.join(self.root, umbrella), encoding="utf-8") as file:
            text = file.read()
        for header in public:
            if f"<{header}>" not in text and header != "spectile/spectile.hpp":
                self.complain("umbrella", umbrella, f"lacks {header}")

    def check_folders(self):
        count = {}
        for path in self.files:
            count[os.path.dirname(path)] = count.get(os.path.dirname(path), 0) + 1
        for folder, files in count.items():
            if files > MAX_FILES and not matches(folder, SIZE_EXEMPT):
                self.complain("files", folder, f"{files} files, at most {MAX_FILES}")


def main():
    complaints = FloorPlan(sys.argv[1]).check()
    print("\n".join(complaints) if complaints else "every room is in order")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
