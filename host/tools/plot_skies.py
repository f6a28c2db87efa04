#!/usr/bin/env python3
"""Draws brightness temperatures of a uniform, a clear and an overcast sky, and Q/I of paint under them, over zenith.

Usage: plot_skies.py DOLP OUT.png [--band FROM TO]
DOLP is the program. The uniform sky has the temperature at which its irradiance equals the irradiance of the clear sky.
Needs python3-numpy and python3-matplotlib.
Exit status: 0 done, 2 usage; if DOLP fails, the status of DOLP.
"""
import argparse
import csv
import functools
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)
import numpy as np  # noqa: E402

sys.dont_write_bytecode = True  # writes no cache folder among the sources
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import picture_file  # noqa: E402

SCENE = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "clear_sky.toml"
# Colours of Okabe and Ito, which colour-blind readers can tell apart.
SKIES = {"uniform": "#777777", "clear": "#0072B2", "overcast": "#D55E00"}
PROFILES = {"clear": "clear-sky", "overcast": "overcast"}
MIRROR = ["surface.n=1e6", "surface.k=1e6", "surface.specular=1", "surface.diffuse=0", "emission=none"]


def results(program, settings, sigma):
    """Columns of the table of SCENE with `settings` (KEY=VALUE) and `sigma`, as arrays."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "t.csv"
        command = [program, "table", str(SCENE), "-o", str(out), "--quiet", "--set", f"grid.sigma={sigma}"]
        for setting in settings:
            command += ["--set", setting]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            print(run.stderr, end="", file=sys.stderr)
            sys.exit(run.returncode)
        rows = csv.DictReader(line for line in out.read_text().splitlines() if not line.startswith("#"))
        columns = [{name: float(value or "nan") for name, value in row.items()} for row in rows]
    table = {name: np.array([row[name] for row in columns]) for name in columns[0]}
    # Where I is NaN, at 90 degrees, Q/I is a limit far from the neighbouring values; not drawn.
    table["q_over_i"][np.isnan(table["stokes_i"])] = np.nan
    return table


@functools.cache
def sky_exitance(program, sky, band):
    """Table of a perfect mirror under a sky. Its column stokes_i is pi times the sky's radiance at each zenith."""
    return results(program, MIRROR + [sky, band], 0)


def brightness_temperature(program, band, exitance):
    """The temperature of a uniform sky with this exitance. The logarithm of the exitance is nearly linear in 1/T."""
    known_K = np.arange(150.0, 316.0, 7.5)
    known = [sky_exitance(program, f"surroundings.temperature_K={t}", band)["stokes_i"][0] for t in known_K]
    return 1 / np.interp(np.log(exitance), np.log(known), 1 / known_K)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1])
    parser.add_argument("program")
    parser.add_argument("out")
    parser.add_argument("--band", nargs=2, type=float, default=(8.0, 14.0))
    options = parser.parse_args()
    band = f"spectrum.band_um=[{options.band[0]}, {options.band[1]}]"
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
    settings = {name: f"surroundings.profile={profile}" for name, profile in PROFILES.items()}
    clear = sky_exitance(options.program, settings["clear"], band)
    theta = np.radians(clear["theta_deg"])
    mean = np.trapz(clear["stokes_i"] * np.sin(2 * theta), theta)
    uniform_K = brightness_temperature(options.program, band, mean)
    settings["uniform"] = f"surroundings.temperature_K={uniform_K}"
    for name, colour in SKIES.items():
        sky = sky_exitance(options.program, settings[name], band)
        temperature = brightness_temperature(options.program, band, sky["stokes_i"])
        left.plot(sky["theta_deg"], temperature, color=colour, label=name)
        for sigma, line in ((0.05, "--"), (0.15, "-"), (0.4, ":")):
            table = results(options.program, [settings[name], band], sigma)
            label = f"{name}, σ = {sigma}" if sigma == 0.15 else (f"σ = {sigma}" if name == "uniform" else None)
            right.plot(table["theta_deg"], 100 * table["q_over_i"], line, color=colour, label=label)
    left.set(xlabel="zenith [°]", ylabel="brightness temperature [K]", title="Skies", xlim=(0, 90))
    right.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
    right.set(xlabel="zenith [°]", ylabel="Q/I [%]", title="Paint at 290 K under them", xlim=(0, 90))
    left.legend(frameon=False)
    right.legend(frameon=False, fontsize=8)
    figure.suptitle(f"{options.band[0]:g}–{options.band[1]:g} µm; the uniform sky ({uniform_K:.0f} K) has the mean of the clear one",
                    fontsize=10)
    picture_file.save(figure, options.out, dpi=110)


if __name__ == "__main__":
    main()
