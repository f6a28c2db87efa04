"""Figure and tables of `dolp-bench peers`, for plot.py."""
from plot_style import digits, foot, head, origin, row_of_cells, style, tidy, time_text

NEEDED = {"context", "methods", "cases", "targets", "results"}
COLOURS = ("#56B4E9", "#0072B2", "#000000")
TARGET_TOLERANCE = 1e-4


def rows_of(result, method, case):
    """The results of one method in one case: a dictionary from tolerances to rows."""
    return {row["tolerance"]: row for row in result["results"] if row["method"] == method and row["case"] == case}


def compared_time(row):
    return row.get("kernel_time_s", row.get("time_s"))


def tolerances_of(result):
    return sorted({row["tolerance"] for row in result["results"]}, reverse=True)


def time_table(result):
    tolerances = tolerances_of(result)
    names = [case["name"] for case in result["cases"]]
    lines = ["Time per entry for an error of at most "
             f"{' / '.join(f'{tolerance:g}' for tolerance in tolerances)}. For methods with kernels it is the time in kernels. "
             "A dash means that no tried setting reaches this error.", ""]
    lines += head(["method", "cores"] + names)
    for method in result["methods"]:
        cells = []
        for name in names:
            rows = rows_of(result, method["name"], name)
            times = [compared_time(rows[tolerance]) if tolerance in rows else None for tolerance in tolerances]
            cells.append(" / ".join("—" if time_s is None else time_text(time_s) for time_s in times))
        lines.append(row_of_cells([method["label"], method["cores"]] + cells))
    return lines


def ratio_text(row):
    """A text with two ratios. Each is the time of a method divided by a time of dolp. For the first ratio dolp
    interpolates between entries, for the second it integrates every entry. A star means that the method ran with the
    cheapest setting for each entry. Such settings can be chosen only with hindsight."""
    cells = []
    for prefix in ("table_", ""):
        ratio = row.get(f"{prefix}ratio", row.get(f"hindsight_{prefix}ratio"))
        mark = "" if f"{prefix}ratio" in row else "*"
        cells.append("—" if ratio is None else digits(ratio) + mark)
    return " / ".join(cells)


def ratio_table(result):
    names = [case["name"] for case in result["cases"]]
    lines = ["Time of each method, divided by the time of dolp's kernels in float, both for an error of at most "
             f"{TARGET_TOLERANCE:g}. In the first number of a cell, dolp interpolates between slope distributions, as `dolp table` "
             "does. In the second number, dolp integrates every entry. A star marks methods that have a different setting for each "
             "entry, chosen with hindsight.", ""]
    lines += head(["method"] + names)
    for method in result["methods"]:
        cells = [ratio_text(rows_of(result, method["name"], name).get(TARGET_TOLERANCE, {})) for name in names]
        lines.append(row_of_cells([method["label"]] + cells))
    return lines


def target_table(result):
    lines = [f"Factors by which other methods take longer than dolp, for an error of at most {TARGET_TOLERANCE:g}:", ""]
    lines += head(["method", "masking", "target factor", "measured factor", "factor with hindsight", "target reached"])
    for target in result["targets"]:
        hindsight = digits(target["hindsight_ratio"]) if "hindsight_ratio" in target else "—"
        measured = digits(target["ratio"]) if "ratio" in target else "—"
        reached = {True: "yes", False: "no", None: "—"}[target.get("met")]
        lines.append(row_of_cells([target["against"], target["case"], f"{target['wanted']:,g}", measured, hindsight,
                                   reached]))
    return lines


def markdown(result):
    """Times, ratios and targets as Markdown tables."""
    blocks = [time_table(result), ratio_table(result)]
    if result["targets"]:
        blocks.append(target_table(result))
    return "\n\n".join("\n".join(block) for block in blocks)


def draw_case(axes, result, case):
    tolerances = tolerances_of(result)
    for y, method in enumerate(result["methods"]):
        rows = rows_of(result, method["name"], case["name"])
        for i, tolerance in enumerate(tolerances):
            row = rows.get(tolerance, {})
            colour = COLOURS[i % len(COLOURS)]
            place = y + 0.22 * (i - 0.5 * (len(tolerances) - 1))
            if "time_s" in row:
                if "kernel_time_s" in row:
                    axes.plot([row["kernel_time_s"], row["time_s"]], [place, place], color=colour, linewidth=0.8)
                    axes.plot(row["time_s"], place, "|", color=colour, markersize=6)
                axes.plot(compared_time(row), place, "o", color=colour, markersize=5)
            if "hindsight_time_s" in row:
                axes.plot(row["hindsight_time_s"], place, "o", markerfacecolor="white", markeredgecolor=colour,
                          markersize=4)
        target = rows.get(TARGET_TOLERANCE, {})
        text = f"× {digits(target['table_ratio'])}" if "table_ratio" in target else "—"
        axes.annotate(text, (1.01, y), xycoords=("axes fraction", "data"), va="center", fontsize=7.5)
    axes.set_yticks(range(len(result["methods"])), [style(method["name"])[0] for method in result["methods"]])
    axes.set_ylim(len(result["methods"]) - 0.4, -0.6)
    axes.set_xscale("log")
    axes.set_title(f"masking {case['name']}", fontsize=10, loc="left")
    axes.set_xlabel("time per entry [s]", fontsize=9)
    tidy(axes)


def figure(result, path, save):
    """Draws one panel per masking; `save(drawing, path)` writes it."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams["font.family"] = "DejaVu Sans"
    if not any("time_s" in row for row in result["results"]):
        raise ValueError("holds no measured setting")
    columns = min(2, len(result["cases"]))
    rows = (len(result["cases"]) + columns - 1) // columns
    drawing, places = plt.subplots(rows, columns, figsize=(13.5, 1.2 + 4.2 * rows), squeeze=False, sharex=True)
    for axes, case in zip(places.flat, result["cases"]):
        draw_case(axes, result, case)
    first = places[0][0]
    for i, tolerance in enumerate(tolerances_of(result)):
        first.plot([], [], "o", color=COLOURS[i % len(COLOURS)], label=f"error ≤ {tolerance:g}")
    first.plot([], [], "o", markerfacecolor="white", markeredgecolor="black", markersize=4, label="with hindsight")
    first.plot([], [], "|", color="black", label="whole call")
    drawing.legend(*first.get_legend_handles_labels(), fontsize=8, loc="upper right", ncol=5, frameon=False)
    foot(drawing, f"Dots: kernels, where there are any. × is to the kernels of the Vulkan table, both for "
                  f"{TARGET_TOLERANCE:g}. {origin(result)}")
    drawing.tight_layout(h_pad=1.5, w_pad=4.0, rect=(0.0, 0.03, 1.0, 0.97))
    save(drawing, path)
