#!/usr/bin/env python3
"""Finds the n and sigma that give two measured values of DOLP, by interpolation in a table over n, k and sigma.

retrieval_table.py [PICTURE]
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
k = 0.1
sigma = 0.2
q = 3.0
masking = "v-cavity"
[emission]
temperature_K = 300.0
[spectrum]
wavelength_um = 10.0
[accuracy]
tolerance = 1e-3
""")
table = dolp.table(scene, n=np.linspace(1.3, 2.0, 15), k=[0.0, 0.1, 0.2], theta_deg=np.linspace(40, 80, 21),
                   sigma=np.linspace(0.05, 0.5, 19), q=3.0)

# Two measurements of a plate, at zeniths of 50 and 70 degrees.
truth = {"n": 1.62, "k": 0.1, "sigma": 0.23}
seen = {angle: float(dolp.evaluate(scene, theta_deg=angle, **truth).dolp) for angle in (50.0, 70.0)}
n, sigma = np.linspace(1.3, 2.0, 141), np.linspace(0.05, 0.5, 91)
of_plate = table.dolp.sel(k=0.1, q=3.0)
misfit = sum((of_plate.interp(theta=angle).interp(n=n, sigma=sigma) / value - 1) ** 2 for angle, value in seen.items())
best = misfit.where(misfit == misfit.min(), drop=True)
found_n, found_sigma = float(best.n[0]), float(best.sigma[0])
print(f"true n {truth['n']}, sigma {truth['sigma']}; found n {found_n:.3f}, sigma {found_sigma:.3f}")

figure, axes = plt.subplots(figsize=(6.4, 4.8), layout="constrained")
np.sqrt(misfit).rename("relative misfit of both").plot(ax=axes, vmax=0.2, cmap="viridis_r")
axes.plot(truth["sigma"], truth["n"], "w+", markersize=12)
axes.set(title="DOLP seen at 50° and 70°; + is the truth", xlabel="σ", ylabel="n")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "retrieval_table.png", dpi=120)
