#!/usr/bin/env python3
"""tests/slow.txt is sorted, and each of its lines names a test. usage: slow_tests.py SLOW_LIST TEST_PROGRAM..."""
import subprocess
import sys


def tests_of(program):
    listing = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    suite = ""
    for line in listing.splitlines():
        name = line.split("#")[0].rstrip()
        if name.startswith("  "):
            yield suite + name.strip()
        else:
            suite = name


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        slow = [line for line in file.read().splitlines() if not line.startswith("#")]
    known = {test for program in sys.argv[2:] for test in tests_of(program)}
    complaints = [f"no such test: {test}" for test in slow if test not in known]
    if slow != sorted(set(slow)):
        complaints.append("not sorted, or a line twice")
    print("\n".join(complaints) if complaints else f"{len(slow)} slow tests of {len(known)}")
    return 1 if complaints or not known else 0


if __name__ == "__main__":
    sys.exit(main())
