#!/usr/bin/env python3
"""One closing line in plain words for a run of ctest: single tests, where an entry of ctest runs a whole suite.

Names the tests that were skipped, and those that took long without being listed in tests/slow.txt.
usage: count_tests.py LOG COUNTS   LOG: what ctest printed; COUNTS: a folder of GoogleTest's XML files, one an entry
"""
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

ENTRY = re.compile(r"^ *\d+/\d+ Test +#\d+: (\S+) [. ]*(Passed|[\w ]*\*\*\*[\w ]+)", re.MULTILINE)

LONG_S = 3


def name_of(entry, case):
    """Full name of a test in an entry that is named after its suite, or after the test itself."""
    return f"{entry.split('.')[0]}.{case.get('name')}"


def main():
    log, counts = sys.argv[1:3]
    with open(log, encoding="utf-8", errors="replace") as file:
        entries = ENTRY.findall(file.read())
    passed, failed, skipped, names, long = 0, 0, 0, [], []
    for entry, result in entries:
        path = os.path.join(counts, entry.replace("/", "_") + ".xml")
        if os.path.exists(path):
            cases = [case for case in ElementTree.parse(path).iter("testcase") if case.get("status") == "run"]
            failures = sum(case.find("failure") is not None for case in cases)
            skips = [case for case in cases if case.find("skipped") is not None]
            # A process that ends badly after its last test failed all the same.
            failures = max(failures, 0 if result == "Passed" else 1)
            names += [name_of(entry, case) for case in skips]
            long += [f"{name_of(entry, case)} ({case.get('time')} s)" for case in cases
                     if float(case.get("time")) > LONG_S and name_of(entry, case) != entry]
        else:
            cases = [entry]
            skips = cases if result.startswith("***Skipped") else []
            failures = 0 if result == "Passed" or skips else 1
            names += skips
        passed += len(cases) - failures - len(skips)
        failed += failures
        skipped += len(skips)
    if long:
        print(f"over {LONG_S} s: " + " ".join(long))
    if names:
        print("skipped: " + " ".join(names))
    if entries:
        print(f"{passed} passed, {failed} failed, {skipped} skipped")


if __name__ == "__main__":
    main()
