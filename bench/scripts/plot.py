#!/usr/bin/env python3
"""Figures and tables of dolp-bench.

Usage: plot.py accuracy RESULT.json -o FIGURE.png    error against time per entry, one panel per case
       plot.py accuracy RESULT.json --markdown       time per entry at given errors, as a Markdown table on stdout
       plot.py throughput|scale|fit RESULT.json -o FIGURE.png | --markdown    figure or tables of these studies
`dolp-bench STUDY --json RESULT.json` writes RESULT.json. Figures need python3-matplotlib and its dependency Pillow.
Exit status: 0 done, 2 wrong usage or a file that is not a result of the study, 4 the figure could not be written.
"""
import argparse
import json
import math
import pathlib
import sys
import textwrap

sys.dont_write_bytecode = True  # writes no cache folder among the sources
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "host"))

import picture_file  # noqa: E402
import plot_fit_sets  # noqa: E402
import plot_scale  # noqa: E402
import plot_throughput  # noqa: E402
from plot_style import style, time_text  # noqa: E402

STUDIES = {"throughput": plot_throughput, "scale": plot_scale, "fit": plot_fit_sets}  # all studies except accuracy
NEEDED = {"context", "methods", "cases", "results"}  # keys that a result of the study of accuracy must have
WANTED_ERRORS = (1e-3, 1e-6, 1e-9)
PANEL_COLUMNS = 3
LABEL_GAP_POINTS = 9.0
KEY_WIDTH = 62  # letters
DOTS_PER_INCH = 110
COLOURS = 128
SYMBOLS = {"theta_r": "θr", "delta_phi": "Δφ", "alpha": "α"}


class NotAResult(Exception):
    """The file is not a result of the study."""


def read_result(path, study):
    with open(path, encoding="utf-8") as file:
        result = json.load(file)
    if not isinstance(result, dict) or result.get("study") != study:
        raise NotAResult(f"is no result of dolp-bench {study}")
    missing = (STUDIES[study].NEEDED if study in STUDIES else NEEDED) - result.keys()
    if missing:
        raise NotAResult(f"lacks {', '.join(sorted(missing))}")
    return result


def points(result, method, case):
    """Points (error, time per entry), one for each setting that ran. Errors below the error bound of the reference are
    not known, so the bound replaces them."""
    bound = case["reference"]["bound"]
    return [(max(row["error"], bound), row["time_s"]) for row in result["results"]
            if row["method"] == method and row["case"] == case["name"] and "error" in row]


def worth_it(all_points):
    """Keeps a point if its error is smaller than the errors of all cheaper settings. Sorts from coarse to fine."""
    kept = []
    for error, time_s in sorted(all_points, key=lambda point: (point[1], point[0])):
        if not kept or error < kept[-1][0]:
            kept.append((error, time_s))
    return kept


def why_not_run(result, method):
    rows = [row for row in result["results"] if row["method"] == method]
    if any("error" in row for row in rows):
        return None
    return rows[0]["not_run"] if rows else "no results"


def markdown(result):
    """Time per entry of the cheapest setting that reaches each given error, for every method and case."""
    wanted = " / ".join(f"{error:g}" for error in WANTED_ERRORS)
    names = [case["name"] for case in result["cases"]]
    lines = [f"Time per entry of the cheapest setting whose error is at most {wanted}. A dash means that no setting reaches this error.", "",
             "| method | cores | " + " | ".join(names) + " |", "|---" * (2 + len(names)) + "|"]
    for method in result["methods"]:
        reason = why_not_run(result, method["name"])
        cells = []
        for case in result["cases"]:
            reached = points(result, method["name"], case)
            times = [min((time_s for error, time_s in reached if error <= goal), default=None)
                     for goal in WANTED_ERRORS]
            cells.append(" / ".join("—" if time_s is None else time_text(time_s) for time_s in times))
        if reason:
            cells = [f"not run: {reason}"] + [""] * (len(names) - 1)
        lines.append(f"| {method['label']} | {method['cores']} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def spread_apart(heights, gap):
    """Moves heights as little as necessary, so that neighbours are at least `gap` apart. Keeps their order."""
    order = sorted(range(len(heights)), key=lambda i: heights[i])
    placed = [heights[i] for i in order]
    for _ in range(200):
        moved = False
        for low in range(len(placed) - 1):
            lack = gap - (placed[low + 1] - placed[low])
            if lack > 1e-6:
                placed[low] -= lack / 2
                placed[low + 1] += lack / 2
                moved = True
        if not moved:
            break
    result = [0.0] * len(heights)
    for position, i in enumerate(order):
        result[i] = placed[position]
    return result


def draw_curves(axes, result, case):
    """Draws all curves of a case. Returns the most accurate point, the label and the colour of each curve."""
    ends = []
    for method in result["methods"]:
        label, colour, marker, line = style(method["name"])
        everything = points(result, method["name"], case)
        if not everything:
            continue
        kept = worth_it(everything)
        is_hollow = line == "--"
        is_ours = method["cores"] == "all"
        axes.plot(*zip(*everything), linestyle="none", marker=marker, markersize=3.2, color=colour, alpha=0.35,
                  markerfacecolor="white" if is_hollow else colour)
        axes.plot(*zip(*kept), linestyle=line, marker=marker, markersize=4.6, color=colour,
                  linewidth=2.0 if is_ours else 1.3, markerfacecolor="white" if is_hollow else colour,
                  zorder=4 if is_ours else 3)
        ends.append((kept[-1], label, colour))
    return ends


def label_ends(axes, ends):
    """Writes the name of each curve to the left of the curve's most accurate point. The curve whose most accurate point
    has the largest error gets its name on the right. Moves names that would touch."""
    if not ends:
        return
    to_points = 72.0 / axes.figure.dpi
    low, high = (axes.transAxes.transform((0, y))[1] * to_points for y in (0, 1))
    coarsest = max(ends, key=lambda end: end[0][0]) if len(ends) > 1 else None
    left = [end for end in ends if end is not coarsest]
    levels = [axes.transData.transform(point)[1] * to_points for point, _, _ in left]
    heights = spread_apart(levels, LABEL_GAP_POINTS)
    places = [(end, (-14, min(max(height, low + 6), high - 6) - level), "right")
              for end, level, height in zip(left, levels, heights)]
    if coarsest:
        places.append((coarsest, (7, 0), "left"))
    for (point, label, colour), shift, side in places:
        line = {"arrowstyle": "-", "color": colour, "linewidth": 0.5, "shrinkA": 0, "shrinkB": 3}
        axes.annotate(label, point, xytext=shift, textcoords="offset points", ha=side, va="center", fontsize=7.5,
                      color=colour, zorder=6, arrowprops=line if side == "right" else None,
                      bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.75})


def panel_title(case):
    index = f"n = {case['n']:g}" if case["k"] == 0 else f"n + ik = {case['n']:g} + {case['k']:g}i"
    return (f"{case['name']}: {case['what']}\n{case['masking']}, θ = {case['theta_deg']:g}°, σ = {case['sigma']:g}, "
            f"q = {case['q']:g}, {index}")


def draw_key(axes, result):
    """Describes the methods, and how to read the figure."""
    axes.axis("off")
    context = result["context"]
    device = context["device"].get("name", "no Vulkan device")
    y, step = 1.0, 0.038
    for method in result["methods"]:
        label, colour, marker, line = style(method["name"])
        reason = why_not_run(result, method["name"])
        text = f"{label}: {method['what']}" + (f" (not run: {reason})" if reason else "")
        axes.plot([0.0, 0.07], [y, y], color=colour, linestyle=line, marker=marker, markersize=4.6, linewidth=1.6,
                  markerfacecolor="white" if line == "--" else colour, markevery=[0], clip_on=False)
        for name, symbol in SYMBOLS.items():
            text = text.replace(name, symbol)
        wrapped = textwrap.wrap(text, KEY_WIDTH)
        axes.text(0.1, y + 0.018, "\n".join(wrapped), fontsize=7.2, va="top")
        y -= step * len(wrapped) + 0.011
    notes = [f"Vulkan and CPU use all {context['machine']['cores']} cores, the others one. "
             "Lines join the settings that no cheaper one of the same method beats; faint: the rest. "
             "Left of the grey edge the reference itself does not know the value.",
             f"{context['machine']['processor']}; {device}; {context['date'][:10]}"]
    axes.text(0.0, y - 0.01, "\n".join(line for note in notes for line in textwrap.wrap(note, KEY_WIDTH + 8)),
              fontsize=7.2, va="top", color="#444444")
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)


def prepare(axes, result, case, limits):
    from matplotlib.ticker import LogLocator, NullFormatter
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(limits[0], limits[1])
    axes.set_ylim(limits[2], limits[3])
    axes.xaxis.set_major_locator(LogLocator(numticks=20, subs=(1.0,), base=1000.0))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_formatter(NullFormatter())
    axes.grid(True, which="major", color="#DDDDDD", linewidth=0.6)
    axes.axvspan(limits[0], case["reference"]["bound"], color="#EEEEEE", zorder=0)
    axes.set_title(panel_title(case), fontsize=8.5, loc="left")
    axes.tick_params(labelsize=8)


def limits_of(result):
    everything = [point for method in result["methods"] for case in result["cases"]
                  for point in points(result, method["name"], case)]
    if not everything:
        raise NotAResult("holds no measured setting")
    errors, times = zip(*everything)
    finest, coarsest = math.log10(min(errors)), math.log10(max(errors))
    # The names of the curves need space on the left and on the right.
    return 10 ** (finest - 4.7), 10 ** (coarsest + 1.4), min(times) / 2.0, max(times) * 2.5


def figure(result, path, save):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    rows = math.ceil((len(result["cases"]) + 1) / PANEL_COLUMNS)
    plt.rcParams["font.family"] = "DejaVu Sans"
    drawing, grid = plt.subplots(rows, PANEL_COLUMNS, figsize=(13.5, 4.6 * rows), squeeze=False)
    panels = list(grid.flat)
    limits = limits_of(result)
    for axes, case in zip(panels, result["cases"]):
        prepare(axes, result, case, limits)
    drawing.supxlabel(r"error  $\max(|\delta r_I|, |\delta r_Q|)\,/\,r_I$", fontsize=10)
    drawing.supylabel("time per entry [s]", fontsize=10)
    for axes in panels[len(result["cases"]) + 1:]:
        axes.axis("off")
    drawing.tight_layout(h_pad=1.5, w_pad=1.2)
    for axes, case in zip(panels, result["cases"]):
        label_ends(axes, draw_curves(axes, result, case))
    draw_key(panels[len(result["cases"])], result)
    save(drawing, path)


def save(drawing, path):
    picture_file.save(drawing, path, COLOURS, dpi=DOTS_PER_INCH)


def arguments():
    parser = argparse.ArgumentParser(prog="plot.py", description=__doc__.splitlines()[0])
    studies = parser.add_subparsers(dest="study", required=True)
    for name, what in (("accuracy", "error against time per entry"),
                       ("throughput", "entries a second, with all axes"),
                       ("scale", "time and peak memory over the size of a table"),
                       ("fit", "intervals of fits beside the truth")):
        study = studies.add_parser(name, help=what)
        study.add_argument("result", metavar="RESULT.json")
        output = study.add_mutually_exclusive_group(required=True)
        output.add_argument("-o", "--output", metavar="FIGURE.png")
        output.add_argument("--markdown", action="store_true")
    return parser.parse_args()


def main():
    options = arguments()
    try:
        result = read_result(options.result, options.study)
        module = STUDIES.get(options.study, sys.modules[__name__])
        if options.markdown:
            print(module.markdown(result))
        else:
            module.figure(result, options.output, save)
    except (OSError, ValueError, KeyError, NotAResult) as error:
        is_output = isinstance(error, OSError) and error.filename == options.output
        name = options.output if is_output else options.result
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        print(f"plot.py: {name}: {reason}", file=sys.stderr)
        return 4 if is_output else 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
