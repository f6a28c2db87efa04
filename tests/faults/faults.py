#!/usr/bin/env python3
"""Drives dolp into faults, and counts how it takes them.

Usage: faults.py BUILD [--quick] [--json FILE] [KIND...]    BUILD is the folder that has dolp and tests/faults
       faults.py --table FILE      what is in such a FILE, as a table for the manual
Each try has a folder of its own with an output from before. After it that output is as it was, or a whole new one is in
its place, and no other file is left; a run that failed says so in one line and with the exit status of its fault, but
where a C library ends it for lack of memory.
With --quick only some of the allocations fail, and less of all else. Exit status: 0, or 1 after a try that broke one of
these rules.
The result has the rows of all kinds that were driven into it, in one run or several.
"""
import argparse
import collections
import concurrent.futures
import contextlib
import csv
import json
import operator
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SEED = 19
TIMEOUT_S = 120
OLD = b"kept\n"
DONE, INPUT, DEVICE, IO, MEMORY, INTERRUPTED = 0, 2, 3, 4, 6, 130
# A C library without memory ends the program itself, or says that its file or device is no good.
LIBRARY = (INPUT, DEVICE, IO, 255, -signal.SIGABRT, -signal.SIGSEGV, -signal.SIGBUS)
SCENE = (pathlib.Path(__file__).resolve().parents[1] / "data/scene.toml").read_text(encoding="utf-8")
POINTS = "theta_deg,sigma,q\n0,0.1,2\n60.0,0.4,3.5\n80.5,0.1,2\n"
COMMANDS = {"table": (["table", "scene.toml"], "out.nc"),
            "eval": (["eval", "scene.toml", "--points", "points.csv"], "out.csv"),
            "lookup": (["lookup", "in.nc", "--points", "points.csv"], "out.csv")}
CPU = ("--evaluator", "cpu")
# Many tiles, and on one core about a second.
LARGE = ("--set", "grid.theta_deg={from=0, to=89, count=60}", "--set", "grid.sigma={from=0.05, to=1, count=20}")
SLOW = (*CPU, "--tolerance", "1e-6", "--precision", "double", *LARGE)
# More than one part of a run, in a second.
PARTS = (*CPU, "--tolerance", "1e-2", "--set", "surface.masking=none", "--set", "surface.distribution=gaussian",
         "--set", "grid.theta_deg={from=0, to=89, count=90}", "--set", "grid.sigma={from=0.05, to=1, count=400}",
         "--set", "grid.q={from=2, to=4, count=90}")
# HDF5 says at length that it found no memory to begin with; nobody can ask it not to before it has.
OF_HDF5 = re.compile(r"^(HDF5-DIAG: |  #\d+: |    (major|minor): ).*\n", re.MULTILINE)
# Of a process that ended while it gave the finished file its name, killed or out of memory.
LEFT_BY_THE_KILLED = re.compile(r"\.dolp-\d+-\d+\.tmp")
VULKAN_CALLS = ("vkCreateInstance", "vkEnumeratePhysicalDevices", "vkCreateDevice", "vkCreateCommandPool",
                "vkAllocateCommandBuffers", "vkCreateBuffer", "vkAllocateMemory", "vkBindBufferMemory", "vkMapMemory",
                "vkCreateDescriptorSetLayout", "vkAllocateDescriptorSets", "vkCreateShaderModule",
                "vkCreateComputePipelines", "vkBeginCommandBuffer", "vkEndCommandBuffer", "vkQueueSubmit",
                "vkWaitForFences")
VULKAN_RESULTS = {"out of host memory": -1, "out of device memory": -2, "initialisation failed": -3, "device lost": -4}
DEVICE_LOST = VULKAN_RESULTS["device lost"]
# Where to sync takes no time.
FOLDERS = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


class Broken(Exception):
    """A try after which something is not as it must be."""


class Driver:
    """The program, its inputs, and what it makes of them where nothing fails."""

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
        """What a finished output says, without what differs from run to run; nothing of one that is not whole."""
        if output.suffix == ".nc":
            read = [self.program, "lookup", output.name, "--points", "points.csv", "-o", "-", "--quiet"]
            looked_up = subprocess.run(read, cwd=output.parent, capture_output=True, check=False).stdout
            # The hash is of all bits, and lookup has compared it with the values.
            return looked_up, re.findall(rb"placed64:[0-9a-f]{16}", output.read_bytes())
        return output.read_bytes()

    def expect(self, command, options=()):
        """Has the command once do its work undisturbed; the seconds that this takes."""
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
        """1 to `most`, or in a quick run so many of them, the ends included."""
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
    """A run in a folder with the inputs and an output from before."""

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
            for number in (signal.SIGINT, signal.SIGHUP):  # a shell in the background has others ignore them
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
        return process.returncode, OF_HDF5.sub("", err.decode(errors="replace"))

    def check(self, status, err, allowed, may_stay=None):
        """Raises Broken unless the run ended in a way that is allowed and the files are as they must be."""
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


# --- The kinds of fault. Each yields the exit status of every try. ---


def agree(ours, theirs):
    """True for results of `eval` that agree within their bounds, as those of two kernels of the same source do."""
    rows, others = (list(csv.DictReader(text.decode().splitlines())) for text in (ours, theirs))
    if len(rows) != len(others):
        return False
    for row, other in zip(rows, others):
        for name, bound, scale in (("dolp", "error_estimate", 1), ("rho_i", "rho_error_estimate", float(row["rho_i"]))):
            if not abs(float(row[name]) - float(other[name])) <= scale * (float(row[bound]) + float(other[bound])):
                return False
    return [row["status"] for row in rows] == [row["status"] for row in others]


def allocations_of(driver, command, options, quick, step, is_same=operator.eq):
    """The n-th allocation fails, then also all after it."""
    driver.expect(command, options)
    count = driver.count("allocation", "DOLP_COUNT_ALLOCATIONS", command, options)

    def fail(number):
        environment = driver.preload("allocation", DOLP_FAIL_ALLOCATION=number)
        return driver.try_once(command, options, (DONE, MEMORY, *LIBRARY), environment=environment, is_same=is_same)

    # What threads allocate comes in any order, so a try may do without the allocation that was to fail.
    numbers = [f"{n}{after}" for n in driver.numbers(count // step, quick // 2) for after in ("", "+")]
    numbers = [re.sub(r"\d+", lambda n: str(int(n.group()) * step), number) for number in numbers]
    with concurrent.futures.ThreadPoolExecutor(1 if driver.is_quick else os.cpu_count()) as pool:
        yield from pool.map(fail, numbers)


def allocation_in_table(driver):
    """the n-th allocation of `table` fails, alone or with all after it"""
    return allocations_of(driver, "table", CPU, 100, 1)


def allocation_in_eval(driver):
    """the n-th allocation of `eval` fails, alone or with all after it"""
    return allocations_of(driver, "eval", CPU, 100, 1)


def allocation_in_lookup(driver):
    """the n-th allocation of `lookup` fails, alone or with all after it"""
    return allocations_of(driver, "lookup", (), 100, 1)


def allocation_with_driver(driver):
    """every 100th allocation of `eval` on a Vulkan device fails, in its driver too"""
    # A compiler of kernels that lacks memory may make another kernel, without a word.
    return allocations_of(driver, "eval", (), 10, 100, agree)


def memory_limit(driver):
    """the addresses of `table` on a Vulkan device are limited (RLIMIT_AS), 100 MB to 2 GB"""
    driver.expect("table", LARGE)
    for megabytes in ((100, 150, 300, 500, 1000) if driver.is_quick else range(100, 2001, 20)):
        limit = (resource.RLIMIT_AS, megabytes * 1_000_000)
        yield driver.try_once("table", LARGE, (DONE, MEMORY, *LIBRARY), limit=limit)


def few_threads(driver):
    """the system allows n threads beside the first"""
    driver.expect("table", LARGE)
    # As many as lavapipe waits for, and then some for the program.
    needed = 2 * min(os.cpu_count(), 32) + 3
    for n in [0, *driver.numbers(needed, 7)] if driver.is_quick else range(needed + 20):
        fault = driver.preload("thread", DOLP_MOST_THREADS=str(n))
        yield driver.try_once("table", LARGE, (MEMORY,) if n < needed else (DONE, MEMORY), environment=fault)


def lost_device(driver):
    """the device is lost at the n-th submission: a new one takes over"""
    driver.expect("eval", LARGE)
    driver.expect("table", LARGE)
    for command in ("eval", "table"):
        count = driver.count("vulkan", "DOLP_COUNT_SUBMISSIONS", command, LARGE)
        for call in ("vkQueueSubmit", "vkWaitForFences"):
            for n in driver.numbers(count, 3):
                fault = driver.preload("vulkan", DOLP_FAIL_VULKAN=f"{call}:{n}:{DEVICE_LOST}")
                yield driver.try_once(command, LARGE, (DONE,), environment=fault)


def lost_devices(driver):
    """the device is lost at the n-th submission, and the new one too"""
    driver.expect("table", LARGE)
    count = driver.count("vulkan", "DOLP_COUNT_SUBMISSIONS", "table", LARGE)
    for n in driver.numbers(count, 3):
        fault = driver.preload("vulkan", DOLP_FAIL_VULKAN=f"vkQueueSubmit:{n}+:{DEVICE_LOST}")
        yield driver.try_once("table", LARGE, (DEVICE,), environment=fault)


def device_memory(driver):
    """the device refuses pieces of memory above a size: tiles shrink, the values stay"""
    driver.expect("table", LARGE)
    for kilobytes in ((1, 150, 1000) if driver.is_quick else (1, 10, 50, 100, 120, 150, 200, 300, 500, 1000, 5000)):
        fault = driver.preload("vulkan", DOLP_VULKAN_MEMORY=str(kilobytes * 1000))
        allowed = (MEMORY,) if kilobytes <= 1 else (DONE,) if kilobytes >= 150 else (DONE, MEMORY)
        yield driver.try_once("table", LARGE, allowed, environment=fault)


def vulkan_call(driver):
    """a call of Vulkan fails the first time, or each time"""
    driver.expect("eval")
    calls = [(call, result, after) for call in VULKAN_CALLS for result in VULKAN_RESULTS.values() for after in ("", "+")]
    for call, result, after in driver.random.sample(calls, 20) if driver.is_quick else calls:
        fault = driver.preload("vulkan", DOLP_FAIL_VULKAN=f"{call}:1{after}:{result}")
        yield driver.try_once("eval", (), (DONE, DEVICE, MEMORY), environment=fault)


def lacking_driver(driver):
    """the only device lacks double precision, a compute queue or Vulkan 1.2"""
    driver.expect("eval")
    double = ("--precision", "double")
    driver.expect("eval", double)
    for what, options, allowed in (("float64", (), DONE), ("float64", double, DEVICE), ("compute", (), DEVICE),
                                   ("version", (), DEVICE)):
        fault = driver.preload("vulkan", DOLP_VULKAN_WITHOUT=what)
        yield driver.try_once("eval", options, (allowed,), environment=fault)


def broken_driver_file(driver):
    """a driver's file is missing, empty, cut short or no JSON"""
    driver.expect("eval")
    for text in (None, "", "{", '{"file_format_version": "1.0.0"}', "\0\xff", "[]"):
        with tempfile.TemporaryDirectory(dir=FOLDERS) as folder:
            path = pathlib.Path(folder) / "driver.json"
            if text is not None:
                path.write_text(text)
            fault = {"VK_DRIVER_FILES": str(path), "VK_ICD_FILENAMES": str(path)}
            yield driver.try_once("eval", (), (DEVICE,), environment=fault)


def file_limit(driver):
    """a file may not grow beyond n bytes (RLIMIT_FSIZE)"""
    for command in COMMANDS:
        driver.expect(command)
        with driver.attempt(command) as attempt:
            attempt.run()
            most = attempt.output.stat().st_size
        for n in driver.numbers(20, 3):
            limit = (resource.RLIMIT_FSIZE, most * (n - 1) // 20)
            # The smallest limits also stop what a Vulkan driver keeps in files.
            yield driver.try_once(command, (), (IO, DEVICE, MEMORY), limit=limit)


def in_small_file_system(driver, options, fill):
    """Tries each command in a file system of its own, mounted with options, after the shell command `fill`."""
    for command in COMMANDS:
        driver.expect(command, CPU if command != "lookup" else ())
        with driver.attempt(command, CPU if command != "lookup" else ()) as attempt:
            name = attempt.output.name
            inside = (f"mount -t tmpfs -o {options} none target && cp {name} target/ && ln -s ../in.nc ../points.csv "
                      f"../scene.toml target/ && cd target && {fill} || exit 77; \"$@\"; status=$?; "
                      f"cmp -s {name} ../{name} && ls -A . > ../left; exit $status")
            (attempt.folder / "target").mkdir()
            attempt.words = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", inside, "sh", *attempt.words]
            status, err = attempt.run()
            if status == 77:
                return  # a user may not mount here
            left = attempt.folder / "left"
            if status != IO or not left.exists():
                raise Broken(f"{command} in a file system with {options}: exit status {status}, {err}")
            inputs = {"in.nc", "points.csv", "scene.toml", name, "filled"}
            if set(left.read_text().split()) - inputs or not err.startswith("dolp: ") or err.count("\n") != 1:
                raise Broken(f"{command} in a file system with {options}: leaves {left.read_text()!r}, {err!r}")
            yield status


def full_disk(driver):
    """the file system is full"""
    return in_small_file_system(driver, "size=64k", "{ cat /dev/zero > filled 2> /dev/null; true; }")


def no_inodes(driver):
    """the file system has no more inodes"""
    return in_small_file_system(driver, "nr_inodes=6,size=1m", "{ touch filled 2> /dev/null; true; }")


def read_only_disk(driver):
    """the file system is read-only"""
    return in_small_file_system(driver, "size=1m", "mount -o remount,ro none .")


def vanished_folder(driver):
    """the output's folder vanishes while the command computes"""
    seconds = driver.expect("table", SLOW)
    for _ in range(2 if driver.is_quick else 20):
        with driver.attempt("table", SLOW) as attempt:
            folder = attempt.folder / "soon_gone"
            folder.mkdir()
            attempt.words[attempt.words.index("-o") + 1] = f"soon_gone/{attempt.output.name}"
            with attempt.start() as process:
                time.sleep(seconds * driver.random.uniform(0.1, 0.4))
                shutil.rmtree(folder)
                err = process.communicate(timeout=TIMEOUT_S)[1].decode()
            attempt.check(process.returncode, err, (IO,))
            yield process.returncode


def two_writers(driver):
    """two processes write the same file"""
    for command in ("table", "eval"):
        driver.expect(command, CPU)
        for _ in range(5 if driver.is_quick else 100):
            with driver.attempt(command, CPU) as attempt:
                writers = [attempt.start(), attempt.start()]
                errs = [writer.communicate(timeout=TIMEOUT_S)[1].decode() for writer in writers]
                for writer, err in zip(writers, errs):
                    attempt.check(writer.returncode, err, (DONE,))
                    yield writer.returncode


def kills_by(driver, number, tries):
    """Sends a signal at a random moment of a run."""
    jobs = [("table", CPU), ("eval", CPU), ("table", SLOW)]
    seconds = {job: driver.expect(*job) for job in jobs}
    for i in range(tries if driver.is_quick else 20 * tries):
        command, options = job = jobs[i % len(jobs)]
        with driver.attempt(command, options) as attempt:
            with attempt.start() as process:
                time.sleep(driver.random.uniform(0, seconds[job]))
                process.send_signal(number)
                err = process.communicate(timeout=TIMEOUT_S)[1].decode()
            may_stay = LEFT_BY_THE_KILLED if number == signal.SIGKILL else None
            attempt.check(process.returncode, err, (DONE, INTERRUPTED, -number), may_stay)
            yield process.returncode


def kill(driver):
    """SIGKILL at a random moment"""
    return kills_by(driver, signal.SIGKILL, 6)


def kill_and_resume(driver):
    """SIGKILL at a random moment of a `table` in parts; then --resume makes it the same bits"""
    seconds = driver.expect("table", PARTS)
    for _ in range(2 if driver.is_quick else 20):
        with driver.attempt("table", PARTS) as attempt:
            with attempt.start() as process:
                time.sleep(driver.random.uniform(0, seconds))
                process.kill()
            attempt.words.append("--resume")
            status, err = attempt.run()
            attempt.check(status, err, (DONE,), LEFT_BY_THE_KILLED)
            yield process.returncode


def damage(driver, folder, victim):
    """Damages one of the files that a killed run left, if it left one; the link that it is then, or nothing."""
    left = sorted(folder.glob("out.nc.partial*"))
    how = driver.random.choice(("cut", "overwritten", "replaced", "removed", "symbolic link", "hard link"))
    if not left:
        return None
    path = driver.random.choice(left)
    size = path.stat().st_size
    if how == "cut":
        os.truncate(path, driver.random.randrange(size + 1))
    elif how == "overwritten":
        with path.open("r+b") as file:
            file.seek(driver.random.randrange(size + 1))
            file.write(driver.random.randbytes(64))
    elif how == "replaced":
        shutil.copy(driver.inputs / "in.nc", path)
    else:
        path.unlink()
    if "link" not in how:
        return None
    os.symlink(victim, path) if how == "symbolic link" else os.link(victim, path)
    return path


def kill_and_damage(driver):
    """SIGKILL at random moments of a `table` in parts, its files damaged in between; --resume makes it the same bits"""
    seconds = driver.expect("table", PARTS)
    may_stay = re.compile(rf"{LEFT_BY_THE_KILLED.pattern}|out\.nc\.partial(\.txt)?")
    kills, wanted = 0, 3 if driver.is_quick else 200
    while kills < wanted:
        with driver.attempt("table", PARTS) as attempt, tempfile.TemporaryDirectory(dir=FOLDERS) as elsewhere:
            attempt.words.append("--resume")
            victim = pathlib.Path(elsewhere) / "victim"
            victim.write_bytes(OLD)
            for _ in range(driver.random.randint(1, 4)):
                with attempt.start() as process:
                    time.sleep(seconds * driver.random.uniform(0.2, 1))
                    process.kill()
                kills += 1
                yield process.returncode
                link = damage(driver, attempt.folder, victim)
                if link:
                    attempt.check(*attempt.run(), (IO,), may_stay)
                    link.unlink()
                if victim.read_bytes() != OLD:
                    raise Broken("kill_and_damage: what a link points to was changed")
            attempt.check(*attempt.run(), (DONE,), LEFT_BY_THE_KILLED)


def kill_and_merge(driver):
    """SIGKILL at a random moment of a `merge`; then another one makes the table of one run"""
    driver.expect("table", PARTS)
    with driver.attempt("table", PARTS) as attempt:
        alone = attempt.words
        for shard in ("1/2", "2/2"):
            attempt.words = [*alone, "--shard", shard]
            attempt.run()
        shards = [shutil.move(path, driver.inputs) for path in attempt.folder.glob("out.*-of-2.nc")]
    for _ in range(2 if driver.is_quick else 20):
        with driver.attempt("table", PARTS) as attempt:
            attempt.words = [driver.program, "merge", *shards, "-o", attempt.output.name, "--quiet"]
            with attempt.start() as process:
                time.sleep(driver.random.uniform(0, 0.5))
                process.kill()
            status, err = attempt.run()
            attempt.check(status, err, (DONE,), LEFT_BY_THE_KILLED)
            yield process.returncode


def terminate(driver):
    """SIGTERM at a random moment"""
    return kills_by(driver, signal.SIGTERM, 3)


def interrupt(driver):
    """SIGINT at a random moment"""
    return kills_by(driver, signal.SIGINT, 3)


def hang_up(driver):
    """SIGHUP at a random moment"""
    return kills_by(driver, signal.SIGHUP, 3)


KINDS = (allocation_in_table, allocation_in_eval, allocation_in_lookup, allocation_with_driver, memory_limit, few_threads,
         lost_device, lost_devices, device_memory, vulkan_call, lacking_driver, broken_driver_file, file_limit, full_disk, no_inodes,
         read_only_disk, vanished_folder, two_writers, kill, kill_and_resume, kill_and_damage, kill_and_merge,
         terminate, interrupt, hang_up)


# --- The command. ---


def ending(status):
    return f"status {status}" if status >= 0 else "ended by the signal"


def markdown(results):
    lines = ["| fault | tries | ends |", "|---|---|---|"]
    for row in results["kinds"]:
        ends = ", ".join(f"{count} {what}" for what, count in row["ends"].items())
        lines.append(f"| {row['fault']} | {row['tries']:,} | {ends} |")
    return "\n".join(lines)


def rows_of(path):
    """What is in a result, by fault; nothing where there is none yet."""
    if not path or not path.exists():
        return {}
    return {row["fault"]: row for row in json.loads(path.read_text(encoding="utf-8"))["kinds"]}


def drive(driver, kinds, path):
    """Writes the result after each kind, since all of them take hours; rows of other kinds stay."""
    version = subprocess.run([driver.program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    for kind in kinds:
        start = time.monotonic()
        ends = collections.Counter(ending(status) for status in kind(driver))
        row = {"fault": kind.__doc__, "tries": sum(ends.values()), "ends": dict(sorted(ends.items()))}
        print(f"{kind.__name__}: {row['tries']} tries in {time.monotonic() - start:.1f} s: {row['ends']}", flush=True)
        if path:
            rows = {**rows_of(path), kind.__doc__: row}
            results = {"program": version, "seed": SEED,
                       "kinds": [rows[known.__doc__] for known in KINDS if known.__doc__ in rows]}
            path.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(prog="faults.py", description=__doc__.splitlines()[0])
    parser.add_argument("build", nargs="?", type=pathlib.Path, metavar="BUILD")
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(kind.__name__ for kind in KINDS))
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE")
    parser.add_argument("--table", type=pathlib.Path, metavar="FILE")
    options = parser.parse_intermixed_args()
    if options.table:
        print(markdown(json.loads(options.table.read_text(encoding="utf-8"))))
        return 0
    if not options.build or set(options.kinds) - {kind.__name__ for kind in KINDS}:
        parser.error("BUILD is missing, or a KIND is none of " + ", ".join(kind.__name__ for kind in KINDS))
    kinds = [kind for kind in KINDS if not options.kinds or kind.__name__ in options.kinds]
    try:
        with tempfile.TemporaryDirectory(dir=FOLDERS) as inputs:
            driver = Driver(options.build.resolve(), options.quick, pathlib.Path(inputs))
            drive(driver, kinds, options.json)
    except Broken as broken:
        print(f"faults.py: {broken}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
