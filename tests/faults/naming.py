#!/usr/bin/env python3
"""How an output gets its name: no memory is taken between its temporary name and its own, and there need be no /proc.

usage: naming.py SPECTILE LIBSPECTILE_FAULTS
"""
import sys

import scenarios
from tool import Tool, Workplace, read_folder, skip_if_sanitized


def main():
    program, shim = sys.argv[1:]
    skip_if_sanitized(program)
    problems, linked = [], 0
    with Workplace() as workplace:
        inputs = workplace.folder("inputs")
        tool = Tool(program, shim)
        without = Tool(program, shim)
        without.extra = {"SPECTILE_FAULT_NO_PROC": "1"}
        for scenario in scenarios.all_scenarios(tool, inputs):
            outcomes, files = [], []
            for each in (tool, without):
                folder = workplace.fresh()
                scenario.prepare(inputs, folder, True)
                outcomes.append(each.run(scenario.arguments, folder))
                found = read_folder(folder)
                files.append({path: found.get(path) for path in scenario.targets})
            name, (usual, bare) = scenario.name, outcomes
            linked += usual.calls["linkat"]
            if usual.exit != 0 or usual.calls["malloc_linked"] != 0:
                problems.append(f"{name}: exit {usual.exit}, {usual.calls['malloc_linked']} allocations after linkat")
            if bare.exit != 0 or bare.err != usual.err or files[0] != files[1] or None in files[1].values():
                problems.append(f"{name}: without /proc exit {bare.exit}, or other outputs: {bare.err[:300]}")
            if bare.calls["linkat"] != 0:
                problems.append(f"{name}: {bare.calls['linkat']} calls of linkat without /proc: it is not hidden")
        tool.close()
        without.close()
    if linked == 0:
        problems.append("no output was linked: nothing is tested")
    print("\n".join(problems) or f"{linked} outputs were linked and renamed without memory, and written without /proc")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
