#!/usr/bin/env python3
"""Draws what a polarisation camera sees of a sphere and of a car: camera_images.py [PICTURE]

From a map of normals and a map of temperatures to images of I, Q, U, DOLP and the angle of polarisation. One table over
theta and wavelength gives the reflectances of the paint; the emission of a pixel follows from Planck's law. The
surroundings have one temperature. For ground and sky see tilted_panel.py.
"""
import sys
import time

import matplotlib
import numpy as np
import xarray as xr

import dolp

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SIZE = 512
SKY_K = 260.0
BAND_UM = (8.0, 14.0)
scene = dolp.Scene(text=f"""
[surface]
n = 1.5
k = 0.1
sigma = 0.15
q = 3.0
masking = "smith"
[emission]
temperature_K = 300.0
[surroundings]
temperature_K = {SKY_K}
[spectrum]
band_um = {list(BAND_UM)}
""")
x, y = np.meshgrid(np.linspace(-1, 1, SIZE), np.linspace(1, -1, SIZE))  # right and up in the image


def sphere():
    """Normals (NaN beside the sphere), temperatures, and the directions to the camera and up."""
    radius_2 = (x / 0.95) ** 2 + (y / 0.95) ** 2
    z = np.sqrt(np.where(radius_2 < 1, 1 - radius_2, np.nan))
    normals = np.stack([x / 0.95, y / 0.95, z], axis=-1)
    return normals, np.full(x.shape, 300.0), np.array([0, 0, 1.0]), np.array([0, 1.0, 0])


def box(p, middle, half, rounding):
    """Distance of the points `p` from a rounded box."""
    beyond = np.abs(p - middle) - (np.array(half) - rounding)
    return np.linalg.norm(np.maximum(beyond, 0), axis=-1) + np.minimum(beyond.max(axis=-1), 0) - rounding


def wheels(p):
    beside, along, up = np.abs(p[..., 1]) - 0.72, np.abs(p[..., 0]) - 1.15, p[..., 2] - 0.3
    beyond = np.stack([np.hypot(along, up) - 0.27, np.abs(beside) - 0.09], axis=-1)
    return np.linalg.norm(np.maximum(beyond, 0), axis=-1) + np.minimum(beyond.max(axis=-1), 0) - 0.03


def distance(p):
    """Distance from a shape like a car: a body, a cabin that joins it smoothly, and wheels."""
    body = box(p, (0, 0, 0.55), (1.95, 0.8, 0.3), 0.22)
    cabin = box(p, (-0.25, 0, 0.95), (1.0 - 0.5 * np.clip(p[..., 2:] - 0.8, 0, 1)) * np.array([1, 0.66, 0.42]), 0.2)
    blend = np.clip(0.5 + (cabin - body) / 0.3, 0, 1)
    return np.minimum(cabin + (body - cabin) * blend - 0.15 * blend * (1 - blend), wheels(p))


def car():
    """As sphere(). Each ray moves by the distance to the shape until it arrives, or is beyond the shape."""
    view = np.array([0.75, 0.55, 0.38]) / np.linalg.norm([0.75, 0.55, 0.38])
    up = np.array([0, 0, 1.0])
    right = np.cross(up, view) / np.linalg.norm(np.cross(up, view))
    p = np.array([0, 0, 0.55]) + 4 * view + 1.75 * (x[..., None] * right + y[..., None] * np.cross(view, right))
    p = p.reshape(-1, 3)
    moving = np.arange(len(p))
    while moving.size:
        left = distance(p[moving])
        p[moving] -= 0.6 * left[:, None] * view  # the blend of body and cabin is nearer than its distance says
        moving = moving[(left > 1e-4) & (p[moving] @ view > -3)]
    p = p.reshape(*x.shape, 3)
    steps = 1e-4 * np.eye(3)
    normals = np.stack([distance(p + step) - distance(p - step) for step in steps], axis=-1)
    hood = np.exp(-((p[..., 0] - 1.3) ** 2 + p[..., 1] ** 2) / 0.4)
    temperatures = np.where(wheels(p) < 1e-2, 306.0, 296.0 + 25 * hood)
    return np.where(distance(p)[..., None] < 1e-3, normals, np.nan), temperatures, view, up


def planck(wavelength_um, kelvin):
    """Radiance of a black body in W m-2 sr-1 um-1."""
    return 1.191042972e8 / wavelength_um ** 5 / np.expm1(14387.7688 / (wavelength_um * kelvin))


def images(table, normals, kelvin, view, up):
    theta = np.degrees(np.arccos(np.clip(normals @ view / np.linalg.norm(normals, axis=-1), 0, 1)))
    stokes = np.zeros((3, *theta.shape))
    for um in table.wavelength.values:
        at_um = table.sel(wavelength=um)
        rho_i, rho_q = (np.interp(theta, table.theta, rho) for rho in (at_um.rho_i, at_um.rho_q))
        emitted, reflected = planck(um, kelvin), planck(um, SKY_K)
        stokes[0] += float(at_um.weight) * (emitted * (1 - rho_i) + reflected * rho_i)
        stokes[1] += float(at_um.weight) * (reflected - emitted) * rho_q
    surface = xr.Dataset({f"stokes_{name}": (("row", "column"), image) for name, image in zip("iqu", stokes)})
    return dolp.camera_stokes(surface, normals, view, up)


start = time.perf_counter()
at, weight = np.polynomial.legendre.leggauss(6)
middle, half = np.mean(BAND_UM), np.diff(BAND_UM)[0] / 2
at_one = scene.with_({"spectrum.band_um": None, "spectrum.wavelength_um": middle})
table = dolp.table(at_one, theta_deg=np.linspace(0, 89.5, 359), wavelength_um=middle + half * at,
                   quantities=["rho_i", "rho_q"]).squeeze(["sigma", "q"]).assign(weight=("wavelength", half * weight))
shapes = {"sphere": sphere(), "car": car()}
seen = {name: images(table, *shape) for name, shape in shapes.items()}
print(f"{len(seen)} x {SIZE} x {SIZE} pixels in {time.perf_counter() - start:.1f} s")

random = np.random.default_rng(1)
for name, (normals, kelvin, view, up) in shapes.items():
    pixels = seen[name].stack(pixel=("point_0", "point_1")).reset_index("pixel")
    chosen = random.choice(np.flatnonzero(pixels.theta_deg.values < 89.5), 500, replace=False)
    theta = pixels.theta_deg.values[chosen]
    exact = dolp.evaluate(scene, theta_deg=theta, temperature_K=kelvin.ravel()[chosen])
    error, bound = np.abs(pixels.dolp.values[chosen] - exact.dolp.values).max(), exact.error_estimate.values.max()
    print(f"{name}: DOLP of 500 pixels differs from dolp.evaluate by up to {100 * error:.1g} points, "
          f"whose bound is {100 * bound:.1g}")

figure, axes = plt.subplots(2, 5, figsize=(15, 6.2), layout="constrained")
for row, (name, image) in zip(axes, seen.items()):
    largest = float(abs(image[["stokes_q", "stokes_u"]]).quantile(0.995).to_array().max())
    signed = {"cmap": "RdBu_r", "vmin": -largest, "vmax": largest}
    for ax, (title, values, style) in zip(row, (
            ("I (W m$^{-2}$ sr$^{-1}$)", image.stokes_i, {"cmap": "inferno"}),
            ("Q (W m$^{-2}$ sr$^{-1}$)", image.stokes_q, signed), ("U (W m$^{-2}$ sr$^{-1}$)", image.stokes_u, signed),
            ("DOLP (%)", 100 * image.dolp, {"cmap": "viridis", "vmin": 0}),
            ("angle of polarisation (°)", image.aolp_deg, {"cmap": "hsv", "vmin": 0, "vmax": 180}))):
        figure.colorbar(ax.imshow(values, interpolation="nearest", **style), ax=ax, shrink=0.8)
        ax.set(title=title if name == "sphere" else "", xticks=[], yticks=[])
figure.suptitle(f"Paint at 8–14 µm with surroundings at {SKY_K:g} K: sphere at 300 K; car with a warm hood")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "camera_images.png", dpi=70)
