#!/usr/bin/env python3
"""Draws the result of a fit. `dolp fit --plot` runs this program.

Usage: plot_fit.py .png|.pdf|.svg < REPORT.json > PICTURE
Shows data, model, residuals, contours of chi^2, and as a grey area the range that contains the DOLP with all bounces.
Needs python3-matplotlib. Exit status: 0 done, 2 usage or wrong input, 4 the picture cannot be written.
"""
import json
import re
import sys
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
QUANTITIES = {"dolp": "DOLP", "q_over_i": "Q/I", "emissivity_s": r"$\varepsilon_s$", "emissivity_p": r"$\varepsilon_p$"}
SYMBOLS = {"surface.n": "n", "surface.k": "k", "surface.sigma": "σ", "surface.wind_m_s": "wind (m/s)", "surface.q": "q",
           "surface.specular": r"$k_s$",
           "surface.diffuse": r"$k_d$", "emission.temperature_K": "T (K)", "surroundings.temperature_K": r"$T_{surr}$ (K)",
           "spectrum.wavelength_um": "λ (µm)", "geometry.view_zenith_deg": r"$\theta_v$ (degree)",
           "geometry.relative_azimuth_deg": "Δφ (degree)", "surface.diffuse_exponent": "c",
           "path.temperature_K": r"$T_{path}$ (K)", "path.transmittance": "τ", "source.scale": "scale of $E_0$"}
PERCENT = 100.0
REGIONS = ("68 %", "95 %")  # joint confidence regions of two parameters, in the order of contours["levels"]
MOST_PANELS = 4  # largest number of panels, one per zenith, for data over a spectrum
MARKS = ".x+^sv"


def curves(points, along="theta_deg"):
    """Groups points by data set, quantity and, along theta_deg, by wavelength. Yields each group's key, and its columns
    sorted by `along`."""
    found = {}
    for point in points:
        wavelength_um = point["wavelength_um"] if along == "theta_deg" else None
        found.setdefault((point["data"], point["quantity"], wavelength_um), []).append(point)
    for key, members in found.items():
        members.sort(key=lambda point: point[along])
        yield key, {name: np.array([np.nan if p[name] is None else p[name] for p in members], dtype=float)
                    for name in (along, "measured", "uncertainty", "model", "residual")}


def symbol_of(key):
    return SYMBOLS.get(key, key)


def label_of(key, several):
    data, quantity, wavelength_um = key
    parts = [data] if several else []
    parts += [QUANTITIES[quantity]] + ([f"{wavelength_um:g} µm"] if wavelength_um is not None else [])
    return ", ".join(parts)


def frame(axes, arrays):
    """Sets the vertical limits of `axes` so that they contain all values of `arrays`."""
    values = np.concatenate([np.ravel(array) for array in arrays])
    low, high = np.nanmin(values), np.nanmax(values)
    margin = 0.05 * ((high - low) or 1.0)
    axes.set_ylim(low - margin, high + margin)


def draw_data(upper, lower, report):
    several = len({point["data"] for point in report["points"]}) > 1
    has_uncertainties = report["scale_from"] == "uncertainties"
    factor = 1.0 if has_uncertainties else PERCENT
    lines = {(one["data"], one["quantity"], one["wavelength_um"]): one for one in report["curves"]}
    seen = []
    for i, (key, curve) in enumerate(curves(report["points"])):
        colour = COLOURS[i % len(COLOURS)]
        bars = PERCENT * curve["uncertainty"] if has_uncertainties else np.zeros_like(curve["measured"])
        measured, line = PERCENT * curve["measured"], PERCENT * np.array(lines[key]["model"], dtype=float)
        upper.errorbar(curve["theta_deg"], measured, bars if has_uncertainties else None, fmt="o", markersize=3.5,
                       linewidth=1.0, color=colour, label=f"measured: {label_of(key, several)}")
        upper.plot(lines[key]["theta_deg"], line, color=colour, linewidth=1.6, label="model" if i == 0 else None)
        seen += [measured - bars, measured + bars, line]
        lower.errorbar(curve["theta_deg"], factor * curve["residual"], 1.0 if has_uncertainties else None, fmt="o",
                       markersize=3.5, linewidth=1.0, color=colour)
    for i, bracket in enumerate(filter(None, report["brackets"])):
        low, high = (PERCENT * np.array(bracket[end], dtype=float) for end in ("low", "high"))
        upper.fill_between(bracket["theta_deg"], low, high, color="0.75", alpha=0.5, linewidth=0.0,
                           label="bracket of all bounces" if i == 0 else None)
        seen += [low, high]
    frame(upper, seen)
    lower.set_xlabel(r"zenith angle $\theta$ (degree)")
    label_residuals(lower, has_uncertainties)
    upper.set_ylabel(names_in(report["points"]) + " (%)")
    upper.legend(frameon=False, fontsize=9, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.3, ncols=2)


def label_residuals(axes, has_uncertainties):
    axes.axhline(0.0, color="0.4", linewidth=1.0)
    axes.set_ylabel("measured − model\n" + ("(uncertainties)" if has_uncertainties else "(points of 1 %)"))


def names_in(points):
    return ", ".join(dict.fromkeys(QUANTITIES[point["quantity"]] for point in points))


def zeniths_of_a_spectrum(report):
    """Chooses zeniths for plots over wavelength. Empty if wavelengths are few; then draw_data() plots over zenith."""
    zeniths = sorted({point["theta_deg"] for point in report["points"]})
    wavelengths = {point["wavelength_um"] for point in report["points"]}
    if len(wavelengths) <= max(len(COLOURS), len(zeniths)):
        return []
    count = min(len(zeniths), MOST_PANELS)
    return [zeniths[(2 * i + 1) * len(zeniths) // (2 * count)] for i in range(count)]


def draw_spectrum(panels, lower, report, zeniths):
    """Draws one spectrum per zenith, and below the spectra the residuals of all these zeniths."""
    has_uncertainties = report["scale_from"] == "uncertainties"
    several = len({point["data"] for point in report["points"]}) > 1
    for panel, zenith in zip(panels, zeniths):
        colour = COLOURS[zeniths.index(zenith) % len(COLOURS)]
        points = [point for point in report["points"] if point["theta_deg"] == zenith]
        for (key, curve), mark in zip(curves(points, "wavelength_um"), MARKS):
            bars = PERCENT * curve["uncertainty"] if has_uncertainties else None
            panel.errorbar(curve["wavelength_um"], PERCENT * curve["measured"], bars, fmt=mark, markersize=3.0,
                           linewidth=0.6, color=colour, alpha=0.5, label=f"measured: {label_of(key, several)}")
            panel.plot(curve["wavelength_um"], PERCENT * curve["model"], color="black", linewidth=1.4,
                       label="model" if mark == MARKS[0] else None)
            lower.plot(curve["wavelength_um"], (1.0 if has_uncertainties else PERCENT) * curve["residual"], mark,
                       markersize=2.5, color=colour)
        panel.set_title(f"$\\theta$ = {zenith:g}°", fontsize=10, loc="left")
        panel.set_ylabel(names_in(report["points"]) + " (%)")
        panel.tick_params(labelbottom=False)
    panels[0].legend(frameon=False, fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.3, ncols=2)
    lower.set_xlabel("wavelength λ (µm)")
    label_residuals(lower, has_uncertainties)


def draw_pair(axes, report):
    """Draws chi^2 minus its minimum as contours over two parameters. At each point, all other parameters are fitted."""
    contours = report.get("contours")
    if contours is None:
        axes.set_axis_off()
        axes.text(0.5, 0.5, textwrap.fill(report.get("no_contours", "").replace("none:", "No contours:"), 44), ha="center",
                  va="center", color="0.3")
        return
    x, y, growth = (np.array(contours[name], dtype=float) for name in ("x", "y", "growth"))
    root = np.ma.masked_invalid(np.sqrt(growth))  # grows linearly from the minimum, so its contours are smoother
    widths = (2.0, 1.0)
    axes.contour(x, y, root, np.sqrt(contours["levels"]), colors=COLOURS[0], linewidths=widths)
    for level, region, width in zip(contours["levels"], REGIONS, widths):
        axes.plot([], [], color=COLOURS[0], linewidth=width, label=f"{region} of both, $\\Delta\\chi^2$ = {level:.2f}")
    parameters = {one["key"]: one for one in report["parameters"]}
    first, second = (parameters[key] for key in contours["keys"])
    for one, line in ((first, axes.axvline), (second, axes.axhline)):
        for end in one["interval_95"]:
            if end is not None:
                line(end, color="0.5", linestyle="--", linewidth=1.0)
    axes.plot([], [], color="0.5", linestyle="--", linewidth=1.0, label="95 % of each, profile likelihood")
    axes.plot(first["value"], second["value"], "+", color="black", markersize=10, linestyle="none", label="best fit")
    axes.set_xlabel(symbol_of(first["key"]))
    axes.set_ylabel(symbol_of(second["key"]))
    positions = [list(parameters).index(key) for key in contours["keys"]]
    axes.set_title(f"correlation {report['correlation'][positions[0]][positions[1]]:+.3f}", fontsize=10)
    axes.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.12))


def caption(report):
    values = "   ".join(
        f"{symbol_of(one['key'])} = {one['value']:.5g}" + (
            f" ± {one['standard_error']:.2g}" if one["standard_error"] else " (at its bound)" if one["at_bound"] else "")
        for one in report["parameters"])
    reduced = report["reduced_chi_square"]
    quality = f"reduced $\\chi^2$ = {reduced:.4g}" if reduced is not None else "no degrees of freedom"
    word = f", {report['fit_quality']}" if report.get("fit_quality") else ""
    return f"{values}   {quality}{word}{alike(report)}"


def alike(report):
    """A line of the caption: the number of models that fit equally well, and the 95 % ranges of the parameters."""
    if not report.get("alike"):
        return ""
    ends = lambda interval: " to ".join("open" if end is None else f"{end:.4g}" for end in interval or ())
    ranges = "   ".join(f"{symbol_of(one['key'])} {ends(one['interval_95']) or 'none'}" for one in report["ranges"])
    return (f"\n{len(report['alike'])} models cannot be told apart; 95 % ranges over {report['ranges'][0]['models']} models "
            f"of ΔAIC up to 4:   {ranges}")


def title_of(report):
    """Title of the picture: the scene's title, the settings that changed the scene, and its wavelengths unless the data
    have their own."""
    title = re.sub(r"[, ]*[\d.]+( *[-–] *[\d.]+)? *[uµ]m$", "", report["title"])
    if all(point["wavelength_um"] is None for point in report["points"]):
        ends = dict.fromkeys(f"{end:g}" for end in report["spectrum_um"])
        title = ", ".join(part for part in (title, "–".join(ends) + " µm") if part)
    return (title or "fit") + (f"\nwith {report['changed']}" if report.get("changed") else "")


def draw(report, suffix):
    plt.rcParams.update({"font.size": 10.5, "axes.spines.top": False, "axes.spines.right": False})
    zeniths = zeniths_of_a_spectrum(report)
    panels = max(len(zeniths), 1)
    figure = plt.figure(figsize=(11.5, 3.5 + 1.5 * panels), dpi=150, layout="constrained")
    heights = (3,) * panels + (2 if zeniths else 1,)
    grid = figure.add_gridspec(panels + 1, 2, height_ratios=heights, width_ratios=(3, 2))
    lower = figure.add_subplot(grid[panels, 0])
    upper = [figure.add_subplot(grid[i, 0], sharex=lower) for i in range(panels)]
    if zeniths:
        draw_spectrum(upper, lower, report, zeniths)
    else:
        upper[0].tick_params(labelbottom=False)
        draw_data(upper[0], lower, report)
    draw_pair(figure.add_subplot(grid[:, 1]), report)
    for axes in figure.axes:
        axes.grid(alpha=0.25, linewidth=0.6)
    figure.suptitle(title_of(report), fontsize=13)
    figure.supxlabel(caption(report), fontsize=9, color="0.3")
    figure.savefig(sys.stdout.buffer, format=suffix.lstrip("."))


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
        print(f"the picture cannot be written: {error}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
