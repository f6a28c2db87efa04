#!/usr/bin/env python3
"""Compares a NetCDF table with a CSV of `dolp eval` that has entries of the table. Does not use dolp's own reader.

Usage: read_table.py TABLE.nc EVAL.csv
theta_deg, sigma and q of a CSV row select an entry of the table. A column may be missing if its axis has one value.
Every other column except n and k must equal the variable of its name; NaN equals NaN. If the table lacks this variable,
all values of the column must be NaN, because eval writes NaN for what it does not compute.
Exit status: 0 if all values are equal, 1 if some differ, 2 if the files cannot be compared.
"""
import csv
import sys

import netCDF4
import numpy as np

AXES = {"theta_deg": "theta", "sigma": "sigma", "q": "q"}
MOST_SHOWN = 10


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.reader(line for line in file if not line.startswith("#"))
        names = next(rows)
        return names, np.array([[float(cell) for cell in row] for row in rows]).reshape(-1, len(names))


def positions(dataset, columns, row_count):
    """For each axis of the table, a list with one position for each CSV row."""
    result = []
    for column, axis in AXES.items():
        values = np.asarray(dataset[axis][:])
        if column not in columns:
            if values.size > 1:
                raise ValueError(f"no column {column}, and the table has {values.size} values of {axis}")
            result.append(np.zeros(row_count, int))
            continue
        matches = columns[column][:, None] == values[None, :]
        if not matches.any(axis=1).all():
            row = int(np.argmin(matches.any(axis=1)))
            raise ValueError(f"row {row + 1}: {column} = {columns[column][row]!r} is not on the table's axis")
        result.append(matches.argmax(axis=1))
    return tuple(result)


def differences(dataset, names, data):
    columns = dict(zip(names, data.T))
    at = positions(dataset, columns, len(data))
    found, compared = [], []
    for name, column in columns.items():
        if name in AXES or name in ("n", "k"):
            continue
        if name in dataset.variables:
            variable = dataset[name]
            variable.set_auto_mask(False)
            expected = variable[:][at].astype(float)
            compared.append(name)
        else:
            expected = np.full(len(data), np.nan)
        same = (column == expected) | (np.isnan(column) & np.isnan(expected))
        found += [f"row {i + 1}: {name} is {column[i]!r} in the CSV and {expected[i]!r} in the table"
                  for i in np.flatnonzero(~same)]
    if not compared or not len(data):
        raise ValueError("no column or no row in common with the table")
    return compared, found


def main():
    if len(sys.argv) != 3:
        print(__doc__.splitlines()[2], file=sys.stderr)
        return 2
    try:
        names, data = read_csv(sys.argv[2])
        with netCDF4.Dataset(sys.argv[1]) as dataset:
            compared, found = differences(dataset, names, data)
    except (OSError, ValueError, IndexError, StopIteration) as error:
        print(f"read_table.py: {error}", file=sys.stderr)
        return 2
    for line in found[:MOST_SHOWN]:
        print(line)
    if len(found) > MOST_SHOWN:
        print(f"... and {len(found) - MOST_SHOWN} more")
    print(f"{len(data)} rows, {len(compared)} columns ({', '.join(compared)}): {len(found)} differences")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
