"""Figure and table of `dolp-bench effects`, for plot.py."""
import textwrap

NEEDED = {"context", "grid", "results"}
PLANNED, KERNEL, KEPT = "#0072B2", "#56B4E9", "#D55E00"
NOTE_WIDTH = 140  # letters


def micro(time_s):
    """A time in microseconds, with three digits."""
    return f"{1e6 * time_s:.3g}"


def label(row):
    return f"{row['effect']}: {row['setting']}".replace("(lambda)", "(λ)")


def left_out(row):
    return ", ".join(row["left_out"]) or "—"


def markdown(result):
    """The results as a Markdown table."""
    lines = ["| effect | mode | scene | time per entry, µs | time in kernels per entry, µs | time / time of the first row | time per entry with `--keep-all`, µs | largest change of DOLP without `--keep-all` | effects left out |",
             "|---" * 9 + "|"]
    for row in result["results"]:
        everything = micro(row["keep_all_time_s"]) if "keep_all_time_s" in row else micro(row["time_s"])
        cells = [row["effect"], row["case"], row["setting"].replace("(lambda)", "(λ)"), micro(row["time_s"]),
                 micro(row["kernel_time_s"]), f"{row['ratio']:.2g}", everything, f"{row['error']:.1g}", left_out(row)]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def places_of(rows):
    """The vertical position of each row, with gaps between effects."""
    places, height, last = [], 0.0, None
    for row in rows:
        group = (row["effect"], row["case"])
        height += 1.0 if last in (None, group) else 1.6
        last = group
        places.append(height)
    return places


def tidy(axes):
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(labelsize=8)
    axes.grid(True, axis="x", color="#DDDDDD", linewidth=0.6)
    axes.set_axisbelow(True)


def draw_effects(axes, rows):
    places = places_of(rows)
    for row, y in zip(rows, places):
        if "keep_all_time_s" in row:
            axes.plot([1e6 * row["time_s"], 1e6 * row["keep_all_time_s"]], [y, y], color=KEPT, linewidth=0.8, zorder=2)
            axes.plot(1e6 * row["keep_all_time_s"], y, "o", markersize=6.5, markerfacecolor="white",
                      markeredgecolor=KEPT, zorder=3)
        if row["kernel_time_s"] > 0.0:
            axes.plot(1e6 * row["kernel_time_s"], y, "|", color=KERNEL, markersize=9, markeredgewidth=2.2, zorder=3)
        axes.plot(1e6 * row["time_s"], y, "o", markersize=6.5, color=PLANNED, zorder=4)
        is_base = row["setting"] == row["base"]
        text = f"{micro(row['time_s'])} µs" + ("" if is_base else f", × {row['ratio']:.2g}")
        axes.annotate(text, (1.02, y), xycoords=("axes fraction", "data"), va="center", fontsize=7.5,
                      color="#777777" if is_base else "black")
    axes.set_yticks(places, [label(row) + (" (bistatic)" if row["case"] == "bistatic" else "") for row in rows])
    axes.set_ylim(max(places) + 0.8, min(places) - 0.8)
    axes.set_xscale("log")
    axes.set_xlabel("time per entry [µs]", fontsize=9)
    axes.set_title("Each effect alone; × is to the first line of its group", fontsize=10, loc="left")
    for colour, marker, name in ((PLANNED, "o", "as planned: what a user pays"), (KERNEL, "|", "of that in kernels"),
                                 (KEPT, "o", "--keep-all, where the plan leaves out something")):
        axes.plot([], [], marker, color=colour, label=name, markerfacecolor="white" if colour == KEPT else colour,
                  markeredgewidth=2.2 if marker == "|" else 1.0)
    axes.legend(fontsize=8, loc="lower center", bbox_to_anchor=(0.5, -0.13), ncol=3, frameon=False)
    tidy(axes)


def note(result):
    context = result["context"]
    grid = result["grid"]
    device = context["device"].get("name", "no Vulkan device")
    text = (f"{len(grid['theta_deg'])} zeniths x {len(grid['sigma'])} roughnesses, tolerance {result['tolerance']:g}; "
            f"{context['machine']['processor']}, {context['machine']['cores']} cores; {device}; {context['date'][:10]}")
    return "\n".join(textwrap.wrap(text, NOTE_WIDTH))


def figure(result, path, save):
    """Draws the result; `save(drawing, path)` writes it."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams["font.family"] = "DejaVu Sans"
    if not result["results"]:
        raise ValueError("holds no measured setting")
    drawing, axes = plt.subplots(figsize=(9.5, 2.0 + 0.18 * max(places_of(result["results"]))))
    draw_effects(axes, result["results"])
    drawing.text(0.01, 0.008, note(result), fontsize=7.5, color="#444444")
    drawing.tight_layout(rect=(0.0, 0.03, 1.0, 1.0))
    save(drawing, path)
