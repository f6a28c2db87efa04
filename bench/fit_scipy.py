#!/usr/bin/env python3
"""SciPy's least_squares around `dolp eval`, as one would write it without `dolp fit`.

One argument, JSON: `dolp` (the program), `scene` (text), `tolerance`, `columns` (of the points, one for each
parameter), `low`, `high`, `start`, `theta_deg`, `measured`, `uncertainty`. Prints JSON: `values`, `chi_square`, `calls`
of the program, `time_s`. One call computes a whole Jacobian.
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy
import scipy
import scipy.optimize

STEP = 1e-4  # of differences, relative to the range


class Model:
    def __init__(self, question, folder):
        self.question = question
        self.folder = pathlib.Path(folder)
        self.theta = numpy.array(question["theta_deg"])
        self.low, self.high = numpy.array(question["low"]), numpy.array(question["high"])
        self.calls = 0
        (self.folder / "scene.toml").write_text(question["scene"])

    def residuals_at(self, sets):
        """Residuals of each parameter set, from one call."""
        self.calls += 1
        rows = [[theta, *values] for values in sets for theta in self.theta]
        points = self.folder / "points.csv"
        header = ",".join(["theta_deg", *self.question["columns"]])
        numpy.savetxt(points, rows, delimiter=",", header=header, comments="", fmt="%.17g")
        command = [self.question["dolp"], "eval", self.folder / "scene.toml", "--points", points, "-o", "-", "--quiet"]
        command += ["--tolerance", str(self.question["tolerance"])]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        lines = [line for line in text.splitlines() if not line.startswith("#")]
        q_over_i = [float(row["stokes_q"]) / float(row["stokes_i"]) for row in csv.DictReader(lines)]
        model = numpy.array(q_over_i).reshape(len(sets), self.theta.size)
        return (model - self.question["measured"]) / self.question["uncertainty"]

    def residuals(self, values):
        return self.residuals_at([values])[0]

    def jacobian(self, values):
        steps = STEP * (self.high - self.low) * numpy.where(values < 0.5 * (self.low + self.high), 1, -1)
        residuals = self.residuals_at([values, *(values + numpy.diag(steps))])
        return (residuals[1:] - residuals[0]).T / steps


def main():
    if sys.argv[1] == "--version":
        print("SciPy", scipy.__version__)
        return
    question = json.loads(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        model = Model(question, folder)
        start = time.perf_counter()
        found = scipy.optimize.least_squares(model.residuals, question["start"], model.jacobian,
                                             bounds=(model.low, model.high), x_scale="jac")
        taken = time.perf_counter() - start
    print(json.dumps({"values": list(found.x), "chi_square": 2 * found.cost, "calls": model.calls, "time_s": taken}))


if __name__ == "__main__":
    main()
