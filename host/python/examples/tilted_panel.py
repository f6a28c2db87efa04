#!/usr/bin/env python3
"""Computes the polarisation of a tilted panel between ground and sky: tilted_panel.py [PICTURE]

A sky profile of a scene counts the zenith from the surface normal, so it fits a horizontal surface only. A tilted panel
reflects ground and sky. This script sums the Mueller pBRDF over the directions that the panel sees, and compares the
sum with the profile. The camera looks at the panel from different elevations, in the plane of its tilt.
"""
import pathlib
import sys
import tempfile

import matplotlib
import numpy as np

import dolp

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PANEL_K, GROUND_K, UM = 300.0, 295.0, 10.0
TILT_DEG = 70.0  # from horizontal; the normal leans to the camera
SKY_K = np.array([[0, 210.0], [60, 235.0], [90, 285.0]])  # zenith in degrees, brightness temperature
ZENITHS, AZIMUTHS = 40, 32  # nodes of the sum between breaks
scene = dolp.Scene(text=f"""
[surface]
n = 1.5
k = 0.1
sigma = 0.15
q = 3.0
masking = "smith"
[emission]
temperature_K = {PANEL_K}
[spectrum]
wavelength_um = {UM}
""")


def planck(kelvin):
    """Radiance of a black body in W m-2 sr-1 um-1."""
    return 1.191042972e8 / UM ** 5 / np.expm1(14387.7688 / (UM * kelvin))


def radiance(zenith_deg):
    """Radiance from a direction of the world: the sky, or below the horizon the ground."""
    return np.where(zenith_deg <= 90, planck(np.interp(zenith_deg, *SKY_K.T)), planck(GROUND_K))


def nodes(breaks, count):
    """Nodes and weights of Gauss rules with `count` nodes between the breaks, along the last axis."""
    at, weight = np.polynomial.legendre.leggauss(count)
    half = np.diff(breaks, axis=-1)[..., None] / 2
    middle = (breaks[..., :-1] + breaks[..., 1:])[..., None] / 2
    return ((middle + half * at).reshape(*breaks.shape[:-1], -1), (half * weight).reshape(*breaks.shape[:-1], -1))


def reflected(theta_r_deg, world, fineness):
    """Stokes parameters of the light that the panel reflects to the zenith `theta_r_deg` from its normal; a negative
    zenith is above the normal. Azimuths count from the camera's. The rules end where the horizon crosses a ring of
    directions, and at the zenith of the first ring that it crosses."""
    tilt = np.radians(TILT_DEG)
    theta, weight = nodes(np.array([0, np.pi / 2 - tilt, np.pi / 2]), ZENITHS * fineness)
    horizon = np.arccos(np.clip(1 / np.tan(theta) / np.tan(tilt), -1, 1))
    upper = np.pi if theta_r_deg < 0 else 0
    azimuth, arc = nodes(upper + np.stack([-horizon, horizon, 2 * np.pi - horizon], axis=-1), AZIMUTHS * fineness)
    theta, weight = theta[:, None], (weight * np.sin(theta) * np.cos(theta))[:, None] * arc
    height = np.cos(theta) * np.cos(tilt) - np.sin(theta) * np.cos(azimuth - upper) * np.sin(tilt)
    matrix = dolp.mueller(scene, theta_i_deg=np.degrees(theta), theta_r_deg=abs(theta_r_deg),
                          delta_phi_deg=np.degrees(azimuth) % 360)
    return np.tensordot(weight * world(np.degrees(np.arccos(height))), matrix[..., :3, 0], axes=2)


elevation = np.arange(0.0, 81.0, 5.0)
theta_r = 90 - TILT_DEG - elevation
own = dolp.evaluate(scene, theta_deg=abs(theta_r))
emission = planck(PANEL_K) * np.stack([1 - own.rho_i, -own.rho_q, 0 * own.rho_q], axis=-1)
coarse, fine = (emission + [reflected(theta, radiance, fineness) for theta in theta_r] for fineness in (1, 2))
degree = [np.hypot(stokes[:, 1], stokes[:, 2]) / stokes[:, 0] for stokes in (coarse, fine)]
print(f"twice as many nodes change DOLP by up to {100 * np.abs(degree[1] - degree[0]).max():.1g} points")
closure = reflected(theta_r[-1], np.ones_like, 2)[:2] - [own.rho_i[-1], own.rho_q[-1]]
print(f"light of radiance 1 from everywhere gives rho_i and rho_q up to {np.abs(closure).max():.1g}")
with tempfile.TemporaryDirectory() as folder:
    sky = pathlib.Path(folder) / "sky.csv"
    sky.write_text("zenith_deg,temperature_K\n" + "\n".join(f"{zenith},{kelvin}" for zenith, kelvin in SKY_K))
    horizontal = dolp.evaluate(scene.with_({"surroundings.profile": sky}), theta_deg=abs(theta_r))
print(f"DOLP from an elevation of {elevation[-1]:g}°: {100 * degree[1][-1]:.2f} % between ground and sky; "
      f"the profile would say {100 * float(horizontal.dolp[-1]):.2f} %")

figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
curves = {"between ground and sky": fine[:, 1] / fine[:, 0], "as if it were horizontal": horizontal.q_over_i.values,
          "emission only": emission[:, 1] / emission[:, 0]}
for (name, values), style in zip(curves.items(), ("-", "--", ":")):
    axes.plot(elevation, 100 * values, style, label=name)
axes.axhline(0, color="grey", linewidth=0.8)
axes.set(xlabel="elevation of the camera [degree]", ylabel="Q/I [%], negative: p polarised",
         title=f"Panel tilted by {TILT_DEG:g}°, at {PANEL_K:g} K; ground at {GROUND_K:g} K; {UM:g} µm")
axes.legend()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "tilted_panel.png", dpi=100)
