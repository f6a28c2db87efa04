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

Names and units are those of scene files and tables: angles in degrees, wavelengths in um, temperatures in K. Results are
xarray Datasets with the variables, units and meanings that table files have, and the same bits that the command line
computes; `dataset.dolp.plot()` draws. Every entry has its error bound in `error_estimate`.

The device and its kernels are kept between calls. A long call lets Python's other threads run, and Ctrl-C ends it. A
process that was forked from one that has used a Vulkan device gets a DeviceError: start processes afresh
(multiprocessing.set_start_method("spawn")), or take evaluator="cpu". Errors: InputError (a ValueError) with one line
that says what is allowed, DeviceError (a RuntimeError), IoError (an OSError).
"""
from __future__ import annotations

import functools
import json
import os
import pathlib
import tempfile
from collections.abc import Hashable, Mapping
from typing import Any, NamedTuple, Union

import numpy as np
import xarray as xr

from . import _native
from ._native import DeviceError, InputError, IoError

__all__ = ["DeviceError", "Fit", "InputError", "IoError", "Plan", "Scene", "citation", "devices", "evaluate", "fit", "keys", "lookup", "materials",
           "mueller", "plan", "table", "write_table"]
__version__ = _native.version()

Path = Union[str, "os.PathLike[str]"]
Array = Union[float, "np.ndarray", "xr.DataArray", "list[float]"]

# Of each column of points the name of its coordinate, which is that of table files, with its attributes.
_COORDINATES = {column: (name, {"long_name": long_name, "units": units})
                for column, name, long_name, units in _native.axes()}
_COORDINATES |= {name: (name, {"long_name": long_name, "units": "degree"}) for name, long_name in (
    ("theta_i_deg", "zenith angle of incidence"), ("theta_r_deg", "zenith angle of the view"),
    ("delta_phi_deg", "azimuth between the directions, 180 on the specular side"))}



class Scene:
    """A surface, what it radiates and reflects, and how accurate results are to be: a scene file, or its text.

    Parameters: a path or `text`, then overrides of any key of a scene.

    >>> smooth = dolp.Scene(scene, {"surface.sigma": 0.01, "title": "a mirror"})
    >>> smooth.title
    'a mirror'
    >>> dolp.Scene(scene, {"surface.sigma": -1})
    Traceback (most recent call last):
    dolp._native.InputError: surface.sigma = -1: -1 is out of range; must be a number in [0, 10]
    """

    def __init__(self, path: Path | Scene | None = None, overrides: Mapping[str, Any] | None = None, *,
                 text: str | None = None) -> None:
        if (path is None) == (text is None):
            raise InputError("Scene: needs either a path or text")
        values = _values(overrides or {})
        if isinstance(path, Scene):
            self._native = path._native.with_(values)
        elif path is not None:
            self._native = _native.Scene.from_file(path, values)
        else:
            self._native = _native.Scene.from_text(text, values)

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

    def toml(self) -> str:
        """The scene with its overrides applied, as a scene file has it."""
        return self._native.toml()

    def __repr__(self) -> str:
        return self.toml()


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

    `values` is what `dolp fit --json` prints, as a dictionary: parameters with values and intervals, correlation,
    chi_square, p_value, minima, residuals. `scene` has the values that were found.
    """

    def __init__(self, text: str, values: dict[str, Any], scene: Scene) -> None:
        self.text, self.values, self.scene = text, values, scene

    def __getitem__(self, key: str) -> float:
        """The value of a parameter."""
        return next(one["value"] for one in self.values["parameters"] if one["key"] == key)

    def __repr__(self) -> str:
        return self.text


def table(scene: Scene, *, evaluator: str = "vulkan", device: str = "", keep_all: bool = False,
          **axes: Array) -> xr.Dataset:
    """The table over the scene's grid: a Dataset that is what the file would hold.

    `axes` (theta_deg, sigma, q, wavelength_um, n, k) replace those of the scene.

    >>> t = dolp.table(scene, theta_deg=[0, 60], sigma=[0.1, 0.2, 0.3])
    >>> dict(t.sizes)["theta"], dict(t.sizes)["sigma"], t.dolp.units, t.theta.units
    (2, 3, '1', 'degree')
    """
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "table.nc"
        write_table(scene, path, evaluator=evaluator, device=device, keep_all=keep_all, **axes)
        return xr.load_dataset(path)


def write_table(scene: Scene, path: Path, *, evaluator: str = "vulkan", device: str = "", keep_all: bool = False,
                resume: bool = False, **axes: Array) -> str:
    """The same into a file (.nc, .csv or .npy), part by part, so that memory does not grow with the table.

    Returns the report of the run. What an interrupted call has finished stays beside the file; `resume` goes on there.

    >>> print(dolp.write_table(scene, "/tmp/table_of_scene.nc").splitlines()[1])
      entries    5 x 1 x 1 (theta x sigma x q)
    """
    with_axes = Scene(scene, {f"grid.{axis}": np.atleast_1d(values) for axis, values in axes.items()})
    return _evaluator(evaluator, device).write_table(with_axes._native, path, keep_all, resume)


def evaluate(scene: Scene, *, evaluator: str = "vulkan", device: str = "", keep_all: bool = False,
             **points: Array) -> xr.Dataset:
    """The quantities of a table at points: a Dataset of the shape to which the arrays broadcast.

    `points` (theta_deg, sigma, q, wavelength_um, n, k): what they do not say comes from the scene. DataArrays keep their
    dimensions. Of other arrays, one that has a dimension to itself gives that its coordinate, theta, sigma, q, n, k or
    wavelength as in a table.

    >>> float(dolp.evaluate(scene, theta_deg=40).dolp.round(4))
    0.0295
    >>> d = dolp.evaluate(scene, theta_deg=np.array([[0], [40]]), sigma=[0.1, 0.2, 0.3])
    >>> d.dolp.dims, d.dolp.shape
    (('theta', 'sigma'), (2, 3))
    """
    frame, columns = _columns(points)
    return _dataset(_evaluator(evaluator, device).evaluate(scene._native, columns, keep_all), frame)


def lookup(table: Path | xr.Dataset, **points: Array) -> xr.Dataset:
    """A table between its entries: error estimates contain the interpolation.

    `table`: a file, or a Dataset from `table`. `points`: as for `evaluate`; an axis of one value needs none.

    >>> t = dolp.table(scene, theta_deg=np.linspace(0, 80, 41))
    >>> bool(abs(dolp.lookup(t, theta_deg=33).dolp - dolp.evaluate(scene, theta_deg=33).dolp) < 1e-5)
    True
    """
    if isinstance(table, xr.Dataset):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "table.nc"
            table.to_netcdf(path)
            return lookup(path, **points)
    frame, columns = _columns(points)
    return _dataset(_native.Table.read(table).lookup(columns), frame)


def mueller(scene: Scene, *, evaluator: str = "vulkan", device: str = "", **points: Array) -> np.ndarray:
    """Mueller matrices of the pBRDF in 1/sr, shape (..., 4, 4): of theta_i_deg, theta_r_deg, delta_phi_deg.

    `delta_phi_deg` is 180 on the specular side. Also sigma, q, n, k. NaN where the model has no finite value.

    >>> m = dolp.mueller(scene, theta_i_deg=[10, 20, 30], theta_r_deg=30, delta_phi_deg=180)
    >>> m.shape, bool(m[2, 0, 0] > m[0, 0, 0])
    ((3, 4, 4), True)
    """
    frame, columns = _columns(points)
    matrices = _evaluator(evaluator, device).mueller(scene._native, columns)
    return matrices.reshape(frame.shape + (4, 4))


def fit(scene: Scene, data: Any, vary: Mapping[str, tuple[float, ...]], *, starts: int = 24, seed: int = 1,
        evaluator: str = "vulkan", device: str = "") -> Fit:
    """Numbers of a scene from measured data, with profile-likelihood intervals.

    `data`: a CSV file, or columns by name (a dictionary, a Dataset, a pandas DataFrame): theta_deg or theta_i_deg; dolp,
    q_over_i (signed) or emissivity_s, emissivity_p; uncertainty (one standard deviation), wavelength_um. A list has
    several sets, each alone or as a pair (data, overrides). `vary`: (low, high) or (low, high, start) of each key.

    >>> truth = dolp.evaluate(scene, theta_deg=np.arange(5, 85, 5), n=1.6)
    >>> data = {"theta_deg": truth.theta, "dolp": truth.dolp, "uncertainty": np.full(16, 0.001)}
    >>> found = dolp.fit(scene, data, {"surface.n": (1.1, 3)})
    >>> round(found["surface.n"], 4), found.values["parameters"][0]["interval_95"][0] < 1.6
    (1.6, True)
    """
    sets = [one if isinstance(one, tuple) else (one, {}) for one in (data if isinstance(data, list) else [data])]
    texts = [(_csv(columns), _values(overrides)) for columns, overrides in sets]
    ranges = {key: [float(end) for end in ends] for key, ends in vary.items()}
    text, values, found = _evaluator(evaluator, device).fit(scene._native, texts, ranges, starts, seed)
    fitted = Scene.__new__(Scene)
    fitted._native = found
    return Fit(text, json.loads(values), fitted)


def plan(scene: Scene, *, device: str = "", keep_all: bool = False) -> Plan:
    """What a table over the scene's grid would compute, leave out and cost; nothing is computed.

    >>> dolp.plan(scene).values["entries"]
    5
    """
    text, values = _native.plan(scene._native, device, keep_all)
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


def citation() -> str:
    """How to cite the program and its model, in the Citation File Format."""
    return _native.citation()


@functools.lru_cache(maxsize=None)
def _evaluator(evaluator: str, device: str) -> _native.Evaluator:
    return _native.Evaluator(evaluator, device)


def _values(overrides: Mapping[str, Any]) -> dict[str, Any]:
    return {key: _value(key, value) for key, value in overrides.items()}


def _value(key: str, value: Any) -> Any:
    """A value as the library takes it: None, bool, float, str, a list of floats, or a range as a dictionary."""
    if value is None or isinstance(value, (bool, np.bool_)):
        return None if value is None else bool(value)
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {name: item if isinstance(item, str) else int(item) if name == "count" else float(item)
                for name, item in value.items()}
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{key}: {value!r} is neither a number, a text, a list of numbers nor a range") from None
    return float(numbers) if numbers.ndim == 0 else numbers.ravel().tolist()


def _csv(data: Any) -> str:
    """The text of a file, or columns as one."""
    if isinstance(data, (str, os.PathLike)):
        return pathlib.Path(data).read_text(encoding="utf-8")
    if isinstance(data, xr.Dataset):  # with the coordinates of a result, whose columns have other names
        data = data.rename({name: column for column, (name, _) in _COORDINATES.items() if name in data.variables})
    names = list(data.variables) if isinstance(data, xr.Dataset) else list(data.keys())
    columns = np.broadcast_arrays(*(np.asarray(data[name], dtype=float) for name in names))
    rows = zip(*(column.ravel().tolist() for column in columns))
    return "\n".join([",".join(names), *(",".join(map(repr, row)) for row in rows)]) + "\n"


class _Frame(NamedTuple):
    """What a result has beside its values."""

    shape: tuple[int, ...]
    dims: tuple[Hashable, ...]
    coordinates: dict[Hashable, xr.Variable]


def _columns(points: Mapping[str, Array]) -> tuple[_Frame, dict[str, np.ndarray]]:
    """Columns for the library, of one value where there is one for all, and their common shape with its coordinates."""
    for name in points:
        if name not in _COORDINATES:
            raise InputError(f"points: {name} is none of {', '.join(_COORDINATES)}")
    if any(isinstance(values, xr.DataArray) for values in points.values()):
        arrays = {name: xr.DataArray(values) for name, values in points.items()}
        arrays = dict(zip(arrays, xr.broadcast(*arrays.values())))
        template = next(iter(arrays.values()))
        points = {name: array.values for name, array in arrays.items()}
        shape, dims = template.shape, template.dims
        coordinates = {name: array.variable.copy(deep=False) for name, array in template.coords.items()}
    else:
        points = {name: np.asarray(values, dtype=float) for name, values in points.items()}
        try:
            shape = np.broadcast_shapes(*(values.shape for values in points.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {values.shape}" for name, values in points.items())
            raise InputError(f"points: shapes do not broadcast: {shapes}") from None
        dims, coordinates = _dimensions(points, shape)
    for column, values in points.items():
        name, known = _COORDINATES[column]
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
        name = _COORDINATES[along[0]][0] if len(along) == 1 else None
        if name and points[along[0]].size == size and name not in coordinates:
            dims.append(name)
            coordinates[name] = xr.Variable(name, points[along[0]].ravel())
        else:
            dims.append("point" if len(shape) == 1 else f"point_{axis}")
    return tuple(dims), coordinates


def _dataset(parts: _native.Parts, frame: _Frame) -> xr.Dataset:
    quantities, status, attributes = parts
    variables = {}
    for name, long_name, units, ancillary, values in quantities:
        known = {"long_name": long_name, "units": units}
        if ancillary:
            known["ancillary_variables"] = ancillary
        variables[name] = xr.Variable(frame.dims, values.reshape(frame.shape), known)
    variables["status"] = xr.Variable(frame.dims, status.view(np.int32).reshape(frame.shape), _status_attributes())
    return xr.Dataset(variables, frame.coordinates, attributes)


@functools.lru_cache(maxsize=None)
def _status_attributes() -> dict[str, Any]:
    bits = _native.status_bits()
    return {"long_name": "status bits of the entry; 0 where nothing is wrong", "units": "1",
            "flag_masks": np.array([mask for mask, _ in bits], dtype=np.int32),
            "flag_meanings": " ".join(meaning for _, meaning in bits)}
