"""Faults of files and folders. The function of a fault yields the exit status of each try."""
import resource
import shutil
import signal
import time

from attempt import Broken, COMMANDS, CPU, DEVICE, DONE, IO, MEMORY, SLOW, TIMEOUT_S


def file_limit(driver):
    """a file may not grow beyond n bytes (RLIMIT_FSIZE)"""
    for command in COMMANDS:
        driver.expect(command)
        with driver.attempt(command) as attempt:
            attempt.run()
            most = attempt.output.stat().st_size
        for n in driver.numbers(20, 3):
            limit = (resource.RLIMIT_FSIZE, most * (n - 1) // 20)
            # The smallest limits also affect files of the Vulkan driver. The driver lavapipe of Mesa 24 keeps buffers in
            # a file and does not check whether the file could grow. The run then ends with SIGBUS.
            yield driver.try_once(command, (), (IO, DEVICE, MEMORY, -signal.SIGBUS), limit=limit)


def in_small_file_system(driver, options, fill):
    """Runs each command in a new tmpfs with these mount options, after the shell command `fill` has filled it."""
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
                return  # this user may not mount here, so there are no tries
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


KINDS = (file_limit, full_disk, no_inodes, read_only_disk, vanished_folder, two_writers)
