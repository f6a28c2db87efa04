#!/usr/bin/env python3
"""Draws the plots of the window `dolp explore`: curves, measured points and view. The window runs this program.

Usage: plot_view.py .svg|.pdf|.png < PLOTS.json > PICTURE
Needs python3-matplotlib. Exit status: 0 done, 2 usage or wrong input, 4 the picture cannot be written.
"""
import json
import sys
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.colors import LogNorm, Normalize  # noqa: E402
from matplotlib.patches import Patch  # noqa: E402
from matplotlib.patheffects import withStroke  # noqa: E402
from matplotlib.ticker import FormatStrFormatter, LogLocator, MaxNLocator  # noqa: E402

# Colours of the window's light theme. The line styles distinguish the curves without colours.
STYLES = {"curve": {"color": "#0072B2", "linestyle": "-"}, "overlay": {"color": "#C47C00", "linestyle": (0, (5, 3))}}
PINS = (("#968A00", (0, (1.5, 2))), ("#AA5082", (0, (7, 2.5))), ("#008662", (0, (3, 1.5))), ("#BE4600", (0, (1, 1.5))),
        ("#3296CD", (0, (9, 1.5))), ("#181A1E", (0, (2.5, 4.5))))
ABOVE = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.3, "frameon": False, "fontsize": 8}
LINE_INCHES = 0.17  # height of one line of a legend
LONG_NAME = 40  # a legend whose longest name is shorter has two columns
FAILING = {"color": "0.6", "linewidth": 0.8, "linestyle": "--"}
BAND = "all bounces lie between"
MODEL_FAILS = "the model fails here (status)"
CONTOURS = 7
MOST_CONTRAST = 1e3  # a logarithmic colour scale spans at most this factor, as in the window


def numbers(values):
    return np.array([np.nan if value is None else value for value in values], dtype=float)


def set_axes(axes, x, y):
    for axis, name in ((x, "x"), (y, "y")):
        if axis["is_log"]:
            getattr(axes, f"set_{name}scale")("log")
            getattr(axes, f"{name}axis").set_major_formatter(FormatStrFormatter("%g"))
        getattr(axes, f"set_{name}lim")(axis["from"], axis["to"])
        getattr(axes, f"set_{name}label")(axis["label"])


def draw_curves(axes, plots):
    """Draws curves and points, the main curve on top and first in the legend. Returns the lines of the legend."""
    for order, curve in enumerate(plots["curves"]):
        style = curve["style"]
        style = STYLES.get(style) or dict(zip(("color", "linestyle"), PINS[style % len(PINS)]))
        at, values, good = numbers(curve["at"]), numbers(curve["values"]), np.array(curve["good"], dtype=bool)
        low, high = numbers(curve["low"]), numbers(curve["high"])
        axes.plot(at, np.where(good, values, np.nan), label=curve["name"], linewidth=1.5, zorder=3 - 0.01 * order,
                  **style)
        axes.plot(at, np.where(good, np.nan, values), label="_" if good.all() else MODEL_FAILS, **FAILING)
        if np.isfinite(low).any():
            axes.fill_between(at, low, high, label=BAND, color=style["color"], alpha=0.2, linewidth=0)
    points = plots["measured"]
    if points:
        column = {name: numbers([point[name] for point in points]) for name in ("at", "value", "uncertainty")}
        axes.errorbar(column["at"], column["value"], column["uncertainty"], fmt="o", markersize=4, color="0.2",
                      markerfacecolor="none", elinewidth=0.8, label="measured")
    set_axes(axes, plots["x"], plots["y"])
    axes.grid(alpha=0.25, linewidth=0.6)
    entries = {}  # legend entries; all areas labelled BAND share one, and so do all lines labelled MODEL_FAILS
    for handle, label in zip(*axes.get_legend_handles_labels()):
        entries[label if label in (MODEL_FAILS, BAND) else handle] = (handle, label)
    columns = 2 if max(len(label) for _, label in entries.values()) < LONG_NAME else 1
    axes.legend(*zip(*entries.values()), ncols=columns, **ABOVE)
    return -(-len(entries) // columns)


def places(axis, count):
    spaced = np.geomspace if axis["is_log"] else np.linspace
    return spaced(axis["from"], axis["to"], count)


def draw_map(figure, axes, plot):
    rows = np.ma.masked_invalid([numbers(row) for row in plot["rows"]])
    x, y = places(plot["x"], rows.shape[1]), places(plot["y"], rows.shape[0])
    low, high = (rows.min(), rows.max()) if rows.count() else (0.0, 1.0)
    locator, colours = MaxNLocator(CONTOURS), "viridis"
    if plot["is_signed"]:
        high, colours = max(abs(low), abs(high)), "RdBu_r"
        low = -high
    if plot["colours"]:
        low, high = plot["colours"]["from"], plot["colours"]["to"]
    norm = Normalize(low, high)
    if plot["is_log"] and not plot["is_signed"] and high > 0.0:
        low = max(low, high / MOST_CONTRAST)
        norm, locator = LogNorm(low, high), LogLocator(subs=(1.0, 2.0, 5.0))
    mesh = axes.pcolormesh(x, y, rows, cmap=colours, norm=norm, shading="nearest", rasterized=True)
    axes.set_facecolor("0.72")
    if rows.mask.any():
        axes.legend(handles=[Patch(facecolor="0.72", label=MODEL_FAILS)], **ABOVE)
    levels = [level for level in locator.tick_values(low, high) if low < level < high]
    # Sets the scales of the axes before the labels of contours, because the gaps for these labels depend on the scales.
    set_axes(axes, plot["x"], plot["y"])
    if levels:
        lines = axes.contour(x, y, rows, levels=levels, colors="0.2" if plot["is_signed"] else "white", linewidths=0.7)
        halo = withStroke(linewidth=2, foreground="white" if plot["is_signed"] else "0.2")
        plt.setp(axes.clabel(lines, fontsize=7, fmt="%g"), path_effects=[halo])
    figure.colorbar(mesh, ax=axes, pad=0.02).set_label(plot["label"])


def draw(plots, suffix):
    # Keeps text as text in an SVG. Does not parse titles as formulas, because they may contain any character.
    plt.rcParams.update({"font.size": 10, "svg.fonttype": "none", "text.parse_math": False})
    plt.rcParams.update({"axes.spines.top": False, "axes.spines.right": False})
    has_view = plots["map"] is not None or plots["sweep"] is not None
    size = (11.0 if has_view else 6.5, 4.4)
    figure, panels = plt.subplots(1, 1 + has_view, figsize=size, dpi=150, layout="constrained", squeeze=False)
    figure.set_figheight(size[1] + LINE_INCHES * draw_curves(panels[0, 0], plots))
    if plots["map"] is not None:
        draw_map(figure, panels[0, 1], plots["map"])
    if plots["sweep"] is not None:
        draw_curves(panels[0, 1], plots["sweep"])
    figure.suptitle(textwrap.fill(plots["title"], int(9 * size[0])))
    figure.savefig(sys.stdout.buffer, format=suffix.lstrip(".") or "png")


def main():
    if len(sys.argv) != 2:
        print(__doc__.splitlines()[2], file=sys.stderr)
        return 2
    try:
        plots = json.load(sys.stdin)
        draw(plots, sys.argv[1])
    except (KeyError, TypeError, json.JSONDecodeError) as error:
        print(f"no plots of the window: {error}", file=sys.stderr)
        return 2
    except (OSError, ValueError) as error:
        print(f"the picture cannot be written: {error}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
