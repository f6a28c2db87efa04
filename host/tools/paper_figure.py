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
import pathlib
import sys

sys.dont_write_bytecode = True  # writes no cache folder among the sources

import paper_curves as model  # noqa: E402
import paper_report  # noqa: E402

SUFFIX = ".png"


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


def compute(options):
    """The curves of a figure, and the numbers that --table and --json print."""
    program = model.Program(options.program, options.evaluator, dict(options.set))
    if options.figure == 4:
        curves = model.attenuations(program)
        return curves, paper_report.attenuation_report(curves)
    samples = model.FIGURE_SAMPLES[options.figure]
    curves = model.dolp_curves(program, samples, roughened=len(samples) > 1)
    return curves, paper_report.dolp_report(options.figure, curves, samples)


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
        print(paper_report.markdown(report))
    if options.json:
        print(json.dumps(report, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
