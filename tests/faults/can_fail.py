#!/usr/bin/env python3
"""Each check of failing calls finds its problem: a script that stands in for the tool makes it.

usage: can_fail.py SPECTILE LIBSPECTILE_FAULTS
"""
import os
import sys

import scenarios
import sweep
from tool import Tool, Workplace, skip_if_sanitized

# The wrong done by broken.sh, and the kind of problem that must be found and no other.
CALLS = {"nothing": [], "wrong": ["wrong"], "torn": ["torn"], "input": ["torn"], "leftover": ["leftover"], "code": ["code"],
         "silent": ["lines"], "words": ["words"], "reason": ["reason"], "file": ["file"], "crash": ["crash"],
         "hang": ["hang"]}


def broken_tool(program, shim, wrong, time_limit_s=20):
    tool = Tool(os.path.join(os.path.dirname(os.path.abspath(__file__)), "broken.sh"), shim, time_limit_s)
    tool.extra = {"SPECTILE_REAL": os.path.abspath(program), "SPECTILE_BROKEN": wrong}
    return tool


def failing_calls(program, shim, workplace):
    inputs = workplace.folder("inputs")
    tool = Tool(program, shim)
    scenario = next(s for s in scenarios.all_scenarios(tool, inputs) if s.name == "upsample")
    clean = scenarios.clean_run(tool, scenario, inputs, workplace.fresh(), False)
    tool.close()
    for wrong, expected in CALLS.items():
        tool = broken_tool(program, shim, wrong, time_limit_s=2)
        _, problems, _ = sweep.run_with_fault(tool, scenario, inputs, workplace.fresh(), clean, ("pwrite", 2, "ENOSPC", False), False)
        tool.close()
        yield f"calls: {wrong}", expected, sorted({kind for kind, _ in problems})


def main():
    program, shim = sys.argv[1:3]
    skip_if_sanitized(program)
    failures = 0
    with Workplace() as workplace:
        for name, expected, found in failing_calls(program, shim, workplace):
            good = expected == found
            failures += not good
            print(f"{'ok  ' if good else 'FAIL'} {name}: {' '.join(found) or 'no problem'}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
