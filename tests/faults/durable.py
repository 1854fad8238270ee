#!/usr/bin/env python3
"""Outputs are on the device before a command ends: films always, images with --fsync, and neither where the device fails.

Counts calls of fsync: one for a file, one for its folder. usage: durable.py SPECTILE LIBSPECTILE_FAULTS
"""
import os
import sys

import scenarios
from tool import Tool, Workplace, skip_if_sanitized

IMAGE = ["upsample", "in.exr", "-o", "out.exr", "--bands", "400:700:20", "--quiet"]
MERGE = ["film", "merge", "film0.exr", "film1.exr", "-o", "out.exr", "--quiet"]
# A command, and the files that it makes durable.
COMMANDS = [(IMAGE, 0), (IMAGE + ["--fsync"], 1), (MERGE, 1),
            (["film", "develop", "film0.exr", "-o", "out.exr", "--quiet"], 0),
            (["film", "develop", "film0.exr", "-o", "out.exr", "--quiet", "--fsync"], 1),
            (["film", "average", "image0.exr", "image1.exr", "-o", "out.exr", "--quiet", "--fsync"], 1)]


def main():
    program, shim = sys.argv[1:]
    skip_if_sanitized(program)
    problems = []
    with Workplace() as workplace:
        folder = workplace.folder("inputs")
        tool = Tool(program, shim)
        scenarios.make_inputs(tool, folder)
        target = os.path.join(folder, "out.exr")

        def run(arguments, fault=None):
            if os.path.exists(target):
                os.unlink(target)
            return tool.run(arguments, folder, fault)

        for arguments, files in COMMANDS:
            outcome = run(arguments)
            calls = outcome.calls.get("fsync", 0)
            if outcome.exit != 0 or calls != 2 * files:
                problems.append(f"exit {outcome.exit}, {calls} calls of fsync for {files} files: {' '.join(arguments)}")
            if not files:
                continue
            outcome = run(arguments, "fsync:1:EIO")
            if outcome.exit != 3 or outcome.injected != 1 or os.path.exists(target):
                problems.append(f"exit {outcome.exit} where the file's fsync fails: {' '.join(arguments)}")
            outcome = run(arguments, "fsync:2:EIO")
            if outcome.exit != 3 or outcome.injected != 1:
                problems.append(f"exit {outcome.exit} where the folder's fsync fails: {' '.join(arguments)}")
        outcome = run(scenarios.LONG_FILM + ["-o", "out.exr", "--checkpoint", "check.exr"])
        if outcome.exit != 0 or outcome.calls.get("fsync", 0) < 4:
            problems.append(f"exit {outcome.exit}, {outcome.calls.get('fsync', 0)} calls of fsync with checkpoints")
        tool.close()
    print("\n".join(problems) or f"{len(COMMANDS) + 1} commands make their outputs durable")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
