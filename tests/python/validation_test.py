"""Compares results of dolp with values of others and with closed forms. tests/VALIDATION.md describes the references.

The test compares the results of a Vulkan device. `validation_test.py --table PACKAGES` prints the table of
tests/VALIDATION.md, computed with the evaluator cpu. PACKAGES is the folder of the package dolp.
"""
import csv
import functools
import pathlib
import sys
import unittest
import warnings

import numpy as np

DATA = pathlib.Path(__file__).resolve().parents[1] / "data" / "validation"
TEXTS = ("distribution", "masking")  # columns of the files that are not numbers
SCENE = """
surface = { n = 1.5, sigma = 0.2, q = 2, masking = "smith" }
emission.temperature_K = 300
spectrum.wavelength_um = 10.6
accuracy.tolerance = 1e-7
"""
GAUSSIAN = {"surface.distribution": "gaussian"}
ZENITHS = np.linspace(0, 89, 90)
INDICES = np.array([1.33, 1.5 + 0.1j, 3.4 + 0.01j, 10 + 60j, 27 + 90j, 0.4 + 0.3j, 0.9])  # 0.9 reflects totally

ROUNDING = 1e-9  # a difference below it is an error of rounding, which depends on the machine
EXACT = 1e-9     # tolerance for closed forms: a hundredth of the error that SCENE allows
MATRIX = 1e-11   # the error that `dolp mueller` states in double, relative to m00
FLAT = 1e-7      # tolerance for the limit sigma -> 0 at sigma = 1e-4; the difference falls as sigma^2
# Half of the last printed digit, and the error of the older computation in the next digit.
FIVE_DIGITS, SIX_DIGITS = 6e-6, 6e-7
# The model differs from the surface of the Monte Carlo computation, most at 80 degrees. The differences, rounded up.
SEA_TOLERANCES = {"V-grooves": {"up to 70°": (0.002, 0.0006), "at 80°": (0.03, 0.006)},
                  "direct emission": {"up to 70°": (0.0015, 0.0001), "at 80°": (0.009, 0.001)}}


class Row:
    """One quantity of one reference: results, the values or ranges in which they should lie, and a tolerance."""

    def __init__(self, reference, quantity, found, expected, tolerance):
        """`expected`: values, or ranges as a tuple (lower ends, upper ends)."""
        self.reference, self.quantity, self.tolerance = reference, quantity, tolerance
        self.is_range = isinstance(expected, tuple)
        low, high = expected if self.is_range else (expected, expected)
        outside = np.maximum(np.subtract(low, found), np.subtract(found, high))
        self.difference, self.count = max(float(np.max(outside)), 0.0), np.size(found)

    def __str__(self):
        smallest = "none outside" if self.is_range else f"below {min(ROUNDING, self.tolerance):g}"
        said = f"{self.difference:.2g}" if self.difference > ROUNDING else smallest
        return f"| {self.reference} | {self.quantity} | {self.count} | {said} | {self.tolerance:g} |"


class Model:
    """Calls of the package with one evaluator, for SCENE with other values of some keys."""

    def __init__(self, evaluator):
        import dolp
        self.scene = functools.partial(dolp.Scene, text=SCENE)
        self._points = functools.partial(dolp.evaluate, evaluator=evaluator, keep_all=True)
        self._beams = functools.partial(dolp.mueller, evaluator=evaluator)

    def evaluate(self, settings, **points):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that the model does not suit a surface changes none of these comparisons
            result = self._points(self.scene(overrides=settings), **points)
        return result.assign(emissivity=(result.emissivity_s + result.emissivity_p) / 2)

    def mueller(self, settings, **points):
        return self._beams(self.scene(overrides=settings), **points)


def columns(name):
    """The columns of a file in DATA, as a dictionary of arrays. Numbers become float."""
    with open(DATA / name, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([row[key] if key in TEXTS else float(row[key]) for row in rows]) for key in rows[0]}


def selected(file, *names):
    return {name: file[name] for name in names}


def fresnel(index, zenith_deg):
    """R_s and R_p of a smooth surface."""
    c = np.cos(np.radians(zenith_deg))
    w = np.sqrt(index ** 2 - 1 + c ** 2 + 0j)
    return np.array([abs((c - w) / (c + w)) ** 2, abs((index ** 2 * c - w) / (index ** 2 * c + w)) ** 2])


def s_and_p(result):
    return [result.rho_i + result.rho_q, result.rho_i - result.rho_q]


def mishchenko_travis(model):
    file = columns("mishchenko_travis.csv")
    sigma = np.sqrt((0.003 + 0.00512 * file["wind_m_s"]) / 2)
    beams = selected(file, "theta_i_deg", "theta_r_deg", "delta_phi_deg")
    f = model.mueller(GAUSSIAN, sigma=sigma, n=file["n"], k=0, **beams)
    f = f * np.cos(np.radians(file["theta_i_deg"]))[:, None, None]
    found = np.array([f[:, 0, 0], f[:, 0, 1], f[:, 2, 2]])
    expected = [file[f"{name}_cos_theta_i"] for name in ("m00", "m01", "m22")]
    quantity = "`m00`, `m01` and `m22` of two seas, times cos θ_i"
    yield Row("Mishchenko and Travis 1997", quantity, found, expected, SIX_DIGITS)


def masuda(model):
    file = columns("masuda_1988.csv")
    points = selected(file, "theta_deg", "sigma", "n", "k")
    found = model.evaluate({**GAUSSIAN, "emission.model": "direct"}, **points).emissivity
    yield Row("Masuda et al. 1988", "emissivity of seas, direct emission", found, file["emissivity"], FIVE_DIGITS)


def scatmech(model):
    file = columns("scatmech_mueller.csv")
    names = [f"m{i}{j}" for i in range(4) for j in range(4)]
    for masking in ("none", "v-cavity"):
        found, expected = [], []
        for distribution in ("gaussian", "cauchy"):
            chosen = (file["distribution"] == distribution) & (file["masking"] == masking)
            part = {name: values[chosen] for name, values in file.items()}
            points = selected(part, "theta_i_deg", "theta_r_deg", "delta_phi_deg", "sigma", "q", "n", "k")
            settings = {"surface.masking": masking, "surface.distribution": distribution}
            found.append(model.mueller(settings, **points).reshape(-1, 16) / part["m00"][:, None])
            expected.append(np.stack([part[name] / part["m00"] for name in names], axis=-1))
        yield Row("SCATMECH 7", f"all elements of Mueller matrices over `m00`, `{masking}`", np.concatenate(found),
                  np.concatenate(expected), MATRIX)


def gaussian_sea(model):
    file = columns("gaussian_sea_monte_carlo.csv")
    points = {**selected(file, "theta_deg", "wind_m_s"), "n": 1.1786, "k": 0.07232}
    direct = model.evaluate({**GAUSSIAN, "emission.model": "direct", "emission.bracket": True}, **points)
    single = model.evaluate(GAUSSIAN, **points)
    grooves = model.evaluate({**GAUSSIAN, "surface.masking": "v-cavity", "surface.scattering": "multiple"}, **points)
    reference, steep = "Monte Carlo of a Gaussian sea", file["theta_deg"] > 75
    for name, result, column in (("V-grooves", grooves, "all_bounces"), ("direct emission", direct, "direct")):
        for zeniths, chosen in (("up to 70°", ~steep), ("at 80°", steep)):
            for key, tolerance in zip(("emissivity", "q_over_i"), SEA_TOLERANCES[name][zeniths]):
                quantity = f"{'Q/I' if key == 'q_over_i' else key} {zeniths}, {name}"
                yield Row(reference, quantity, result[key].values[chosen], file[f"{key}_{column}"][chosen], tolerance)
    whole, dolp = file["emissivity_all_bounces"], abs(file["q_over_i_all_bounces"])
    yield Row(reference, "emissivity with all bounces, between the ends of the bracket", whole,
              (direct.emissivity, single.emissivity), 0)
    yield Row(reference, "DOLP with all bounces, between `dolp_low` and `dolp_high`", dolp,
              (direct.dolp_low, direct.dolp_high), 0)


def shaw(model):
    settings = {"surface.sigma": 0, "surface.material": "water 25C", "emission.temperature_K": 273,
                "surroundings.profile": "clear-sky", "surroundings.vapour_cm": 0.3,
                "surroundings.air_temperature_K": 273, "spectrum.band_um": [10.5, 12.5]}
    largest = float(-model.evaluate(settings, theta_deg=ZENITHS).q_over_i.min())
    yield Row("Shaw 1999", f"largest p polarisation of calm water under dry air, {largest:.3f}, between 0.04 and 0.1",
              largest, (0.04, 0.1), 0)


def smooth_surfaces(model):
    zenith, index = np.meshgrid(ZENITHS, INDICES)
    found = model.evaluate({}, theta_deg=zenith, n=index.real, k=index.imag, sigma=0)
    yield Row("Fresnel's equations", "R_s and R_p of mirrors, σ = 0", s_and_p(found), fresnel(index, zenith), EXACT)
    films = [[(0.7 + 0.1j, 1.0)], [(1.5, 3.7)], [(2.2, 0.5), (1.4 + 0.05j, 1.2), (1.6, 4.0)]]
    found, expected = [], []
    for layers, index in zip(films, (27 + 90j, 3.4, 1.5 + 1j)):
        numbers = {f"surface.coating.{i}.{name}": value for i, (n, d) in enumerate(layers, 1)
                   for name, value in (("n", complex(n).real), ("k", complex(n).imag), ("thickness_um", d))}
        result = model.evaluate({**numbers, "surface.sigma": 0, "surface.n": index}, theta_deg=ZENITHS)
        found.append(s_and_p(result))
        expected.append([[stack_reflectance(layers, index, theta, is_s) for theta in ZENITHS]
                         for is_s in (True, False)])
    yield Row("Characteristic matrices", "R_s and R_p of mirrors under one to three films", found, expected, EXACT)
    sharp = model.evaluate({"surface.q": 5, "surface.sigma": 1e-4}, theta_deg=ZENITHS[:81])
    yield Row("Fresnel's equations", "ρ_s and ρ_p for σ = 0.0001, q = 5, up to 80°", s_and_p(sharp),
              fresnel(1.5, ZENITHS[:81]), FLAT)


def stack_reflectance(layers, substrate, theta_deg, is_s):
    """R of films on a substrate from the product of their characteristic matrices (Born and Wolf, section 1.6)."""
    sine2 = np.sin(np.radians(theta_deg)) ** 2

    def admittance(index):
        root = np.sqrt(index ** 2 - sine2 + 0j)
        return root if is_s else index ** 2 / root

    matrix = np.eye(2)
    for index, thickness in layers:
        phase, own = 2 * np.pi * thickness / 10.6 * np.sqrt(index ** 2 - sine2 + 0j), admittance(index)
        matrix = matrix @ [[np.cos(phase), -1j * np.sin(phase) / own], [-1j * own * np.sin(phase), np.cos(phase)]]
    electric, magnetic = matrix @ [1, admittance(substrate)]
    return abs((admittance(1) * electric - magnetic) / (admittance(1) * electric + magnetic)) ** 2


def closed_forms(model):
    reference = "Closed forms"
    sigma = np.array([0.05, 0.2, 0.5, 1, 2])
    m2 = 2 * sigma ** 2
    for distribution, steep in (("cauchy", (m2 / (1 + m2)) ** 2), ("gaussian", np.exp(-1 / m2))):
        settings = {"surface.masking": "none", "surface.distribution": distribution, "surface.q": 3}
        found = model.evaluate(settings, theta_deg=0, sigma=sigma)
        yield Row(reference, f"albedo at 0°, `none`, {distribution}", found.albedo, 1 - steep, EXACT)
    found = model.evaluate({}, theta_deg=0, sigma=np.sqrt(0.5), q=2)
    yield Row(reference, "albedo at 0°, `smith`, q = 2, σ = 1/√2: 1 − ln 2", found.albedo, 1 - np.log(2), EXACT)
    for masking in ("v-cavity", "smith"):
        found = model.evaluate({"surface.masking": masking}, theta_deg=ZENITHS[:, None], sigma=sigma)
        yield Row(reference, f"albedo, `{masking}`, between 0 and 1", found.albedo, (0, 1), EXACT)
    yield Row(reference, "ρ_Q at 0° is 0", model.evaluate({}, theta_deg=0, sigma=sigma).rho_q, 0 * sigma, EXACT)
    found = model.evaluate({"surface.n": 1}, theta_deg=ZENITHS)
    yield Row(reference, "ρ_I and ρ_Q for n = 1 are 0", [found.rho_i, found.rho_q], np.zeros((2, ZENITHS.size)), EXACT)
    found = model.evaluate({"surroundings.temperature_K": 300}, theta_deg=ZENITHS)
    yield Row(reference, "DOLP for T_surr = T is 0", found.dolp, 0 * ZENITHS, EXACT)
    half, whole = (model.evaluate({"surface.specular": factor}, theta_deg=ZENITHS) for factor in (0.5, 1))
    yield Row(reference, "ρ_I for k_s = 0.5 is half of ρ_I for k_s = 1", half.rho_i, whole.rho_i / 2, EXACT)
    yield from beams(model, reference)


def beams(model, reference):
    """GGX (Walter et al. 2007) with alpha_g^2 = 2 sigma^2, and reciprocity, for random pairs of directions."""
    random = np.random.default_rng(5)
    theta_i, theta_r, phi = random.uniform(1, 85, 200), random.uniform(1, 85, 200), random.uniform(-180, 180, 200)
    forth = model.mueller({"surface.masking": "none"}, theta_i_deg=theta_i, theta_r_deg=theta_r, delta_phi_deg=phi)
    c_i, c_r, azimuth = np.cos(np.radians(theta_i)), np.cos(np.radians(theta_r)), np.radians(phi)
    cos_2beta = c_i * c_r + np.sqrt((1 - c_i ** 2) * (1 - c_r ** 2)) * np.cos(azimuth)
    beta, alpha2 = np.arccos(cos_2beta) / 2, 2 * 0.2 ** 2
    normal2 = ((c_i + c_r) / (2 * np.cos(beta))) ** 2
    ggx = alpha2 / (np.pi * (normal2 * (alpha2 - 1) + 1) ** 2)
    expected = ggx * fresnel(1.5, np.degrees(beta)).mean(axis=0) / (4 * c_i * c_r)
    yield Row(reference, "`m00` for q = 2, over the value of GGX", forth[:, 0, 0] / expected, np.ones(200), EXACT)
    back = model.mueller({"surface.masking": "none"}, theta_i_deg=theta_r, theta_r_deg=theta_i, delta_phi_deg=-phi)
    sign = np.diag([1, 1, -1, 1])
    m00 = forth[:, :1, :1]
    yield Row(reference, "reciprocity of Mueller matrices, over `m00`", forth / m00,
              sign @ back.transpose(0, 2, 1) @ sign / m00, MATRIX)


# Files of n and k in the layouts of public archives, with the index that each has at a wavelength in um.
INDEX_FILES = {"aria.csv": (10.6, 1.87 + 0.69j), "basalt.ri": (10.6, 1.87 + 0.69j), "mineral.lnk": (10.6, 1.87 + 0.69j),
               "opac.csv": (10.6, 1.22 + 0.06063j), "wavenumber.csv": (8.0, 1.42 + 0.14j)}


def index_files(model):
    found, expected = [], []
    for name, (wavelength_um, index) in INDEX_FILES.items():
        settings = {"surface.n": None, "surface.material_file": str(DATA.parent / "index_files" / name),
                    "spectrum.wavelength_um": wavelength_um, "surface.sigma": 0}
        found.append(s_and_p(model.evaluate(settings, theta_deg=ZENITHS)))
        expected.append(fresnel(index, ZENITHS))
    yield Row("Files of n and k", "R_s and R_p of mirrors, from five layouts of public archives", found, expected, EXACT)


REFERENCES = (mishchenko_travis, masuda, scatmech, gaussian_sea, shaw, smooth_surfaces, index_files, closed_forms)


class Validation(unittest.TestCase):
    def test_results_agree_with_the_references(self):
        model = Model("vulkan")
        for reference in REFERENCES:
            for row in reference(model):
                print(row)
                with self.subTest(str(row)):
                    self.assertLessEqual(row.difference, row.tolerance)
                    self.assertGreater(row.count, 0)


if __name__ == "__main__" and sys.argv[1:2] == ["--table"]:
    sys.path.insert(0, sys.argv[2])
    print("| reference | quantity | values | largest difference | tolerance |\n|---|---|---|---|---|")
    print("\n".join(str(row) for reference in REFERENCES for row in reference(Model("cpu"))))
