#!/usr/bin/env python3
"""Memory ends while the first thread is made: each call of malloc around it fails, once and from then on.

usage: starting.py SPECTILE LIBSPECTILE_FAULTS
"""
import sys

import scenarios
import sweep
from tool import Tool, Workplace, skip_if_sanitized

BEFORE, AFTER = 60, 30  # calls of malloc; oneTBB 2021.8 makes some 20 before its first thread


def main():
    program, shim = sys.argv[1:]
    skip_if_sanitized(program)
    problems, crashes, refused = [], [], 0
    with Workplace() as workplace:
        inputs = workplace.folder("inputs")
        tool = Tool(program, shim, time_limit_s=5)
        scenario = next(s for s in scenarios.all_scenarios(tool, inputs) if s.name == "upsample")
        clean = scenarios.clean_run(tool, scenario, inputs, workplace.fresh(), False)
        first = clean[0].calls["malloc_at_thread"]
        if first <= BEFORE:
            problems.append(f"{first} calls of malloc before the first thread: too few to be true")
        for n in range(max(1, first - BEFORE), first + AFTER):
            for persistent in (False, True):
                fault = ("malloc", n, "ENOMEM", persistent)
                outcome, found, _ = sweep.run_with_fault(tool, scenario, inputs, workplace.fresh(), clean, fault, False)
                refused += outcome.exit == 3
                # dlopen() of glibc 2.36 reads through -1 where one fails, there is no room for the reason, and the next
                # works: one of these calls.
                if persistent and outcome.exit == -11:
                    crashes.append(n)
                else:
                    problems += [f"{sweep.spec_of(*fault)}: {kind} {text}" for kind, text in found]
        tool.close()
    if len(crashes) > 1:
        problems.append(f"crashes: malloc {crashes}")
    if refused < BEFORE:
        problems.append(f"{refused} runs without memory: too few to be true")
    for problem in problems:
        print(problem)
    print(f"{refused} runs ended for want of memory, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
