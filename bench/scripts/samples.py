#!/usr/bin/env python3
"""Times the ways to compute DOLP of many random samples, as for training data or an inversion: samples.py [COUNT]

Needs the package dolp (PYTHONPATH=build/release/python). Prints the table of bench/README.md, "Many samples". The samples
are random theta, sigma, n and k under a sky of 250 K, with a tolerance of 1e-3. Errors are differences from `evaluate` at
1000 of the samples with a tolerance of 1e-5, in points of DOLP.
"""
import resource
import sys
import time

import numpy as np
from scipy.interpolate import RegularGridInterpolator

import dolp

SCENE = """
[surface]
n = 1.5
k = 0.1
sigma = 0.2
q = 3.0
masking = "{masking}"
[emission]
temperature_K = 300
[surroundings]
temperature_K = 250
[spectrum]
wavelength_um = 10
[accuracy]
tolerance = 1e-3
"""
LIMITS = {"theta_deg": (0, 85), "sigma": (0.05, 0.6), "n": (1.2, 3), "k": (0, 1)}
AXES = {name: np.linspace(*limits, count) for (name, limits), count in zip(LIMITS.items(), (60, 30, 30, 15))}
SIDE = 10  # the third way has so many values of theta and of sigma


def table_and_scipy(scene, samples):
    table = dolp.table(scene, quantities=["q_over_i"], **AXES)
    grid = table.q_over_i.isel(q=0).transpose("theta", "sigma", "n", "k")
    interpolate = RegularGridInterpolator(tuple(AXES.values()), grid.values)
    return np.abs(interpolate(np.stack([samples[name] for name in LIMITS], axis=1)))


def response_and_product(scene, samples):
    """All combinations of SIDE values of theta, SIDE values of sigma, and the materials."""
    planck = {T: dolp.evaluate(scene.with_({"emission.temperature_K": T, "surroundings": None}), theta_deg=0, n=1.0, k=0.0)
              .stokes_i.item() for T in (300, 250)}
    surface = dolp.Scene(text=SCENE.format(masking=scene["surface.masking"]))
    response = dolp.response(surface, theta_deg=np.sort(samples["theta_deg"][:SIDE]), sigma=np.sort(samples["sigma"][:SIDE]))
    rho = dolp.moments(response, n=samples["n"], k=samples["k"])
    i = planck[300] - rho.rho_i * (planck[300] - planck[250])
    return np.abs(rho.rho_q * (planck[300] - planck[250]) / i).values.reshape(SIDE, SIDE, -1)


def timed(function, *arguments):
    start = time.perf_counter()
    result = function(*arguments)
    return result, time.perf_counter() - start


def main():
    count = int(float(sys.argv[1])) if len(sys.argv) > 1 else 1_000_000
    random = np.random.default_rng(1)
    samples = {name: random.uniform(*limits, count) for name, limits in LIMITS.items()}
    few = {name: values[:1000] for name, values in samples.items()}
    print("| masking | way | samples | time | median error | 99 % of the errors below |\n|---|---|---|---|---|---|")
    for masking in ("smith", "v-cavity", "integral"):
        scene = dolp.Scene(text=SCENE.format(masking=masking))
        dolp.evaluate(scene, theta_deg=10.0)  # starts the device
        right = dolp.evaluate(scene.with_({"accuracy.tolerance": 1e-5}), **few).dolp.values

        def row(way, number, seconds, found, right=right, masking=masking):
            errors = 100 * np.abs(found - right)
            print(f"| `{masking}` | {way} | {number:,} | {seconds:.2g} s | {np.median(errors):.1g} | "
                  f"{np.quantile(errors, 0.99):.1g} |", flush=True)

        evaluated, seconds = timed(lambda: dolp.evaluate(scene, **samples).dolp.values)
        row("`evaluate`", count, seconds, evaluated[:1000])
        found, seconds = timed(table_and_scipy, scene, samples)
        row("`table` and SciPy", count, seconds, found[:1000])
        materials = {name: samples[name][:count // SIDE**2] for name in ("n", "k")}
        found, seconds = timed(response_and_product, scene, {**samples, **materials})
        checked = dolp.evaluate(scene.with_({"accuracy.tolerance": 1e-5}), theta_deg=samples["theta_deg"][:SIDE, None],
                                sigma=np.sort(samples["sigma"][:SIDE]), n=materials["n"][0], k=materials["k"][0])
        order = np.argsort(samples["theta_deg"][:SIDE])
        row(f"`response` and `moments`, {SIDE} × {SIDE} values of θ and σ", found.size, seconds, found[..., 0],
            checked.dolp.values[order])
    print(f"\nMemory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20:.1f} GB", file=sys.stderr)


if __name__ == "__main__":
    main()
