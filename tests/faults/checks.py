"""Checks of a run that met a fault: each problem has a kind and a sentence."""
import errno
import os
import re

EXIT_CODES = (1, 3)  # of failures that are the system's; 2 is wrong usage
INTERNAL = re.compile(r"std::|bad_alloc|what\(\)|terminate called|__|basic_string|exception", re.IGNORECASE)
# kinds of problems, in the order of the table
KINDS = ("crash", "hang", "wrong", "torn", "leftover", "code", "lines", "words", "reason", "file")


def expected_reason(function, error):
    """What the message must say, as a regular expression."""
    if function in ("malloc", "mmap"):
        return "memory"
    if function == "pthread_create":
        return "thread"
    # A short write without an error is what a full disk does first.
    return re.escape(os.strerror(error or errno.ENOSPC))


def check_targets(tool, scenario, folder, before, after, clean, finished):
    """Files that are neither what was there nor what a run without a fault writes; files that should not be there."""
    problems, whole = [], 0
    for path in [*scenario.targets, *scenario.special]:
        is_whole = scenario.special.get(path)
        old, new = before.get(path), after.get(path)
        if is_whole and new is not None and (new != old or finished):
            good = is_whole(tool, folder, path, old)
        elif finished:
            good = new == clean.get(path)
        else:
            good = new == old or new == clean.get(path)
        if good:
            whole += 1
        elif finished:
            problems.append(("wrong", f"exit 0, but {path} {describe(new)}"))
        else:
            problems.append(("torn", f"{path} {describe(new)}"))
    for path in sorted(after.keys() - before.keys() - clean.keys() - set(scenario.special)):
        problems.append(("leftover", path))
    for path, contents in after.items():
        # A folder that was made for outputs goes again where nothing came into it.
        if contents is None and path not in before and not any(name.startswith(path + "/") for name in after):
            problems.append(("leftover", f"{path}/, empty"))
    for path, contents in before.items():
        if path not in scenario.targets and path not in scenario.special and after.get(path, b"") != contents:
            problems.append(("torn", f"the input {path} was changed"))
    return problems, whole


def describe(contents):
    return "is missing" if contents is None else f"holds {len(contents)} other bytes"


def check_message(scenario, outcome, folder, function, error, persistent):
    """The lines of a run that failed: as many as problems, each with its reason and the file that it was for."""
    # Fewer threads than asked for are no problem, but are said.
    lines = [line for line in outcome.err.splitlines() if "the system makes only" not in line]
    problems = []
    if not 1 <= len(lines) <= scenario.jobs or not all(line.startswith("spectile: ") for line in lines):
        problems.append(("lines", f"{len(lines)} lines on standard error: {outcome.err[:300]!r}"))
    if INTERNAL.search(outcome.err):
        problems.append(("words", outcome.err[:300].rstrip()))
    if lines and not re.search(expected_reason(function, error), outcome.err):
        problems.append(("reason", f"does not say {expected_reason(function, error)}: {outcome.err[:300].rstrip()}"))
    if persistent or not lines:  # it may be a later call that ends the run
        return problems
    at = outcome.file.removeprefix(folder + "/")
    first = lines[0] if lines else ""
    if at in scenario.inputs:
        if at not in first:
            problems.append(("file", f"{at} could not be read: {first}"))
    elif outcome.file.startswith(folder):
        # A folder, a file without a name or one with a name that nobody knows stands for an output.
        names = [at] if at in scenario.targets or at in scenario.special else [*scenario.targets, *scenario.special]
        if not any(name in first for name in names) and at not in first:
            problems.append(("file", f"{at} could not be written: {first}"))
    return problems


def check_run(tool, scenario, folder, outcome, before, after, clean, clean_outcome, fault):
    """Problems of a run, and how many of its targets are whole. `fault`: function, error, if it persists."""
    function, error, persistent = fault
    if outcome.late:
        return [("hang", "")], 0
    if outcome.crashed:
        problems = [("crash", f"exit {outcome.exit}: {outcome.err[-300:].rstrip()}")]
        # A process that ends at once cannot tidy up, but its targets must be whole.
        more, whole = check_targets(tool, scenario, folder, before, after, clean, False)
        return problems + [problem for problem in more if problem[0] == "torn"], whole
    finished = outcome.exit == 0
    problems, whole = check_targets(tool, scenario, folder, before, after, clean, finished)
    if finished:
        if scenario.prints and outcome.out != clean_outcome.out:
            problems.append(("wrong", f"exit 0, but it printed {outcome.out[:300]!r}"))
        return problems, whole
    if outcome.injected == 0:
        problems.append(("wrong", f"exit {outcome.exit} without a fault: {outcome.err[:300]}"))
        return problems, whole
    if outcome.exit not in EXIT_CODES or (error in (errno.ENOSPC, errno.EACCES, errno.EDQUOT) and outcome.exit != 3):
        problems.append(("code", f"exit {outcome.exit}: {outcome.err[:300].rstrip()}"))
    return problems + check_message(scenario, outcome, folder, function, error, persistent), whole
