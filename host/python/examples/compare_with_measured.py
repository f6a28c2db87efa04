#!/usr/bin/env python3
"""Compares measured values of DOLP with a scene: compare_with_measured.py [MEASURED.csv [PICTURE]]

MEASURED.csv has the columns theta_deg and dolp, and dolp_uncertainty if it is known. Without a file, the script
compares synthetic data: values of the scene with noise.
"""
import sys

import matplotlib
import numpy as np

import dolp

matplotlib.use("Agg")
import matplotlib.pyplot as plt

scene = dolp.Scene(text="""
[surface]
n = 1.5
k = 0.2
sigma = 0.25
q = 3.0
masking = "smith"
[emission]
temperature_K = 320.0
[surroundings]
temperature_K = 290.0
[spectrum]
band_um = [8, 12]
""")
if len(sys.argv) > 1:
    measured = np.genfromtxt(sys.argv[1], delimiter=",", names=True, comments="#")
    theta, values = measured["theta_deg"], measured["dolp"]
    uncertainty = measured["dolp_uncertainty"] if "dolp_uncertainty" in measured.dtype.names else np.full(theta.size, 0.002)
else:
    theta, uncertainty = np.arange(10.0, 85.0, 5.0), np.full(15, 0.002)
    values = dolp.evaluate(scene, theta_deg=theta).dolp.values + np.random.default_rng(7).normal(0, uncertainty)
model = dolp.evaluate(scene, theta_deg=theta)
residuals = (values - model.dolp.values) / uncertainty
print(f"chi^2 of {theta.size} points: {np.sum(residuals ** 2):.1f}")

figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(6, 4.5), layout="constrained",
                                      gridspec_kw={"height_ratios": [3, 1]})
curve = dolp.evaluate(scene, theta_deg=np.linspace(0, 89, 90))
above.plot(curve.theta, 100 * curve.dolp, label="scene")
above.errorbar(theta, 100 * values, 100 * uncertainty, fmt="o", label="measured" if len(sys.argv) > 1 else "synthetic")
above.set_ylabel("DOLP [%]")
above.legend()
below.axhline(0, color="grey")
below.plot(theta, residuals, "o")
below.set(xlabel="zenith angle [degree]", ylabel="residual / $\\sigma$")
figure.savefig(sys.argv[2] if len(sys.argv) > 2 else "compare_with_measured.png", dpi=120)
