#!/usr/bin/python3
"""Fits the coefficients of the error model (host/plan/doubt_model.hpp) and writes host/plan/doubt_coefficients.inc.

    build/release/host/calibrate/dolp-doubts FIRST --draws 16000 --seed 1 \
        --stored tests/data/random_points.csv --stored host/verify/hard_cases.csv
    build/release/host/calibrate/dolp-doubts SECOND --draws 4000 --seed 2
    /usr/bin/python3 host/calibrate/fit_doubts.py FIRST SECOND -o host/plan/doubt_coefficients.inc
    build/release/host/calibrate/dolp-doubts OTHER --draws 4000 --seed 3
    /usr/bin/python3 host/calibrate/fit_doubts.py OTHER --check host/plan/doubt_coefficients.inc

log10(error bound / doubt) is linear in the features. For each model the fit is the function of the least mean over the
entries that is nowhere below log10(error / doubt) plus a margin: a linear programme, solved with the constraints that
matter, which are added until none is violated. --check says how many entries of a folder are understated, and by how much.
"""

import argparse
import concurrent.futures
import pathlib
import re
import sys

import numpy as np
from scipy.optimize import linprog

MODELS = [(m, d) for m in range(4) for d in range(2)]  # masking, distribution: the order of host/scene/scene.hpp
MASKINGS = ["none", "v-cavity", "integral", "smith"]
DISTRIBUTIONS = ["cauchy", "gaussian"]
QUANTITIES = ["r_i and r_q", "deficit"]

# Decades beyond the errors seen, in the core of the domain, outside, and with a critical angle.
CORE_MARGIN = 0.22
OUTER_MARGIN = 0.5
CRITICAL_MARGIN = 1.1
OUTSIDE = "outside"  # how the features begin that vanish in the core
CRITICAL = ("critical", "nearly critical")
OUTER_WEIGHT = 0.2  # in the mean
UNSEEN_WEIGHT = 0.1  # of an error that rounding hides, and
UNSEEN_EXCESS = -2.5  # the least that is asked for it
PULL_TO_ZERO = 1e-3  # on coefficients that no entry decides
LARGEST_COEFFICIENT = 30.0
FIRST_CONSTRAINTS = 4000
MORE_CONSTRAINTS = 2000
AT_ONCE = 2  # models, a gigabyte or two each


def read_description(folder):
    lines = (folder / "features.txt").read_text().splitlines()
    return [float(knot) for knot in lines[0].split()], lines[1:]


def hats(digits, knots):
    """Shares of the knots, (entries, knots), in a function of the digits that is linear between them."""
    return np.stack([np.interp(digits, knots, row) for row in np.eye(len(knots))], axis=1)


def read_samples(folders, model, knots, names):
    """digits, excess (entries, 2), margins, and the two design matrices (entries, features * knots)."""
    files = [folder / "{}{}.bin".format(*model) for folder in folders]
    rows = np.concatenate([np.fromfile(file) for file in files]).reshape(-1, 3 + 2 * len(names))
    digits, excess = rows[:, 0], rows[:, 1:3]
    blocks = np.split(rows[:, 3:], 2, axis=1)
    outside = blocks[0][:, [name.startswith(OUTSIDE) for name in names]].any(axis=1)
    critical = blocks[0][:, [name in CRITICAL for name in names]].any(axis=1)
    margins = np.where(critical, CRITICAL_MARGIN, np.where(outside, OUTER_MARGIN, CORE_MARGIN))
    shares = hats(digits, knots)[:, None, :]
    return digits, excess, margins, [(b[:, :, None] * shares).reshape(len(rows), -1) for b in blocks]


def envelope(design, target, weights):
    """The linear function of least weighted mean that is nowhere below the target."""
    mean = weights @ design / weights.sum()
    pull = PULL_TO_ZERO * np.maximum(np.abs(design).mean(axis=0), 1e-3)
    active = np.zeros(len(target), bool)
    active[np.random.default_rng(0).choice(len(target), min(FIRST_CONSTRAINTS, len(target)), replace=False)] = True
    active[np.argsort(-target)[:MORE_CONSTRAINTS]] = True
    while True:
        rows = design[active]
        result = linprog(
            np.concatenate([mean + pull, pull - mean]),
            A_ub=np.hstack([-rows, rows]),
            b_ub=-target[active],
            bounds=(0.0, LARGEST_COEFFICIENT),
            method="highs",
        )
        if result.status != 0:
            sys.exit(f"fit_doubts.py: {result.message}")
        fitted = np.subtract(*np.split(result.x, 2))
        shortfall = target - design @ fitted
        if shortfall.max() < 1e-6:
            return fitted
        worst = np.argsort(-shortfall)[:MORE_CONSTRAINTS]
        active[worst[shortfall[worst] > 1e-7]] = True


def fit(excess, margins, design):
    known = ~np.isnan(excess) & np.isfinite(design).all(axis=1)
    excess, margins, design = excess[known], margins[known], design[known]
    weights = np.where(margins == CORE_MARGIN, 1.0, OUTER_WEIGHT) * np.where(np.isfinite(excess), 1.0, UNSEEN_WEIGHT)
    return envelope(design, np.maximum(excess, UNSEEN_EXCESS) + margins, weights)


def described(title, digits, excess, margins, bound):
    """How the bounds stand: median over the error seen, by digits, and entries that are understated."""
    core = margins == CORE_MARGIN
    over = np.where(np.isfinite(excess), bound - excess, np.inf)
    parts = []
    for low, high in ((3, 5), (5, 7), (7, 9), (9, 16)):
        here = core & np.isfinite(over) & (digits >= low) & (digits < high)
        parts.append(f"{10 ** np.median(over[here]):.0f}" if here.any() else "-")
    for part in (core, ~core):
        short = over[part] < 0.0
        worst = 10 ** max(0.0, -over[part].min())
        parts.append(f"{short.sum()} of {part.sum()} understated, up to {worst:.2f} times")
    return f"{title:32s} bound/error by digits {', '.join(parts[:4])}; core {parts[4]}; outside {parts[5]}"


def title_of(model, i):
    return f"{MASKINGS[model[0]]} {DISTRIBUTIONS[model[1]]} {QUANTITIES[i]}"


def write_coefficients(path, names, fitted):
    width = len(next(iter(fitted.values()))) // len(names)
    lines = ["// Written by host/calibrate/fit_doubts.py. A line for each feature, a column for each knot of the digits."]
    for m in range(4):
        lines.append("{")
        for d in range(2):
            lines.append("{")
            for i in range(2):
                lines.append("{{  // " + title_of((m, d), i))
                for name, row in zip(names, fitted[m, d, i].reshape(-1, width)):
                    numbers = ", ".join(f"{value:.3f}" if abs(value) > 5e-4 else "0.0" for value in row)
                    lines.append("{{" + numbers + "}},  // " + name)
                lines.append("}},")
            lines.append("},")
        lines.append("},")
    path.write_text("\n".join(lines) + "\n")


def read_coefficients(path):
    text = re.sub(r"//.*", "", path.read_text())
    numbers = np.array([float(x) for x in re.findall(r"-?\d+\.\d+", text)]).reshape(4, 2, 2, -1)
    return {(m, d, i): numbers[m, d, i] for m, d in MODELS for i in range(2)}


def examine(folders, model, knots, names, given):
    """Coefficients of a model, fitted unless given, and how they stand."""
    digits, excess, margins, designs = read_samples(folders, model, knots, names)
    coefficients = {}
    lines = []
    for i in range(2):
        coefficients[(*model, i)] = given[(*model, i)] if given else fit(excess[:, i], margins, designs[i])
        bound = designs[i] @ coefficients[(*model, i)]
        lines.append(described(title_of(model, i), digits, excess[:, i], margins, bound))
    return coefficients, lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=pathlib.Path, nargs="+", metavar="FOLDER")
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("-o", dest="output", type=pathlib.Path, metavar="FILE")
    action.add_argument("--check", type=pathlib.Path, metavar="FILE")
    arguments = parser.parse_args()
    knots, names = read_description(arguments.folders[0])
    coefficients = read_coefficients(arguments.check) if arguments.check else {}
    with concurrent.futures.ProcessPoolExecutor(AT_ONCE) as pool:
        tasks = [
            pool.submit(examine, arguments.folders, model, knots, names, arguments.check and coefficients)
            for model in MODELS
        ]
        for task in tasks:
            fitted, lines = task.result()
            coefficients.update(fitted)
            print("\n".join(lines), flush=True)
    if arguments.output:
        write_coefficients(arguments.output, names, coefficients)


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit(f"fit_doubts.py: {error}")
