"""Runs dolp on random scenes (scenes.py) and reports each that crashes, hangs, ends with an internal error, is refused by
one call and taken by another, or has results that contradict each other.

    PYTHONPATH=build/release/python /usr/bin/python3 -B tests/corners/walk.py build/release/dolp --first 1 --count 300

Each scene goes through dolp.table, plan, evaluate, response and mueller in one process, and every 10th scene through the
commands, too: table, verify, eval, plan, mueller, response, and explore where a display is. `--seconds` instead of
`--count` sets a time. Ends with 1 if there was a fault. A fault names the seed; `--show SEED` prints its scene.
"""
from __future__ import annotations

import argparse
import os
import queue
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import dolp
import scenes

_HANG_S = 240           # a call that takes longer counts as a hang; ordinary calls take under a second
_PATIENCE_S = 60        # the reference may need minutes for an entry (bands, thick films); `verify` is then ended
# A scene with more integrand evaluations, such as a band of a film of 1 mm, is planned and not computed.
_MOST_EVALUATIONS = 2e8
_COMMANDS_EVERY = 10
_EVALUATOR = "cpu"      # of the calls; the commands use the Vulkan device
_MOST_REPORTED = 20
_FAILED = 4 | 1 | 8     # status bits with which a value need not be finite, or a bound need not hold
# The bounds of two results of one entry add up. A part of a unit in the last place is lost when each is rounded.
_ROUNDING = 1e-12


class Fault(Exception):
    """A result that must not be."""


def check_refusal(message: str) -> None:
    if "\n" in message.strip() or not message.strip():
        raise Fault(f"a refusal is not one line: {message!r}")
    if "internal" in message:
        raise Fault(message)


def check_values(name: str, table: xr.Dataset) -> None:
    """DOLP is finite and has a bound wherever the status does not say that it fails."""
    right = (table.status & _FAILED) == 0
    for quantity in ("dolp", "error_estimate", "stokes_i", "stokes_q"):
        values = table[quantity].where(right, 0.0)
        if not bool(np.isfinite(values).all()) and quantity != "error_estimate":
            raise Fault(f"{name}: {quantity} is not finite where the status is {sorted(set(table.status.values.ravel()))}")
        if bool((values < 0).any()) and quantity in ("dolp", "error_estimate"):
            raise Fault(f"{name}: {quantity} is negative")


def check_agreement(table: xr.Dataset, points: xr.Dataset) -> None:
    """An entry of a table and a point with the same values differ by no more than the sum of their bounds."""
    right = ((table.status | points.status) & (_FAILED | 2)) == 0
    allowed = table.error_estimate + points.error_estimate + _ROUNDING
    excess = (abs(table.dolp - points.dolp) - allowed).where(right, 0.0)
    if bool((excess > 0).any()):
        raise Fault(f"dolp of evaluate and table differ by {float(excess.max()):.2g} more than their bounds allow")


class Walk:
    def __init__(self, program: str, folder: Path) -> None:
        self._program = program
        self._folder = folder

    def scene(self, seed: int, report: Callable[[str], None]) -> str:
        """Runs all calls on the scene of a seed. Returns "taken", "refused" or "large"."""
        report("draw")
        text = scenes.draw(seed, self._folder)
        try:
            scene = dolp.Scene(text=text)
        except dolp.InputError as error:
            check_refusal(str(error))
            scene = None
        report("plan")
        if scene is not None and self._is_large(scene):
            return "large"
        refused = "no scene" if scene is None else self._calls(scene, report)
        if seed % _COMMANDS_EVERY == 0:
            self._commands(text, bool(refused), report)
        return "refused" if refused else "taken"

    @staticmethod
    def _is_large(scene: dolp.Scene) -> bool:
        try:
            return bool(dolp.plan(scene).values["evaluations"] > _MOST_EVALUATIONS)
        except dolp.InputError:
            return False

    def _calls(self, scene: dolp.Scene, report: Callable[[str], None]) -> str:
        """Runs the calls of the package. Returns why `table` refuses the scene, or an empty text."""
        results: dict[str, Any] = {}
        refusals: dict[str, str] = {}
        angles = {"theta_i_deg": [0.0, 50.0], "theta_r_deg": [0.0, 70.0], "delta_phi_deg": [180.0, 30.0]}
        calls = {"table": lambda: dolp.table(scene, evaluator=_EVALUATOR), "plan": lambda: dolp.plan(scene),
                 "evaluate": lambda: self._entries(scene, results["table"]),
                 "response": lambda: dolp.response(scene, theta_deg=[0, 60, 90], evaluator=_EVALUATOR),
                 "mueller": lambda: dolp.mueller(scene, **angles, evaluator=_EVALUATOR)}
        for name, call in calls.items():
            if name == "evaluate" and "table" in refusals:
                continue
            report(name)
            try:
                results[name] = call()
            except dolp.InputError as error:
                check_refusal(str(error))
                refusals[name] = str(error)
        if ("table" in refusals) != ("plan" in refusals):
            raise Fault(f"table and plan disagree: {refusals}")
        if "table" in results:
            check_values("table", results["table"])
        if results.get("evaluate") is not None:
            check_values("evaluate", results["evaluate"])
            check_agreement(results["table"], results["evaluate"])
        return refusals.get("table", "")

    @staticmethod
    def _entries(scene: dolp.Scene, table: xr.Dataset) -> xr.Dataset | None:
        """The entries of a table computed as points. None for a table with axes that points do not have."""
        if {"material", "band"} & set(table.dims):
            return None
        columns = {"theta": "theta_deg", "wavelength": "wavelength_um", "temperature": "temperature_K"}
        axes = {columns.get(str(dim), str(dim)): table[dim] for dim in table.dims}
        if "wind_m_s" in table.coords:
            axes["wind_m_s"] = table.wind_m_s
            axes.pop("sigma")
        if "temperature_K" in axes:
            return None
        return dolp.evaluate(scene, **axes, evaluator=_EVALUATOR)

    def _commands(self, text: str, is_refused: bool, report: Callable[[str], None]) -> None:
        scene, points, beams = (self._folder / name for name in ("scene.toml", "points.csv", "beams.csv"))
        table = self._folder / "table.nc"
        scene.write_text(text)
        points.write_text("theta_deg\n0\n60\n90\n")
        beams.write_text("theta_i_deg,theta_r_deg,delta_phi_deg\n0,0,180\n50,70,30\n")
        commands = {"dolp table": ["table", scene, "-o", table], "dolp plan": ["plan", scene],
                    "dolp eval": ["eval", scene, "--points", points, "-o", self._folder / "out.csv"],
                    "dolp mueller": ["mueller", scene, "--points", beams, "-o", self._folder / "m.csv"],
                    "dolp response": ["response", scene, "-o", self._folder / "r.nc", "--set", "grid.theta_deg=[0,60]"],
                    "dolp verify": ["verify", table, "--samples", "2", "--named-files"]}
        if "DISPLAY" in os.environ:
            commands["dolp explore"] = ["explore", scene, "--frames", "1", "--screenshot", self._folder / "s.png"]
        statuses = {}
        for name, arguments in commands.items():
            if name == "dolp verify" and is_refused:
                continue
            report(name)
            try:
                done = subprocess.run([self._program, *map(str, arguments)], capture_output=True, text=True,
                                      timeout=_PATIENCE_S if name == "dolp verify" else _HANG_S - 10)
            except subprocess.TimeoutExpired:
                if name == "dolp verify":
                    continue
                raise Fault(f"{name} hangs") from None
            statuses[name] = done.returncode
            if done.returncode not in (0, 2):
                raise Fault(f"{name} ends with {done.returncode}: {(done.stderr or done.stdout).strip()[-400:]}")
        if (statuses["dolp table"] == 2) != is_refused or statuses["dolp plan"] != statuses["dolp table"]:
            raise Fault(f"the commands and the package disagree about a refusal: {statuses}")


def work(program: str, first: int) -> None:
    """Walks through scenes from number `first` on and prints a line before each step, until the pipe is closed."""
    with tempfile.TemporaryDirectory() as folder:
        walk = Walk(program, Path(folder))
        seed = first
        while True:
            try:
                outcome = walk.scene(seed, lambda step: print(f"step {seed} {step}", flush=True))
            except Fault as fault:
                outcome = f"fault {fault}"
            except Exception as error:  # noqa: BLE001: anything that is neither a result nor a refusal is a fault
                outcome = f"fault {type(error).__name__}: {error}"
            print(f"done {seed} {outcome}".replace("\n", " "), flush=True)
            seed += 1


class Worker:
    """A process that walks through scenes. `line` is its next line, or None if it ended or hangs."""

    def __init__(self, program: str, first: int) -> None:
        self._process = subprocess.Popen([sys.executable, "-B", __file__, program, "--first", str(first), "--work"],
                                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self._lines: queue.Queue[str] = queue.Queue()
        self._errors: list[str] = []
        threading.Thread(target=self._read, daemon=True).start()
        threading.Thread(target=lambda: self._errors.extend(self._process.stderr or ()), daemon=True).start()

    def _read(self) -> None:
        for line in self._process.stdout or ():
            self._lines.put(line.rstrip("\n"))
        self._lines.put("")

    def line(self) -> str | None:
        try:
            return self._lines.get(timeout=_HANG_S) or None
        except queue.Empty:
            return None

    def stop(self) -> str:
        """Ends the process. Returns how it ended and the end of what it wrote."""
        time.sleep(0.2)
        ended = self._process.poll()
        self._process.kill()
        self._process.wait()
        how = "hangs" if ended is None else f"ends with {ended}"
        return f"{how} {' '.join(self._errors)[-300:]}".replace("\n", " ")


def drive(program: str, first: int, count: int, seconds: float) -> int:
    """Returns the number of faults. Starts a new worker after a crash or a hang."""
    outcomes: Counter[str] = Counter()
    faults: list[str] = []
    started = time.monotonic()
    seed, step = first, "start"
    worker = Worker(program, seed)
    while seed < first + count and time.monotonic() - started < seconds and len(faults) < _MOST_REPORTED:
        line = worker.line()
        if line is None:
            faults.append(f"seed {seed}, {step}: {worker.stop()}")
            print(faults[-1], flush=True)
            seed += 1
            worker = Worker(program, seed)
            continue
        kind, _, what = line.split(" ", 2)
        if kind == "step":
            step = what
            continue
        outcomes[what.split()[0]] += 1
        if what.startswith("fault"):
            faults.append(f"seed {seed}, {step}: {what[6:]}")
            print(faults[-1], flush=True)
        seed += 1
    worker.stop()
    print(f"seeds {first} to {seed - 1}: {dict(outcomes)}, {len(faults)} faults")
    return len(faults)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--count", type=int, default=10**9)
    parser.add_argument("--seconds", type=float, default=1e9)
    parser.add_argument("--show", type=int, metavar="SEED")
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.show is not None:
        with tempfile.TemporaryDirectory() as folder:
            print(scenes.draw(options.show, Path(folder)))
        return 0
    if options.work:
        work(options.program, options.first)
    return 1 if drive(options.program, options.first, options.count, options.seconds) else 0


if __name__ == "__main__":
    sys.exit(main())
