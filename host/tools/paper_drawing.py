"""Draws figures 4-7 of the paper with the curves of paper_curves.py, as small PNG files."""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)
import numpy as np  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import paper_curves as model  # noqa: E402
import picture_file  # noqa: E402

# Colours of Okabe and Ito, which colour-blind readers can tell apart.
BLUE, VERMILION, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#777777"
LOOKS = {"cauchy": ("-", "o"), "gaussian": ("--", "s")}
SAMPLE_COLOURS = {"steel": BLUE, "aluminium": VERMILION}
FRAMED_UP_TO_DEG = 80.0  # the DOLP axis contains all curves up to this angle; beyond it, they may leave the plot
HEADROOM = {5: 1.4, 6: 1.4, 7: 1.7}  # end of the DOLP axis divided by the largest DOLP; leaves room for the legend
SMALLEST_SPAN_PERCENT = 0.01  # least height of the DOLP axis, so that rounding noise does not look like a signal
DOTS_PER_INCH = 110
PALETTE = 96  # number of colours; few colours keep the file small
SAMPLE_NAMES = {"steel": "stainless steel", "aluminium": "aviation aluminium"}


def curve_look(curve, figure):
    """Colour, line style and marker of `curve`. Colours show distributions (figures 5, 6) or samples (figure 7)."""
    if curve.sample not in SAMPLE_COLOURS:
        return GREY, ":", "^"
    by_distribution = {"cauchy": BLUE, "gaussian": VERMILION}[curve.distribution]
    return (SAMPLE_COLOURS[curve.sample] if figure == 7 else by_distribution, *LOOKS[curve.distribution])


def curve_label(curve, figure):
    name = "steel's n, aluminium's σ" if curve.sample not in SAMPLE_COLOURS else curve.sample
    peak = curve.peak()
    text = f"{peak[1]:.1f} % at {peak[0]:.1f}°" if peak else "no peak"
    start = f"{name}, {curve.distribution.capitalize()}" if figure == 7 else curve.distribution.capitalize()
    return f"{start}, σ = {curve.sigma:.3g}: {text}"


def draw_dolp_panel(axes, curves, figure):
    marked = [angle * model.STEPS_PER_DEGREE for angle in model.PAPER_ANGLES_DEG]
    for curve in curves:
        colour, line, marker = curve_look(curve, figure)
        held = np.where(curve.holds(), curve.dolp, np.nan)
        hollow = "white" if curve.distribution == "gaussian" else colour
        axes.plot(model.ANGLES_DEG, held, color=colour, linewidth=1.6, linestyle=line, marker=marker, markevery=marked,
                  markersize=3.8, markerfacecolor=hollow, label=curve_label(curve, figure))
    failing = [curve.fails_from() for curve in curves if curve.fails_from() is not None]
    if failing:
        axes.axvspan(min(failing), 90.0, color="0.85", linewidth=0)
    framed = model.ANGLES_DEG <= FRAMED_UP_TO_DEG
    highest = max(np.nanmax(curve.dolp[framed]) for curve in curves)
    axes.set_ylim(0.0, HEADROOM[figure] * max(highest, SMALLEST_SPAN_PERCENT))
    axes.set_title(f"{curves[0].reading} masking, {curves[0].mode}", fontsize=10.5, loc="left")
    axes.legend(frameon=False, fontsize=8.5, loc="upper left")


def reading_text(sample, reading, changes):
    names = dict(zip(model.UNPRINTED, ("q", "$k_s$", "$k_d$", "c", "$E_0/πB(T)$")))
    settings = model.READINGS[reading] | changes
    values = [f"{name} = {model.scene_value(sample, settings, key):g}".replace("-", "−") for key, name in names.items()]
    return f"{reading}: " + ", ".join(values)


def draw_dolp(curves, figure, changes, path):
    prepare()
    drawing, panels = plt.subplots(2, 2, figsize=(11.0, 8.0), layout="constrained", sharex=True)
    places = [(reading, mode) for reading in model.READINGS for mode in model.MODES]
    for axes, (reading, mode) in zip(panels.flat, places):
        draw_dolp_panel(axes, [c for c in curves if (c.reading, c.mode) == (reading, mode)], figure)
    for axes, where in zip(panels[-1], ("zenith of the source $θ_i$, seen from 60° (degree)", "zenith θ (degree)")):
        axes.set_xlabel(where)
    for axes in panels[:, 0]:
        axes.set_ylabel("DOLP (%)")
    named = [f"{SAMPLE_NAMES[s]}, n = {model.scene_value(s, {}, 'surface.n'):g}" for s in model.FIGURE_SAMPLES[figure]]
    drawing.suptitle(f"Figure {figure}, model curves: " + "; ".join(named), fontsize=13)
    drawing.supxlabel(dolp_caption(model.FIGURE_SAMPLES[figure], changes), fontsize=8.5, color="0.3")
    save(drawing, path)


def dolp_caption(samples, changes):
    readings = "; ".join(reading_text(samples[0], reading, changes) for reading in model.READINGS)
    return (f"{readings}.\nThese values and the masking are choices of this project, which the paper does not print; "
            "Gaussian: $σ/\\sqrt{q-1}$. Symbols: the paper's angles.\nDOLP touches 0 where Q changes sign. "
            "Hemispherical curves rise out of the frame. Grey: the model fails there (status 1, 4 or 8).")


def draw_attenuation(curves, path):
    prepare()
    drawing, (left, right) = plt.subplots(1, 2, figsize=(11.0, 4.6), layout="constrained", sharex=True)
    looks = {("integral", "cauchy"): (BLUE, "-"), ("integral", "gaussian"): (VERMILION, "--"),
             ("v-cavity", "cauchy"): (GREEN, "-.")}
    middles = 0.5 * (model.ANGLES_DEG[1:] + model.ANGLES_DEG[:-1])
    for curve in (c for c in curves if c.theta_i_deg == model.FIGURE4_THETA_I_DEG):
        colour, line = looks[curve.masking, curve.distribution]
        name = curve.masking if curve.masking == "v-cavity" else f"{curve.masking}, {curve.distribution.capitalize()}"
        left.plot(model.ANGLES_DEG, curve.g, color=colour, linestyle=line, linewidth=1.8, label=name)
        right.plot(middles, curve.slopes(), color=colour, linestyle=line, linewidth=1.8, label=name)
    left.set_ylim(0.0, 1.05)
    left.set_ylabel("G")
    right.set_ylabel(r"$\mathrm{d}G/\mathrm{d}θ_r$ (1/rad)")
    for axes in (left, right):
        axes.set_xlabel("view zenith $θ_r$, specular side (degree)")
        axes.legend(frameon=False, loc="lower left")
    drawing.suptitle("Figure 4: geometric attenuation at $θ_i$ = 30°, σ = 0.3", fontsize=13)
    caption = (f"Cauchy with q = {model.FIGURE4_Q:g}, a choice of this project; a Gaussian of the same D(0) then has "
               "the same σ. G of v-cavity depends on neither.")
    drawing.supxlabel(caption, fontsize=8.5, color="0.3")
    save(drawing, path)


def prepare():
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                         "grid.alpha": 0.25, "grid.linewidth": 0.6})


def save(drawing, path):
    for axes in drawing.axes:
        axes.set_xlim(0, 90)
        axes.set_xticks(range(0, 91, 15))
    picture_file.save(drawing, path, PALETTE, dpi=DOTS_PER_INCH)
