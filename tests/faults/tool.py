"""Runs of the tool in a folder of their own: with a fault, a time limit, a memory limit, or a signal."""
import argparse
import atexit
import dataclasses
import mmap
import os
import resource
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SKIPPED = 77  # as ctest is told
TIME_LIMIT_S = 20


@dataclasses.dataclass
class Outcome:
    exit: int  # negative: ended by that signal
    late: bool  # ended for having taken longer than allowed
    out: str
    err: str
    seconds: float
    memory_bytes: int  # most that was resident
    calls: dict  # of each counted function
    injected: int  # calls that failed
    file: str  # that the first of them was for

    @property
    def crashed(self):
        # 134 and 139: a shell's codes, where a script stands in for the tool. 127: a library that cannot go on.
        return not self.late and (self.exit < 0 or self.exit in (127, 134, 139))


def is_sanitized(program):
    """True where sanitizers have an allocator and signal handlers of their own."""
    with open(program, "rb") as file:
        text = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        return text.find(b"__asan_init") >= 0 or text.find(b"__tsan_init") >= 0


def skip_if_sanitized(program):
    if is_sanitized(program):
        print("skipped: the tool is built with a sanitizer, which replaces what these tests replace")
        sys.exit(SKIPPED)


class Tool:
    def __init__(self, program, shim=None, time_limit_s=TIME_LIMIT_S):
        self.time_limit_s = time_limit_s
        self.extra = {}  # variables of the environment
        self.program = os.path.abspath(program)
        self.shim = shim and os.path.abspath(shim)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))  # of this process, and so of those that it starts
        self.report = tempfile.NamedTemporaryFile(prefix="spectile-faults-", delete=False).name

        atexit.register(self.close)

    def close(self):
        if os.path.exists(self.report):
            os.unlink(self.report)

    def environment(self, fault):
        # A Slurm job's variables would change what the commands do.
        out = {name: value for name, value in os.environ.items() if not name.startswith(("SLURM_", "SPECTILE_"))}
        if self.shim:
            out["LD_PRELOAD"] = self.shim
            out["SPECTILE_FAULT_PROGRAM"] = "spectile"
            out["SPECTILE_FAULT_REPORT"] = self.report
            if fault:
                out["SPECTILE_FAULT"] = fault
        return out | self.extra

    def start(self, arguments, folder, fault=None, memory_bytes=None, out=subprocess.DEVNULL, err=subprocess.DEVNULL):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (memory_bytes, memory_bytes))

        return subprocess.Popen([self.program, *arguments], cwd=folder, env=self.environment(fault), stdin=subprocess.DEVNULL,
                                stdout=out, stderr=err, preexec_fn=limit if memory_bytes else None)

    def run(self, arguments, folder, fault=None, memory_bytes=None, stop=None):
        """`stop`: seconds after which a signal is sent, and the signal."""
        if os.path.exists(self.report):
            os.truncate(self.report, 0)
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            start = time.monotonic()
            process = self.start(arguments, folder, fault, memory_bytes, out, err)
            exit, usage, late = self.finish(process, stop, self.time_limit_s)
            seconds = time.monotonic() - start
            texts = []
            for file in (out, err):
                file.seek(0)
                texts.append(file.read().decode("utf-8", "replace"))
        calls, injected, faulty_file = self.read_report()
        return Outcome(exit, late, texts[0], texts[1], seconds, usage.ru_maxrss * 1024, calls, injected, faulty_file)

    @staticmethod
    def finish(process, stop=None, time_limit_s=TIME_LIMIT_S):
        """Exit code as in Outcome, resources that were used, and whether it had to be ended."""
        # Not Popen.send_signal(), which may take the exit code of a process that has just ended.
        pidfd = os.pidfd_open(process.pid)
        try:
            poll = select.poll()
            poll.register(pidfd, select.POLLIN)
            if stop and not poll.poll(stop[0] * 1000):
                signal.pidfd_send_signal(pidfd, stop[1])
            late = not poll.poll(time_limit_s * 1000)
            if late:
                signal.pidfd_send_signal(pidfd, signal.SIGKILL)
        finally:
            os.close(pidfd)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, usage, late

    def read_report(self):
        calls, injected, file = {}, 0, ""
        with open(self.report, encoding="utf-8", errors="replace") as report:
            for line in report:
                name, _, value = line.rstrip("\n").partition(" ")
                if name == "file":
                    file = value
                elif name == "injected":
                    injected = int(value)
                elif value.isdigit():
                    calls[name] = int(value)
        return calls, injected, file


def driver_options(about, runs, only, runs_help="runs of each scenario"):
    """The parser of the options that all drivers share."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", help="the command spectile")
    parser.add_argument("shim", help="libspectile_faults.so")
    parser.add_argument("--runs", type=int, default=runs, help=f"{runs_help} (default {runs})")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", metavar=only)
    parser.add_argument("--json", metavar="FILE", help="write the table and the problems as JSON")
    return parser


class Workplace:
    """A folder for the inputs, made once, and for the folder of each run; in memory where there is room."""

    def __init__(self, keep=None):
        memory = "/dev/shm"
        parent = memory if os.access(memory, os.W_OK) else None
        self.kept = keep
        self.path = keep or tempfile.mkdtemp(prefix="spectile-faults-", dir=parent)
        os.makedirs(self.path, exist_ok=True)
        self.runs = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if not self.kept:
            shutil.rmtree(self.path)

    def folder(self, name):
        path = os.path.join(self.path, name)
        os.makedirs(path, exist_ok=True)
        return path

    def fresh(self):
        """Path of a run's folder, not made yet."""
        self.runs += 1
        return os.path.join(self.path, f"run{self.runs}")


def copy_folder(source, target):
    """With the times of files, on which --update depends."""
    shutil.copytree(source, target)


def read_folder(folder):
    """Bytes of each file below a folder by its path; None for a folder in it."""
    out = {}
    for at, folders, files in os.walk(folder):
        for name in folders:
            out[os.path.relpath(os.path.join(at, name), folder)] = None
        for name in files:
            path = os.path.join(at, name)
            with open(path, "rb") as file:
                out[os.path.relpath(path, folder)] = file.read()
    return out
