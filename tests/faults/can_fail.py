#!/usr/bin/env python3
"""Each check of failing calls, stopped runs and damaged files finds its problem: a script that stands in for the tool makes it.

usage: can_fail.py SPECTILE LIBSPECTILE_FAULTS
"""
import os
import random
import signal
import sys

import flipper
import killer
import scenarios
import sweep
from tool import Tool, Workplace, skip_if_sanitized

# The wrong done by broken.sh, and the kind of problem that must be found and no other.
CALLS = {"nothing": [], "wrong": ["wrong"], "torn": ["torn"], "input": ["torn"], "leftover": ["leftover"], "code": ["code"],
         "silent": ["lines"], "words": ["words"], "reason": ["reason"], "file": ["file"], "crash": ["crash"],
         "hang": ["hang"]}

STOPS = {"nothing": [], "torn": ["torn"], "leftover": ["leftover"], "code": ["code"], "slow": ["slow"], "silent": ["lines"],
         "crash": ["crash"], "again": ["again"]}
DAMAGES = {"nothing": [], "wrong": ["wrong"], "leftover": ["leftover"], "code": ["code"], "silent": ["lines"],
           "words": ["words"], "crash": ["crash"], "hang": ["hang"]}


def broken_tool(program, shim, wrong, time_limit_s=20, script="broken.sh"):
    tool = Tool(os.path.join(os.path.dirname(os.path.abspath(__file__)), script), shim, time_limit_s)
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


def stopped_runs(program, shim, workplace):
    tool = Tool(program)
    film = ["film", "simulate", "--size", "8", "8", "--samples", "300000", "--wavelengths", "1", "--threads", "2", "--quiet"]
    scenario = scenarios.Scenario("film", [*film, "-o", "film.exr"], [], ["film.exr"])
    outcome, files = scenarios.clean_run(tool, scenario, None, workplace.fresh(), True)
    tool.close()
    for wrong, expected in STOPS.items():
        tool = broken_tool(program, None, wrong, script="broken_stop.sh")
        folder = os.path.join(workplace.folder(f"stop-{wrong}"), "run")
        scenario.prepare(None, folder, True)
        _, problems = killer.stop_once(tool, scenario, folder, files, signal.SIGTERM, outcome.seconds / 2)
        if wrong == "again":
            problems += killer.run_again(tool, scenario, folder, files, outcome)
        tool.close()
        yield f"stops: {wrong}", expected, sorted({kind for kind, _ in problems})


def damaged_files(program, _shim, workplace):
    folder = workplace.folder("damages")
    tool = Tool(program)
    name, commands, guarded = next(entry for entry in flipper.make_files(tool, folder) if entry[0] == "film-zip.exr")
    tool.close()
    flipper.damage = lambda contents, _draw: (contents[:len(contents) // 2], "cut")
    for wrong, expected in [*DAMAGES.items(), ("memory", ["memory"])]:
        if wrong == "memory":
            flipper.MAX_MEMORY_BYTES = 1 << 20
        tool = broken_tool(program, None, wrong, time_limit_s=2)
        found = [problems for *_, problems in flipper.flip(tool, folder, name, commands[:1], guarded, random.Random(1), 1)]
        tool.close()
        yield f"damages: {wrong}", expected, sorted({kind for kind, _ in found[0]})


def main():
    program, shim = sys.argv[1:3]
    skip_if_sanitized(program)
    failures = 0
    with Workplace() as workplace:
        for checked in (failing_calls, stopped_runs, damaged_files):
            for name, expected, found in checked(program, shim, workplace):
                good = expected == found
                failures += not good
                print(f"{'ok  ' if good else 'FAIL'} {name}: {' '.join(found) or 'no problem'}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
