#!/usr/bin/env python3
"""Exposes dolp to faults, and counts how its runs end.

Usage: faults.py BUILD [--quick] [--json FILE] [KIND...]    BUILD is the folder that has dolp and tests/faults
       faults.py --table FILE      prints the results in FILE as the table of tests/README.md
A KIND is a kind of fault. Each try runs dolp in a new folder with an old output file and causes one fault. Then the
conditions in tests/README.md must hold. With --quick each KIND has fewer tries. Exit status: 1 if a condition did not
hold after a try, otherwise 0. --json writes a row for each KIND to FILE, and keeps the rows of the other kinds in FILE.
"""
import argparse
import collections
import json
import pathlib
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # no cache folders in the sources

import of_devices  # noqa: E402
import of_files  # noqa: E402
import of_memory  # noqa: E402
import of_signals  # noqa: E402
from attempt import FOLDERS, SEED, Broken, Driver  # noqa: E402

KINDS = of_memory.KINDS + of_devices.KINDS + of_files.KINDS + of_signals.KINDS


def ending(status):
    return f"status {status}" if status >= 0 else "ended by a signal"


def markdown(results):
    lines = ["| fault | number of tries | how many tries ended with which exit status |", "|---|---|---|"]
    for row in results["kinds"]:
        ends = ", ".join(f"{count:,} × {what}" for what, count in row["ends"].items())
        lines.append(f"| {row['fault']} | {row['tries']:,} | {ends} |")
    return "\n".join(lines)


def rows_of(path):
    """The rows of a result file. The key of a row is the description of its fault. Empty if there is no file yet."""
    if not path or not path.exists():
        return {}
    return {row["fault"]: row for row in json.loads(path.read_text(encoding="utf-8"))["kinds"]}


def drive(driver, kinds, path):
    """Tries the given kinds of fault. Writes the result file after each kind, because all kinds together take hours."""
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
