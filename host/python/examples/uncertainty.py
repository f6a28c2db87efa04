#!/usr/bin/env python3
"""Draws the uncertainty of DOLP that follows from uncertainties of n, k, sigma and T: uncertainty.py [PICTURE]"""
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
sigma = 0.2
q = 3.0
masking = "smith"
[emission]
temperature_K = 310.0
[surroundings]
temperature_K = 280.0
[spectrum]
wavelength_um = 10.0
""")
uncertainty = {"surface.n": 0.03, "surface.k": 0.02, "surface.sigma": 0.01, "emission.temperature_K": 1.0}
theta_deg = np.arange(10, 86, 5)
d = dolp.evaluate(scene, theta_deg=theta_deg, derivatives=list(uncertainty))
share = {key: u * d["d_dolp__" + key.replace(".", "_")] for key, u in uncertainty.items()}
deviation = sum(part**2 for part in share.values())**0.5

# The same by 10^4 random draws.
draws = np.random.default_rng(1).normal(size=(len(uncertainty), 10_000))
columns = {"surface.n": "n", "surface.k": "k", "surface.sigma": "sigma", "emission.temperature_K": "temperature_K"}
values = {columns[key]: scene[key] + u * draw for (key, u), draw in zip(uncertainty.items(), draws)}
at = [4, 10]
coarse = scene.with_({"accuracy.tolerance": 1e-3})
drawn = [dolp.evaluate(coarse, theta_deg=theta, **values).dolp.std().item() for theta in theta_deg[at]]

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
left.plot(theta_deg, 100 * d.dolp, color="black")
left.fill_between(theta_deg, 100 * (d.dolp - deviation), 100 * (d.dolp + deviation), alpha=0.4)
left.set_ylabel("DOLP [%]")
for key, part in share.items():
    right.plot(theta_deg, 100 * abs(part), label=key)
right.plot(theta_deg, 100 * deviation, color="black", label="all")
right.plot(theta_deg[at], 100 * np.array(drawn), "o", color="black", label="10 000 draws")
right.set_ylabel("standard deviation of DOLP [points]")
right.legend(fontsize=8)
for axes in (left, right):
    axes.set_xlabel("zenith angle [degree]")
figure.suptitle("Paint at (310 ± 1) K, n = 1.50 ± 0.03, k = 0.20 ± 0.02, σ = 0.20 ± 0.01")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "uncertainty.png", dpi=120)
ratio = np.array(drawn) / deviation.values[at]
print(f"standard deviation of DOLP at 60 degrees: {100 * deviation.sel(theta=60).item():.3f} points; "
      f"draws over derivatives: {ratio.min():.3f} to {ratio.max():.3f}")
