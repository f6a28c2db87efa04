"""Figure and table of `dolp-bench scale`, for plot.py."""
NEEDED = {"context", "results"}
TIME, MEMORY = "#0072B2", "#D55E00"


def rows_of(result, case):
    return [row for row in result["results"] if row["case"] == case]


def markdown(result):
    """The results as Markdown tables."""
    lines = ["| entries | time, s | entries/s | time of `cp` of the file, s | peak memory, MB | file, MB |", "|---" * 6 + "|"]
    for row in rows_of(result, "entries"):
        lines.append(f"| {row['entries']:,} | {row['time_s']:.2f} | {row['entries'] / row['time_s']:.2g} "
                     f"| {row['copy_time_s']:.2f} | {row['peak_bytes'] / 1e6:.0f} | {row['file_bytes'] / 1e6:.0f} |")
    lines += ["", "One table, computed in shards that run at the same time:", "", "| number of shards | entries of the table | time until the last shard ends, s | time of the merge, s | peak memory of one shard, MB |", "|---" * 5 + "|"]
    for row in rows_of(result, "shards"):
        merge = f"{row['merge_time_s']:.2f}" if row["merge_time_s"] else "—"
        lines.append(f"| {row['setting']} | {row['entries']:,} | {row['time_s']:.2f} | {merge} "
                     f"| {row['peak_bytes'] / 1e6:.0f} |")
    return "\n".join(lines)


def figure(result, path, save):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams["font.family"] = "DejaVu Sans"
    drawing, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    rows = rows_of(result, "entries")
    entries = [row["entries"] for row in rows]
    for axes, values, colour, title, unit in (
            (left, [row["time_s"] for row in rows], TIME, "time of dolp table", "s"),
            (right, [row["peak_bytes"] / 1e6 for row in rows], MEMORY, "peak memory", "MB")):
        axes.loglog(entries, values, "o-", color=colour)
        axes.set_title(title, fontsize=10, loc="left")
        axes.set_xlabel("entries")
        axes.set_ylabel(unit)
        axes.grid(True, which="major", color="#DDDDDD", linewidth=0.6)
    left.loglog(entries, [row["copy_time_s"] for row in rows], "o--", color="#999999", label="cp of the file")
    last = rows[-1]
    left.loglog(entries, [last["time_s"] * count / last["entries"] for count in entries], ":", color="black",
                linewidth=0.8, label="linear")
    left.legend(fontsize=8, frameon=False)
    right.set_ylim(10, 10 ** 4)
    drawing.tight_layout()
    save(drawing, path)
