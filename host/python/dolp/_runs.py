"""Computes tables, values at points, lookups, Mueller matrices and plans of scenes."""
from __future__ import annotations

import functools
import json
import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from . import _native
from ._arguments import Array, Path, axis_values, check_names, label_values, device_name, flag, native_path, short, word, word_list
from ._datasets import check_slopes, common_attributes, concatenated, dataset_at, table_dataset
from ._native import InputError
from ._points import KEY_ATTRIBUTES, columns_of, with_real_index, without_unused
from ._scene import Scene

_COLUMNS = [column for column, *_ in _native.axes()]
_PAIRS = ["theta_i_deg", "theta_r_deg", "delta_phi_deg", "sigma", "wind_m_s", "q", "n", "k", "sigma_cross", "surface_azimuth_deg"]


def table(scene: Scene, *, evaluator: str | None = None, device: str = "", keep_all: bool = False,
          quantities: Iterable[str] = (), derivatives: Iterable[str] = (), **axes: Array) -> xr.Dataset:
    """The table over the scene's grid: a Dataset with the contents of the table's file, and with
    the names of materials and bands as an index, as in `t.sel(material="iron", band="8-14")`.

    `axes` (theta_deg, sigma or wind_m_s, q, sigma_cross, surface_azimuth_deg, wavelength_um or band_um, temperature_K,
    and n, k or material; in bistatic mode view_zenith_deg and relative_azimuth_deg) replace axes of the scene. Each axis
    is a number or a list, and the table has all combinations of their values. Materials are names, as in `dolp.table(scene, material=["gold (Ordal)",
    "iron"])`, or "all". A complex n gives n and k. Winds become a second coordinate along sigma;
    `t.swap_dims(sigma="wind_m_s").sel(wind_m_s=5)` selects a wind. A scene with surface.wind_model = "directional" takes
    winds, not sigma.

    `quantities`: the variables of the table, such as `["dolp", "status"]`; all if there are none.

    `derivatives`: keys of numbers of the scene, such as `["surface.n"]`. The table then also has `d_dolp__surface_n` and
    `d_q_over_i__surface_n`, per unit of the key, and their estimated error, `derivative_error__surface_n`. They are NaN
    where a step leaves the domain, such as k = 0.

    Any other number of the scene can be an axis, with its key as the name. The program then computes one table for each
    value and joins the tables. Only attributes equal in all tables remain. `lookup` takes other values of the key, as in
    `dolp.lookup(t, **{"path.transmittance": 0.85}, theta_deg=40)`.

    >>> t = dolp.table(scene, theta_deg=[0, 60], sigma=[0.1, 0.2, 0.3])
    >>> dict(t.sizes)["theta"], dict(t.sizes)["sigma"], t.dolp.units, t.theta.units
    (2, 3, '1', 'degree')
    >>> dolp.table(scene, **{"emission.temperature_K": [280, 300]}).stokes_i.dims
    ('emission.temperature_K', 'theta', 'sigma', 'q')
    """
    key = next((name for name in axes if "." in name), None)
    quantities, derivatives = word_list("quantities", quantities), word_list("derivatives", derivatives)
    if key is None:
        on_axes = with_axes(native_scene(scene), axes)
        whole = table_dataset(*native_evaluator(scene, evaluator, device).table(
            on_axes, flag("keep_all", keep_all), quantities, derivatives))
        scene._warn_of_model(whole.get("status", 0), whole.attrs)
        return whole
    optional = ("temperature_K", "view_zenith_deg", "relative_azimuth_deg", "sigma_cross", "surface_azimuth_deg")
    columns = [column for column in _COLUMNS if column not in optional or column in axes or scene[f"grid.{column}"] is not None]
    _check_varied("axes", [key], columns)
    others = {name: values for name, values in axes.items() if name != key}
    values = np.array(axis_values(key, axes[key]))
    return concatenated([table(scene.with_({key: value}), evaluator=evaluator, device=device, keep_all=keep_all,
                               quantities=quantities, derivatives=derivatives, **others)
                         for value in values.tolist()], key, values)


def write_table(scene: Scene, path: Path, *, evaluator: str | None = None, device: str = "", keep_all: bool = False,
                resume: bool = False, quantities: Iterable[str] = (), derivatives: Iterable[str] = (), **axes: Array) -> str:
    """Writes the table that `table` would return to a file (.nc, .csv or .npy). It does so part by part, so that memory
    does not grow with the size of the table.

    Returns the report of the run. An interrupted call leaves its finished parts beside the file, and `resume` continues
    from these parts. Scene keys as axes, such as path.transmittance, are possible only in `table`.

    >>> with tempfile.TemporaryDirectory() as folder:
    ...     report = dolp.write_table(scene, folder + "/table.nc")
    >>> "entries    5 x 1 x 1 (theta x sigma x q)" in report
    True
    """
    if key := next((name for name in axes if "." in name), None):
        raise InputError(f"axes: {key} is no axis of a file; write a file for each value, of scene.with_({{{key!r}: VALUE}})")
    on_axes = with_axes(native_scene(scene), axes)
    return native_evaluator(scene, evaluator, device).write_table(
        on_axes, native_path("path", path), flag("keep_all", keep_all), flag("resume", resume),
        word_list("quantities", quantities), word_list("derivatives", derivatives))


def evaluate(scene: Scene, *, evaluator: str | None = None, device: str = "", keep_all: bool = False,
             derivatives: Iterable[str] = (), **points: Array) -> xr.Dataset:
    """The quantities of a table at points: a Dataset with the shape to which the arrays of `points` broadcast.

    `points` (theta_deg, sigma or wind_m_s, q, sigma_cross, surface_azimuth_deg, wavelength_um, n, k, view_zenith_deg,
    relative_azimuth_deg): arrays of the same shape are combined value by value, unlike the axes of `table`. Numbers that
    you do not give come from the scene. A complex n gives n and k. Any other number of the scene can be given too, with
    its key as the name; each of its values is a separate run.
    DataArrays keep their dimensions, and coordinates that are no numbers of a scene. Beside them, an array without names
    of dimensions must be a number or have the shape to which the DataArrays broadcast; its values join theirs one by one.
    Without DataArrays, a dimension along which only one array varies gets the name (theta, sigma, q, n, k or wavelength,
    as in tables) and the values of this array.

    >>> float(dolp.evaluate(scene, theta_deg=40).dolp.round(4))
    0.0295
    >>> d = dolp.evaluate(scene, theta_deg=np.array([[0], [40]]), sigma=[0.1, 0.2, 0.3])
    >>> d.dolp.dims, d.dolp.shape
    (('theta', 'sigma'), (2, 3))
    >>> dolp.evaluate(scene, theta_deg=40, **{"surroundings.temperature_K": [250, 290]}).dolp.round(4).values
    array([0.0179, 0.0043])

    `derivatives`: see `table`.

    >>> d = dolp.evaluate(scene, theta_deg=40, derivatives=["surface.sigma"])
    >>> abs(d.d_dolp__surface_sigma.item()) > 1000 * d.derivative_error__surface_sigma.item()
    True
    """
    return _evaluated(scene, evaluator, device, keep_all, points, derivatives)


def _evaluated(scene: Scene, evaluator: str | None, device: str, keep_all: bool, points: Mapping[str, Array],
               derivatives: Iterable[str] = ()) -> xr.Dataset:
    """Computes points for `evaluate` and `lookup`."""
    native, engine = native_scene(scene), native_evaluator(scene, evaluator, device)
    check_names("points", [name for name in points if "." not in name], _COLUMNS)
    frame, columns = columns_of(without_unused(points), native.labels())
    for name, labels in native.labels().items():
        if len(labels) > 1 and name not in columns:
            raise InputError(f"points: {name} is missing, one of {', '.join(labels)}")
    varied = {key: columns.pop(key) for key in [*columns] if "." in key}
    _check_varied("points", varied, columns)

    effects, keys = flag("keep_all", keep_all), word_list("derivatives", derivatives)

    def run(own: _native.Scene, values: dict[str, np.ndarray]) -> _native.Parts:
        return engine.evaluate(own, values, effects, keys)

    results = dataset_at(
        _over_keys(run, native, columns, varied) if varied and 0 not in frame.shape else run(native, columns), frame)
    scene._warn_of_model(results.get("status", 0), results.attrs)
    return results


def lookup(table: Path | xr.Dataset, *, evaluator: str | None = None, device: str = "", keep_all: bool = False,
           derivatives: Iterable[str] = (), **points: Array) -> xr.Dataset:
    """Values between the entries of a table: computed from the table's scene, with error bounds as from `evaluate`.

    `table`: the file of a table (.nc), or a Dataset with a table or a part of one. Only its attributes and the values of
    its axes count, so it may be a slice, or may be interpolated, averaged or edited.
    In a file of a part of a table, which xarray wrote, axes without a dimension count, as in `t.sel(q=8)`. An axis that
    kept its dimension counts with the values of the whole table.
    `points` and the other arguments: as for `evaluate`. An axis with one value in the table, such as q in `t.sel(q=8)`,
    gives the value of points that do not name it. For another tolerance or precision, change the table's scene, as in
    `dolp.evaluate(dolp.Scene(t, {"accuracy.tolerance": 1e-6}).for_points(), theta_deg=33)`.

    >>> t = dolp.table(scene, theta_deg=[0, 40, 80], sigma=[0.1, 0.2])
    >>> bool(dolp.lookup(t.sel(sigma=0.2), theta_deg=33).dolp == dolp.evaluate(scene, theta_deg=33, sigma=0.2).dolp)
    True
    """
    if not isinstance(table, (str, bytes, os.PathLike, xr.Dataset)):
        raise TypeError(f"table: must be a path or an xarray.Dataset, not {type(table).__name__}")
    scene = Scene(table)
    if not scene.is_of_table:
        raise InputError(f"table: {short(table)} is a scene and no table; use dolp.evaluate")
    for key in (*table.dims, *table.coords) if isinstance(table, xr.Dataset) else ():
        if key in KEY_ATTRIBUTES and key not in points and (table[key].size != 1 or key not in table.coords):
            raise InputError(f"points: {key} is missing; the table has {table[key].size} values of it")
    return _evaluated(scene.for_points(), evaluator, device, keep_all, points, derivatives)


def mueller(scene: Scene, *, evaluator: str | None = None, device: str = "", **points: Array) -> np.ndarray:
    """Mueller matrices of the pBRDF in 1/sr, with shape (..., 4, 4).

    `points`: theta_i_deg, theta_r_deg, delta_phi_deg (180 on the specular side), and optionally sigma or wind_m_s, q, n,
    k, sigma_cross, surface_azimuth_deg. Arrays are combined as by `evaluate`. Other numbers come from the scene:
    `scene.with_({"surface.specular": 0.1})`. A matrix is NaN if the model has no finite value.

    >>> m = dolp.mueller(scene, theta_i_deg=[10, 20, 30], theta_r_deg=30, delta_phi_deg=180)
    >>> m.shape, bool(m[2, 0, 0] > m[0, 0, 0])
    ((3, 4, 4), True)
    """
    native = native_scene(scene)
    check_names("points", points, _PAIRS)
    for name, key in ("material", "surface.material"), ("band_um", "spectrum.wavelength_um"):
        if len(labels := native.labels()[name]) > 1:
            raise InputError(f"scene: has {', '.join(labels)} on the axis {name}, of which a Mueller matrix needs one: "
                             f'scene.with_({{"{key}": ...}})')
    frame, columns = columns_of(points)
    matrices = native_evaluator(scene, evaluator, device).mueller(native, columns)
    return matrices.reshape(frame.shape + (4, 4))


class Plan:
    """The plan of a table: what the program would compute or leave out, why, and the cost. `print` shows a report.

    `values`: the report of `dolp plan --json` as a dictionary.
    """

    def __init__(self, text: str, values: dict[str, Any]) -> None:
        self.text, self.values = text, values

    def __repr__(self) -> str:
        return self.text


def plan(scene: Scene, *, device: str = "", keep_all: bool = False) -> Plan:
    """Plans the table over the scene's grid: what it would compute, leave out and cost. Computes no entry.

    >>> dolp.plan(scene).values["entries"]
    5
    """
    text, values = _native.plan(native_scene(scene), device_name(device), flag("keep_all", keep_all))
    return Plan(text, json.loads(values))


def devices() -> list[dict[str, Any]]:
    """The Vulkan devices of this machine: name, type, driver, api_version, usable, why_not, has_double, memory_bytes."""
    return _native.devices()


def native_evaluator(scene: Scene, evaluator: str | None, device: str) -> _native.Evaluator:
    """The evaluator with this name. Without a name: the evaluator of the scene's table, or "vulkan"."""
    device = device_name(device)
    if evaluator is None:
        evaluator = "vulkan" if device else native_surface(scene).evaluator
    return _evaluator_of(word("evaluator", evaluator), device)


@functools.lru_cache(maxsize=None)
def _evaluator_of(evaluator: str, device: str) -> _native.Evaluator:
    return _native.Evaluator(evaluator, device)


def native_scene(scene: Scene) -> _native.Scene:
    if isinstance(scene, Scene) and scene._is_for_response:
        raise InputError("scene: has no material, because it comes from Scene.for_response or a response table; only dolp.response takes it, so write dolp.Scene(PATH) with the file of a scene")
    return native_surface(scene)


def native_surface(scene: Scene) -> _native.Scene:
    """The scene for a call that needs only its surface."""
    if isinstance(scene, Scene):
        return scene._native
    hint = "; dolp.Scene(path) reads a file" if isinstance(scene, (str, os.PathLike)) else ""
    raise TypeError(f"scene: must be a dolp.Scene, not {type(scene).__name__}{hint}")


def with_axes(native: _native.Scene, axes: Mapping[str, Array]) -> _native.Scene:
    """Replaces axes of the scene's grid by `axes`. The names in `axes` are column names, such as theta_deg."""
    check_names("axes", axes, _COLUMNS)
    check_slopes("axes", native, axes)
    if np.iscomplexobj(axes.get("n")):
        if np.size(axes["n"]) > 1:
            raise InputError("n: several complex values form no grid of n and k; give the lists n and k, or use dolp.evaluate")
        axes = with_real_index(axes)
    return native.with_([(f"grid.{axis}", label_values(values) if axis in native.labels() else axis_values(axis, values))
                         for axis, values in axes.items()])


def _check_varied(what: str, keys: Iterable[str], columns: Iterable[str]) -> None:
    """Errors: InputError if one of `keys` and one of `columns` name the same number, such as surface.n and n, or give the
    slopes in two ways."""
    for key in keys:
        table, _, column = key.partition(".")
        if table == "grid":
            raise InputError(f"{what}: {key} is a list of the grid; the name of this argument is {column}")
        if column in columns and table in ("surface", "spectrum", "emission", "geometry"):
            raise InputError(f"{what}: {key} and {column} are the same")
        if (other := {"surface.sigma": "wind_m_s", "surface.wind_m_s": "sigma"}.get(key)) in columns:
            raise InputError(f"{what}: {key} and {other} cannot be combined")


def _over_keys(run: Callable[..., _native.Parts], scene: _native.Scene, columns: dict[str, np.ndarray],
               varied: dict[str, np.ndarray]) -> _native.Parts:
    """Computes points that have different values of the scene keys in `varied`. Each combination of these values takes
    one run. The results keep only attributes that are equal in all runs."""
    different, which = np.unique(np.stack(np.broadcast_arrays(*varied.values()), axis=-1), axis=0, return_inverse=True)
    size = max(values.size for values in (*columns.values(), *varied.values()))
    which = np.broadcast_to(which.ravel(), size)
    found: tuple[list[Any], np.ndarray] | None = None
    attributes = []
    for i, values in enumerate(different.tolist()):
        at = np.flatnonzero(which == i)
        own = {name: column if column.size == 1 else column[at] for name, column in columns.items()}
        part = run(scene.with_([*zip(varied, values)]), own)
        if found is None:
            found = ([(*facts, np.empty(size)) for *facts, _ in part[0]], np.empty(size, np.uint32))
        for (*_, whole), (*_, results) in zip((*found[0], (found[1],)), (*part[0], (part[1],))):
            whole[at] = results
        attributes.append(part[2])
    return (*found, common_attributes(attributes, varied))
