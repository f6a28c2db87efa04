"""Figures and tables of `dolp-bench throughput`, for plot.py."""
from plot_style import MASKINGS, digits, foot, head, origin, row_of_cells, tidy, time_text

NEEDED = {"context", "grid", "results"}
TOLERANCE = 1e-4


def interpolated(rows):
    """Returns the rows of runs in which dolp may interpolate between entries, as in `dolp table`."""
    return [row for row in rows if row["interpolation"] == "auto"]


def part(result, name):
    return [row for row in result["results"] if row["part"] == name and "not_run" not in row]


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


def arithmetic_table(result, rows):
    peak = result["peak"]
    lines = ["Peak speed of the device for multiplications and additions in float, measured in the same run: "
             f"{1e-9 * peak['flops_per_s']:.0f} GFLOP/s.", ""]
    lines += head(["masking", "tolerance", "time in kernels per entry", "evaluations per entry", "flops per entry", "÷ and √ per entry",
                   "GFLOP/s", "share of the peak", "share of busy lanes (upper bound)"])
    for row in rows:
        slow = row["operations"]["divide"] + row["operations"]["square_root"]
        lines.append(row_of_cells([
            row["case"], f"{row['setting']:g}", time_text(row["time_s"]), f"{row['evaluations']:.3g}",
            digits(row["flops"]), digits(slow), f"{1e-9 * row['flops_per_s']:.1f}", f"{row['share_of_peak']:.0%}",
            f"{row['busy_lanes']:.0%}"]))
    return lines


def scaling_table(rows, variable):
    settings = sorted({row["setting"] for row in rows})
    names = list(dict.fromkeys(row["case"] for row in rows))
    lines = head([f"`{variable}`"] + [f"{name}: speed / speed of the first row (time per entry)" for name in names])
    for setting in settings:
        cells = [f"{row['speedup']:.2f} ({time_text(row['time_min_s'])})" for row in rows if row["setting"] == setting]
        lines.append(row_of_cells([f"{setting:g}"] + cells))
    return lines


def markdown(result):
    """All parts of the study that the result contains, as Markdown tables."""
    blocks = []
    if part(result, "grids"):
        blocks.append(grid_table(part(result, "grids")))
    if part(result, "materials"):
        blocks.append(materials_table(part(result, "materials")))
    if part(result, "arithmetic"):
        blocks.append(arithmetic_table(result, part(result, "arithmetic")))
    for name, variable in (("cores", "LP_NUM_THREADS"), ("vector-width", "LP_NATIVE_VECTOR_WIDTH")):
        if part(result, name):
            blocks.append(scaling_table(part(result, name), variable))
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


def draw_arithmetic(axes, result, rows):
    peak = 1e-9 * result["peak"]["flops_per_s"]
    labels = []
    for i, row in enumerate(rows):
        rate = 1e-9 * row["flops_per_s"]
        axes.barh(i, rate / row["busy_lanes"], height=0.6, color="white", edgecolor=MASKINGS[row["case"]], linestyle=":")
        axes.barh(i, rate, height=0.6, color=MASKINGS[row["case"]])
        axes.annotate(f" {row['share_of_peak']:.0%}", (rate / row["busy_lanes"], i), va="center", fontsize=8)
        labels.append(f"{row['case']}, {row['setting']:g}")
    axes.axvline(peak, color="black", linewidth=1.0)
    axes.annotate("peak ", (peak, len(rows) - 0.6), ha="right", fontsize=8)
    axes.set_xlim(0, 1.06 * peak)
    axes.set_yticks(range(len(rows)), labels)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlabel("GFLOP/s in kernels; dotted: with lanes that wait", fontsize=9)
    axes.set_title("Arithmetic of the moments, float", fontsize=10, loc="left")
    tidy(axes)


def draw_scaling(axes, result):
    place, labels = 0, []
    for name, title in (("cores", "cores"), ("vector-width", "bits")):
        rows = part(result, name)
        for setting in sorted({row["setting"] for row in rows}):
            own = {row["case"]: row["speedup"] for row in rows if row["setting"] == setting}
            for i, (masking, colour) in enumerate(MASKINGS.items()):
                if masking in own:
                    axes.bar(place + 0.2 * (i - 1.5), own[masking], width=0.18, color=colour)
                    axes.annotate(f"{own[masking]:.2f}", (place + 0.2 * (i - 1.5), own[masking]), ha="center",
                                  va="bottom", fontsize=6.5)
            labels.append(f"{setting:g} {title}" if setting != 1 else "1 core")
            place += 1
        place += 0.5 if rows else 0
        labels += [""] if rows else []
    ticks, texts, position = [], [], 0.0
    for text in labels:
        if text:
            ticks.append(position)
            texts.append(text)
        position += 1.0 if text else 0.5
    axes.set_xticks(ticks, texts)
    axes.set_ylabel("speed over the first of its kind", fontsize=9)
    axes.set_title("lavapipe: cores and vector width", fontsize=10, loc="left")
    tidy(axes, "y")


def figure(result, path, save):
    """Draws all parts of the study that the result contains; `save(drawing, path)` writes the figure."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams["font.family"] = "DejaVu Sans"
    grids, arithmetic = part(result, "grids"), part(result, "arithmetic")
    panels = []
    if grids:
        panels += [lambda axes: draw_grids(axes, grids), lambda axes: draw_tolerances(axes, grids, result["grid"])]
    if arithmetic:
        panels.append(lambda axes: draw_arithmetic(axes, result, arithmetic))
    if part(result, "cores") or part(result, "vector-width"):
        panels.append(lambda axes: draw_scaling(axes, result))
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
