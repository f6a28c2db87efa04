#!/usr/bin/env python3
"""Draws what `dolp fit --json` reports: data and fit, residuals, and the two parameters that depend most on each other.

Usage: plot_fit.py PICTURE < REPORT.json    `dolp fit --plot PICTURE` runs it
Needs python3-matplotlib. Exit status: 0 done, 2 no report of a fit, 4 the picture could not be written.
"""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
LABELS = {"dolp": "DOLP (%)", "q_over_i": "Q/I (%)", "emissivity_s": "emissivity (%)", "emissivity_p": "emissivity (%)"}
PERCENT = 100.0
# Half axes, in standard deviations, of the regions that hold two parameters in 68.27 % and 95 % of all cases.
ELLIPSES = ((1.515, "68 %"), (2.448, "95 %"))


def curves(points):
    """The points of each data set, quantity and wavelength, by zenith."""
    found = {}
    for point in points:
        found.setdefault((point["data"], point["quantity"], point["wavelength_um"]), []).append(point)
    for key, members in found.items():
        members.sort(key=lambda point: point["theta_deg"])
        yield key, {name: np.array([np.nan if p[name] is None else p[name] for p in members], dtype=float)
                    for name in ("theta_deg", "measured", "uncertainty", "model", "residual")}


def label_of(key, several):
    data, quantity, wavelength_um = key
    parts = [data] if several else []
    parts += [quantity] + ([f"{wavelength_um:g} µm"] if wavelength_um is not None else [])
    return ", ".join(parts)


def draw_data(upper, lower, report):
    several = len({point["data"] for point in report["points"]}) > 1
    has_uncertainties = report["scale_from"] == "uncertainties"
    factor = 1.0 if has_uncertainties else PERCENT
    for i, (key, curve) in enumerate(curves(report["points"])):
        colour = COLOURS[i % len(COLOURS)]
        bars = PERCENT * curve["uncertainty"] if has_uncertainties else None
        upper.errorbar(curve["theta_deg"], PERCENT * curve["measured"], bars, fmt="o", markersize=3.5, linewidth=1.0,
                       color=colour, label=label_of(key, several))
        upper.plot(curve["theta_deg"], PERCENT * curve["model"], color=colour, linewidth=1.6)
        lower.errorbar(curve["theta_deg"], factor * curve["residual"], 1.0 if has_uncertainties else None, fmt="o",
                       markersize=3.5, linewidth=1.0, color=colour)
    lower.axhline(0.0, color="0.4", linewidth=1.0)
    lower.set_xlabel(r"zenith angle $\theta$ (degree)")
    lower.set_ylabel("measured − model\n" + ("(uncertainties)" if has_uncertainties else "(points of 1 %)"))
    upper.set_ylabel(LABELS[report["points"][0]["quantity"]])
    upper.legend(frameon=False, fontsize=9)


def most_correlated(report):
    """Positions of the two parameters of the largest correlation, or None where there is none."""
    table = np.array([[np.nan if cell is None else cell for cell in row] for row in report["correlation"]], dtype=float)
    np.fill_diagonal(table, np.nan)
    if not np.isfinite(table).any():
        return None
    return sorted(np.unravel_index(np.nanargmax(np.abs(table)), table.shape))


def draw_pair(axes, report):
    pair = most_correlated(report)
    if pair is None:
        axes.set_visible(False)
        return
    first, second = (report["parameters"][position] for position in pair)
    correlation = report["correlation"][pair[0]][pair[1]]
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    for radius, name in ELLIPSES:
        x = np.cos(turn)
        y = correlation * x + np.sqrt(max(0.0, 1.0 - correlation**2)) * np.sin(turn)
        axes.plot(first["value"] + radius * first["standard_error"] * x,
                  second["value"] + radius * second["standard_error"] * y, color=COLOURS[0],
                  linewidth=2.0 if name == "68 %" else 1.0, label=f"{name}, from the covariance")
    for one, line in ((first, axes.axvline), (second, axes.axhline)):
        for end in one["interval_95"]:
            if end is not None:
                line(end, color="0.5", linestyle="--", linewidth=1.0)
    axes.plot([], [], color="0.5", linestyle="--", linewidth=1.0, label="95 % of each, profile likelihood")
    axes.plot(first["value"], second["value"], "+", color="black", markersize=10)
    axes.set_xlabel(first["key"])
    axes.set_ylabel(second["key"])
    axes.set_title(f"correlation {correlation:+.3f}", fontsize=10)
    axes.legend(frameon=False, fontsize=8)
    axes.margins(0.12, 0.3)


def caption(report):
    values = "   ".join(
        f"{one['key']} = {one['value']:.5g}" + (f" ± {one['standard_error']:.2g}" if one["standard_error"] else "")
        for one in report["parameters"])
    reduced = report["reduced_chi_square"]
    quality = f"reduced $\\chi^2$ = {reduced:.4g}" if reduced is not None else "no degrees of freedom"
    return f"{values}   {quality}"


def draw(report, path):
    plt.rcParams.update({"font.size": 10.5, "axes.spines.top": False, "axes.spines.right": False})
    figure = plt.figure(figsize=(11.5, 5.0), dpi=150, layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(3, 1), width_ratios=(3, 2))
    upper = figure.add_subplot(grid[0, 0])
    lower = figure.add_subplot(grid[1, 0], sharex=upper)
    upper.tick_params(labelbottom=False)
    draw_data(upper, lower, report)
    draw_pair(figure.add_subplot(grid[:, 1]), report)
    for axes in figure.axes:
        axes.grid(alpha=0.25, linewidth=0.6)
    figure.suptitle(report["title"] or "fit", fontsize=13)
    figure.supxlabel(caption(report), fontsize=9, color="0.3")
    figure.savefig(path, format="png")


def main():
    if len(sys.argv) != 2:
        print(__doc__.splitlines()[2], file=sys.stderr)
        return 2
    try:
        report = json.load(sys.stdin)
        report["points"], report["correlation"]
    except (ValueError, KeyError, TypeError) as error:
        print(f"stdin: no report of dolp fit --json: {error}", file=sys.stderr)
        return 2
    try:
        draw(report, sys.argv[1])
    except OSError as error:
        print(f"{sys.argv[1]}: {error}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
