"""The model's curves for figures 4-7 of the paper, computed by dolp, and numbers that check statements of the paper.

The paper prints neither the values of the keys in UNPRINTED nor the masking of its Gaussian curves. So figures 5-7 are
computed with two sets of values, called readings. `integral` has the values of the sample scenes; `smith` replaces some
of them. The Gaussian has the width sigma / sqrt(q - 1), with sigma and q of the Cauchy distribution. Then both have the
same density D(0) of horizontal facets.
"""
import csv
import dataclasses
import math
import pathlib
import subprocess
import tomllib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = {"steel": "stainless_steel", "aluminium": "aviation_aluminium"}
FIGURE_SAMPLES = {5: ["steel"], 6: ["aluminium"], 7: ["steel", "aluminium"]}
MODES = ("bistatic", "hemispherical")
DISTRIBUTIONS = ("cauchy", "gaussian")
READINGS = {
    "integral": {},
    "smith": {"surface.masking": "smith", "surface.q": 3.0, "surface.specular": 0.3, "surface.diffuse": 0.3,
              "surface.diffuse_exponent": -0.3, "source.relative_irradiance": 3.0},
}
# Scene keys whose values the paper does not print; --set of paper_figure.py may change them.
UNPRINTED = ("surface.q", "surface.specular", "surface.diffuse", "surface.diffuse_exponent",
             "source.relative_irradiance")
VIEW_DEG = 60.0  # zenith of the view in bistatic mode
PAPER_ANGLES_DEG = [*range(0, 60, 6), *range(60, 91, 3)]
STEPS_PER_DEGREE = 10
ANGLES_DEG = np.arange(90 * STEPS_PER_DEGREE + 1) / STEPS_PER_DEGREE
MODEL_FAILS = 1 | 4 | 8  # status bits: rho outside [0, 1], entry outside the model's domain, I <= 0

FIGURE4_SIGMA, FIGURE4_Q, FIGURE4_THETA_I_DEG = 0.3, 2.0, 30.0
GRAZING_THETA_I_DEG = 85.0  # at this angle of incidence, G of `integral` has a clear kink at theta_r = theta_i
GRAZING_DEG = 90.0 - 1e-6  # used instead of 90 degrees, where G would be a ratio of two infinite pBRDFs


class CannotRun(Exception):
    """The program is missing or failed; `status` is the exit status to return."""

    def __init__(self, status, line):
        super().__init__(line)
        self.status = status


@dataclasses.dataclass
class Program:
    """Runs dolp. `changes` has values for keys in UNPRINTED, and has priority over READINGS."""

    path: pathlib.Path
    evaluator: str | None = None
    changes: dict = dataclasses.field(default_factory=dict)

    def columns(self, command, scene, settings, points, options=()):
        """Runs `dolp COMMAND` on the input columns `points`. Returns output columns by name. Errors: CannotRun."""
        rows = [",".join(points), *(",".join(map(repr, row)) for row in zip(*(map(float, c) for c in points.values())))]
        line = [str(self.path), command, str(ROOT / "host" / "scenes" / f"{scene}.toml"), "--points", "-", "-o", "-",
                "--quiet", *options, *(("--evaluator", self.evaluator) if self.evaluator else ())]
        for key, value in settings.items():
            line += ["--set", f"{key}={value}"]
        try:
            run = subprocess.run(line, input="\n".join(rows) + "\n", capture_output=True, text=True, check=False)
        except OSError as error:
            raise CannotRun(2, f"{self.path}: {error.strerror}; build it, or name it with --program") from error
        if run.returncode != 0:
            raise CannotRun(run.returncode if run.returncode > 0 else 5, run.stderr.strip() or "dolp has failed")
        table = csv.DictReader(text for text in run.stdout.splitlines() if not text.startswith("#"))
        found = list(table)
        if len(found) != len(rows) - 1:
            raise CannotRun(5, f"{self.path}: wrote {len(found)} rows for {len(rows) - 1} points")
        return {name: np.array([float(row[name]) for row in found]) for name in table.fieldnames}


@dataclasses.dataclass
class Curve:
    """DOLP of a sample over the zenith of the source (bistatic mode) or of the view (hemispherical mode)."""

    sample: str
    reading: str
    mode: str
    distribution: str
    sigma: float
    dolp: np.ndarray  # percent, at ANGLES_DEG
    bound: np.ndarray  # bound of the numerical error of `dolp`, percent
    status: np.ndarray

    def holds(self):
        return (self.status & MODEL_FAILS) == 0

    def at(self, theta_deg):
        return float(self.dolp[round(theta_deg * STEPS_PER_DEGREE)])

    def peak(self):
        """Angle and value of the largest DOLP. None if this DOLP is no peak: its angle is 0 or 90 degrees, or
        the model fails at the next larger angle."""
        held = np.where(self.holds(), self.dolp, -np.inf)
        top = int(np.argmax(held))
        is_inside = 0 < top < held.size - 1 and np.isfinite(held[top + 1])
        return (float(ANGLES_DEG[top]), float(held[top])) if is_inside else None

    def fails_from(self):
        failing = np.flatnonzero(~self.holds())
        return float(ANGLES_DEG[failing[0]]) if failing.size else None


def scene_value(sample, settings, key):
    """Value of a scene key such as surface.q: from `settings` if they have it, otherwise from the sample scene."""
    table, name = key.split(".")
    with open(ROOT / "host" / "scenes" / f"{SAMPLES[sample]}.toml", "rb") as file:
        return settings.get(key, tomllib.load(file)[table][name])


def width(sigma, q, distribution):
    """The sigma with which `distribution` has the same D(0) as the Cauchy distribution with `sigma` and `q`."""
    return sigma / math.sqrt(q - 1.0) if distribution == "gaussian" else sigma


def curve(program, sample, reading, mode, distribution, roughness_of=None):
    """The DOLP curve of a sample. If `roughness_of` names another sample, the curve has the sigma of that sample."""
    settings = READINGS[reading] | program.changes
    q = scene_value(sample, settings, "surface.q")
    sigma = width(scene_value(roughness_of or sample, settings, "surface.sigma"), q, distribution)
    settings |= {"surface.distribution": distribution, "surface.sigma": sigma, "geometry.mode": mode,
                 "geometry.view_zenith_deg": VIEW_DEG}
    found = program.columns("eval", SAMPLES[sample], settings, {"theta_deg": ANGLES_DEG})
    name = f"{sample} with sigma of {roughness_of}" if roughness_of else sample
    return Curve(name, reading, mode, distribution, sigma, 100.0 * found["dolp"], 100.0 * found["error_estimate"],
                 found["status"].astype(int))


def dolp_curves(program, samples, roughened=False):
    """DOLP curves of figures 5-7. `roughened` adds curves of the first sample with the sigma of the second sample."""
    result = []
    for reading in READINGS:
        for mode in MODES:
            result += [curve(program, sample, reading, mode, distribution)
                       for sample in samples for distribution in DISTRIBUTIONS]
            if roughened:
                result.append(curve(program, samples[0], reading, mode, "cauchy", roughness_of=samples[1]))
    return result


def largest_difference(one, other, low, high):
    """The angle from `low` to `high` with the largest difference of DOLP, and this difference. Leaves out angles at
    which the model fails for one of the curves."""
    where = (ANGLES_DEG >= low) & (ANGLES_DEG <= high) & one.holds() & other.holds()
    apart = np.where(where, one.dolp - other.dolp, 0.0)
    worst = int(np.argmax(np.abs(apart)))
    return float(ANGLES_DEG[worst]), float(apart[worst])


def ranges_above(one, other):
    """Ranges [from, to] of angles in which the DOLP of `one` exceeds the DOLP of `other` by more than the sum of both
    error bounds. Leaves out angles at which the model fails for one of the curves."""
    is_above = (one.dolp - other.dolp > one.bound + other.bound) & one.holds() & other.holds()
    above = np.concatenate([[False], is_above, [False]])
    edges = np.flatnonzero(above[1:] != above[:-1])
    return [(float(ANGLES_DEG[a]), float(ANGLES_DEG[b - 1])) for a, b in zip(edges[::2], edges[1::2])]


@dataclasses.dataclass
class Attenuation:
    """The masking G over the view zenith, in the plane of incidence on the specular side."""

    masking: str
    distribution: str
    theta_i_deg: float
    g: np.ndarray  # at ANGLES_DEG

    def at(self, theta_deg):
        return float(self.g[round(theta_deg * STEPS_PER_DEGREE)])

    def slopes(self):
        """dG/dtheta_r in 1/rad, between neighbouring angles of ANGLES_DEG."""
        return np.diff(self.g) / np.radians(1.0 / STEPS_PER_DEGREE)

    def corner(self):
        """The corner of the curve: the angle of the largest jump of dG/dtheta_r, and this jump (1/rad)."""
        g, step = self.g, np.radians(1.0 / STEPS_PER_DEGREE)
        right = (-3.0 * g[2:-2] + 4.0 * g[3:-1] - g[4:]) / (2.0 * step)
        left = (3.0 * g[2:-2] - 4.0 * g[1:-3] + g[:-4]) / (2.0 * step)
        worst = int(np.argmax(np.abs(right - left)))
        return float(ANGLES_DEG[worst + 2]), float((right - left)[worst])


def attenuation(program, masking, distribution, theta_i_deg):
    """G: Mueller element m00 with masking, divided by m00 without. k_d is 0, because the diffuse part has no G."""
    view = np.minimum(ANGLES_DEG, GRAZING_DEG)
    points = {"theta_i_deg": np.full(view.size, theta_i_deg), "theta_r_deg": view,
              "delta_phi_deg": np.full(view.size, 180.0)}
    sigma = width(FIGURE4_SIGMA, FIGURE4_Q, distribution)
    settings = {"surface.distribution": distribution, "surface.sigma": sigma, "surface.q": FIGURE4_Q,
                "surface.diffuse": 0.0}
    with_masking, without = (
        program.columns("mueller", SAMPLES["steel"], settings | {"surface.masking": name}, points,
                        ("--precision", "double"))["m00"] for name in (masking, "none"))
    return Attenuation(masking, distribution, theta_i_deg, with_masking / without)


def attenuations(program):
    """The curves G of figure 4, and a curve of the masking `integral` near grazing incidence."""
    chosen = [("integral", "cauchy", FIGURE4_THETA_I_DEG), ("integral", "gaussian", FIGURE4_THETA_I_DEG),
              ("v-cavity", "cauchy", FIGURE4_THETA_I_DEG), ("integral", "cauchy", GRAZING_THETA_I_DEG)]
    return [attenuation(program, *which) for which in chosen]
