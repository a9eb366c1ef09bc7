"""The unit tests of a part of the package, against a library that one changed source went into."""

import json
import os
import pathlib
import re
import resource
import shlex
import subprocess

# Of those that run first.
QUICK_SUITE_MS = 100
BUILD_LIMIT_S = 1200
COMPILE_LIMIT_S = 300
HINT_LIMIT_S = 60
# Of glibc: whether anything was written behind the end of memory. They stand in for AddressSanitizer, with which
# test/run runs the same tests.
HEAP_CHECKS = {"LD_PRELOAD": "libc_malloc_debug.so.0", "MALLOC_CHECK_": "3"}
MEMORY_LIMIT = 8 << 30  # bytes of addresses; a change may ask for any amount


class UnitTests:
    """A program of tests and the library that it tests, in a build folder of their own.

    Only the changed source is compiled, and only its library linked, both into a folder `changed`
    beside the build, which the program then searches first. Sources and build stay as they are.
    """

    def __init__(self, root, build, library, program):
        self.root, self.build_folder, self.library, self.program = root, build, library, program
        self.changed = build / "changed" / library
        self.suites = {}  # how long each takes, ms
        self.names = set()  # of all tests

    def build(self):
        """Whether the tests of the sources as they are compile."""
        try:
            return subprocess.run(
                ["make", "--no-print-directory", "--quiet", "-C", self.build_folder, self.program],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                check=False, timeout=BUILD_LIMIT_S).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def measure(self):
        """Runs all suites and notes how long each takes. Which test failed first, as for run()."""
        fault, output = self.run_program("*", BUILD_LIMIT_S)
        self.suites = {name: int(time_ms) for name, time_ms in
                       re.findall(r"^\[-+\] \d+ tests? from ([^\s,]+).* \((\d+) ms total\)", output, re.M)}
        self.names = set(re.findall(r"^\[ RUN      \] (\S+)", output, re.M))
        return fault

    def suites_in(self, tests):
        """The suites of some files of tests."""
        names = set()
        for test in tests:
            names.update(re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),", test.read_text(), re.M))
        return {suite for suite in self.suites if names.intersection(suite.split("/"))}

    def batches(self, path, own_only):
        """All suites in the order in which to run them: those of the source, of its folder, and others, if asked for;
        the quick ones of each before the slow."""
        folder = self.root / "test" / pathlib.Path(path).parent.name
        source = self.suites_in(folder.glob(f"{pathlib.Path(path).stem}*_test.cpp"))
        own = self.suites_in(folder.glob("*_test.cpp")) - source
        for suites in (source, own, set() if own_only else set(self.suites) - source - own):
            for quick in (True, False):
                batch = {suite for suite in suites if (self.suites[suite] <= QUICK_SUITE_MS) == quick}
                if batch:
                    yield batch

    def first_failure(self, path, hint="", own_only=False, use_changed=True):
        """Which test failed first, or how else the program ended; empty if all passed.

        The hint, a test that failed before, runs first, then batches().
        """
        if hint:
            fault, _ = self.run_program(hint, HINT_LIMIT_S, use_changed)
            if fault:
                return fault
        for batch in self.batches(path, own_only):
            limit_s = 10 + 5 * sum(self.suites[suite] for suite in batch) / 1000
            fault, _ = self.run_program(":".join(f"{suite}.*" for suite in sorted(batch)), limit_s, use_changed)
            if fault:
                return fault
        return ""

    def run_program(self, test_filter, limit_s, use_changed=False):
        """Which test failed, as for first_failure(), and what was printed.

        The limit is one of processor time; of time as such it is six times as long, since others may use
        the processor, too.
        """
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit_s), int(limit_s)))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))

        environment = dict(os.environ, **HEAP_CHECKS, GTEST_FAIL_FAST="1", GTEST_COLOR="no")
        if use_changed:
            environment["LD_LIBRARY_PATH"] = f"{self.changed}:{os.environ.get('LD_LIBRARY_PATH', '')}"
        program = self.build_folder / "devel" / "lib" / "fast_edi" / self.program
        try:
            run = subprocess.run([program, f"--gtest_filter={test_filter}"], env=environment, text=True,
                                 errors="replace", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, check=False, timeout=6 * limit_s, preexec_fn=limit)
        except subprocess.TimeoutExpired:
            return "time limit", ""
        if run.returncode == 0:
            return "", run.stdout
        failed = re.search(r"\[  FAILED  \] (\S+?)[,. (]*(?:\s|$)", run.stdout)
        started = re.findall(r"\[ RUN      \] (\S+)", run.stdout)
        return (failed.group(1) if failed
                else f"ended by {run.returncode} in {started[-1] if started else '?'}"), run.stdout

    def compile(self, path, text):
        """Makes the library with this text of a source. Whether it compiles, and whether to other code."""
        commands = json.loads((self.build_folder / "compile_commands.json").read_text())
        command = next(shlex.split(entry["command"]) for entry in commands
                       if entry["file"] == str(self.root / path))
        original = self.build_folder / command[command.index("-o") + 1]
        self.changed.mkdir(parents=True, exist_ok=True)
        # The names are those of the original, since they are in the object.
        source = self.changed / pathlib.Path(path).name
        source.write_text(text)
        changed_object = source.with_suffix(".o")
        command[command.index("-o") + 1] = str(changed_object)
        command[command.index("-c") + 1] = str(source)
        if not self.succeeds([*command, "-iquote", str((self.root / path).parent)]):
            return False, False
        if changed_object.read_bytes() == original.read_bytes():
            return True, False
        link = shlex.split((self.build_folder / "CMakeFiles" / f"{self.library}.dir" / "link.txt").read_text())
        link[link.index("-o") + 1] = str(self.changed / f"lib{self.library}.so")
        link[link.index(str(original.relative_to(self.build_folder)))] = str(changed_object)
        if not self.succeeds(link):
            raise RuntimeError(f"cannot link: {shlex.join(link)}")
        return True, True

    def succeeds(self, command):
        try:
            return subprocess.run(command, cwd=self.build_folder, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False,
                                  timeout=COMPILE_LIMIT_S).returncode == 0
        except subprocess.TimeoutExpired:
            return False
