"""Figure and table of `dolp-bench fit`, for plot.py."""
NEEDED = {"context", "results", "coverage", "time"}
HELD, MISSED = "#0072B2", "#D55E00"


def sets_of(result):
    return [row for row in result["results"] if row["part"] == "set"]


def markdown(result):
    """The results as a Markdown table, then sentences on fits to data with all bounces, and on the time of a fit."""
    coverage = result["coverage"]
    rows = sets_of(result)
    lines = ["| varied parameters | data sets | median time of a fit, s | 68 % intervals that contain the true value | 95 % intervals that contain the true value | fits that found the global minimum |",
             "|---" * 6 + "|"]
    for count in sorted({len(row["truth"]) for row in rows}):
        own = [row for row in rows if len(row["truth"]) == count]
        lines.append(line_of(count, own))
    lines.append(line_of("all", rows))
    bracket = result["bracket"]
    share = {name: 100 * bracket[name] for name in ("share_68", "share_95", "share_of_n")}
    time, scipy = result["time"], result["time"]["scipy"]
    lines += ["", f"The table counts {coverage['intervals']} intervals of each kind. Intervals of the same data set are not independent.", "",
              f"In {bracket['sets']} other data sets (`v-cavity`, half of them without noise) the light bounces any number of times. "
              "The study fits n and σ to these data sets with single scattering and `--model-error bracket`. Then "
              f"{share['share_68']:.0f} % of the 68 % intervals and {share['share_95']:.0f} % of the 95 % intervals contain the true "
              f"value. The intervals are wide: the 95 % interval of n covers {share['share_of_n']:.0f} % of the searched range of n "
              "(median).", "",
              f"A fit of {time['parameters']} parameters to {time['points']} points, with its intervals, takes {time['time_s']:.2f} s "
              f"and evaluates the model for {time['evaluations']} parameter sets."]
    if scipy:
        lines[-1] += (f" One descent of SciPy's `least_squares` around `dolp.evaluate`, without intervals, takes {scipy['time_s']:.2f} s "
                      f"and {scipy['calls']} calls. It finds the same parameters within {scipy['apart_in_standard_errors']:.1g} standard "
                      "errors.")
    if spectrum := result.get("spectrum"):
        lines[-1] += (f" A fit of σ and q to {spectrum['points']} points of spectra (300 wavelengths of water at three zeniths) takes "
                      f"{spectrum['time_s']:.1f} s and evaluates the model for {spectrum['evaluations']} parameter sets.")
    return "\n".join(lines)


def line_of(name, rows):
    intervals = sum(len(row["truth"]) for row in rows)
    times = sorted(row["time_s"] for row in rows)
    held = [100 * sum(row[which] for row in rows) / intervals for which in ("held_68", "held_95")]
    return (f"| {name} | {len(rows)} | {times[len(times) // 2]:.2f} | {held[0]:.1f} % | {held[1]:.1f} % "
            f"| {sum(row['is_global'] for row in rows)} of {len(rows)} |")


def intervals_of(result):
    """Yields both ends of each 95 % interval, as distances from the true value. The distances are divided by half the
    width of the interval. Leaves out intervals with an open end."""
    for row in sets_of(result):
        for truth, (low, high) in zip(row["truth"], row["interval_95"]):
            if low is not None and high is not None:
                yield tuple(2 * (end - truth) / (high - low) for end in (low, high))


def figure(result, path, save):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams["font.family"] = "DejaVu Sans"
    drawing, axes = plt.subplots(figsize=(10, 3.5))
    for position, (low, high) in enumerate(sorted(intervals_of(result), key=sum)):
        axes.plot([position, position], [low, high], color=HELD if low <= 0 <= high else MISSED, linewidth=0.9)
    axes.axhline(0, color="black", linewidth=0.8)
    axes.set_title("95 % intervals around the truth", fontsize=10, loc="left")
    axes.set_xlabel("interval, in the order of their centres")
    axes.set_ylabel("distance from the truth\nin half-widths")
    drawing.tight_layout()
    save(drawing, path)
