#!/usr/bin/env python3
"""Stops the tool's commands by SIGKILL, SIGTERM and SIGINT at random moments, and checks what is left.

Targets are the old file or the new one, nothing else is left, the exit code is 128 and the signal's number, and the same
command run again ends with the same bytes: checkpoints, manifests and --update go on from where they were. Then films
that take seconds are stopped: the answer may take a second. Exit code 1: there are problems.
"""
import collections
import json
import os
import random
import re
import shlex
import signal
import sys
import time

import checks
import scenarios
from tool import Tool, Workplace, driver_options, read_folder, skip_if_sanitized

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
ANSWER_S = 1.0
KINDS = ("crash", "hang", "wrong", "torn", "leftover", "code", "lines", "slow", "again")


def answer_problems(outcome, number, seconds, limit_s):
    """Of the exit code, the message, and the time that it took."""
    if outcome.late:
        return [("hang", f"{number.name}: no end")]
    problems = []
    if seconds > limit_s:
        problems.append(("slow", f"{number.name}: an answer after {seconds:.1f} s"))
    lines = outcome.err.splitlines()
    if outcome.exit == 128 + number:
        if len(lines) != 1 or not re.search("interrupted|stopped", lines[0]):
            problems.append(("lines", f"{number.name}: {outcome.err[:300]!r}"))
    elif outcome.exit not in (0, -number):  # done already, or not converting yet
        kind = "crash" if outcome.crashed else "code"
        problems.append((kind, f"{number.name}: exit {outcome.exit}: {outcome.err[:300].rstrip()}"))
    return problems


def stop_once(tool, scenario, folder, clean, number, moment_s, limit_s=ANSWER_S):
    """Starts the command in a folder and sends a signal. Outcome, and problems."""
    before = read_folder(folder)
    outcome = tool.run(scenario.arguments, folder, stop=(moment_s, number))
    after = read_folder(folder)
    problems = answer_problems(outcome, number, outcome.seconds - moment_s, limit_s)
    more, _ = checks.check_targets(tool, scenario, folder, before, after, clean, outcome.exit == 0)
    if number == signal.SIGKILL:
        # Between its temporary name and its own a file has both; nobody can tidy up after this signal.
        more = [(kind, text) for kind, text in more if kind != "leftover" or is_untidied(text)]
    return outcome, problems + more


def is_untidied(text):
    name = os.path.basename(text)
    return not (name.startswith(".spectile-") and name.endswith(".part")) and not text.endswith("/, empty")


def run_again(tool, scenario, folder, clean, clean_outcome):
    """Problems of the same command after it was stopped: it must end as if it had not been."""
    outcome = tool.run(scenario.arguments, folder)
    if outcome.exit != 0:
        return [("again", f"exit {outcome.exit}: {outcome.err[:300].rstrip()}")]
    after = read_folder(folder)
    problems = [("again", f"{path} {checks.describe(after.get(path))}") for path in scenario.targets
                if after.get(path) != clean.get(path)]
    problems += [("again", f"{path} is not whole") for path, is_whole in scenario.special.items()
                 if path in after and not is_whole(tool, folder, path, None)]
    if scenario.prints and outcome.out != clean_outcome.out:
        problems.append(("again", f"it printed {outcome.out[:300]!r}"))
    return problems


def adapt(scenario):
    """A manifest goes with --update."""
    if scenario.name == "upsample-folder":
        scenario.arguments = [*scenario.arguments, "--update"]
    return scenario


def stop_long(tool, scenario, inputs, workplace, draw, runs):
    """The same of a command that takes seconds, which is to answer: it is not run again."""
    outcome, files = scenarios.clean_run(tool, scenario, inputs, workplace.fresh(), True)
    for i in range(runs):
        number = (signal.SIGTERM, signal.SIGINT)[i % 2]
        folder = workplace.fresh()
        scenario.prepare(inputs, folder, True)
        moment_s = outcome.seconds * draw.uniform(0.05, 0.95)
        stopped, problems = stop_once(tool, scenario, folder, files, number, moment_s)
        yield number, stopped, [(kind, f"after {moment_s:.2f} of {outcome.seconds:.2f} s: {text}") for kind, text in problems]
        scenarios.remove(folder)


def stop_scenario(tool, scenario, inputs, workplace, draw, runs):
    """Yields what happened in each of the runs, and its problems."""
    cleans = {with_old: scenarios.clean_run(tool, scenario, inputs, workplace.fresh(), with_old) for with_old in (False, True)}
    for i in range(runs):
        with_old = draw.random() < 0.5
        outcome, files = cleans[with_old]
        folder = workplace.fresh()
        scenario.prepare(inputs, folder, with_old)
        # As many stops as it takes to meet a checkpoint of a checkpoint.
        stops = draw.choice((1, 1, 2, 3)) if scenario.special else 1
        for _ in range(stops):
            number = SIGNALS[i % len(SIGNALS)] if stops == 1 else draw.choice(SIGNALS)
            # Most of the time before the end, where the files are written.
            moment_s = outcome.seconds * draw.triangular(0, 1.1, 0.9)
            stopped, problems = stop_once(tool, scenario, folder, files, number, moment_s)
            yield number, stopped, [(kind, f"after {moment_s * 1000:.0f} ms: {text}") for kind, text in problems]
        yield None, None, run_again(tool, scenario, folder, files, outcome)
        scenarios.remove(folder)


def long_scenarios(tool, folder):
    """Commands that take seconds: each answers within one."""
    film = ["film", "simulate", "--size", "1024", "1024", "--wavelengths", "1", "--threads", "2", "--quiet"]
    names = [f"big{i}.exr" for i in range(2)]
    for name, seed in zip(names, "12"):
        outcome = tool.run([*film, "--samples", "2", "--seed", seed, "-o", name, "--statistics", "variance"], folder)
        if outcome.exit != 0:
            raise RuntimeError(f"inputs cannot be made: {outcome.err}")
    images = []
    for name in names:
        images.append("image-" + name)
        outcome = tool.run(["film", "develop", name, "-o", images[-1], "--depth", "float", "--quiet"], folder)
        if outcome.exit != 0:
            raise RuntimeError(f"inputs cannot be made: {outcome.err}")
    return [
        scenarios.Scenario("long-simulate", [*film, "--samples", "64", "-o", "film.exr"], [], ["film.exr"]),
        scenarios.Scenario("long-save", [*film, "--samples", "2", "-o", "film.exr", "--compression", "zip:9"], [], ["film.exr"]),
        scenarios.Scenario("long-merge", ["film", "merge", *names, "-o", "all.exr", "--compression", "zip:9", "--threads", "2"],
                           names, ["all.exr"]),
        scenarios.Scenario("long-develop", ["film", "develop", names[0], "-o", "image.exr", "--to", "variance", "--depth", "float",
                                            "--compression", "zip:9", "--threads", "1"], names[:1], ["image.exr"]),
        scenarios.Scenario("long-average", ["film", "average", *images * 20, "-o", "mean.exr", "--compression", "zip:9", "--threads",
                                            "1"], images, ["mean.exr"]),
        scenarios.Scenario("long-upsample", ["upsample", images[0], "-o", "spectral.exr", "--compression", "zip:9", "--quantity",
                                             "illuminant", "--threads", "2"], images[:1], ["spectral.exr"]),
    ]


class Report:
    def __init__(self):
        self.rows = collections.OrderedDict()
        self.problems = []

    def add(self, scenario, number, outcome, problems):
        row = self.rows.setdefault(scenario.name, collections.Counter())
        row["runs"] += 1
        if outcome:
            row["finished"] += outcome.exit == 0
            row["answered"] += outcome.exit == 128 + number
            row["ended"] += outcome.exit == -number
        for kind in {kind for kind, _ in problems}:
            row[kind] += 1
        self.problems += [{"scenario": scenario.name, "kind": kind, "problem": text,
                           "command": shlex.join(["spectile", *scenario.arguments])} for kind, text in problems]

    def print(self):
        columns = ("runs", "finished", "answered", "ended", *KINDS)
        print(f"{'scenario':16}" + "".join(f"{name:>9}" for name in columns))
        for name, row in self.rows.items():
            print(f"{name:16}" + "".join(f"{row[column]:9}" for column in columns))
        for problem in self.problems:
            print(f"\n[{problem['kind']}] {problem['scenario']} {problem['problem']}\n    {problem['command']}")


def main():
    parser = driver_options(__doc__, 3, "SCENARIO", "runs of each scenario")
    parser.add_argument("--long", type=int, default=0, help="runs of each long command (default 0)")
    options = parser.parse_args()
    skip_if_sanitized(options.tool)
    start = time.monotonic()
    report = Report()
    with Workplace() as workplace:
        inputs = workplace.folder("inputs")
        maker = Tool(options.tool, options.shim)
        everything = [adapt(scenario) for scenario in scenarios.all_scenarios(maker, inputs)]
        maker.close()
        tool = Tool(options.tool)  # a signal meets the tool as it is
        plan = [(scenario, options.runs, stop_scenario) for scenario in everything if options.runs]
        if options.long:
            plan += [(scenario, options.long, stop_long) for scenario in long_scenarios(tool, inputs)]
        for scenario, runs, stop in plan:
            if options.only and scenario.name not in options.only:
                continue
            draw = random.Random(f"{options.seed} {scenario.name}")
            for number, outcome, problems in stop(tool, scenario, inputs, workplace, draw, runs):
                report.add(scenario, number, outcome, problems)
        tool.close()
    report.print()
    print(f"\n{sum(row['runs'] for row in report.rows.values())} runs in {time.monotonic() - start:.0f} s, "
          f"{len(report.problems)} problems")
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"seed": options.seed, "rows": report.rows, "problems": report.problems}, file, indent=1)
    return 1 if report.problems or not report.rows else 0


if __name__ == "__main__":
    sys.exit(main())
