"""A run of dolp with a fault, in a separate folder, and the rules that it must obey."""
import contextlib
import operator
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import tempfile
import time

SEED = 19
TIMEOUT_S = 120
OLD = b"kept\n"
DONE, INPUT, DEVICE, IO, MEMORY, INTERRUPTED = 0, 2, 3, 4, 6, 130
# Exit statuses and signals that are allowed if a C library has no memory: the library may end the program, or report a
# bad file or device. HDF5, which netCDF-C starts and ends, may turn each exit status into 255.
LIBRARY = (INPUT, DEVICE, IO, 255, -signal.SIGABRT, -signal.SIGSEGV, -signal.SIGBUS)
SCENE = (pathlib.Path(__file__).resolve().parents[1] / "data/scene.toml").read_text(encoding="utf-8")
POINTS = "theta_deg,sigma,q\n0,0.1,2\n60.0,0.4,3.5\n80.5,0.1,2\n"
COMMANDS = {"table": (["table", "scene.toml"], "out.nc"),
            "eval": (["eval", "scene.toml", "--points", "points.csv"], "out.csv"),
            "lookup": (["lookup", "in.nc", "--points", "points.csv"], "out.csv")}
CPU = ("--evaluator", "cpu")
# A table that takes about a second on one core. A Vulkan device computes it in several submissions.
LARGE = ("--set", "grid.theta_deg={from=0, to=89, count=60}", "--set", "grid.sigma={from=0.05, to=1, count=20}")
SLOW = (*CPU, "--tolerance", "1e-6", "--precision", "double", *LARGE)
# A table of 1.6 million entries, which takes about half a second. The program writes such a table in two parts.
PARTS = (*CPU, "--tolerance", "1e-2", "--set", "surface.masking=none", "--set", "surface.distribution=gaussian",
         "--set", "grid.theta_deg={from=0, to=89, count=90}", "--set", "grid.sigma={from=0.05, to=1, count=200}",
         "--set", "grid.q={from=2, to=4, count=90}")
# Name of the temporary file that a process leaves if it is killed or runs out of memory before it renames the file.
LEFT_BY_THE_KILLED = re.compile(r"\.dolp-\d+-\d+\.tmp")
# Parent folder of the tries: a file system in memory, because fsync takes no time there.
FOLDERS = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


class Broken(Exception):
    """A try after which a condition of check() does not hold."""


class Driver:
    """The program under test, its inputs, and the results of its commands without faults."""

    def __init__(self, build, is_quick, inputs):
        self.program = str(build / "dolp")
        self.faults = build / "tests/faults"
        self.is_quick = is_quick
        self.random = random.Random(SEED)
        self.inputs = inputs
        self.expected = {}
        (inputs / "scene.toml").write_text(SCENE)
        (inputs / "points.csv").write_text(POINTS)
        subprocess.run([self.program, "table", "scene.toml", "-o", "in.nc", "--quiet", *CPU], cwd=inputs, check=True)

    def preload(self, name, **environment):
        return {"LD_PRELOAD": str(self.faults / f"libfail_{name}.so"), **environment}

    def values(self, output):
        """Content of an output file that is equal in equal runs. For example, it lacks the times in a table file."""
        if output.suffix == ".nc":
            # The hash stands for all values of the table. `verify` fails if the values do not have this hash.
            read = [self.program, "verify", output.name, "--between", "1", "--json"]
            checked = subprocess.run(read, cwd=output.parent, capture_output=True, check=False)
            return checked.returncode, re.findall(rb"placed64:[0-9a-f]{16}", output.read_bytes())
        return output.read_bytes()

    def expect(self, command, options=()):
        """Runs the command once without faults. Returns the seconds that it takes."""
        with self.attempt(command, options) as attempt:
            start = time.monotonic()
            status, err = attempt.run()
            seconds = time.monotonic() - start
            if status != DONE:
                raise Broken(f"{command} fails without a fault: {err}")
            self.expected[command, options] = self.values(attempt.output)
        return seconds

    @contextlib.contextmanager
    def attempt(self, command, options=(), **settings):
        with tempfile.TemporaryDirectory(dir=FOLDERS) as folder:
            yield Attempt(self, command, options, pathlib.Path(folder), **settings)

    def numbers(self, most, quick):
        """The numbers 1 to `most`. In a quick run only `quick` of these numbers: 1, `most`, and random ones."""
        if not self.is_quick or most <= quick:
            return list(range(1, most + 1))
        return sorted({1, most, *(self.random.randint(1, most) for _ in range(quick - 2))})

    def count(self, library, variable, command, options=()):
        with self.attempt(command, options) as attempt:
            counted = attempt.folder / "count"
            attempt.environment.update(self.preload(library, **{variable: str(counted)}))
            attempt.run()
            count = int(counted.read_text())
        if count == 0:
            raise Broken(f"{library}: nothing of it is called")
        return count

    def try_once(self, command, options=(), allowed=(DONE,), **settings):
        with self.attempt(command, options, **settings) as attempt:
            status, err = attempt.run()
            attempt.check(status, err, allowed)
            return status


class Attempt:
    """A run of dolp in a new folder with the inputs and an old output file."""

    def __init__(self, driver, command, options, folder, environment=None, limit=None, prefix=(), is_same=operator.eq):
        self.driver, self.command, self.options, self.folder = driver, command, options, folder
        self.is_same = is_same
        words, name = COMMANDS[command]
        self.words = [*prefix, driver.program, *words, "-o", name, "--quiet", *options]
        self.output = folder / name
        self.environment = {**os.environ, "DOLP_VALIDATION": "0", **(environment or {})}
        self.limit = limit
        for source in driver.inputs.iterdir():
            (folder / source.name).symlink_to(source)
        self.output.write_bytes(OLD)

    def start(self):
        def prepare():
            # A shell may start this script with SIGINT or SIGHUP ignored. The program under test must not inherit this.
            for number in (signal.SIGINT, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            if self.limit:
                which, most = self.limit
                resource.setrlimit(which, (most, most))
        return subprocess.Popen(self.words, cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=prepare)

    def run(self):
        with self.start() as process:
            try:
                _, err = process.communicate(timeout=TIMEOUT_S)
            except subprocess.TimeoutExpired:
                process.kill()
                raise Broken(f"{self.words[1:]} does not end") from None
        return process.returncode, err.decode(errors="replace")

    def check(self, status, err, allowed, may_stay=None):
        """Raises Broken unless `status` is allowed, its message fits, and the folder contains only files that may stay."""
        fault = {name: value for name, value in self.environment.items() if name.startswith("DOLP_")}
        what = f"{self.words[1:]}, {fault}, exit status {status}, {err!r}"
        if status not in allowed:
            raise Broken(f"{what}: expected {sorted(allowed)}")
        is_library = status in LIBRARY and set(LIBRARY) <= set(allowed)
        if status > 0 and not is_library and not (err.startswith("dolp: ") and err.count("\n") == 1 and err.endswith("\n")):
            raise Broken(f"{what}: not one line")
        if not is_library and (status == MEMORY) != err.startswith("dolp: out of memory"):
            raise Broken(f"{what}: the words of another exit status")
        here = {path.name for path in self.folder.iterdir()} - {path.name for path in self.driver.inputs.iterdir()}
        may_stay = may_stay or (LEFT_BY_THE_KILLED if status == MEMORY or is_library else None)
        left = {name for name in here - {self.output.name} if not (may_stay and may_stay.fullmatch(name))}
        if left:
            raise Broken(f"{what}: leaves {sorted(left)}")
        self.check_output(what, status)

    def check_output(self, what, status):
        if not self.output.exists():
            raise Broken(f"{what}: the output from before is gone")
        is_old = self.output.read_bytes() == OLD
        if is_old and status == DONE:
            raise Broken(f"{what}: nothing was written")
        expected = self.driver.expected[self.command, self.options]
        if not is_old and not self.is_same(self.driver.values(self.output), expected):
            raise Broken(f"{what}: the output is not whole")
