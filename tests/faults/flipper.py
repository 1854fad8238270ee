#!/usr/bin/env python3
"""Flips a bit of files that the tool reads, or cuts them short, and has them read.

The tool must say in one line what is wrong, or take the file as it is; it must not crash, hang or take much memory. A film
carries a checksum over its sums: a damaged one is refused, or gives the same result. Exit code 1: there are problems.
"""
import collections
import json
import os
import random
import shlex
import shutil
import sys
import time

import checks
import scenarios
from tool import Tool, Workplace, driver_options, skip_if_sanitized

MAX_MEMORY_BYTES = 2 << 30
ADDRESSES_BYTES = 2 * MAX_MEMORY_BYTES  # so that a file that asks for all memory takes it from nobody else
KINDS = ("crash", "hang", "memory", "wrong", "leftover", "code", "lines", "words")
OUT = "out.exr"

SPDX = """<?xml version="1.0" encoding="UTF-8"?>
<IESTM2714 version="1.0">
<Header/>
<SpectralDistribution>
<SpectralQuantity>flux</SpectralQuantity>
{}</SpectralDistribution>
</IESTM2714>
"""


def make_files(tool, folder):
    """A file of each format: its name, the commands that read it, and whether its result is guarded by a checksum."""
    def run(*arguments):
        outcome = tool.run([*arguments, "--quiet"], folder)
        if outcome.exit != 0:
            raise RuntimeError(f"inputs cannot be made: {arguments}: {outcome.err}")

    def write(name, text):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    scenarios.write_rgb(os.path.join(folder, "in.exr"), 16, 16, 0)
    threads = ["--threads", "2"]
    spectral = [["info", "FILE", "--pixel", "3,4"], ["validate", "FILE"], ["project", "FILE", "-o", OUT, *threads],
                ["convert", "FILE", "-o", OUT, *threads]]
    out = []
    for compression in ("none", "rle", "zips", "zip", "piz"):
        run("upsample", "in.exr", "-o", f"spectral-{compression}.exr", "--bands", "400:700:20", "--compression", compression)
        out.append((f"spectral-{compression}.exr", spectral, False))
    run("upsample", "in.exr", "-o", "tiled.exr", "--bands", "400:700:20", "--tile", "8", "8", "--mipmap")
    run("upsample", "in.exr", "-o", "coefficients.exr", "--store", "coefficients")
    out += [("tiled.exr", spectral, False), ("coefficients.exr", [["expand", "FILE", "-o", OUT, *threads]], False)]
    for name, *options in (["film-none.exr", "--compression", "none"], ["film-piz.exr", "--compression", "piz"],
                           ["film-zip.exr"], ["film-rle.exr", "--compression", "rle", "--statistics", "variance"],
                           ["film-spectral.exr", "--compression", "zips", "--spectral", "--bands", "400:700:60"]):
        other = f"other-{name}"
        run(*scenarios.FILM, *options, "--shard", "0/2", "-o", name)
        run(*scenarios.FILM, *options, "--shard", "1/2", "-o", other)
        out.append((name, [["film", "develop", "FILE", "-o", OUT, "--depth", "float", *threads],
                           ["film", "merge", "FILE", other, "-o", OUT, *threads]], True))
    run("plan", "--illuminant", "D65", "--count", "3", "--folds", "0", "-o", "plan.json")
    out.append(("plan.json", [["upsample", "in.exr", "-o", OUT, "--bands", "FILE", *threads]], False))
    values = [(nm, 50 + (nm * 7 % 40)) for nm in range(380, 785, 5)]
    write("light.csv", "wavelength,power\n" + "".join(f"{nm},{value}\n" for nm, value in values))
    write("light.spd", "".join(f"{nm} {value}\n" for nm, value in values))
    write("light.spdx", SPDX.format("".join(f'<SpectralData wavelength="{nm}">{value}</SpectralData>\n' for nm, value in values)))
    out += [(name, [["spectra", "FILE"], ["relight", "in.exr", "-o", OUT, "--illuminant", "FILE", *threads]], False)
            for name in ("light.csv", "light.spd", "light.spdx")]
    return out


def damage(contents, draw):
    """Damaged bytes, and what was done to them: mostly near the beginning, where the headers are."""
    if draw.random() < 0.2:
        length = draw.randrange(len(contents))
        return contents[:length], f"cut to {length} bytes"
    at = int(len(contents) * draw.random() ** 3)
    bit = draw.randrange(8)
    out = bytearray(contents)
    out[at] ^= 1 << bit
    return bytes(out), f"bit {bit} of byte {at} flipped"


def read_out(folder):
    path = os.path.join(folder, OUT)
    if not os.path.exists(path):
        return None
    with open(path, "rb") as file:
        contents = file.read()
    os.unlink(path)
    return contents


def problems_of(outcome, guarded, expected, result, left):
    if outcome.late:
        return [("hang", "")]
    problems = []
    if outcome.memory_bytes > MAX_MEMORY_BYTES:
        problems.append(("memory", f"{outcome.memory_bytes >> 20} MiB"))
    if outcome.crashed:
        return problems + [("crash", f"exit {outcome.exit}: {outcome.err[-300:].rstrip()}")]
    if left:
        problems.append(("leftover", " ".join(left)))
    if outcome.exit == 0:
        if guarded and result != expected:
            problems.append(("wrong", f"exit 0, and the result is {checks.describe(result)}"))
        return problems
    if result is not None:
        problems.append(("leftover", OUT))
    if outcome.exit not in (1, 2):  # 2: a file that an option names
        problems.append(("code", f"exit {outcome.exit}: {outcome.err[:300].rstrip()}"))
    lines = outcome.err.splitlines()
    # `validate` lists what a file breaks on standard output.
    if not (len(lines) == 1 and lines[0].startswith("spectile: ")) and not (not lines and outcome.out):
        problems.append(("lines", f"{len(lines)} lines on standard error: {outcome.err[:300]!r}"))
    if checks.INTERNAL.search(outcome.err):
        problems.append(("words", outcome.err[:300].rstrip()))
    return problems


def flip(tool, folder, name, commands, guarded, draw, runs):
    """Yields the command, what was done to the file, the outcome, and the problems of each run."""
    with open(os.path.join(folder, name), "rb") as file:
        contents = file.read()
    damaged_name = "damaged" + os.path.splitext(name)[1]
    path = os.path.join(folder, damaged_name)
    expected = {}
    for i, command in enumerate(commands):
        shutil.copyfile(os.path.join(folder, name), path)
        outcome = tool.run([damaged_name if word == "FILE" else word for word in command], folder)
        if outcome.exit != 0:
            raise RuntimeError(f"{command} fails with an undamaged file: {outcome.err}")
        expected[i] = read_out(folder)
    before = set(os.listdir(folder))
    for _ in range(runs):
        i = draw.randrange(len(commands))
        damaged, done = damage(contents, draw)
        with open(path, "wb") as file:
            file.write(damaged)
        arguments = [damaged_name if word == "FILE" else word for word in commands[i]]
        outcome = tool.run(arguments, folder, memory_bytes=ADDRESSES_BYTES)
        result = read_out(folder)
        left = sorted(set(os.listdir(folder)) - before)
        for leftover in left:
            os.unlink(os.path.join(folder, leftover))
        yield arguments, done, outcome, problems_of(outcome, guarded, expected[i], result, left)


def main():
    parser = driver_options(__doc__, 6, "FILE", "damaged files of each format")
    options = parser.parse_args()
    skip_if_sanitized(options.tool)
    start = time.monotonic()
    rows, problems = collections.OrderedDict(), []
    with Workplace() as workplace:
        folder = workplace.folder("files")
        tool = Tool(options.tool)
        for name, commands, guarded in make_files(tool, folder):
            if options.only and name not in options.only:
                continue
            draw = random.Random(f"{options.seed} {name}")
            row = rows.setdefault(name, collections.Counter())
            for arguments, done, outcome, found in flip(tool, folder, name, commands, guarded, draw, options.runs):
                row["runs"] += 1
                row["exit0"] += outcome.exit == 0
                row["errors"] += outcome.exit > 0
                row["MiB"] = max(row["MiB"], outcome.memory_bytes >> 20)
                for kind in {kind for kind, _ in found}:
                    row[kind] += 1
                problems += [{"file": name, "damage": done, "kind": kind, "problem": text,
                              "command": shlex.join(["spectile", *arguments])} for kind, text in found]
        tool.close()
    columns = ("runs", "exit0", "errors", "MiB", *KINDS)
    print(f"{'file':20}" + "".join(f"{column:>9}" for column in columns))
    for name, row in rows.items():
        print(f"{name:20}" + "".join(f"{row[column]:9}" for column in columns))
    for problem in problems:
        print(f"\n[{problem['kind']}] {problem['file']}, {problem['damage']}: {problem['problem']}\n    {problem['command']}")
    runs = sum(row["runs"] for row in rows.values())
    print(f"\n{runs} runs in {time.monotonic() - start:.0f} s, {len(problems)} problems")
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"seed": options.seed, "runs": runs, "rows": rows, "problems": problems}, file, indent=1)
    return 1 if problems or runs == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
