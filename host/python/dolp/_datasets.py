"""Converts results of the library to xarray Datasets, and the attributes of Datasets to scenes."""
from __future__ import annotations

import functools
import os
from collections.abc import Hashable, Iterable
from typing import Any

import numpy as np
import xarray as xr

from . import _native
from ._arguments import floats
from ._native import InputError
from ._points import COORDINATES, KEY_ATTRIBUTES, Frame

_SIGMA_ROUNDING = 1e-6  # relative; a coordinate may have become single precision


def dataset_at(parts: _native.Parts, frame: Frame) -> xr.Dataset:
    return xr.Dataset(_variables(parts, frame.dims, frame.shape, {}), frame.coordinates, parts[2])


def table_dataset(axes: list[tuple[str, np.ndarray]], winds: np.ndarray,
                   curves: list[tuple[str, str, str, np.ndarray]], parts: _native.Parts) -> xr.Dataset:
    """The Dataset that xarray would read from the file of the table, with_names."""
    known = dict(COORDINATES.values())
    coordinates = {}
    for name, values in axes:
        coordinates |= _label_coordinates(name, values) if isinstance(values, list) else {name: xr.Variable(name, values, known[name])}
    shape = tuple(len(values) for _, values in axes)
    variables = _variables(parts, tuple(name for name, _ in axes), shape, {"_FillValue": np.nan})
    if winds.size:
        coordinates["wind_m_s"] = xr.Variable("sigma", winds, known["wind_m_s"])
    for name, long_name, units, used in curves:
        along = ("wavelength",) if "wavelength" in coordinates else ()
        coordinates[name] = xr.Variable(along, used if along else used[0], {"long_name": long_name, "units": units})
    if others := [name for name in coordinates if name not in dict(axes)]:
        for variable in variables.values():
            variable.encoding["coordinates"] = " ".join(others)
    table = xr.Dataset(variables, coordinates, {name: value if isinstance(value, str) else np.float64(value)
                                                for name, value in parts[2].items()})
    for variable in table.variables.values():
        variable.encoding.setdefault("dtype", variable.dtype)
    return with_names(table)


def _label_coordinates(axis: str, labels: list[str]) -> dict[Hashable, xr.Variable]:
    """The coordinates that a file has for the labels of an axis."""
    if axis == "material":
        return {"material_name": xr.Variable(axis, np.array(labels, object), {"long_name": "material of the surface"},
                                             {"dtype": np.dtype("S1"), "char_dim_name": "name_length", "_Encoding": "utf-8"})}
    limits = np.array([label.split("-") for label in labels], float).T
    return {f"band_{end}": xr.Variable(axis, values, {"long_name": f"{word} limit of the band", "units": "um"})
            for end, word, values in zip(("low", "high"), ("lower", "upper"), limits)}


def with_names(table: xr.Dataset) -> xr.Dataset:
    """Adds the names of materials and bands as an index, for `t.sel(material="iron", band="8-14")`. Files have only the
    coordinates material_name, band_low and band_high: in netCDF an index has numbers."""
    names = {}
    if "material_name" in table.coords:
        names["material"] = table.material_name.variable
    if "band_low" in table.coords and "band_high" in table.coords:
        ends = [[np.format_float_positional(end, trim="-") for end in table[name].values.ravel()] for name in ("band_low", "band_high")]
        labels = np.array(["-".join(band) for band in zip(*ends)], object)
        names["band"] = table.band_low.variable.copy(data=labels.reshape(table.band_low.shape))
    known = dict(COORDINATES.values())
    return table.assign_coords({axis: xr.Variable(variable.dims, variable.values, {"long_name": known[axis]["long_name"]})
                                for axis, variable in names.items() if axis not in table.coords})


def concatenated(tables: list[xr.Dataset], key: str, values: np.ndarray) -> xr.Dataset:
    """Joins tables of scenes that differ only in `key`. The key becomes a dimension of the result."""
    if not tables:
        raise InputError(f"{key}: needs at least one value")
    first = tables[0]
    along = [name for name, variable in first.data_vars.items()
             if "theta" in variable.dims or not all(variable.equals(table[name]) for table in tables)]
    differing = [name for name, coordinate in first.coords.items()
                 if not all(coordinate.variable.equals(table.coords[name].variable) for table in tables)]
    joined = xr.concat(tables, xr.Variable(key, values, KEY_ATTRIBUTES.get(key)), data_vars=along, coords=differing,
                       compat="override", combine_attrs="drop_conflicts")
    joined.attrs = common_attributes([table.attrs for table in tables], [key])
    return joined


def common_attributes(results: list[dict[Any, Any]], keys: Iterable[str]) -> dict[Any, Any]:
    """The attributes that are equal in all results of scenes that differ only in `keys`, and the overrides of the scene
    without the last one of each of `keys`, which is that of the result."""
    first = results[0]
    common = {name: value for name, value in first.items() if name != "scene_hash" and all(other.get(name) == value for other in results)}
    if "scene_overrides" in first:
        lines = first["scene_overrides"].split("\n")
        for key in keys:
            last = max((i for i, line in enumerate(lines) if line.startswith(f"{key}=")), default=None)
            lines = [line for i, line in enumerate(lines) if i != last]
        common["scene_overrides"] = "\n".join(lines)
    return common


def scene_of_dataset(table: xr.Dataset) -> _native.Scene:
    """The scene of a table, with the one value of each axis and scene key that has only one value in the table."""
    table = with_names(table)
    scene = read_scene(table)
    columns = {name: column for column, name, *_ in _native.axes()}
    single = {str(name): values.item() for name, values in table.coords.items() if values.size == 1}
    sigma = single.pop("sigma", None) if "wind_m_s" in single else None
    if "sigma" in single:
        check_slopes("Dataset", scene, ["sigma"])
    values = [(name, value) for name, value in single.items() if name in KEY_ATTRIBUTES]
    values += [(f"grid.{columns[name]}", [[float(end) for end in value.split("-")]] if name == "band" else [value])
               for name, value in single.items() if name in columns]
    chosen = scene.with_(values).for_points()
    if sigma is not None and not np.isclose(chosen.value("surface.sigma"), sigma, rtol=_SIGMA_ROUNDING, atol=0):
        raise InputError(f"Dataset: sigma = {sigma:g} is not the sigma of wind_m_s = {single['wind_m_s']:g}, as after interpolating; "
                         "remove one of them by drop_vars")
    return chosen


def check_slopes(what: str, scene: _native.Scene, names: Iterable[str]) -> None:
    """Errors: InputError if `names` contain slopes, and the scene has a directional wind, which they would replace."""
    for name in names:
        if name in ("sigma", "sigma_cross") and scene.value("surface.wind_model") == "directional":
            raise InputError(f"{what}: {name}: in the scene slopes along and across follow from the wind "
                             f'(surface.wind_model = "directional"); give only wind_m_s, or take scene.with_({{"surface.sigma": ...}})')


def read_scene(table: xr.Dataset) -> _native.Scene:
    """The scene that the attributes of a result contain."""
    attributes = _attributes_of(table)
    if "spectral_data" not in attributes:  # tables of dolp 0.2 have n, k and the irradiance of the scene as variables
        rows = [f"{name},{um!r},{value!r}\n" for name in ("index_n", "index_k", "irradiance") if f"{name}_wavelength" in table
                for um, value in zip(table[f"{name}_wavelength"].values.tolist(), table[name].values.tolist())]
        attributes["spectral_data"] = "".join(rows)
    return _native.Scene.from_attributes(attributes, "Dataset")


def _attributes_of(table: xr.Dataset) -> dict[str, str | float]:
    """The attributes of a Dataset, with the long texts that files of dolp 0.2 have as variables."""
    attributes = {name: value if isinstance(value, str) else float(floats(f"Dataset: attribute {name}", value))
                  for name, value in table.attrs.items() if isinstance(value, (str, int, float, np.integer, np.floating))}
    return attributes | {name: os.fsdecode(variable.values.item()) for name, variable in table.data_vars.items()
                         if variable.ndim == 0 and variable.dtype.kind == "S"}


def _variables(parts: _native.Parts, dims: tuple[Hashable, ...], shape: tuple[int, ...],
               encoding: dict[str, Any]) -> dict[str, xr.Variable]:
    quantities, status, _ = parts
    names = {name for name, *_ in quantities} | ({"status"} if status.size else set())
    variables = {}
    for name, long_name, units, ancillary, values in quantities:
        known = {"long_name": long_name, "units": units}
        if present := [qualifier for qualifier in ancillary.split() if qualifier in names]:
            known["ancillary_variables"] = " ".join(present)
        variables[name] = xr.Variable(dims, values.reshape(shape), known, encoding)
    if status.size:
        variables["status"] = xr.Variable(dims, status.view(np.int32).reshape(shape), _status_attributes())
    return variables


@functools.lru_cache(maxsize=None)
def _status_attributes() -> dict[str, Any]:
    bits = _native.status_bits()
    return {"long_name": "status bits of the entry; 0 where nothing is wrong", "units": "1",
            "flag_masks": np.array([mask for mask, _ in bits], dtype=np.int32),
            "flag_meanings": " ".join(meaning for _, meaning in bits)}
