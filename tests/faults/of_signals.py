"""Signals at random moments. The function of a fault yields the exit status of each try."""
import os
import pathlib
import re
import shutil
import signal
import tempfile
import time

from attempt import Broken, CPU, DONE, FOLDERS, INTERRUPTED, IO, LEFT_BY_THE_KILLED, OLD, PARTS, SLOW, TIMEOUT_S


def kills_by(driver, number, tries):
    """Sends a signal at a random moment of a run. Yields the exit status of each try."""
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
    """Damages a file that a killed run left, or replaces it by a link to `victim`. Returns the link, otherwise None."""
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


KINDS = (kill, kill_and_resume, kill_and_damage, kill_and_merge, terminate, interrupt, hang_up)
