#!/usr/bin/env python3
"""Draws properties of response tables: weights, accuracy against number of angles, time against number of materials.

Usage: plot_response.py -o FIGURE.png, with the package dolp on PYTHONPATH.
Prints the numbers that bench/README.md states.
"""
import argparse
import sys
import time
from pathlib import Path

import dolp
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

sys.dont_write_bytecode = True  # writes no cache folder among the sources
sys.path.append(str(Path(__file__).resolve().parents[2] / "host"))
import picture_file

SCENE = dolp.Scene(text="""
[surface]
n = 1.5
sigma = 0.3
masking = "smith"
[emission]
temperature_K = 300
[spectrum]
wavelength_um = 10
""")
SURFACES = {"σ = 0.02": (0.02, "#0072B2"), "σ = 0.2": (0.2, "#009E73"), "σ = 0.8": (0.8, "#D55E00")}
INDICES = [1.05, 1.15 + 0.08j, 1.25 + 0.3j, 1.33, 1.5, 1.5 + 0.1j, 1.8 + 0.5j, 2.2 + 0.9j, 2.4, 3.4, 4.0, 0.8 + 1.5j, 0.5 + 3j,
           0.1 + 10j, 3 + 5j, 10 + 60j, 27 + 90j, 60 + 120j, 0.4 + 0.3j, 0.9 + 0.3j]
COUNTS = (8, 12, 16, 20, 24)
GRID = {"theta_deg": [0.01, 30, 60, 80, 89], "sigma": [0.05, 0.3, 1], "q": [1.6, 2.5, 4]}
TIGHT = 1e-9


def reflectances(index, cosine):
    """(R_s + R_p)/2 and (R_s - R_p)/(2 sin^2 beta), where `cosine` is cos(beta)."""
    root = np.sqrt((index - 1) * (index + 1) + cosine ** 2 + 0j)
    r_s = abs((cosine - root) / (cosine + root)) ** 2
    r_p = abs((index ** 2 * cosine - root) / (index ** 2 * cosine + root)) ** 2
    return (r_s + r_p) / 2, (r_s - r_p) / (2 * (1 - cosine ** 2))


def transform(count):
    """Returns the zeros of the Chebyshev polynomial T_count, and the matrix that computes the Chebyshev coefficients of
    a function from its values at these zeros."""
    x = np.polynomial.chebyshev.chebpts1(count)[::-1]
    matrix = 2 / count * np.polynomial.chebyshev.chebvander(x, count - 1).T
    matrix[0] /= 2
    return x, matrix


def errors(counts):
    """For each refractive index and each number K of angles: the largest error of rho_i and rho_q, divided by rho_i.
    The errors are those of a response table with K angles, which replaces the Fresnel reflectances by sums of K
    Chebyshev polynomials. The true values come from `dolp table`."""
    scene = SCENE.with_({"accuracy.tolerance": TIGHT})
    response = dolp.response(scene, evaluator="cpu", **GRID)
    c0, most = response.attrs["c0"], response.sizes["beta"]
    # Column m of `sums` has the values of the Chebyshev polynomial T_m at the angles of the response table.
    # of_i[..., m] is rho_i of an imaginary material whose (R_s + R_p)/2 is T_m. of_q[..., m] is rho_q of an imaginary
    # material whose (R_s - R_p)/(2 sin^2 beta) is T_m.
    sums = np.polynomial.chebyshev.chebvander(transform(most)[0], most - 1)
    of_i = response.response_i.values @ sums
    of_q = (response.response_q * np.sin(np.deg2rad(response.beta)) ** 2).values @ sums
    found = np.empty((len(INDICES), len(counts)))
    for i, index in enumerate(INDICES):
        table = dolp.table(scene.with_({"surface.n": complex(index)}), evaluator="cpu", keep_all=True, **GRID)
        for j, count in enumerate(counts):
            x, matrix = transform(count)
            mean, half = reflectances(index, c0 * np.sinh(0.5 * (1 + x) * np.arcsinh(1 / c0)))
            off = [abs(part[..., :count] @ (matrix @ curve) - right) / table.rho_i.values
                   for part, curve, right in ((of_i, mean, table.rho_i.values), (of_q, half, table.rho_q.values))]
            found[i, j] = np.max(off)
    return found


def seconds(call):
    call()
    times = []
    for _ in range(3):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def times(numbers):
    """Seconds that dolp takes for a response table, for the table of one material, and for the moments of several
    materials from the response table."""
    axes = {"theta_deg": np.linspace(0, 85, 32), "sigma": np.geomspace(0.05, 1, 8), "q": np.linspace(1.75, 6, 8)}
    response = dolp.response(SCENE, **axes)
    pass_s = seconds(lambda: dolp.response(SCENE, **axes))
    table_s = seconds(lambda: dolp.table(SCENE, keep_all=True, **axes))
    n = np.linspace(1.2, 4, max(numbers))
    return pass_s, table_s, [seconds(lambda: dolp.moments(response, n=n[:number], k=0.1)) for number in numbers]


def draw_weights(axes):
    for name, (sigma, colour) in SURFACES.items():
        response = dolp.response(SCENE, theta_deg=60, sigma=sigma, q=3).squeeze()
        axes.plot(response.beta, response.response_i, "o-", color=colour, markersize=4, linewidth=1.2, label=name)
    axes.axhline(0, color="black", linewidth=0.6)
    axes.set(xlabel="local angle of incidence β (degree)", ylabel="weight response_i", title="θ = 60°, q = 3, smith")
    axes.legend(frameon=False)


def draw_errors(axes, found):
    axes.semilogy(COUNTS, found.T, color="#BBBBBB", linewidth=0.8)
    for label, values, colour in (("largest of 20", found.max(axis=0), "#D55E00"), ("median", np.median(found, axis=0), "#0072B2")):
        axes.semilogy(COUNTS, values, "o-", color=colour, label=label)
    axes.set(xlabel="angles K", ylabel="error of ρ over ρ_I", title="20 indices, one grey line each", xticks=COUNTS)
    axes.legend(frameon=False)


def draw_times(axes, numbers, measured):
    pass_s, table_s, moments_s = measured
    axes.loglog(numbers, table_s * np.array(numbers), "s-", color="#D55E00", label="one table × materials")
    axes.loglog(numbers, pass_s + np.array(moments_s), "o-", color="#0072B2", label="response and moments")
    axes.set(xlabel="materials", ylabel="seconds", title="32 × 8 × 8 entries")
    axes.legend(frameon=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("-o", "--output", required=True, type=Path)
    output = parser.parse_args().output
    found, numbers = errors(COUNTS), (1, 3, 10, 30, 100, 300, 1000)
    measured = times(numbers)
    print("| index | " + " | ".join(f"K = {count}" for count in COUNTS) + " |")
    for index, row in zip(INDICES, found):
        print(f"| {index} | " + " | ".join(f"{value:.0e}" for value in row) + " |")
    print(f"one pass {measured[0]:.3f} s, one table {measured[1]:.3f} s, moments of {numbers[-1]} materials {measured[2][-1]:.3f} s")
    drawing, axes = plt.subplots(1, 3, figsize=(12, 3.8), constrained_layout=True)
    draw_weights(axes[0])
    draw_errors(axes[1], found)
    draw_times(axes[2], numbers, measured)
    for own in axes:
        own.spines[["top", "right"]].set_visible(False)
    picture_file.save(drawing, output)


if __name__ == "__main__":
    main()
