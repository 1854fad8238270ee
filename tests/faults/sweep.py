#!/usr/bin/env python3
"""Runs the tool's commands with one failing call of the system after the other, and checks what each run leaves.

The calls of each function are counted in a run without a fault. Then the n-th fails, once or from then on: all n where
there are few, else a sample with a fixed seed. Prints a table of scenarios and functions, and each problem once, with
the command that shows it again. Exit code 1: there are problems.
"""
import collections
import concurrent.futures
import errno
import json
import random
import re
import shlex
import sys
import threading
import time

import checks
import scenarios
from tool import Tool, Workplace, driver_options, read_folder, skip_if_sanitized

# Errors and other faults of each function that are tried; those of one line are drawn from the same calls.
FAULTS = {
    "read": ["EIO"],
    "pread": ["EIO"],
    "write": ["ENOSPC", "EIO", "short"],
    "pwrite": ["ENOSPC", "EIO", "short", "EINTR"],
    "fwrite": ["ENOSPC"],
    "open": ["EMFILE", "EACCES"],
    "close": ["EIO"],
    "rename": ["EACCES", "EIO"],
    "linkat": ["ENOSPC", "EIO"],
    "fsync": ["EIO"],
    "ftruncate": ["ENOSPC"],
    "mmap": ["ENOMEM"],
    "malloc": ["ENOMEM"],
    "pthread_create": ["EAGAIN"],
}
ENDS = 50  # calls at the beginning and at the end that come before those in between, where there are many


def calls_in_order(count, draw):
    """Numbers from 1 to count, the ones to try first in front: the ends, then a sample of the rest."""
    first = list(range(1, min(ENDS, count) + 1))
    last = [n for n in range(count, max(count - ENDS, 0), -1) if n > ENDS]
    rest = draw.sample(range(ENDS + 1, count - ENDS + 1), min(2000, count - 2 * ENDS)) if count > 2 * ENDS else []
    ends = first + last
    draw.shuffle(ends)
    # One of the ends, then one of the rest.
    out = []
    for i in range(max(len(ends), len(rest))):
        out += ends[i:i + 1] + rest[i:i + 1]
    return out


def planned_faults(calls, draw, runs):
    """At most `runs` faults: functions in turn, each with its own numbers of calls; malloc four times as often."""
    queues = []
    for function, errors in FAULTS.items():
        count = calls.get(function, 0)
        if count == 0:
            continue
        faults = []
        for n in calls_in_order(count, draw):
            kinds = [(error, persistent) for error in errors for persistent in (False, True)
                     if not (error == "EINTR" and persistent)]
            draw.shuffle(kinds)
            faults.append([(function, n, error, persistent) for error, persistent in kinds])
        # All first choices of the kind of fault before all second ones.
        ordered = [fault for kinds in zip_longest(faults) for fault in kinds]
        queues.append((4 if function == "malloc" else 1, ordered))
    out = []
    while len(out) < runs and any(queue for _, queue in queues):
        for weight, queue in queues:
            out += queue[:weight]
            del queue[:weight]
    return out[:runs]


def zip_longest(lists):
    for i in range(max(map(len, lists), default=0)):
        yield [each[i] for each in lists if i < len(each)]


def spec_of(function, n, error, persistent):
    return f"{function}:{n}:{error}" + (":persistent" if persistent else "")


def run_with_fault(tool, scenario, inputs, folder, clean, fault, with_old):
    """Outcome, problems, and how many targets are whole. `clean`: outcome and files of a run without a fault."""
    function, _, error, persistent = fault
    scenario.prepare(inputs, folder, with_old)
    before = read_folder(folder)
    outcome = tool.run(scenario.arguments, folder, spec_of(*fault))
    after = read_folder(folder)
    number = getattr(errno, error, None)
    problems, whole = checks.check_run(tool, scenario, folder, outcome, before, after, clean[1], clean[0],
                                       (function, number, persistent))
    # Lines of a manifest are one write each, shared between processes: the rest of a short one cannot follow it.
    harmless = error == "EINTR" or (error == "short" and function != "write")
    if outcome.exit > 0 and harmless and not outcome.late and not outcome.crashed:
        problems.append(("wrong", f"a short or interrupted call is no error: exit {outcome.exit} {outcome.err[:300]}"))
    return outcome, problems, whole


class Sweep:
    def __init__(self, options, workplace):
        self.options = options
        self.workplace = workplace
        self.tools = threading.local()
        self.all_tools = []
        self.lock = threading.Lock()
        self.rows = {}
        self.problems = []

    def tool(self):
        """One for each thread: it has a report of its own."""
        if not hasattr(self.tools, "tool"):
            self.tools.tool = Tool(self.options.tool, self.options.shim)
            with self.lock:
                self.all_tools.append(self.tools.tool)
        return self.tools.tool

    def fresh_folder(self):
        with self.lock:
            return self.workplace.fresh()

    def clean(self, scenario, inputs, with_old):
        """Outcome and files without a fault: twice, since what differs by itself proves nothing."""
        first = scenarios.clean_run(self.tool(), scenario, inputs, self.fresh_folder(), with_old)
        _, again = scenarios.clean_run(self.tool(), scenario, inputs, self.fresh_folder(), with_old)
        for path in scenario.targets:
            if first[1].get(path) is None or first[1][path] != again.get(path):
                raise RuntimeError(f"{scenario.name}: {path} is missing, or differs from run to run")
        return first

    def one(self, scenario, inputs, clean, fault):
        function, n, _, _ = fault
        with_old = n % 2 == 0
        folder = self.fresh_folder()
        outcome, problems, whole = run_with_fault(self.tool(), scenario, inputs, folder, clean[with_old], fault, with_old)
        with self.lock:
            row = self.rows[scenario.name, function]
            row["runs"] += 1
            row["exit0"] += outcome.exit == 0
            row["errors"] += outcome.exit > 0 and not outcome.crashed and not outcome.late
            row["targets"] += len(scenario.targets) + len(scenario.special)
            row["whole"] += whole
            for kind in {kind for kind, _ in problems}:
                row[kind] += 1
            for kind, text in problems:
                self.problems.append({"scenario": scenario.name, "fault": spec_of(*fault), "kind": kind, "problem": text,
                                      "old": with_old, "command": shlex.join(["spectile", *scenario.arguments])})
        if not self.options.keep:
            scenarios.remove(folder)

    def run(self, pool):
        inputs = self.workplace.folder("inputs")
        everything = scenarios.all_scenarios(self.tool(), inputs)
        wanted = [s for s in everything if not self.options.only or s.name in self.options.only]
        jobs = []
        for scenario in wanted:
            # The bytes of a name, and no hash, which differs from process to process.
            draw = random.Random(f"{self.options.seed} {scenario.name}")
            clean = {with_old: self.clean(scenario, inputs, with_old) for with_old in (False, True)}
            calls = clean[False][0].calls
            if not calls.get("malloc"):
                raise RuntimeError("no calls are counted: the tool does not load libspectile_faults.so")
            seconds = clean[False][0].seconds
            # Long commands get fewer runs.
            runs = max(min(12, self.options.runs), int(self.options.runs * min(1, 0.08 / seconds)))
            faults = planned_faults(calls, draw, runs)
            if self.options.fault:
                faults = [parse_fault(self.options.fault)]
            for function in FAULTS:
                self.rows[scenario.name, function] = collections.Counter(calls=calls.get(function, 0))
            jobs += [(scenario, inputs, clean, fault) for fault in faults]
        for done in [pool.submit(self.one, *job) for job in jobs]:
            done.result()


def parse_fault(text):
    function, n, error, *rest = text.split(":")
    return function, int(n), error, rest == ["persistent"]


COLUMNS = ("calls", "runs", "exit0", "errors", "targets", "whole", *checks.KINDS)


def print_table(rows):
    print(f"{'scenario':16}{'function':16}" + "".join(f"{name:>9}" for name in COLUMNS))
    total = collections.Counter()
    for (scenario, function), row in rows.items():
        if row["runs"]:
            print(f"{scenario:16}{function:16}" + "".join(f"{row[name]:9}" for name in COLUMNS))
            total += row
    total["calls"] = 0
    print(f"{'all':32}" + "".join(f"{total[name] if name != 'calls' else '':>9}" for name in COLUMNS))


def print_problems(problems):
    """Those that differ by the scenario and the number of the call only, once."""
    groups = collections.OrderedDict()
    for problem in sorted(problems, key=lambda p: (checks.KINDS.index(p["kind"]), p["fault"], p["scenario"])):
        function = problem["fault"].split(":")[0]
        key = problem["kind"], function, re.sub(r"\d+|[\w/-]+\.(exr|json|jsonl|html)", "#", problem["problem"])
        groups.setdefault(key, []).append(problem)
    for group in groups.values():
        first = group[0]
        where = sorted({problem["scenario"] for problem in group})
        print(f"\n[{first['kind']}] {first['problem']}\n    {len(group)} runs of {' '.join(where)}")
        print(f"    SPECTILE_FAULT={first['fault']} LD_PRELOAD=libspectile_faults.so {first['command']}")


def main():
    parser = driver_options(__doc__, 12, "SCENARIO", "runs of each scenario at most")
    parser.add_argument("--fault", help="only this, such as pwrite:3:ENOSPC:persistent, in each scenario")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--keep", metavar="FOLDER", help="keep the folders of all runs here")
    options = parser.parse_args()
    skip_if_sanitized(options.tool)
    start = time.monotonic()
    with Workplace(options.keep) as workplace, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        sweep = Sweep(options, workplace)
        try:
            sweep.run(pool)
        finally:
            for tool in sweep.all_tools:
                tool.close()
    print_table(sweep.rows)
    print_problems(sweep.problems)
    runs = sum(row["runs"] for row in sweep.rows.values())
    print(f"\n{runs} runs in {time.monotonic() - start:.0f} s, {len(sweep.problems)} problems")
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"seed": options.seed, "runs": runs, "problems": sweep.problems,
                       "rows": [{"scenario": scenario, "function": function, **{name: row[name] for name in COLUMNS}}
                                for (scenario, function), row in sweep.rows.items()]}, file, indent=1)
    return 1 if sweep.problems or runs == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
