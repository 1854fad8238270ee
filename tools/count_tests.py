#!/usr/bin/env python3
"""One closing line in plain words for a run of ctest: single tests, where an entry of ctest runs a whole suite.

usage: count_tests.py LOG COUNTS   LOG: what ctest printed; COUNTS: a folder of GoogleTest's XML files, one an entry
"""
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

ENTRY = re.compile(r"^ *\d+/\d+ Test +#\d+: (\S+) [. ]*(Passed|[\w ]*\*\*\*[\w ]+)", re.MULTILINE)


def main():
    log, counts = sys.argv[1:3]
    with open(log, encoding="utf-8", errors="replace") as file:
        entries = ENTRY.findall(file.read())
    passed, failed, skipped, names = 0, 0, 0, []
    for entry, result in entries:
        path = os.path.join(counts, entry.replace("/", "_") + ".xml")
        if os.path.exists(path):
            cases = [case for case in ElementTree.parse(path).iter("testcase") if case.get("status") == "run"]
            failures = sum(case.find("failure") is not None for case in cases)
            skips = [case for case in cases if case.find("skipped") is not None]
            # A process that ends badly after its last test failed all the same.
            failures = max(failures, 0 if result == "Passed" else 1)
            names += [f"{entry.split('.')[0]}.{case.get('name')}" for case in skips]
        else:
            cases = [entry]
            skips = cases if result.startswith("***Skipped") else []
            failures = 0 if result == "Passed" or skips else 1
            names += skips
        passed += len(cases) - failures - len(skips)
        failed += failures
        skipped += len(skips)
    if names:
        print("skipped: " + " ".join(names))
    if entries:
        print(f"{passed} passed, {failed} failed, {skipped} skipped")


if __name__ == "__main__":
    main()
