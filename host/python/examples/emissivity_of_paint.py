#!/usr/bin/env python3
"""Draws emissivity and DOLP of a painted plate over the zenith angle: emissivity_of_paint.py [PICTURE]"""
import sys

import matplotlib
import numpy as np

import dolp

matplotlib.use("Agg")
import matplotlib.pyplot as plt

scene = dolp.Scene(text="""
[surface]
n = 1.5
k = 0.05
sigma = 0.2
q = 3.0
masking = "v-cavity"
scattering = "multiple"
[emission]
temperature_K = 310.0
[surroundings]
temperature_K = 250.0
[spectrum]
wavelength_um = 10.0
""")
plate = dolp.evaluate(scene, theta_deg=np.linspace(0, 89, 90))

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
plate.emissivity_s.plot(ax=left, label="s")
plate.emissivity_p.plot(ax=left, label="p")
left.set_ylabel("emissivity")
left.legend()
(100 * plate.dolp).plot(ax=right, color="black")
right.set_ylabel("DOLP [%]")
for axes in (left, right):
    axes.set_xlabel("zenith angle [degree]")
figure.suptitle("Paint at 310 K under surroundings at 250 K, 10 um")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "emissivity_of_paint.png", dpi=120)
largest = plate.dolp.idxmax()
print(f"DOLP is largest at {float(largest):.0f} degrees: {100 * float(plate.dolp.max()):.2f} %, "
      f"error below {100 * float(plate.error_estimate.max()):.1g} points")
