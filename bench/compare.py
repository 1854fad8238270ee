#!/usr/bin/env python3
"""Compares the operations of two builds of spectile in one interleaved run, and fails where the second one loses.

usage: bench/compare.py OLD NEW [--rounds N] [--isa NAME] [--only TEXT] [--least LOSS] [--record HISTORY --label TEXT]

OLD and NEW are spectile commands. Each round runs both, in turn first; an operation's figure is the fraction of the
machine's own limit that it reaches, measured in the same seconds, so that a machine that slows down does not count.
A round gives one ratio new / old for each operation. A loss is real where the median of the ratios is below 1 by more
than LOSS (0.05) and by more than three times the noise: the standard error of the median, from the median of the
ratios' absolute deviations. Exit code 0 without a real loss, 1 with one, 2 for wrong usage or a build that fails.

--record adds the second build's fractions to a history (JSON), as bench/history.json keeps them.
"""
import argparse
import datetime
import json
import math
import statistics
import subprocess
import sys


def measure(command, args):
    """Fractions of the limit by operation and instruction set, of one run."""
    call = [command, "bench", "--quick", "--json", "-q", "--cache-only", "--threads", "1", "--only", args.only]
    if args.isa:
        call += ["--isa", args.isa]
    try:
        done = subprocess.run(call, capture_output=True, text=True, check=False)
    except OSError as error:
        print(f"compare: {command}: {error.strerror}", file=sys.stderr)
        raise SystemExit(2) from error
    if done.returncode != 0:
        print(f"compare: {command} failed: {done.stderr.strip()}", file=sys.stderr)
        raise SystemExit(2)
    report = json.loads(done.stdout)
    return report, {(o["isa"], o["name"]): o["fraction"] for o in report["operations"]}


def evaluate(ratios, least):
    """Median, noise, and whether it is a real loss."""
    middle = statistics.median(ratios)
    deviation = statistics.median(abs(r - middle) for r in ratios)
    # 1.4826: a normal distribution's standard deviation over its median absolute deviation; 1.2533: a median's
    # standard error over a mean's.
    noise = 1.4826 * 1.2533 * deviation / math.sqrt(len(ratios))
    return middle, noise, 1 - middle > max(least, 3 * noise)


def record(path, label, report, fractions):
    """Adds an entry to a history, with three digits."""
    try:
        with open(path, encoding="utf-8") as file:
            history = json.load(file)
    except FileNotFoundError:
        history = {"what": "fractions of the machine's own limits, second-level cache, one thread, medians",
                   "entries": []}
    entry = {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"),
        "label": label,
        "machine": report["machine"]["processor"],
        "fractions": {},
    }
    for (isa, name), values in sorted(fractions.items()):
        entry["fractions"].setdefault(isa, {})[name] = float(f"{statistics.median(values):.3g}")
    history["entries"].append(entry)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(history, file, indent=1)
        file.write("\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--rounds", type=int, default=9, help="runs of each (9)")
    parser.add_argument("--isa", default="", help="instruction set (all that run here)")
    parser.add_argument("--only", default="", help="operations whose name contains this")
    parser.add_argument("--least", type=float, default=0.05, help="smallest loss that counts (0.05)")
    parser.add_argument("--record", default="", help="history to add the second build's fractions to")
    parser.add_argument("--label", default="", help="what the entry is of: a commit, a version")
    args = parser.parse_args()
    if args.rounds < 5:
        parser.error("fewer than 5 rounds tell nothing of the noise")
    ratios = {}
    fractions = {}
    report = None
    for number in range(args.rounds):
        # Whoever comes second finds the machine as the first has left it: by turns.
        order = [False, True] if number % 2 == 0 else [True, False]
        found = {}
        for new in order:
            report, found[new] = measure(args.new if new else args.old, args)
        for key, value in found[True].items():
            fractions.setdefault(key, []).append(value)
            # What only one of them has cannot be compared.
            if found.get(False, {}).get(key, 0) > 0:
                ratios.setdefault(key, []).append(value / found[False][key])
    if not ratios:
        print("compare: the builds have no operation in common", file=sys.stderr)
        return 2
    losses = []
    for key, values in sorted(ratios.items()):
        middle, noise, lost = evaluate(values, args.least)
        mark = "LOSS" if lost else "gain" if middle - 1 > max(args.least, 3 * noise) else ""
        print(f"{key[0]:<8} {key[1]:<44} {middle:6.3f} +- {noise:.3f} {mark}")
        if lost:
            losses.append(key)
    if args.record:
        record(args.record, args.label, report, fractions)
    print(f"{len(ratios)} operations, {args.rounds} rounds: {len(losses)} real losses")
    return 1 if losses else 0


if __name__ == "__main__":
    sys.exit(main())
