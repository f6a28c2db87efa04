"""Figures and tables of `dolp-bench throughput`, for plot.py."""
from plot_style import MASKINGS, digits, foot, head, origin, row_of_cells, tidy, time_text

NEEDED = {"context", "grid", "results"}
TOLERANCE = 1e-4


def interpolated(rows):
    """Returns the rows of runs in which dolp may interpolate between entries, as in `dolp table`."""
    return [row for row in rows if row["interpolation"] == "auto"]


def part(result, name):
    return [row for row in result["results"] if row["part"] == name]


def millions(rate):
    return f"{1e-6 * rate:.3g}"


def grid_table(rows):
    lines = head(["masking", "grid (θ × σ × q)", "tolerance", "interpolation", "time of the whole run", "time in kernels", "time of the whole run per entry", "time in kernels per entry",
                  "million entries/s", "million evaluations/s", "evaluations per entry", "time / time of half the entries"])
    order = lambda row: (list(MASKINGS).index(row["case"]), -row["tolerance"], row["entries"], row["interpolation"])
    for row in sorted(rows, key=order):
        lines.append(row_of_cells([
            row["case"], " × ".join(str(side) for side in row["grid"]), f"{row['tolerance']:g}",
            row["interpolation"], time_text(row["run_s"]), time_text(row["kernel_run_s"]), time_text(row["time_s"]),
            time_text(row["kernel_time_s"]), millions(row["entries_per_s"]), millions(row["evaluations_per_s"]),
            f"{row['evaluations']:.3g}", f"{row['doubled_ratio']:.2f}" if "doubled_ratio" in row else "—"]))
    return lines


def materials_table(rows):
    lines = head(["masking", "surface", "entries", "time of the whole run", "time in kernels", "time in kernels / time in kernels of the compared row",
                  "time of the whole run per entry"])
    for row in rows:
        lines.append(row_of_cells([
            row["case"], row["setting"], digits(row["entries"]), time_text(row["run_s"]), time_text(row["kernel_run_s"]),
            f"{row['kernels_over_one']:.1f}", time_text(row["time_s"])]))
    return lines


def markdown(result):
    """All parts of the study that the result contains, as Markdown tables."""
    blocks = []
    if part(result, "grids"):
        blocks.append(grid_table(part(result, "grids")))
    if part(result, "materials"):
        blocks.append(materials_table(part(result, "materials")))
    return "\n\n".join("\n".join(block) for block in blocks)


def draw_grids(axes, rows):
    for name, colour in MASKINGS.items():
        own = sorted((row for row in interpolated(rows) if row["case"] == name and row["tolerance"] == TOLERANCE
                      and row["grid"][1] == row["grid"][2]),
                     key=lambda row: row["entries"])
        if not own:
            continue
        entries = [row["entries"] for row in own]
        axes.plot(entries, [1.0 / row["time_s"] for row in own], "o-", color=colour, label=name)
        axes.plot(entries, [1.0 / row["kernel_time_s"] for row in own], "o--", color=colour, markerfacecolor="white",
                  linewidth=1.0)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("entries of the grid", fontsize=9)
    axes.set_ylabel("entries per second", fontsize=9)
    axes.set_title(f"Whole run (full) and kernels alone (dashed), tolerance {TOLERANCE:g}", fontsize=10, loc="left")
    axes.legend(fontsize=8, frameon=False)
    tidy(axes, "both")


def draw_tolerances(axes, rows, grid):
    tolerances = sorted({row["tolerance"] for row in rows}, reverse=True)
    own = [row for row in interpolated(rows) if " × ".join(str(side) for side in row["grid"]) == grid.replace("x", "×")]
    for i, (name, colour) in enumerate(MASKINGS.items()):
        for j, tolerance in enumerate(tolerances):
            for row in own:
                if row["case"] != name or row["tolerance"] != tolerance:
                    continue
                place = i + 0.26 * (j - 1)
                axes.bar(place, 1.0 / row["time_s"], width=0.24, color=colour, alpha=1.0 - 0.3 * j)
                axes.annotate(f"{tolerance:.0e}".replace("e-0", "e-"), (place, 1.0 / row["time_s"]), ha="center",
                              va="bottom", fontsize=7)
    axes.set_yscale("log")
    axes.set_xticks(range(len(MASKINGS)), list(MASKINGS))
    axes.set_ylabel("entries per second, whole run", fontsize=9)
    axes.set_title(f"Tolerances, {grid}", fontsize=10, loc="left")
    tidy(axes, "y")


def figure(result, path, save):
    """Draws all parts of the study that the result contains; `save(drawing, path)` writes the figure."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams["font.family"] = "DejaVu Sans"
    grids = part(result, "grids")
    panels = []
    if grids:
        panels += [lambda axes: draw_grids(axes, grids), lambda axes: draw_tolerances(axes, grids, result["grid"])]
    if not panels:
        raise ValueError("holds no measured setting")
    rows = (len(panels) + 1) // 2
    drawing, places = plt.subplots(rows, 2, figsize=(13.5, 4.4 * rows), squeeze=False)
    for axes in list(places.flat)[len(panels):]:
        axes.axis("off")
    for axes, draw in zip(places.flat, panels):
        draw(axes)
    foot(drawing, f"{result['scene']}; {origin(result)}")
    drawing.tight_layout(h_pad=2.0, w_pad=2.0, rect=(0.0, 0.03, 1.0, 1.0))
    save(drawing, path)
