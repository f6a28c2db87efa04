"""dolp: infrared degree of linear polarisation (DOLP) of rough surfaces.

>>> import dolp
>>> scene = dolp.Scene(text='''
... [surface]
... n = 1.5
... k = 0.05
... sigma = 0.2
... q = 3.0
... masking = "smith"
... [emission]
... temperature_K = 300.0
... [spectrum]
... wavelength_um = 10.0
... [grid]
... theta_deg = {from = 0, to = 80, count = 5}
... ''')
>>> dolp.evaluate(scene, theta_deg=[0, 40, 80]).dolp.values.round(4)
array([0.    , 0.0295, 0.1346])

Scene                   a scene: a file or a text, with other values of its keys
table, write_table      the quantities over the scene's grid: a Dataset, or a file
evaluate, mueller       the same at points; Mueller matrices of pairs of directions
lookup                  a table between its entries
fit                     numbers of a scene from measured data
plan                    what a table would compute and cost
material                n and k of a built-in material
devices, keys, materials, citation

Names and units are those of scene files and tables: angles in degrees, wavelengths in um, temperatures in K. Results are
xarray Datasets with the variables, units and meanings that table files have, and the same bits that the command line
computes; `dataset.dolp.plot()` draws. Every entry has its error bound in `error_estimate`.

The device and its kernels are kept between calls. A long call lets Python's other threads run, and Ctrl-C ends it. A
process that was forked from one that has used a Vulkan device gets a DeviceError: start processes afresh
(multiprocessing.set_start_method("spawn")), or take evaluator="cpu". Errors: InputError (a ValueError) with one line
that says what is allowed, DeviceError (a RuntimeError), IoError (an OSError); a TypeError for arguments of another kind;
MemoryError. A file that is to be read and is not there is a MissingFileError (an InputError and a FileNotFoundError).
Masked arrays are refused, because results have no mask: fill or compress them.
"""
from __future__ import annotations

import difflib
import functools
import json
import operator
import os
import pathlib
from collections.abc import Callable, Hashable, Iterable, Mapping
from typing import Any, NamedTuple, Union

import numpy as np
import xarray as xr

from . import _native
from ._native import DeviceError, InputError, IoError

# The exceptions stand in the text above: with them `help` would print the methods of Python's own.
__all__ = ["Fit", "Material", "Plan", "Scene", "citation", "devices", "evaluate", "fit", "keys", "lookup", "material", "materials",
           "mueller", "plan", "table", "write_table"]
__version__ = _native.version()

class MissingFileError(InputError, FileNotFoundError):
    """A file that was to be read is not there."""


Path = Union[str, bytes, "os.PathLike[str]"]
Array = Union[float, "np.ndarray", "xr.DataArray", "list[float]"]

# Of each column of points the name of its coordinate, which is that of table files, with its attributes.
_COORDINATES = {column: (name, {"long_name": long_name, "units": units})
                for column, name, long_name, units in _native.axes()}
_COORDINATES |= {name: (name, {"long_name": long_name, "units": "degree"}) for name, long_name in (
    ("theta_i_deg", "zenith angle of incidence"), ("theta_r_deg", "zenith angle of the view"),
    ("delta_phi_deg", "azimuth between the directions, 180 on the specular side"))}



class Scene:
    """A surface, what it radiates and reflects, and how accurate results are to be: a scene file, or its text.

    Parameters: a path or `text`, then overrides of any key of a scene; None or "none" removes a table or a key; a complex
    surface.n gives n and k. `scene[key]` is the value of a key, None where the scene has no such thing. Scenes can be
    copied, pickled and sent to other processes, which find the files that a scene names where this one did.

    >>> smooth = dolp.Scene(scene, {"surface.sigma": 0.01, "title": "a mirror", "surface.n": 1.5 + 0.1j})
    >>> smooth.title, smooth["surface.k"], smooth["surface.masking"], smooth["grid.q"], smooth["path.radiance"]
    ('a mirror', 0.1, 'smith', [3.0], None)
    >>> dolp.Scene(scene, {"surface.sigma": -1})
    Traceback (most recent call last):
    dolp.InputError: surface.sigma = -1: -1 is out of range; must be a number in [0, 10]
    """

    def __init__(self, path: Path | Scene | None = None, overrides: Mapping[str, Any] | None = None, *,
                 text: str | None = None) -> None:
        if (path is None) == (text is None):
            raise InputError("Scene: needs either a path or text")
        values = _values(overrides)
        if isinstance(path, Scene):
            self._native = path._native.with_(values)
        elif path is not None:
            self._native = _native.Scene.from_file(_input_path("path", path), values)
        elif isinstance(text, str):
            self._native = _native.Scene.from_text(text, values, "text")
        else:
            raise TypeError(f"text: must be a str, not {type(text).__name__}")

    def with_(self, values: Mapping[str, Any]) -> Scene:
        """The same scene with other values of keys.

        >>> scene.with_({"surface.q": 4, "grid.sigma": {"from": 0.1, "to": 1, "count": 5, "spacing": "log"}}).title
        ''
        """
        return Scene(self, values)

    def without(self, key: str) -> Scene:
        """The same scene without the table of an effect, or without a key.

        >>> "emission" in scene.with_({"surroundings.temperature_K": 250}).without("emission").toml()
        False
        """
        return Scene(self, {key: None})

    @property
    def title(self) -> str:
        """The scene's title."""
        return self._native.title

    def __getitem__(self, key: str) -> float | str | bool | list[float] | None:
        return self._native.value(_key(key))

    def toml(self) -> str:
        """The scene with its overrides applied, as a scene file has it."""
        return self._native.toml()

    def __repr__(self) -> str:
        changes = [f"{key}={_short(value)}" for key, value in self._native.values()]
        if len(changes) > 4:
            changes[4:] = [f"and {len(changes) - 4} more"]
        return f"<dolp.Scene {', '.join([f'{self.title!r} of {self._native.name}', *changes])}>"


class Plan:
    """What a table of a scene would compute and leave out, why, and what it would cost; prints as a report.

    `values` is what `dolp plan --json` prints, as a dictionary.
    """

    def __init__(self, text: str, values: dict[str, Any]) -> None:
        self.text, self.values = text, values

    def __repr__(self) -> str:
        return self.text


class Fit:
    """What a fit found; prints as a report.

    `params` and `stderr` are dictionaries of values and standard errors (None where the data give none), `fit[key]` is
    one value, `covariance` is in their order, NaN where there is none. `scene` has the values that were found, and what
    was best of `compare`. `values` is what `dolp fit --json` prints, as a dictionary: parameters, correlation,
    chi_square, reduced_chi_square, p_value, aic, bic, minima, residuals, models.
    """

    def __init__(self, text: str, values: dict[str, Any], scene: Scene, overrides: dict[str, Mapping[str, Any]]) -> None:
        self.text, self.values, self.scene, self._overrides = text, values, scene, overrides
        self.params: dict[str, float] = {one["key"]: one["value"] for one in values["parameters"]}
        self.stderr: dict[str, float | None] = {one["key"]: one["standard_error"] for one in values["parameters"]}

    def __getitem__(self, key: str) -> float:
        """The value of a parameter."""
        _check_names("fit", [key], list(self.params))
        return self.params[key]

    @property
    def covariance(self) -> np.ndarray:
        """The covariance of the parameters."""
        errors = np.array(list(self.stderr.values()), dtype=float)
        return np.array(self.values["correlation"], dtype=float) * np.outer(errors, errors)

    def conf_interval(self, level: float = 0.95) -> dict[str, tuple[float | None, float | None]]:
        """Intervals of the profile likelihood at a level of 0.68 or 0.95; an end that the data do not bound is None."""
        if level not in (0.68, 0.95):
            raise InputError(f"level = {level}: must be 0.68 or 0.95")
        return {one["key"]: tuple(one[f"interval_{100 * level:.0f}"]) for one in self.values["parameters"]}

    def plot(self, axes: Any = None) -> Any:
        """Draws data and model over zenith with Matplotlib, and returns the axes."""
        import matplotlib.pyplot as plt
        axes = plt.subplots()[1] if axes is None else axes
        sets: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
        for point in self.values["points"]:
            sets.setdefault((point["data"], point["quantity"], point["wavelength_um"]), []).append(point)
        for (name, quantity, wavelength_um), points in sets.items():
            theta, measured = ([point[column] for point in points] for column in ("theta_deg", "measured"))
            errors = [point["uncertainty"] or 0.0 for point in points]
            symbol = {"dolp": "DOLP", "q_over_i": "Q/I"}.get(quantity, quantity)
            label = ", ".join([symbol, *([f"{wavelength_um:g} µm"] if wavelength_um else []),
                               *([name] if len(self._overrides) > 1 else [])])
            bars = axes.errorbar(theta, measured, errors, fmt="o", markersize=4, label=label)
            zeniths = np.linspace(min(theta), max(theta), 181)
            curve = self._model(name, quantity, {"theta_deg": zeniths} | ({"wavelength_um": wavelength_um} if wavelength_um else {}))
            axes.plot(zeniths, curve, color=bars[0].get_color())
        axes.set_xlabel("zenith angle θ (degree)")
        axes.legend()
        return axes

    def _model(self, name: str, quantity: str, points: dict[str, Any]) -> xr.DataArray:
        """The fitted model of a data set; with a model error a mixture of both ends of its bracket."""
        scene = self.scene.with_(self._overrides[name])
        own = evaluate(scene, evaluator="cpu", **points)
        if "model_error" not in self.params:
            return own[quantity]
        other = scene.with_({"emission.model": "moments" if scene["emission.model"] == "direct" else "direct"})
        mixed = "q_over_i" if quantity == "dolp" else quantity
        share = self.params["model_error"]
        curve = (1 - share) * own[mixed] + share * evaluate(other, evaluator="cpu", **points)[mixed]
        return abs(curve) if quantity == "dolp" else curve

    def __repr__(self) -> str:
        return self.text


def table(scene: Scene, *, evaluator: str = "vulkan", device: str = "", keep_all: bool = False,
          **axes: Array) -> xr.Dataset:
    """The table over the scene's grid: a Dataset that is what the file would hold.

    `axes` (theta_deg, sigma or wind_m_s, q, wavelength_um, n, k) replace those of the scene. Winds are a second coordinate
    along sigma: `t.swap_dims(sigma="wind_m_s")`.

    >>> t = dolp.table(scene, theta_deg=[0, 60], sigma=[0.1, 0.2, 0.3])
    >>> dict(t.sizes)["theta"], dict(t.sizes)["sigma"], t.dolp.units, t.theta.units
    (2, 3, '1', 'degree')
    """
    with_axes = _with_axes(scene, axes)
    return _table_dataset(*_evaluator(evaluator, device).table(with_axes, bool(keep_all)))


def write_table(scene: Scene, path: Path, *, evaluator: str = "vulkan", device: str = "", keep_all: bool = False,
                resume: bool = False, **axes: Array) -> str:
    """The same into a file (.nc, .csv or .npy), part by part, so that memory does not grow with the table.

    Returns the report of the run. What an interrupted call has finished stays beside the file; `resume` goes on there.

    >>> with tempfile.TemporaryDirectory() as folder:
    ...     print(dolp.write_table(scene, folder + "/table.nc").splitlines()[1])
      entries    5 x 1 x 1 (theta x sigma x q)
    """
    with_axes = _with_axes(scene, axes)
    return _evaluator(evaluator, device).write_table(with_axes, _path("path", path), bool(keep_all), bool(resume))


def evaluate(scene: Scene, *, evaluator: str = "vulkan", device: str = "", keep_all: bool = False,
             **points: Array) -> xr.Dataset:
    """The quantities of a table at points: a Dataset of the shape to which the arrays broadcast.

    `points` (theta_deg, sigma or wind_m_s, q, wavelength_um, n, k): what they do not say comes from the scene. A complex n
    gives n and k. Any other number of the scene can be given by its key, each of its values as a run of its own.
    DataArrays keep their dimensions and coordinates. Of other arrays, one that has a dimension to itself gives that its
    coordinate, theta, sigma, q, n, k or wavelength as in a table.

    >>> float(dolp.evaluate(scene, theta_deg=40).dolp.round(4))
    0.0295
    >>> d = dolp.evaluate(scene, theta_deg=np.array([[0], [40]]), sigma=[0.1, 0.2, 0.3])
    >>> d.dolp.dims, d.dolp.shape
    (('theta', 'sigma'), (2, 3))
    >>> dolp.evaluate(scene, theta_deg=40, **{"surroundings.temperature_K": [250, 290]}).dolp.round(4).values
    array([0.0179, 0.0043])
    """
    frame, columns = _columns(points, has_keys=True)
    varied = {key: columns.pop(key) for key in [*columns] if "." in key}
    for twice in (key for key in varied if key.partition(".")[2] in columns):
        raise InputError(f"points: {twice} and {twice.partition('.')[2]} are the same")
    native, engine = _scene(scene), _evaluator(evaluator, device)

    def run(own: _native.Scene, of_scene: dict[str, np.ndarray]) -> _native.Parts:
        return engine.evaluate(own, of_scene, bool(keep_all))

    return _dataset(_over_keys(run, native, columns, varied) if varied and 0 not in frame.shape else run(native, columns), frame)


def lookup(table: Path | xr.Dataset, **points: Array) -> xr.Dataset:
    """A table between its entries: error estimates contain the interpolation.

    `table`: a file, or a Dataset of `table` or of such a file, or a part of one: fewer values of an axis, or one of them,
    as `t.sel(k=0.1)`, fewer variables. Its attribute scene is needed; values_hash is that of the whole table, and is not
    looked at. `points`: as for `evaluate`; an axis of one value needs none. The file that was used last stays in memory;
    a Dataset is copied in each call.

    >>> t = dolp.table(scene, theta_deg=np.linspace(0, 80, 41), sigma=[0.1, 0.2])
    >>> bool(abs(dolp.lookup(t.sel(sigma=0.2), theta_deg=33).dolp - dolp.evaluate(scene, theta_deg=33).dolp) < 1e-5)
    True
    """
    frame, columns = _columns(points)
    if isinstance(table, xr.Dataset):
        return _dataset(_native_table(table).lookup(columns), frame)
    path = _input_path("table", table)
    known = os.stat(path)
    return _dataset(_table_of(path, (known.st_ino, known.st_size, known.st_mtime_ns)).lookup(columns), frame)


def mueller(scene: Scene, *, evaluator: str = "vulkan", device: str = "", **points: Array) -> np.ndarray:
    """Mueller matrices of the pBRDF in 1/sr, shape (..., 4, 4): of theta_i_deg, theta_r_deg, delta_phi_deg.

    `delta_phi_deg` is 180 on the specular side. Also sigma, q, n, k. NaN where the model has no finite value.

    >>> m = dolp.mueller(scene, theta_i_deg=[10, 20, 30], theta_r_deg=30, delta_phi_deg=180)
    >>> m.shape, bool(m[2, 0, 0] > m[0, 0, 0])
    ((3, 4, 4), True)
    """
    frame, columns = _columns(points)
    matrices = _evaluator(evaluator, device).mueller(_scene(scene), columns)
    return matrices.reshape(frame.shape + (4, 4))


def fit(scene: Scene, data: Any, vary: Mapping[str, tuple[float, ...]], *, compare: Mapping[str, Iterable[str]] | None = None,
        loss: str = "squares", model_error: str = "none", starts: int = 24, seed: int = 1, plot: Path | None = None,
        evaluator: str = "vulkan", device: str = "") -> Fit:
    """Numbers of a scene from measured data, with profile-likelihood intervals.

    `data`: a CSV file, or columns by name (a dictionary, a Dataset, a pandas DataFrame): theta_deg or theta_i_deg; dolp,
    q_over_i (signed) or emissivity_s, emissivity_p; uncertainty (one standard deviation), wavelength_um. A list has
    several sets, each alone or as a pair (data, overrides). `vary`: (low, high) or (low, high, start) of each key.
    `compare`: values of keys, all combinations of which are fitted and ranked. `loss`: squares, or huber, soft-l1,
    cauchy or tukey for data with outliers. `model_error`: none, or bracket, which takes the bracket of single scattering
    as an uncertainty that all points share; then `model_error` is one more number of the fit. `plot`: a PNG of data,
    model, residuals and contours, as the command draws it.

    >>> truth = dolp.evaluate(scene, theta_deg=np.arange(5, 85, 5), n=1.6)
    >>> data = {"theta_deg": truth.theta, "dolp": truth.dolp, "uncertainty": np.full(16, 0.001)}
    >>> found = dolp.fit(scene, data, {"surface.n": (1.1, 3)})
    >>> round(found.params["surface.n"], 4), found.conf_interval()["surface.n"][0] < 1.6, found.covariance.shape
    (1.6, True, (1, 1))
    """
    native = _scene(scene)
    sets = [one if isinstance(one, tuple) else (one, {}) for one in (data if isinstance(data, list) else [data])]
    if any(len(one) != 2 for one in sets):
        raise InputError("data: a set of its own must be a pair (data, overrides)")
    texts = [(_csv(columns), _values(overrides)) for columns, overrides in sets]
    ranges = {_key(key): _numbers(key, ends).ravel().tolist() for key, ends in _mapping("vary", vary).items()}
    compared = {_key(key): _words(key, words) for key, words in _mapping("compare", compare).items()}
    text, values, found = _evaluator(evaluator, device).fit(
        native, texts, ranges, compared, str(loss), str(model_error), _count("starts", starts), _count("seed", seed),
        "" if plot is None else _path("plot", plot))
    fitted = Scene.__new__(Scene)
    fitted._native = found
    names = ["data"] if len(sets) == 1 else [f"data{i + 1}" for i in range(len(sets))]
    return Fit(text, json.loads(values), fitted, {name: own or {} for name, (_, own) in zip(names, sets)})


def plan(scene: Scene, *, device: str = "", keep_all: bool = False) -> Plan:
    """What a table over the scene's grid would compute, leave out and cost; nothing is computed.

    >>> dolp.plan(scene).values["entries"]
    5
    """
    text, values = _native.plan(_scene(scene), str(device), bool(keep_all))
    return Plan(text, json.loads(values))


def devices() -> list[dict[str, Any]]:
    """The Vulkan devices of this machine: name, type, driver, api_version, usable, why_not, has_double, memory_bytes."""
    return _native.devices()


def keys() -> dict[str, dict[str, str]]:
    """The keys that scenes have, with unit, allowed values, default and meaning.

    >>> dolp.keys()["surface.sigma"]["allowed"]
    'a number in [0, 10]'
    """
    names = ("unit", "allowed", "default", "meaning")
    return {key: dict(zip(names, facts)) for key, *facts in _native.keys()}


def materials() -> dict[str, dict[str, Any]]:
    """The built-in materials, with the wavelengths at which they are known, in um, and the source.

    >>> dolp.materials()["gold (Ordal)"]["from_um"] <= 8
    True
    """
    return {name: {"from_um": low, "to_um": high, "source": source} for name, low, high, source in _native.materials()}


class Material:
    """A built-in material; `n(wavelength_um)` and `k(wavelength_um)` take numbers and arrays."""

    def __init__(self, name: str) -> None:
        known = materials()
        wanted = str(name).casefold()
        same = [one for one in known if one.casefold() == wanted]
        near = same or [one for one in known if one.casefold().startswith(f"{wanted} ")]
        self.name: str = near[0] if len(near) == 1 else str(name)
        _check_names("material", [self.name], list(known))
        self.from_um, self.to_um, self.source = known[self.name].values()
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
        wavelengths = _numbers("wavelength_um", wavelength_um)
        values = [self._native.refractive_index(value) for value in wavelengths.ravel().tolist()]
        return np.array(values).reshape(wavelengths.shape + (2,))

    def __repr__(self) -> str:
        return f"<dolp.Material {self.name!r}, {self.from_um:g} to {self.to_um:g} um, {self.source}>"


def material(name: str) -> Material:
    """A built-in material by name.

    >>> gold = dolp.material("gold (Ordal)")
    >>> gold.n(10.6).round(2), gold.k([8, 10.6]).shape
    (13.52, (2,))
    """
    return Material(name)


def citation() -> str:
    """How to cite the program and its model, in the Citation File Format."""
    return _native.citation()


@functools.lru_cache(maxsize=None)
def _evaluator(evaluator: str, device: str) -> _native.Evaluator:
    return _native.Evaluator(str(evaluator), str(device))


@functools.lru_cache(maxsize=1)
def _table_of(path: str, _: tuple[int, int, int]) -> _native.Table:
    """The table of a file, read again when the file has changed."""
    return _native.Table.read(path)


def _scene(scene: Scene) -> _native.Scene:
    if isinstance(scene, Scene):
        return scene._native
    hint = "; dolp.Scene(path) reads a file" if isinstance(scene, (str, os.PathLike)) else ""
    raise TypeError(f"scene: must be a dolp.Scene, not {type(scene).__name__}{hint}")


def _with_axes(scene: Scene, axes: Mapping[str, Array]) -> _native.Scene:
    """The scene on other axes, by the names of their columns."""
    native = _scene(scene)
    _check_names("axes", axes, [column for column, *_ in _native.axes()])
    return native.with_([(f"grid.{axis}", np.atleast_1d(_numbers(axis, values)).ravel().tolist())
                         for axis, values in axes.items()])


def _mapping(name: str, values: Mapping[str, Any] | None) -> Mapping[str, Any]:
    if values is None or isinstance(values, Mapping):
        return values or {}
    raise TypeError(f"{name}: must be a dictionary with keys of a scene, not {type(values).__name__}")


def _path(name: str, path: Path) -> str:
    if isinstance(path, (str, bytes, os.PathLike)):
        return os.fsdecode(path)
    raise TypeError(f"{name}: must be a path, not {type(path).__name__}")


def _input_path(name: str, path: Path) -> str:
    text = _path(name, path)
    if os.path.exists(text):
        return text
    raise MissingFileError(f"{text}: there is no such file")


def _key(key: str) -> str:
    if isinstance(key, str):
        return key
    raise TypeError(f"{_short(key)}: a key of a scene must be a str, not {type(key).__name__}")


def _words(key: str, words: Iterable[str]) -> list[str]:
    if isinstance(words, str) or not isinstance(words, Iterable):
        raise TypeError(f"{key}: must be a list of values, not {type(words).__name__}")
    return [str(word) for word in words]


def _count(name: str, value: int) -> int:
    try:
        if 0 <= (count := operator.index(value)) < 2**63:
            return count
    except TypeError:
        raise TypeError(f"{name}: must be a whole number, not {type(value).__name__}") from None
    raise InputError(f"{name} = {value}: must be a whole number from 0 to 2^63 - 1")


def _check_names(what: str, given: Iterable[str], known: list[str]) -> None:
    """Refuses a name that is none of those known, with the one that may have been meant."""
    for name in given:
        if name in known:
            continue
        near = [one for one in known if one.startswith(f"{name}_")] or difflib.get_close_matches(name, known, 1)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise InputError(f"{what}: {name} is none of {', '.join(known)}{hint}")


def _numbers(name: str, values: Any) -> np.ndarray:
    """Values as floats. Refuses what would silently become other numbers: masks and dates."""
    if isinstance(values, np.ma.MaskedArray):
        raise InputError(f"{name}: is a masked array, and results have no mask: fill or compress it")
    try:
        array = np.asarray(values)
        if array.dtype.kind in "biuf" or (array.dtype.kind == "O" and None not in array.ravel().tolist()):
            return array.astype(float)
    except (TypeError, ValueError):
        raise InputError(f"{name}: {_short(values)} are no numbers") from None
    raise InputError(f"{name}: {_short(values)} are no numbers but {array.dtype}")


def _short(value: Any) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else f"{text[:57]}..."


def _values(overrides: Mapping[str, Any] | None) -> list[tuple[str, Any]]:
    values = []
    for key, value in _mapping("overrides", overrides).items():
        if key == "surface.n" and np.ndim(value) == 0 and np.iscomplexobj(value):
            values += [(key, float(np.real(value))), ("surface.k", float(np.imag(value)))]
        else:
            values.append((_key(key), _value(key, value)))
    return values


def _value(key: str, value: Any) -> Any:
    """A value as the library takes it: None, bool, float, str, a list of floats, or a range as a dictionary."""
    if value is None or isinstance(value, (bool, np.bool_)):
        return None if value is None else bool(value)
    if isinstance(value, (str, bytes, os.PathLike)):
        return os.fsdecode(value)
    if isinstance(value, Mapping):
        return {name: str(item) if name == "spacing" else _count(f"{key}.count", item) if name == "count"
                else float(_numbers(f"{key}.{name}", item)) for name, item in value.items()}
    numbers = _numbers(key, value)
    return float(numbers) if numbers.ndim == 0 else numbers.ravel().tolist()


def _csv(data: Any) -> str:
    """The text of a file, or columns as one."""
    if isinstance(data, (str, bytes, os.PathLike)):
        path = _input_path("data", data)
        try:
            return pathlib.Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error.reason}") from None
    if not (isinstance(data, Mapping) or hasattr(data, "keys")):
        raise TypeError(f"data: must be a path or columns by name, not {type(data).__name__}")
    if isinstance(data, xr.Dataset):  # with the coordinates of a result, whose columns have other names
        data = data.rename({name: column for column, (name, _) in _COORDINATES.items() if name in data.variables})
    names = list(data.variables) if isinstance(data, xr.Dataset) else list(data.keys())
    columns = [_numbers(name, data[name]) for name in names]
    try:
        columns = np.broadcast_arrays(*columns)
    except ValueError:
        sizes = ", ".join(f"{name} {column.shape}" for name, column in zip(names, columns))
        raise InputError(f"data: columns of different lengths: {sizes}") from None
    rows = zip(*(column.ravel().tolist() for column in columns))
    return "\n".join([",".join(names), *(",".join(map(repr, row)) for row in rows)]) + "\n"


def _with_real_index(points: Mapping[str, Array]) -> Mapping[str, Array]:
    """The points with n and k in the place of a complex n."""
    if not np.iscomplexobj(points.get("n")):
        return points
    if "k" in points:
        raise InputError("n: is complex, so that k cannot be given too")
    index = points["n"]
    index = index if isinstance(index, xr.DataArray) else np.asarray(index)
    return {**points, "n": index.real, "k": index.imag}


class _Frame(NamedTuple):
    """What a result has beside its values."""

    shape: tuple[int, ...]
    dims: tuple[Hashable, ...]
    coordinates: dict[Hashable, xr.Variable]


def _over_keys(run: Callable[..., _native.Parts], scene: _native.Scene, columns: dict[str, np.ndarray],
               varied: dict[str, np.ndarray]) -> _native.Parts:
    """The points in runs of scenes that differ in the keys of `varied`; the attributes that all runs have."""
    different, which = np.unique(np.stack(np.broadcast_arrays(*varied.values()), axis=-1), axis=0, return_inverse=True)
    size = max(values.size for values in (*columns.values(), *varied.values()))
    which = np.broadcast_to(which.ravel(), size)
    found: _native.Parts | None = None
    for i, values in enumerate(different.tolist()):
        at = np.flatnonzero(which == i)
        own = {name: column if column.size == 1 else column[at] for name, column in columns.items()}
        part = run(scene.with_([*zip(varied, values)]), own)
        if found is None:
            found = ([(*facts, np.empty(size)) for *facts, _ in part[0]], np.empty(size, np.uint32), part[2])
        for (*_, whole), (*_, results) in zip((*found[0], (found[1],)), (*part[0], (part[1],))):
            whole[at] = results
        found = (*found[:2], {name: value for name, value in found[2].items() if part[2].get(name) == value})
    return found


def _columns(points: Mapping[str, Array], has_keys: bool = False) -> tuple[_Frame, dict[str, np.ndarray]]:
    """Columns for the library, of one value where there is one for all, and their common shape with its coordinates."""
    _check_names("points", [name for name in points if not (has_keys and "." in name)], list(_COORDINATES))
    points = _with_real_index(points)
    if any(isinstance(values, xr.DataArray) for values in points.values()):
        arrays = {name: values.copy(data=_numbers(name, values)) if isinstance(values, xr.DataArray)
                  else xr.DataArray(_numbers(name, values)) for name, values in points.items()}
        arrays = dict(zip(arrays, xr.broadcast(*arrays.values())))
        template = next(iter(arrays.values()))
        points = {name: array.values for name, array in arrays.items()}
        shape, dims = template.shape, template.dims
        coordinates = {name: coordinate.variable.copy(deep=False)
                       for array in arrays.values() for name, coordinate in array.coords.items()}
    else:
        points = {name: _numbers(name, values) for name, values in points.items()}
        try:
            shape = np.broadcast_shapes(*(values.shape for values in points.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {values.shape}" for name, values in points.items())
            raise InputError(f"points: shapes do not broadcast: {shapes}") from None
        dims, coordinates = _dimensions(points, shape)
    for column, values in points.items():
        name, known = _COORDINATES.get(column, (column, {}))
        if name in coordinates:
            coordinates[name].attrs.update(known)
        else:
            along = dims if values.ndim > 0 else ()
            coordinates[name] = xr.Variable(along, np.broadcast_to(values, shape) if along else values, known)
    columns = {name: np.broadcast_to(values, shape if values.ndim > 0 else ()).ravel()
               for name, values in points.items()}
    return _Frame(shape, dims, coordinates), columns


def _dimensions(points: Mapping[str, np.ndarray],
                shape: tuple[int, ...]) -> tuple[tuple[str, ...], dict[str, xr.Variable]]:
    """Names of the dimensions and the coordinates along one of them."""
    dims, coordinates = [], {}
    for axis, size in enumerate(shape):
        along = [column for column, values in points.items()
                 if values.ndim >= len(shape) - axis and values.shape[axis - len(shape)] == size]
        name = _COORDINATES.get(along[0], along)[0] if len(along) == 1 else None
        if name and points[along[0]].size == size and name not in coordinates:
            dims.append(name)
            coordinates[name] = xr.Variable(name, points[along[0]].ravel())
        else:
            dims.append("point" if len(shape) == 1 else f"point_{axis}")
    return tuple(dims), coordinates


def _variables(parts: _native.Parts, dims: tuple[Hashable, ...], shape: tuple[int, ...],
               encoding: dict[str, Any]) -> dict[str, xr.Variable]:
    quantities, status, _ = parts
    variables = {}
    for name, long_name, units, ancillary, values in quantities:
        known = {"long_name": long_name, "units": units}
        if ancillary:
            known["ancillary_variables"] = ancillary
        variables[name] = xr.Variable(dims, values.reshape(shape), known, encoding)
    if status.size:
        variables["status"] = xr.Variable(dims, status.view(np.int32).reshape(shape), _status_attributes())
    return variables


def _dataset(parts: _native.Parts, frame: _Frame) -> xr.Dataset:
    return xr.Dataset(_variables(parts, frame.dims, frame.shape, {}), frame.coordinates, parts[2])


def _table_dataset(axes: list[tuple[str, np.ndarray]], winds: np.ndarray,
                   curves: list[tuple[str, str, str, np.ndarray, np.ndarray]], parts: _native.Parts) -> xr.Dataset:
    """A table as xarray has it of its file."""
    known = dict(_COORDINATES.values())
    coordinates = {name: xr.Variable(name, values, known[name]) for name, values in axes}
    shape = tuple(values.size for _, values in axes)
    variables = _variables(parts, tuple(name for name, _ in axes), shape, {"_FillValue": np.nan})
    if winds.size:
        coordinates["wind_m_s"] = xr.Variable("sigma", winds, known["wind_m_s"])
        for variable in variables.values():
            variable.encoding["coordinates"] = "wind_m_s"
    for name, long_name, units, wavelengths, values in curves:
        along = f"{name}_wavelength"
        coordinates[along] = xr.Variable(along, wavelengths, {"long_name": "wavelength", "units": "um"})
        variables[name] = xr.Variable(along, values, {"long_name": long_name, "units": units})
    attributes = {}
    for name, value in parts[2].items():
        encoded = value.encode("utf-8", "surrogateescape") if isinstance(value, str) else b""
        if len(encoded) > _native.most_attribute_bytes:
            encoding = {"char_dim_name": f"{name}_length", "dtype": np.dtype("S1")}
            variables[name] = xr.Variable((), np.array(encoded), encoding=encoding)
        else:
            attributes[name] = value if isinstance(value, str) else np.float64(value)
    table = xr.Dataset(variables, coordinates, attributes)
    for variable in table.variables.values():
        variable.encoding.setdefault("dtype", variable.dtype)
    return table


def _native_table(table: xr.Dataset) -> _native.Table:
    """What a Dataset holds of a table; a coordinate of one value is an axis of one."""
    axes = [name for name in ("wavelength", "n", "k", "theta", "sigma", "q") if name in table.coords]
    columns, status = {}, np.empty(0, np.uint32)
    for name, variable in table.variables.items():
        if variable.dtype.kind not in "iuf" or variable.ndim > len(axes):
            continue
        if set(variable.dims) <= set(axes) and name not in axes:
            variable = variable.transpose(*(axis for axis in axes if axis in variable.dims))
        if name == "status":
            if not np.all(np.isfinite(variable.values)):
                raise InputError("Dataset: status has entries without a value; take the Dataset before it was masked")
            status = np.ascontiguousarray(variable.values, dtype=np.uint32).ravel()
        else:
            columns[name] = np.asarray(variable.values, dtype=float).ravel()
    attributes = {name: value if isinstance(value, str) else float(value) for name, value in table.attrs.items()
                  if isinstance(value, (str, int, float, np.integer, np.floating))}
    for name, variable in table.data_vars.items():
        if variable.ndim == 0 and variable.dtype.kind == "S":
            attributes[name] = os.fsdecode(variable.values.item())
    stokes = next((table[name] for name in ("stokes_i", "stokes_q", "stokes_u", "stokes_v") if name in table), None)
    units = "" if stokes is None else str(stokes.attrs.get("units", ""))
    return _native.Table.of(columns, status, units, attributes, "Dataset")


@functools.lru_cache(maxsize=None)
def _status_attributes() -> dict[str, Any]:
    bits = _native.status_bits()
    return {"long_name": "status bits of the entry; 0 where nothing is wrong", "units": "1",
            "flag_masks": np.array([mask for mask, _ in bits], dtype=np.int32),
            "flag_meanings": " ".join(meaning for _, meaning in bits)}
