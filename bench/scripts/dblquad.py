#!/usr/bin/env python3
"""The moments of one entry by scipy.integrate.dblquad over (theta_r, delta_phi), as a Python user would write it.

Usage: dblquad.py --version | dblquad.py REQUEST
REQUEST is JSON with distribution (cauchy | gaussian), masking, theta_rad, sigma, q, n, k, tolerance, time_limit_s.
Prints JSON: r_i, r_q, stated_error (relative to r_i), evaluations, times_s (one per repeat; includes masking tables).
If the first computation exceeds the time limit, prints too_long: true instead. Exit status: 0 done, 2 usage.
"""
import json
import math
import signal
import sys
import time

import numpy as np
import scipy
from scipy.integrate import dblquad
from scipy.interpolate import CubicHermiteSpline
from scipy.special import betainc, gammaln

STEP = 1 / 64  # step of asinh(tau/width) between nodes of the masking tables
FAR = 1e5  # last tau of the masking tables, divided by max(1, m); beyond it, each integral is a power of tau
MOST_REPEATS = 3
ENOUGH_S = 1.5  # repeats end after this many seconds in total


class MaskingTails:
    """Tables of three integrals over slopes t from tau to infinity: int p dt, int g p dt and int g p (t - tau) dt.
    p(t) is the density of slopes along one azimuth, and g = 1/sqrt(1 + t^2)."""

    def __init__(self, m, q, is_gaussian):
        self.q = q
        width = min(0.5, m if is_gaussian else m / math.sqrt(max(1.0, q / 1.5)))
        norm = 1 / (math.sqrt(math.pi) * m)
        if not is_gaussian:
            norm *= math.exp(gammaln(q - 0.5) - gammaln(q - 1))

        def density(tau):
            return norm * (np.exp(-((tau / m) ** 2)) if is_gaussian else (1 + (tau / m) ** 2) ** (0.5 - q))

        self.width, self.is_gaussian = width, is_gaussian
        x = np.arange(0, math.asinh(FAR * max(1, m) / width), STEP)
        tau = width * np.sinh(x)
        nodes, weights = np.polynomial.legendre.leggauss(4)
        half = 0.5 * np.diff(tau)
        inside = tau[:-1, None] + half[:, None] * (1 + nodes)
        p = half[:, None] * weights * density(inside)
        weighted = p / np.sqrt(1 + inside**2)
        end = density(tau[-1])
        tail = 0.0 if is_gaussian else end * tau[-1] / (2 * q - 2)
        tail_first = 0.0 if is_gaussian else end / (2 * q - 1)
        tail_height = 0.0 if is_gaussian else tail_first * tau[-1] / (2 * q - 2)

        def from_end(cells, last):
            return np.append(last + np.cumsum(cells[::-1])[::-1], last)

        probability = from_end(p.sum(1), tail)
        first = from_end(weighted.sum(1), tail_first)
        height = from_end((weighted * (inside - tau[:-1, None])).sum(1) + np.diff(tau) * first[1:], tail_height)
        rise = np.sqrt(width**2 + tau**2)
        slopes = [-first * rise, -density(tau) / np.sqrt(1 + tau**2) * rise, -density(tau) * rise]
        self.end, self.at_end = tau[-1], (tail_height, tail_first, tail)
        self.spline = CubicHermiteSpline(x, np.stack([height, first, probability], 1), np.stack(slopes, 1))

    def __call__(self, tau):
        if tau < self.end:
            return self.spline(math.asinh(tau / self.width))
        power = 0.0 if self.is_gaussian else (tau / self.end) ** (2 - 2 * self.q)
        return self.at_end[0] * power, self.at_end[1] * power * self.end / tau, self.at_end[2] * power


class Surface:
    """The integrand D G M sin(theta_r)/4 of r_i and r_q. D is the density of facet normals, G the masking, and M an
    element of the Mueller matrix: M00 for r_i, M01 for r_q."""

    def __init__(self, request):
        self.is_gaussian = request["distribution"] == "gaussian"
        self.masking, self.q = request["masking"], request["q"]
        self.m = math.sqrt(2) * request["sigma"]
        self.index2 = complex(request["n"], request["k"]) ** 2
        self.c, self.s = math.cos(request["theta_rad"]), math.sin(request["theta_rad"])
        self.evaluations = 0
        self.theta_r = None
        if self.masking == "integral":
            self.tails = MaskingTails(self.m, self.q, self.is_gaussian)

    def smith_lambda(self, mu):
        m, q = self.m, self.q
        if self.is_gaussian:
            nu = mu / m
            return math.exp(-nu * nu) / (2 * nu * math.sqrt(math.pi)) - 0.5 * math.erfc(nu)
        gammas = math.exp(gammaln(q - 0.5) - gammaln(q - 1)) / math.sqrt(math.pi)
        first = gammas * m / mu * (1 + (mu / m) ** 2) ** (1.5 - q) / (2 * q - 3)
        return first - 0.5 * betainc(q - 1, 0.5, m * m / (m * m + mu * mu))

    def start_row(self, theta_r):
        """Computes the values that depend only on theta_r. dblquad keeps theta_r fixed while delta_phi runs."""
        self.theta_r, self.cr, self.sr = theta_r, math.cos(theta_r), math.sin(theta_r)
        if self.masking == "smith":
            self.smith = 1 / (1 + self.smith_lambda(self.c / self.s) + self.smith_lambda(self.cr / self.sr))
        if self.masking == "integral":
            self.low_c, self.low_s = (self.cr, self.sr) if self.cr < self.c else (self.c, self.s)
            self.low_height = self.tails(self.low_c / self.low_s)[0]

    def attenuation(self, cos_alpha, tan_alpha, cos_beta):
        if self.masking == "none":
            return 1.0
        if self.masking == "smith":
            return self.smith
        if self.masking == "v-cavity":
            return min(1.0, 2 * cos_alpha * min(self.c, self.cr) / cos_beta)
        c, s = self.low_c, self.low_s
        kappa = s / (cos_alpha * (c + s * tan_alpha))
        cos2, sin2 = c * c - s * s, 2 * s * c
        below = cos2 + tan_alpha * sin2
        if below >= 0:
            return 1 - kappa * self.low_height
        tau = (tan_alpha * cos2 - sin2) / below
        height, first, probability = self.tails(tau)
        return 1 - kappa * (self.low_height - height - (tau - c / s) * first) - probability

    def values(self, delta_phi, theta_r):
        """The integrands of r_i and r_q in one direction."""
        self.evaluations += 1
        if theta_r != self.theta_r:
            self.start_row(theta_r)
        cos_2beta = self.c * self.cr + self.s * self.sr * math.cos(delta_phi)
        cos_beta, sin_beta = math.sqrt((1 + cos_2beta) / 2), math.sqrt(max(0.0, 1 - cos_2beta) / 2)
        cos_alpha = min(1.0, (self.c + self.cr) / (2 * cos_beta))
        tan2_alpha = 1 / cos_alpha**2 - 1
        m2 = self.m**2
        if self.is_gaussian:
            slopes = math.exp(-tan2_alpha / m2)
        else:
            slopes = (self.q - 1) * (1 + tan2_alpha / m2) ** -self.q
        w = (self.index2 - sin_beta**2) ** 0.5
        r_s = abs((cos_beta - w) / (cos_beta + w)) ** 2
        r_p = abs((self.index2 * cos_beta - w) / (self.index2 * cos_beta + w)) ** 2
        cos_eta = (cos_alpha - self.c * cos_beta) / (self.s * sin_beta) if self.s * sin_beta > 0 else math.sqrt(0.5)
        g = self.attenuation(cos_alpha, math.sqrt(tan2_alpha), cos_beta)
        common = slopes / (math.pi * m2 * cos_alpha**4) * g * self.sr / 4
        return 0.5 * common * (r_s + r_p), 0.5 * common * (2 * cos_eta**2 - 1) * (r_s - r_p)


def moments(request):
    surface = Surface(request)
    tolerance = request["tolerance"]

    def integral(component, absolute, relative):
        return dblquad(
            lambda delta_phi, theta_r: surface.values(delta_phi, theta_r)[component],
            0, math.pi / 2, 0, math.pi, epsabs=absolute, epsrel=relative)

    # r_q may be 0, so its tolerance is a share of r_i. The integrals cover half of the azimuths, hence the factor 2.
    r_i, error_i = integral(0, 0.0, tolerance)
    r_q, error_q = integral(1, tolerance * r_i, 0.0)
    return {"r_i": 2 * r_i, "r_q": 2 * r_q, "stated_error": max(error_i, error_q) / r_i,
            "evaluations": surface.evaluations}


class TooLong(Exception):
    pass


def too_long(*_):
    raise TooLong


def timed(request):
    signal.signal(signal.SIGALRM, too_long)
    signal.setitimer(signal.ITIMER_REAL, request["time_limit_s"])
    times = []
    try:
        while not times or (len(times) < MOST_REPEATS and sum(times) < ENOUGH_S):
            start = time.perf_counter()
            result = moments(request)
            times.append(time.perf_counter() - start)
    except TooLong:
        if not times:
            return {"too_long": True}
    signal.setitimer(signal.ITIMER_REAL, 0)
    return result | {"times_s": times}


def main(arguments):
    if arguments == ["--version"]:
        print(f"SciPy {scipy.__version__}, NumPy {np.__version__}, Python {sys.version.split()[0]}")
        return 0
    if len(arguments) != 1:
        print("usage: dblquad.py --version | dblquad.py REQUEST", file=sys.stderr)
        return 2
    import warnings
    warnings.simplefilter("ignore")  # dblquad warns if it misses a tolerance; stated_error shows this too
    print(json.dumps(timed(json.loads(arguments[0]))))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
