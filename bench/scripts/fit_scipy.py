#!/usr/bin/env python3
"""Fits parameters with SciPy's least_squares, which calls `dolp.evaluate`. A user without `dolp fit` would do the same.

The argument is a JSON object with these members:
  package              folder of the Python package dolp
  scene, tolerance     text of the scene, and its tolerance
  columns              for each parameter, its keyword argument of dolp.evaluate
  low, high, start     for each parameter, the ends of its range, and the value at which the fit starts
  theta_deg, measured  for each measurement, the zenith, and Q/I
  uncertainty          one number for all measurements
Prints a JSON object with `values`, `chi_square`, `time_s` and `calls`. `calls` is the number of calls of dolp.evaluate.
One call computes a whole Jacobian.
"""
import json
import sys
import time

import numpy as np
import scipy.optimize

STEP = 1e-4  # step of finite differences, as a share of the parameter's range


class Model:
    def __init__(self, question):
        sys.path.insert(0, question["package"])
        import dolp
        self.evaluate = dolp.evaluate
        self.scene = dolp.Scene(text=question["scene"], overrides={"accuracy.tolerance": question["tolerance"]})
        self.question = question
        self.theta = np.array(question["theta_deg"])
        self.low, self.high = np.array(question["low"]), np.array(question["high"])
        self.calls = 0

    def residuals_at(self, sets):
        """Residuals of several parameter sets, from one call of dolp.evaluate."""
        self.calls += 1
        columns = dict(zip(self.question["columns"], np.array(sets).T[:, :, np.newaxis]))
        found = self.evaluate(self.scene, theta_deg=self.theta, **columns)
        model = (found.stokes_q / found.stokes_i).values
        return (model - self.question["measured"]) / self.question["uncertainty"]

    def residuals(self, values):
        return self.residuals_at([values])[0]

    def jacobian(self, values):
        steps = STEP * (self.high - self.low) * np.where(values < 0.5 * (self.low + self.high), 1, -1)
        residuals = self.residuals_at([values, *(values + np.diag(steps))])
        return (residuals[1:] - residuals[0]).T / steps


def main():
    question = json.loads(sys.argv[1])
    model = Model(question)
    model.residuals(np.array(question["start"]))  # creates device and kernels before the timed part
    model.calls = 0
    start = time.perf_counter()
    found = scipy.optimize.least_squares(model.residuals, question["start"], model.jacobian,
                                         bounds=(model.low, model.high), x_scale="jac")
    taken = time.perf_counter() - start
    print(json.dumps({"values": list(found.x), "chi_square": 2 * found.cost, "calls": model.calls, "time_s": taken}))


if __name__ == "__main__":
    main()
