#!/usr/bin/env python3
"""Draws emissivity and DOLP of rough metal and paint: three models, and the bracket that holds all bounces' DOLP.

The models are single scattering, all bounces, and direct emission. The bracket is a range that contains the DOLP with
all bounces; dolp computes it with single scattering. Usage: plot_scattering.py DOLP -o FIGURE.png. DOLP is the program.
"""

import argparse
import csv
import io
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.dont_write_bytecode = True  # writes no cache folder among the sources
sys.path.append(str(Path(__file__).resolve().parents[2] / "host"))
import picture_file

SURFACES = {
    "metal, N = 10 + 60i, gaussian, $\\sigma$ = 0.3": ["surface.n=10", "surface.k=60", "surface.distribution=gaussian"],
    "paint, N = 1.5, cauchy, $\\sigma$ = 0.3, q = 2": ["surface.n=1.5", "surface.k=0", "surface.distribution=cauchy"],
}
MODELS = {
    "single scattering": ["emission.bracket=true"],
    "all bounces": ["surface.scattering=multiple"],
    "direct emission": ["emission.model=direct"],
}
COLOURS = {"single scattering": "#888888", "all bounces": "#c03030", "direct emission": "#3060b0"}
SCENE = """
[surface]
n = 1.5
sigma = 0.3
masking = "v-cavity"
[emission]
temperature_K = 300
[spectrum]
wavelength_um = 10
[grid]
theta_deg = { from = 0, to = 89, count = 90 }
"""


def computed(program, scene, overrides):
    """Computes the table of a scene. Returns a dictionary from the names of its columns to their values."""
    command = [program, "table", scene, "-o", "-", "--quiet"]
    for override in overrides:
        command += ["--set", override]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rows = csv.DictReader(io.StringIO("\n".join(line for line in text.splitlines() if not line.startswith("#"))))
    columns = {}
    for row in rows:
        for name, value in row.items():
            columns.setdefault(name, []).append(float(value))
    return {name: np.array(values) for name, values in columns.items()}


def draw(program, path):
    figure, axes = plt.subplots(2, 2, figsize=(10.0, 6.4), sharex=True, constrained_layout=True)
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        scene.write_text(SCENE)
        for column, (surface, keys) in enumerate(SURFACES.items()):
            for model, more in MODELS.items():
                table = computed(program, scene, keys + more)
                theta = table["theta_deg"]
                style = {"color": COLOURS[model], "label": model, "linewidth": 2.0}
                axes[0, column].plot(theta, 0.5 * (table["emissivity_s"] + table["emissivity_p"]), **style)
                axes[1, column].plot(theta, 100.0 * table["dolp"], **style)
                if "dolp_low" in table:
                    low, high = 100.0 * table["dolp_low"], 100.0 * table["dolp_high"]
                    axes[1, column].fill_between(theta, low, high, color="0.5", alpha=0.18, linewidth=0.0, label="bracket")
            axes[0, column].set_title(surface, fontsize=11)
            axes[0, column].set_ylim(bottom=0.0)
            axes[1, column].set_ylim(bottom=0.0)
            axes[1, column].set_xlabel("zenith (degrees)")
    axes[0, 0].set_ylabel("emissivity")
    axes[1, 0].set_ylabel("DOLP of the emission (%)")
    for panel in axes.flat:
        panel.grid(alpha=0.25, linewidth=0.6)
        panel.set_xlim(0.0, 89.0)
    axes[1, 0].legend(frameon=False, fontsize=9, loc="upper left")
    picture_file.save(figure, path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()
    draw(arguments.program, arguments.output)


if __name__ == "__main__":
    sys.exit(main())
