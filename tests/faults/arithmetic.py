#!/usr/bin/env python3
"""Checks error bounds on devices whose divisions and square roots are as inexact as Vulkan allows.

Usage: arithmetic.py BUILD [--quick] [--entries N] [--mode MODE] [--kernel KERNEL]
BUILD is the folder that has dolp and tests/faults. inexact_vulkan.cpp rewrites the float kernels so that each quotient
and each square root has an error. The script computes random entries with these kernels, and again with a smaller
tolerance in double. For each mode, kernel and tolerance it prints the largest quotients of error and bound. It also
runs `dolp verify --hard-cases` in each mode, and checks that dolp refuses larger errors than Vulkan allows. --quick
runs one mode with few entries of one kernel. Exit status: 1 if an error exceeds its bound, otherwise 0.
"""
import argparse
import csv
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

# DOLP_VULKAN_ARITHMETIC for each mode. Vulkan allows errors of 2.5 ulp in a division and 4.5 ulp in a square root. The
# device's own error of 0.5 ulp comes on top of the added errors.
MODES = {"as it is": None, "random": "random:2:4", "quotients larger": "plus:2:0", "quotients smaller": "minus:2:0",
         "roots larger": "plus:0:4", "roots smaller": "minus:0:4", "both larger": "plus:2:4",
         "both smaller": "minus:2:4"}
TOO_INEXACT = {"plus:3:0": "division in float is wrong by up to 3.",
               "random:0:5": "square root in float is wrong by up to 5."}
SKY = ('surroundings.profile="clear-sky"',)
GROOVES = ('surface.scattering="multiple"',)
DIRECT = ('emission.model="direct"',)
FILMS = ("surface.coating=[{n=0.7, k=0.1, thickness_um=1.0}, {n=1.5, k=0.01, thickness_um=3.0}]",)
# The masking of each kind of kernel, and other settings. Kernels for responses compute tables with many indices.
KERNELS = {"none": ("none",), "v-cavity": ("v-cavity",), "integral": ("integral",), "smith": ("smith",),
           "grooves": ("v-cavity", *GROOVES), "sky grooves": ("v-cavity", *GROOVES, *SKY),
           "sky v-cavity": ("v-cavity", *SKY), "sky integral": ("integral", *SKY), "sky smith": ("smith", *SKY),
           "films none": ("none", *FILMS), "films integral": ("integral", *FILMS), "films smith": ("smith", *FILMS),
           "direct v-cavity": ("v-cavity", *DIRECT), "direct smith": ("smith", *DIRECT),
           "responses v-cavity": ("v-cavity",), "responses integral": ("integral",), "responses smith": ("smith",),
           "responses sky": ("smith", *SKY), "responses direct": ("smith", *DIRECT)}
QUICK = {"mode": ["both larger"], "kernel": ["none"], "entries": 100, "tolerance": ["1e-6"]}
TRUTH = ("--precision", "double", "--tolerance", "1e-9")
MOST_TRUTH_ERROR = 1e-7  # entries whose true values are not known better than this are left out
SCENE = """[surface]
n = 1.5
k = 0.1
sigma = 0.3
q = 3.0
[emission]
temperature_K = 300.0
[surroundings]
temperature_K = 250.0
[spectrum]
wavelength_um = 10.6
"""
SEED = 58
REFUSED = 3


class Program:
    """The program under test, in a folder with a scene."""

    def __init__(self, build, folder):
        self.program = build / "dolp"
        self.library = build / "tests/faults/libinexact_vulkan.so"
        self.folder = folder
        (folder / "scene.toml").write_text(SCENE, encoding="utf-8")

    def run(self, words, arithmetic=None):
        environment = {**os.environ, "DOLP_VALIDATION": "0"}
        if arithmetic:
            environment |= {"LD_PRELOAD": str(self.library), "DOLP_VULKAN_ARITHMETIC": arithmetic}
        return subprocess.run([self.program, *words], cwd=self.folder, env=environment, capture_output=True, text=True,
                              check=False)

    def rows(self, words, arithmetic=None):
        done = self.run([*words, "-o", "out.csv"], arithmetic)
        if done.returncode != 0:
            sys.exit(f"arithmetic.py: {words}: {done.stderr}")
        with open(self.folder / "out.csv", encoding="utf-8") as file:
            return [{name: float(value or "nan") for name, value in row.items()}
                    for row in csv.DictReader(line for line in file if not line.startswith("#"))]


def log_uniform(draw, low, high):
    return 10 ** draw.uniform(math.log10(low), math.log10(high))


def random_entry(draw, masking):
    least_q = 1.55 if masking == "smith" else 1.05
    grazing = 90 - log_uniform(draw, *draw.choice([(1e-3, 10), (1e-10, 1e-3)]))
    return {"theta_deg": draw.choice([draw.uniform(0, 89), draw.uniform(0, 89), grazing]),
            "sigma": log_uniform(draw, 0.003, 5), "q": least_q + log_uniform(draw, 0.03, 10),
            "n": log_uniform(draw, 0.5, 20),
            "k": draw.choice([0.0, log_uniform(draw, 0.001, 60), log_uniform(draw, 0.1, 60)])}


def random_grid(draw, masking, count):
    """Axes with about `count` entries, and so many refractive indices that the program computes responses."""
    entries = [random_entry(draw, masking) for _ in range(8)]
    return {"theta_deg": [entry["theta_deg"] for entry in entries], "sigma": [entry["sigma"] for entry in entries[:4]],
            "q": [entry["q"] for entry in entries[:2]],
            "n": [log_uniform(draw, 1.2, 20) for _ in range(max(8, count // 512))],
            "k": [0.0, *(log_uniform(draw, 0.01, 60) for _ in range(7))]}


def random_entries(kernel, distribution, count, folder):
    """Arguments of dolp for random entries that need this kernel."""
    draw = random.Random(f"{SEED} {kernel} {distribution}")
    masking, *others = KERNELS[kernel]
    settings = [f'surface.masking="{masking}"', f'surface.distribution="{distribution}"', *others]
    has_grid = kernel.startswith("responses")
    columns = random_grid(draw, masking, count) if has_grid else {}
    entries = [] if has_grid else [random_entry(draw, masking) for _ in range(count)]
    left_out = {"q"} if distribution == "gaussian" else set()
    settings += [f"grid.{name}={sorted(values)}" for name, values in columns.items() if name not in left_out]
    if entries:
        with open(folder / "points.csv", "w", encoding="utf-8", newline="") as file:
            rows = csv.DictWriter(file, [name for name in entries[0] if name not in left_out], extrasaction="ignore")
            rows.writeheader()
            rows.writerows(entries)
    words = ["eval", "--points", "points.csv"] if entries else ["table"]
    return [*words, "scene.toml", "--quiet", "--keep-all",
            *(word for setting in settings for word in ("--set", setting))]


def quotients(got, truth):
    """Errors of rho and DOLP over their bounds. The errors of the true values are subtracted. 0 without a bound."""
    error = max(abs(got[name] - truth[name]) for name in ("rho_i", "rho_q"))
    rho = (error / abs(got["rho_i"]) if error else 0.0) - truth["rho_error_estimate"]
    dolp = abs(got["dolp"] - truth["dolp"]) - truth["error_estimate"]
    pairs = ((rho, got["rho_error_estimate"]), (dolp, got["error_estimate"]))
    return [0.0 if not error > 0 or math.isinf(bound) else error / bound if bound else math.inf
            for error, bound in pairs]


def check_entries(program, kernel, options, summary):
    for distribution in ("cauchy", "gaussian"):
        words = random_entries(kernel, distribution, options.entries, program.folder)
        truth = program.rows([*words, *TRUTH])
        for mode in options.mode:
            for tolerance in options.tolerance:
                got = program.rows([*words, "--precision", "float", "--tolerance", tolerance], MODES[mode])
                known = [pair for pair in zip(got, truth, strict=True)
                         if not max(pair[1]["rho_error_estimate"], pair[1]["error_estimate"]) > MOST_TRUTH_ERROR]
                found = [quotients(*pair) for pair in known]
                rho, dolp = (max(quotient[i] for quotient in found) for i in (0, 1))
                above = sum(max(quotient) > 1 for quotient in found)
                worst = known[max(range(len(found)), key=lambda i: max(found[i]))][0]
                place = {name: worst[name] for name in ("theta_deg", "sigma", "q", "n", "k") if name in worst}
                print(f"{mode:18} {kernel:18} {distribution:8} {tolerance}  {len(found)} entries, largest quotient "
                      f"of rho {rho:.2f}, of dolp {dolp:.2f}; above 1: {above}", place if above else "", flush=True)
                total = summary.setdefault((mode, tolerance), [0, 0, 0.0])
                summary[mode, tolerance] = [total[0] + len(found), total[1] + above, max(total[2], rho, dolp)]


def check_hard_cases(program, mode):
    done = program.run(["verify", "--hard-cases", "--precision", "float"], MODES[mode])
    print(f"{mode:18} {done.stdout.splitlines()[-1].strip() if done.stdout else done.stderr}", flush=True)
    return done.returncode == 0


def check_refusals(program):
    for arithmetic, words in TOO_INEXACT.items():
        done = program.run(["table", "scene.toml", "-o", "out.csv", "--quiet"], arithmetic)
        if done.returncode != REFUSED or words not in done.stderr or done.stderr.count("\n") != 1:
            sys.exit(f"arithmetic.py: {arithmetic}: status {done.returncode}, {done.stderr!r}: expected {words!r}")


def main():
    parser = argparse.ArgumentParser(prog="arithmetic.py", description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path, metavar="BUILD")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--entries", type=int, default=425, help="random entries per kernel and slope distribution")
    parser.add_argument("--mode", action="append", choices=MODES)
    parser.add_argument("--kernel", action="append", choices=KERNELS)
    parser.add_argument("--tolerance", nargs="*", default=["1e-4", "1e-6"])
    options = parser.parse_args()
    if options.quick:
        vars(options).update(QUICK)
    options.mode = options.mode or MODES
    summary = {}
    with tempfile.TemporaryDirectory() as folder:
        program = Program(options.build.resolve(), pathlib.Path(folder))
        check_refusals(program)
        for kernel in options.kernel or KERNELS:
            check_entries(program, kernel, options, summary)
        hard_cases = options.quick or all([check_hard_cases(program, mode) for mode in options.mode])
    for (mode, tolerance), (count, above, largest) in summary.items():
        print(f"{mode:18} {tolerance}  {count} entries, largest quotient {largest:.2f}, above 1: {above}")
    return int(not hard_cases or any(above for _, above, _ in summary.values()))


if __name__ == "__main__":
    sys.exit(main())
