"""Scenes and built-in materials."""
from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from . import _native
from ._arguments import Array, Path, check_key, check_mapping, floats, input_path, native_values, short, warn, word
from ._datasets import scene_of_dataset
from ._native import InputError

_MODEL_INACCURATE = 32  # status bit


class ModelWarning(UserWarning):
    """Warns that the estimated error of the intensity I or of DOLP is above 5 % (status 32), because single scattering
    loses light or the masking function creates light. Also warns that this light may change a fit by more than the
    uncertainties."""


class Scene:
    """A surface, its radiation and surroundings, and the accuracy of results, from a scene file or from its text.

    Parameters: `path` or `text`, and `overrides`, a dict with values for any keys. `path` can also be another Scene, the
    file of a table (.nc) or a Dataset with a table: both contain their scene, with n, k and other data of the table.
    The value None removes a key or a whole table of keys. The text "none" does so too, except for keys that hold a word
    or a text. A complex surface.n gives n and k. `scene[key]` is the value of a key, or None if the scene has no value.
    You can copy and pickle a scene and send it to another process, which reads the scene's files from the same paths.

    >>> smooth = dolp.Scene(scene, {"surface.sigma": 0.01, "title": "a mirror", "surface.n": 1.5 + 0.1j})
    >>> smooth.title, smooth["surface.k"], smooth["surface.masking"], smooth["grid.q"], smooth["path.radiance"]
    ('a mirror', 0.1, 'smith', [3.0], None)
    >>> dolp.Scene(scene, {"surface.sigma": -1})
    Traceback (most recent call last):
    dolp.InputError: surface.sigma = -1: -1 is out of range; must be a number in [0, 10]
    """

    _has_model_warning = False  # true after a dolp.ModelWarning for this scene
    _is_for_response = False  # true for scenes of for_response, whose material is arbitrary

    def __init__(self, path: Path | Scene | xr.Dataset | None = None, overrides: Mapping[str, Any] | None = None, *,
                 text: str | None = None) -> None:
        if (path is None) == (text is None):
            raise InputError("Scene: needs either a path or text")
        values = native_values(overrides)
        if isinstance(path, Scene):
            self._native = path._native.with_(values)
            self._is_for_response = path._is_for_response
        elif isinstance(path, xr.Dataset):
            scene = scene_of_dataset(path)
            self._native = scene.with_(values) if values else scene
            self._is_for_response = "c0" in path.attrs
        elif path is not None:
            if isinstance(path, str) and "\n" in path:
                raise InputError(f"path: {short(path)} is the text of a scene; write Scene(text=...)")
            self._native = _native.Scene.from_file(input_path("path", path), values)
            if self._native.is_of_table:
                self._native = self._native.for_points().with_(values)
        elif isinstance(text, str):
            self._native = _native.Scene.from_text(text, values, "text")
        else:
            raise TypeError(f"text: must be a str, not {type(text).__name__}")

    @classmethod
    def for_response(cls, path: Path | Scene | None = None, overrides: Mapping[str, Any] | None = None, *,
                     text: str | None = None) -> Scene:
        """A scene for `dolp.response`, which needs no material, no spectrum and no radiation. Other calls refuse it.

        >>> surface = dolp.Scene.for_response(text="surface = { sigma = 0.2, q = 3 }")
        >>> dolp.moments(dolp.response(surface, theta_deg=60), n=1.5).rho_i.round(3).values.ravel()
        array([0.08])
        """
        scene = cls(path, {**check_mapping("overrides", overrides), **dict(_native.surface_settings())}, text=text)
        scene._is_for_response = True
        return scene

    def with_(self, values: Mapping[str, Any]) -> Scene:
        """A copy of the scene with new values of some keys. Other keys keep their values, here the title.

        >>> scene.with_({"surface.q": 4, "grid.sigma": {"from": 0.1, "to": 1, "count": 5, "spacing": "log"}}).title
        ''
        """
        return Scene(self, values)

    @property
    def is_of_table(self) -> bool:
        """True if the scene comes from a table."""
        return self._native.is_of_table

    def for_points(self) -> Scene:
        """A copy in which keys such as surface.sigma have the value of the grid's axis, where the axis has only one."""
        copy = Scene(self)
        copy._native = self._native.for_points()
        return copy

    def without(self, key: str) -> Scene:
        """A copy of the scene without a key, or without a table of keys such as `emission`.

        >>> "emission" in scene.with_({"surroundings.temperature_K": 250}).without("emission").toml()
        False
        """
        return Scene(self, {check_key(key): None})

    @property
    def title(self) -> str:
        """The scene's title."""
        return self._native.title

    def __getitem__(self, key: str) -> float | str | bool | list[float] | None:
        return self._native.value(check_key(key))

    def toml(self) -> str:
        """The text of a scene file that describes this scene, including the overrides."""
        return self._native.toml()

    def _warn_of_model(self, status: Any, attributes: Mapping[Hashable, Any] | None = None) -> None:
        """Warns once for each scene if an entry has status 32. `attributes`: those of the results, with the largest
        changes of I and of DOLP."""
        if self._has_model_warning or not np.any(np.asarray(status) & _MODEL_INACCURATE):
            return
        self._has_model_warning = True
        much = "I or DOLP by an estimated more than 5 %"
        if attributes and {"model_change", "model_change_dolp"} <= attributes.keys():
            much = (f"I by up to {100 * float(attributes['model_change']):.2g} % and DOLP by up to "
                    f"{float(attributes['model_change_dolp']):.2g} points")
        warn(f"{self!r}: light that single scattering loses, or that the masking creates, changes {much} "
             f"(status 32); {self._native.model_advice()}", ModelWarning)

    def _warn_of_gap(self, gap: float | None) -> None:
        """Warns once for each scene if a bracket reaches more than one uncertainty away from a fit. `gap`: this
        distance."""
        if self._has_model_warning or gap is None or gap <= 1:
            return
        self._has_model_warning = True
        warn(f"{self!r}: light of further bounces can move the model by {gap:.2g} uncertainties of a point, which the "
             'intervals of the fit ignore; model_error="bracket" includes it', ModelWarning)

    def __repr__(self) -> str:
        changes = [f"{key}={short(value)}" for key, value in self._native.values()]
        if len(changes) > 4:
            changes[4:] = [f"and {len(changes) - 4} more"]
        return f"<dolp.Scene {', '.join([f'{self.title!r} of {self._native.name}', *changes])}>"


def keys() -> dict[str, dict[str, str]]:
    """All keys of scenes, with unit, allowed values, default and meaning.

    >>> dolp.keys()["surface.sigma"]["allowed"]
    'a number in [0, 10]'
    """
    names = ("unit", "allowed", "default", "meaning")
    return {key: dict(zip(names, facts)) for key, *facts in _native.keys()}


class Material:
    """A built-in material. `n(wavelength_um)` and `k(wavelength_um)` take numbers and arrays. `kind`: as in `materials()`."""

    def __init__(self, name: str) -> None:
        self.name: str
        self.name, self.from_um, self.to_um, self.source, self.kind = _native.material(word("material", name))
        self._native = _native.Scene.from_text("surface.sigma = 0\nemission.temperature_K = 300\n", [
            ("surface.material", self.name), ("spectrum.wavelength_um", self.from_um)], "material")

    def n(self, wavelength_um: Array) -> np.ndarray:
        """The real part of the refractive index."""
        return self._at(wavelength_um)[..., 0]

    def k(self, wavelength_um: Array) -> np.ndarray:
        """The imaginary part of the refractive index."""
        return self._at(wavelength_um)[..., 1]

    def plot(self, axes: Any = None) -> Any:
        """Draws n and k over the wavelength with Matplotlib, and returns the axes."""
        import matplotlib.pyplot as plt
        axes = plt.subplots()[1] if axes is None else axes
        wavelengths = np.linspace(self.from_um, self.to_um, 401)
        axes.plot(wavelengths, self.n(wavelengths), label="n")
        axes.plot(wavelengths, self.k(wavelengths), label="k")
        axes.set(xlabel="wavelength (µm)", ylabel="refractive index n + ik", title=self.name)
        axes.legend()
        return axes

    def _at(self, wavelength_um: Array) -> np.ndarray:
        wavelengths = floats("wavelength_um", wavelength_um)
        if np.isnan(wavelengths).any():
            raise InputError("wavelength_um: holds NaN")
        values = [self._native.refractive_index(value) for value in wavelengths.ravel().tolist()]
        return np.array(values).reshape(wavelengths.shape + (2,))

    def __repr__(self) -> str:
        return f"<dolp.Material {self.name!r}, {self.from_um:g} to {self.to_um:g} um, {self.source}>"


def material(name: str) -> Material:
    """A built-in material by name.

    >>> gold = dolp.material("gold (Ordal)")
    >>> float(gold.n(10.6).round(2)), gold.k([8, 10.6]).shape
    (13.52, (2,))
    """
    return Material(name)


def materials() -> dict[str, dict[str, Any]]:
    """The built-in materials, with the range of known wavelengths in um and the source of the data.

    >>> dolp.materials()["gold (Ordal)"]["from_um"] <= 8
    True
    """
    facts = ("from_um", "to_um", "source", "kind")
    return {name: dict(zip(facts, values)) for name, *values in _native.materials()}
