#!/usr/bin/env python3
"""Draws the model curves of figure 4, 5, 6 or 7 of the paper. The measured values are missing: the paper prints none.

Usage: paper_figure.py FIGURE [-o FIGURE.png] [--table | --json] [--set KEY=VALUE]...
  4        geometric attenuation G, with integral masking and with v-cavity masking
  5, 6, 7  DOLP of steel, of aluminium, of both, for Cauchy and Gaussian slopes, in bistatic and hemispherical mode
--table prints the numbers as Markdown, --json as JSON. --set changes a value that the paper does not print, such as
surface.q, in figures 5-7. Runs build/release/dolp, or the program in --program.
Needs python3-numpy, and python3-matplotlib for the picture.
Exit status: 0 done, 2 usage or no program, 4 the picture could not be written; if dolp fails, the status of dolp.
"""
import argparse
import json
import math
import pathlib
import sys

sys.dont_write_bytecode = True  # writes no cache folder among the sources

import paper_curves as model  # noqa: E402

SUFFIX = ".png"
KEY_ANGLES_DEG = (0, 30, 60, 75, 90)
FIGURE4_ANGLES_DEG = (0, 30, 60, 70, 75, 90)
RANGES_DEG = {"below_60": (0.0, 59.9), "from_60_to_70": (60.0, 70.0), "from_70_to_80": (70.0, 80.0),
              "above_80": (80.0, 90.0)}
DIGITS = 6


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"{self.prog}: {message}\n")


def unprinted(text):
    key, _, value = text.partition("=")
    if key not in model.UNPRINTED:
        raise argparse.ArgumentTypeError(f"{text}: the key must be one of {', '.join(model.UNPRINTED)}")
    try:
        return key, float(value)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text}: the value must be a number") from error


def arguments():
    parser = Parser(prog="paper_figure.py", description=__doc__.splitlines()[0])
    parser.add_argument("figure", type=int, choices=(4, 5, 6, 7))
    parser.add_argument("-o", "--output", metavar="FIGURE.png", type=pathlib.Path)
    printed = parser.add_mutually_exclusive_group()
    printed.add_argument("--table", action="store_true", help="print the numbers as Markdown")
    printed.add_argument("--json", action="store_true", help="print the numbers as JSON")
    parser.add_argument("--program", type=pathlib.Path, default=model.ROOT / "build" / "release" / "dolp")
    parser.add_argument("--evaluator", choices=("vulkan", "cpu", "reference"), help="of dolp")
    parser.add_argument("--set", metavar="KEY=VALUE", type=unprinted, action="append", default=[],
                        help="replaces a value that the paper does not print, figures 5-7")
    options = parser.parse_args()
    if not (options.output or options.table or options.json):
        parser.error("nothing to do: give -o FIGURE.png, --table or --json")
    if options.figure == 4 and options.set:
        parser.error("--set is for figures 5, 6 and 7")
    if options.output and options.output.suffix != SUFFIX:
        parser.error(f"-o {options.output}: the name of the picture must end in {SUFFIX}")
    if options.output and not options.output.parent.is_dir():
        parser.exit(4, f"{parser.prog}: {options.output}: there is no folder {options.output.parent}\n")
    return options


def plain(value):
    return round(float(value), DIGITS) if math.isfinite(value) else None


def place(found, value_name):
    return {"theta_deg": found[0], value_name: plain(found[1])} if found else None


def curve_entry(curve):
    return {"sample": curve.sample, "reading": curve.reading, "mode": curve.mode, "distribution": curve.distribution,
            "sigma": plain(curve.sigma), "peak": place(curve.peak(), "dolp_percent"),
            "model_fails_from_deg": curve.fails_from(), "theta_deg": model.PAPER_ANGLES_DEG,
            "dolp_percent": [plain(curve.at(angle)) for angle in model.PAPER_ANGLES_DEG],
            "status": [int(curve.status[angle * model.STEPS_PER_DEGREE]) for angle in model.PAPER_ANGLES_DEG]}


def find(curves, **wanted):
    return next(c for c in curves if all(getattr(c, name) == value for name, value in wanted.items()))


def difference_entry(curves, sample, reading, mode):
    cauchy, gaussian = (find(curves, sample=sample, reading=reading, mode=mode, distribution=d)
                        for d in model.DISTRIBUTIONS)
    peak = cauchy.peak()
    at_peak = plain(cauchy.at(peak[0]) - gaussian.at(peak[0])) if peak else None
    return {"sample": sample, "reading": reading, "mode": mode, "at_cauchy_peak": at_peak,
            **{name: place(model.largest_difference(cauchy, gaussian, *ends), "points")
               for name, ends in RANGES_DEG.items()}}


def rougher_entry(curves, reading, mode, distribution):
    steel, aluminium = (find(curves, sample=s, reading=reading, mode=mode, distribution=distribution)
                        for s in model.SAMPLES)
    return {"reading": reading, "mode": mode, "distribution": distribution,
            "aluminium_above_steel_deg": model.ranges_above(aluminium, steel)}


def dolp_report(figure, curves, samples):
    pairs = [(reading, mode) for reading in model.READINGS for mode in model.MODES]
    report = {"figure": figure, "curves": [curve_entry(c) for c in curves],
              "cauchy_minus_gaussian": [difference_entry(curves, s, *pair) for pair in pairs for s in samples]}
    if len(samples) > 1:
        report["rougher"] = [rougher_entry(curves, *pair, d) for pair in pairs for d in model.DISTRIBUTIONS]
    return report


def attenuation_report(curves):
    return {"figure": 4, "sigma": model.FIGURE4_SIGMA, "q": model.FIGURE4_Q, "curves": [
        {"masking": c.masking, "distribution": c.distribution, "theta_i_deg": c.theta_i_deg,
         "theta_r_deg": list(FIGURE4_ANGLES_DEG), "g": [plain(c.at(angle)) for angle in FIGURE4_ANGLES_DEG],
         "corner": place(c.corner(), "slope_jump_per_rad")} for c in curves]}


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def number(value, digits=2):
    return "—" if value is None else f"{value:.{digits}f}".replace("-", "−")


def at_text(found, name):
    return "none" if found is None else f"{number(found[name])} at {found['theta_deg']:.1f}°"


def corner_text(corner):
    return f"{corner['slope_jump_per_rad']:.3g}/rad at {corner['theta_deg']:.1f}°".replace("-", "−")


def dolp_markdown(report):
    """Markdown tables: peaks of DOLP, Cauchy minus Gaussian, angles where aluminium exceeds steel, all values."""
    curves = report["curves"]
    column = {angle: i for i, angle in enumerate(model.PAPER_ANGLES_DEG)}
    heads = ["masking", "mode", "sample", "distribution", "peak", *(f"{angle}°" for angle in KEY_ANGLES_DEG),
             "model fails from"]
    peaks = [[c["reading"], c["mode"], c["sample"], c["distribution"], at_text(c["peak"], "dolp_percent"),
              *(number(c["dolp_percent"][column[a]]) for a in KEY_ANGLES_DEG),
              "—" if c["model_fails_from_deg"] is None else f"{c['model_fails_from_deg']:.1f}°"] for c in curves]
    parts = ["DOLP in percent:", table(heads, peaks), "Cauchy minus Gaussian, largest in each range, in points:",
             table(["masking", "mode", "sample", "below 60°", "60–70°", "70–80°", "above 80°", "at the Cauchy peak"],
                   [[d["reading"], d["mode"], d["sample"],
                     *(at_text(d[name], "points") for name in RANGES_DEG),
                     number(d["at_cauchy_peak"])] for d in report["cauchy_minus_gaussian"]])]
    if "rougher" in report:
        rows = [[r["reading"], r["mode"], r["distribution"],
                 ", ".join(f"{a:.1f}–{b:.1f}°" for a, b in r["aluminium_above_steel_deg"]) or "nowhere"]
                for r in report["rougher"]]
        parts += ["Where the DOLP of aluminium exceeds that of steel:",
                  table(["masking", "mode", "distribution", "range"], rows)]
    names = [f"{c['reading']}, {c['mode']}, {c['sample']}, {c['distribution']}" for c in curves]
    values = [[f"{angle}°", *(number(c["dolp_percent"][i]) + ("*" if c["status"][i] else "") for c in curves)]
              for angle, i in column.items()]
    parts += ["DOLP in percent at the paper's angles (*: status other than 0):", table(["θ", *names], values)]
    return "\n\n".join(parts)


def attenuation_markdown(report):
    rows = [[c["masking"], c["distribution"], f"{c['theta_i_deg']:g}°", *(number(g, 3) for g in c["g"]),
             corner_text(c["corner"])] for c in report["curves"]]
    heads = ["masking", "distribution", "θ_i", *(f"{angle}°" for angle in FIGURE4_ANGLES_DEG),
             "largest jump of slope"]
    return "\n\n".join([f"G at σ = {report['sigma']:g}, q = {report['q']:g}, over θ_r:", table(heads, rows)])


def markdown(report):
    return attenuation_markdown(report) if report["figure"] == 4 else dolp_markdown(report)


def compute(options):
    """The curves of a figure, and the numbers that --table and --json print."""
    program = model.Program(options.program, options.evaluator, dict(options.set))
    if options.figure == 4:
        curves = model.attenuations(program)
        return curves, attenuation_report(curves)
    samples = model.FIGURE_SAMPLES[options.figure]
    curves = model.dolp_curves(program, samples, roughened=len(samples) > 1)
    return curves, dolp_report(options.figure, curves, samples)


def draw(curves, options):
    import paper_drawing  # imported here, because Matplotlib loads slowly and the tables do not need it
    if options.figure == 4:
        paper_drawing.draw_attenuation(curves, options.output)
    else:
        paper_drawing.draw_dolp(curves, options.figure, dict(options.set), options.output)


def main():
    options = arguments()
    try:
        curves, report = compute(options)
    except model.CannotRun as error:
        print(f"paper_figure.py: {error}", file=sys.stderr)
        return error.status
    if options.output:
        try:
            draw(curves, options)
        except OSError as error:
            print(f"paper_figure.py: {options.output}: {error.strerror or error}", file=sys.stderr)
            return 4
    if options.table:
        print(markdown(report))
    if options.json:
        print(json.dumps(report, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
