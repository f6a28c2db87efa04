#!/usr/bin/env python3
"""Writes planck.csv and smooth_absorptance.csv beside itself, computed with 50 digits. Needs python3-mpmath.

The formulas are in textbook form. 1 - |r|^2 cancels for small absorptances, but enough of the 50 digits remain.
"""
import pathlib

import mpmath as mp

mp.mp.dps = 50
PLANCK, LIGHT, BOLTZMANN = mp.mpf("6.62607015e-34"), mp.mpf(299792458), mp.mpf("1.380649e-23")
WAVELENGTHS_UM = ["0.3", "0.55", "3.7", "10.6", "14", "100", "1000"]
TEMPERATURES_K = ["1", "2.7", "77", "240", "298.15", "1500", "6000"]
INDICES = [("1.508", "0"), ("1.373", "0"), ("1.5", "0.1"), ("0.2", "3"), ("27", "90"), ("1000", "1000"), ("0.5", "0"),
           ("1.000001", "0"), ("1", "0"), ("1e6", "1e6")]
COSINES = ["1", "0.75", "0.5", "0.0625", "1e-6", "1e-17"]


def double(text):
    """The double nearest to a number in text, as a C++ compiler reads it."""
    return mp.mpf(float(text))


def planck(wavelength_um, temperature_k):
    wavelength = double(wavelength_um) * mp.mpf("1e-6")
    exponent = PLANCK * LIGHT / (wavelength * BOLTZMANN * double(temperature_k))
    return 2 * PLANCK * LIGHT**2 / wavelength**5 / mp.expm1(exponent) * mp.mpf("1e-6")


def absorptance(n, k, cosine):
    index, c = mp.mpc(double(n), double(k)), double(cosine)
    w = mp.sqrt(index**2 - (1 - c**2))
    r_s = (c - w) / (c + w)
    r_p = (index**2 * c - w) / (index**2 * c + w)
    return 1 - abs(r_s)**2, 1 - abs(r_p)**2


def number(value):
    return "0.0" if abs(value) < mp.mpf("1e-300") else mp.nstr(value, 20, min_fixed=1, max_fixed=0)


def write(name, columns, rows):
    lines = ["# Written by make_radiometry_values.py", columns, *(",".join(row) for row in rows)]
    pathlib.Path(__file__).with_name(name).write_text("\n".join(lines) + "\n", encoding="utf-8")


write("planck.csv", "wavelength_um,temperature_K,radiance",
      [(w, t, number(planck(w, t))) for w in WAVELENGTHS_UM for t in TEMPERATURES_K])
write("smooth_absorptance.csv", "n,k,cosine,s,p",
      [(n, k, c, *map(number, absorptance(n, k, c))) for n, k in INDICES for c in COSINES])
