"""Draws scenes at random from the table of keys: every word, the ends and odd places of every range, every axis, and
every table of a scene present or absent.

`draw(seed, folder)` gives the text of a scene and writes the files that it names into `folder`. Most scenes are valid.
The others break a rule of combination, so that refusals are tried, too.
"""
from __future__ import annotations

import math
import random
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import dolp

KEYS = dolp.keys()

# The interval from which most values are drawn. Values of a key without an entry are drawn from its whole range.
_USUAL = {
    "n": (0.2, 4.0), "k": (1e-4, 20.0), "sigma": (1e-3, 1.0), "q": (1.1, 12.0), "wind_m_s": (0.5, 15.0),
    "temperature_K": (200.0, 400.0), "air_temperature_K": (260.0, 310.0), "vapour_cm": (0.1, 1.0),
    "thickness_um": (0.01, 20.0), "thickness_spread_um": (1e-3, 0.5), "wavelength_um": (3.0, 14.0), "irradiance": (1e-2, 10.0),
    "relative_irradiance": (1e-3, 2.0), "scale": (0.1, 2.0), "radiance": (1e-3, 20.0), "theta_deg": (1.0, 89.0),
}
# Values at which formulas change their form or lose digits, besides the ends of the range.
_ODD = {
    "n": (1.0, 0.9, 27.0, 1000.0), "k": (0.0, 1e-8, 90.0), "sigma": (0.0, 1e-6, 1e-4, 5.0),
    "q": (1.001, 1.5, 1.500001, 2.0, 50.0, 1000.0), "wind_m_s": (0.0,), "temperature_K": (1.0, 288.15, 6000.0),
    "thickness_um": (0.0, 1e-6), "wavelength_um": (0.3, 3.4, 6.3, 10.6, 1000.0), "diffuse_exponent": (0.0, -0.999),
    "theta_deg": (0.0, 1e-6, 45.0, 56.3099, 89.99, 90.0), "view_zenith_deg": (0.0, 45.0, 60.0, 89.0, 90.0),
    "relative_azimuth_deg": (0.0, 90.0, 180.0, 360.0), "specular": (0.0, 1.0), "diffuse": (0.0, 1.0),
}
_TOLERANCES = (1e-2, 1e-3, 1e-3, 1e-4, 1e-4, 1e-5, 1e-6)
_BANDS = ((8.0, 14.0), (3.0, 5.0), (10.5, 10.6), (7.5, 13.5))
_MATERIALS = ("gold (Ordal)", "iron", "PET", "Kapton", "water 25C", "soda-lime glass", "sapphire", "no such stone")
# How often a scene has a table, or a key that it may omit. Other keys: _KEY_SHARE.
_SHARES = {"emission": 0.85, "surroundings": 0.6, "source": 0.4, "path": 0.25, "coating": 0.3}
_KEY_SHARE = 0.4


def draw(seed: int, folder: Path) -> str:
    return _Drawing(random.Random(seed), folder).text()


class _Drawing:
    def __init__(self, rng: random.Random, folder: Path) -> None:
        self._rng = rng
        self._folder = folder

    def text(self) -> str:
        """The scene as TOML, one table after the other."""
        tables = {"surface": self._surface(), "emission": self._plain("emission"), "source": self._source(),
                  "surroundings": self._surroundings(), "path": self._path(), "spectrum": self._spectrum(),
                  "geometry": self._plain("geometry"), "accuracy": self._accuracy(), "grid": self._grid()}
        if tables["emission"] and "model" in tables["emission"] and self._surface_is_plain(tables["surface"]):
            tables["emission"].pop("model")
        kept = {name: keys for name, keys in tables.items() if keys and self._is_there(name)}
        kept["spectrum"] = tables["spectrum"]
        if any(key in kept.get("grid", {}) for key in ("wavelength_um", "band_um")):
            kept["spectrum"] = {}
        return "".join(f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items()) + "\n"
                       for name, keys in kept.items() if keys)

    def _is_there(self, table: str) -> bool:
        return self._chance(_SHARES.get(table, 1.0))

    def _chance(self, share: float) -> bool:
        return self._rng.random() < share

    def _surface_is_plain(self, surface: dict[str, str]) -> bool:
        """True where most emission models are refused; a few of these scenes stay, to be refused."""
        return surface.get("masking", '"integral"') not in ('"smith"', '"v-cavity"') and self._chance(0.9)

    def _plain(self, table: str, *omitted: str) -> dict[str, str]:
        """The keys of a table: the required ones, and the others at random."""
        drawn = {}
        for key, facts in KEYS.items():
            name = key.removeprefix(table + ".")
            if name == key or "." in name or name in omitted:
                continue
            if facts["default"] == "required" or self._chance(_KEY_SHARE):
                drawn[name] = self._value(key)
        return drawn

    def _value(self, key: str) -> str:
        allowed = KEYS[key]["allowed"]
        if " in " in allowed:
            return self._number(key)
        return self._word(re.split(", | or ", allowed.removeprefix("one of ").replace('"', "")))

    def _word(self, words: list[str]) -> str:
        word = self._rng.choice(words)
        return word if word in ("true", "false") else f'"{word}"'

    def _number(self, key: str) -> str:
        """A number in the range of the key: at an odd place, at an end, or anywhere among the usual values."""
        bounds = re.search(r"([\[(])(-?[\d.e+-]+|-inf), (-?[\d.e+-]+|inf)([\])])", KEYS[key]["allowed"])
        low, high = float(bounds[2]), float(bounds[3])
        name = key.rsplit(".", 1)[-1]
        odd = [x for x in _ODD.get(name, ()) if low <= x <= high]
        if odd and self._chance(0.3):
            return repr(self._rng.choice(odd))
        ends = [x for x, bracket in ((low, bounds[1]), (high, bounds[4])) if math.isfinite(x) and bracket in "[]"]
        if ends and self._chance(0.06):
            return repr(self._rng.choice(ends))
        low, high = _USUAL.get(name, (low, high))
        if low > 0 and high > 50 * low:
            return f"{math.exp(self._rng.uniform(math.log(low), math.log(high))):.5g}"
        return f"{self._rng.uniform(low, high):.5g}"

    def _file(self, name: str, header: str, rows: Iterable[Iterable[float]]) -> str:
        lines = [header, *(",".join(f"{value:.6g}" for value in row) for row in rows)]
        (self._folder / name).write_text("\n".join(lines) + "\n")
        return f'"{self._folder / name}"'

    def _optics(self, key: str) -> dict[str, str]:
        """An index: n and k, a material, or a file. `key` is the beginning of its keys."""
        kind = self._rng.choices(("constant", "material", "file"), (0.75, 0.15, 0.1))[0]
        if kind == "material":
            return {"material": f'"{self._rng.choice(_MATERIALS)}"'}
        if kind == "file":
            rows = [(x, self._rng.uniform(0.3, 4), self._rng.choice((0.0, 0.01, 3.0))) for x in (0.3, 4, 8, 12, 1000)]
            return {"material_file": self._file(f"index{self._rng.randrange(10**6)}.csv", "wavelength_um,n,k", rows)}
        drawn = {"n": self._number(key + "n")}
        if self._chance(0.7):
            drawn["k"] = self._number(key + "k")
        return drawn

    def _surface(self) -> dict[str, str]:
        drawn = self._plain("surface", "n", "k", "material", "material_file", "reflectance_file", "diffuse_file",
                            "wind_m_s")
        if self._chance(0.1):
            drawn["diffuse_file"] = self._spectral_file("diffuse.csv", "reflectance")
            drawn.pop("diffuse", None)
            drawn.pop("diffuse_exponent", None)
        if self._chance(0.1):
            rows = sorted({0.0, 90.0, *(round(self._rng.uniform(1, 89), 1) for _ in range(self._rng.randrange(4)))})
            r_0 = self._rng.random()
            reflectances = [(x, *((r_0, r_0) if x == 0 else (self._rng.random(), self._rng.random()))) for x in rows]
            drawn["reflectance_file"] = self._file("reflectance.csv", "beta_deg,r_s,r_p", reflectances)
        else:
            drawn |= self._optics("surface.")
        if drawn.get("masking") != '"v-cavity"' and self._chance(0.95):
            drawn.pop("scattering", None)
        if drawn.get("distribution") == '"gaussian"' and self._chance(0.3):
            drawn.pop("sigma")
            drawn["wind_m_s"] = self._number("surface.wind_m_s")
        is_plain = "scattering" not in drawn and "reflectance_file" not in drawn and "diffuse_polarisation" not in drawn
        if is_plain and self._is_there("coating"):
            drawn["coating"] = f"[{', '.join(self._layer() for _ in range(self._rng.randint(1, 3)))}]"
        return drawn

    def _spectral_file(self, name: str, column: str) -> str:
        """A file with numbers from 0 to 1 at the ends of the range of wavelengths and at random places between."""
        rows = [(x, self._rng.random()) for x in (0.1, *sorted(self._rng.uniform(2.5, 15) for _ in range(9)), 1e4)]
        return self._file(name, f"wavelength_um,{column}", rows)

    def _layer(self) -> str:
        layer = self._optics("surface.coating.1.") | {"thickness_um": self._number("surface.coating.1.thickness_um")}
        if self._rng.random() < 0.3:
            layer["thickness_spread_um"] = self._number("surface.coating.1.thickness_spread_um")
        return f"{{ {', '.join(f'{key} = {value}' for key, value in layer.items())} }}"

    def _source(self) -> dict[str, str]:
        kind = self._rng.choice(("irradiance", "relative_irradiance", "preset", "file"))
        drawn = self._plain("source", *{"irradiance", "relative_irradiance", "preset", "file"})
        if kind == "file":
            rows = [(x, self._rng.uniform(0, 5)) for x in (0.2, 3, 5, 9, 12, 1001)]
            drawn["file"] = self._file("source.csv", "wavelength_um,irradiance", rows)
        else:
            drawn[kind] = self._value("source." + kind)
        return drawn

    def _surroundings(self) -> dict[str, str]:
        sky = self._rng.choices(("uniform", "clear-sky", "overcast", "file"), (0.5, 0.25, 0.1, 0.15))[0]
        if sky == "uniform":
            return {"temperature_K": self._number("surroundings.temperature_K")}
        if sky == "file":
            rows = [(x, self._rng.uniform(180, 300)) for x in (0, 30, 75, 90)]
            return {"profile": self._file("sky.csv", "zenith_deg,temperature_K", rows)}
        drawn = {"profile": f'"{sky}"'}
        for key in ("vapour_cm", "air_temperature_K"):
            if self._chance(_KEY_SHARE):
                drawn[key] = self._number("surroundings." + key)
        return drawn

    def _path(self) -> dict[str, str]:
        return self._plain("path", self._rng.choice(("temperature_K", "radiance")))

    def _spectrum(self) -> dict[str, str]:
        if self._chance(0.6):
            return {"wavelength_um": self._number("spectrum.wavelength_um")}
        if self._chance(0.3):
            low, high = self._rng.choice(_BANDS)
            inside = sorted(self._rng.uniform(low, high) for _ in range(self._rng.randrange(6)))
            rows = [(low, self._rng.choice((0, 1))), *((x, self._rng.random()) for x in inside), (high, 0.5)]
            return {"response_file": self._file("response.csv", "wavelength_um,response", rows),
                    "response_per": self._value("spectrum.response_per")}
        return {"band_um": str(list(self._rng.choice(_BANDS)))}

    def _accuracy(self) -> dict[str, str]:
        return self._plain("accuracy", "tolerance") | {"tolerance": repr(self._rng.choice(_TOLERANCES))}

    def _grid(self) -> dict[str, str]:
        """One to four zeniths and up to two values of a few other axes; sometimes nothing, so that all is default."""
        if self._chance(0.1):
            return {"theta_deg": "{ from = 0, to = 90, count = 19 }"} if self._chance(0.7) else {}
        drawn = {"theta_deg": self._axis("theta_deg", 4)}
        for name in ("sigma", "q"):
            if self._chance(0.5):
                drawn[name] = self._axis(name, 3)
        rare = self._rng.choice(("n", "k", "wavelength_um", "temperature_K", "material", "band_um", "wind_m_s"))
        if self._chance(0.25):
            drawn[rare] = self._axis(rare, 2)
        return drawn

    def _axis(self, name: str, most: int) -> str:
        count = self._rng.randint(1, most)
        if name == "material":
            return "[" + ", ".join(f'"{x}"' for x in self._rng.sample(_MATERIALS[:-1], count)) + "]"
        if name == "band_um":
            return str([list(band) for band in self._rng.sample(_BANDS, count)])
        return f"[{', '.join(dict.fromkeys(self._number('grid.' + name) for _ in range(count)))}]"
