"""Converts results of the library to xarray Datasets, and Datasets to tables of the library."""
from __future__ import annotations

import functools
import json
import os
from collections.abc import Hashable, Iterable
from typing import Any

import numpy as np
import xarray as xr

from . import _native
from ._arguments import floats, short
from ._native import InputError
from ._points import COORDINATES, KEY_ATTRIBUTES, Frame

# Name of an attribute of tables that have scene keys as axes. It has a line KEY=[VALUE, ...] for each such axis.
_COMPUTED = "computed_values"


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
    joined.attrs.pop("scene_hash", None)
    computed = _attributes_of(first).get(_COMPUTED)
    joined.attrs[_COMPUTED] = "\n".join(filter(None, [computed, f"{key}={values.tolist()}"]))
    if "scene_overrides" in first.attrs:  # removes the line with `key`, which has only the first table's value
        before, _, after = f"\n{first.attrs['scene_overrides']}\n".rpartition(f"\n{key}=")
        rest = after.partition("\n")[2]
        joined.attrs["scene_overrides"] = f"{before}\n{rest}".strip("\n")
    return joined


def native_table(table: xr.Dataset) -> _native.Table:
    """Converts a Dataset to a table of the library.

    A scalar coordinate becomes an axis with one value or, if its name is a scene key, sets this key of the scene.
    Dimensions may have any names and order: the coordinate with the name of an axis tells the dimension of the axis.
    """
    table = with_names(table)
    attributes = _attributes_of(table)
    overrides = [str(attributes.get("scene_overrides", "")), *_values_of_keys(table, str(attributes.pop(_COMPUTED, "")))]
    if any(overrides):
        attributes["scene_overrides"] = "\n".join(filter(None, overrides))
    axes = [name for name in _native.table_axes() if name in table.coords]
    dims = [dim for axis in axes for dim in table[axis].dims]
    if any(table[axis].ndim > 1 for axis in axes) or len(set(dims)) < len(dims):
        raise InputError(f"Dataset: {', '.join(axes)} must each be along a dimension of its own, as in dolp.table")
    columns = {str(name): floats(f"Dataset: {name}", variable.values).ravel() for name, variable in table.variables.items()
               if variable.ndim < 2 and variable.dtype.kind in "iuf" and str(name).isascii()}
    for name in [*_native.quantities(), "status"]:
        if name not in table.variables:
            continue
        variable = table.variables[name]
        if set(variable.dims) != set(dims):
            raise InputError(f"Dataset: {name} is over {_text(variable.dims)}; must be over {_text(dims)}, as the axes are")
        columns[name] = floats(f"Dataset: {name}", variable.transpose(*dims).values).ravel()
    labels = {axis: [str(label) for label in np.atleast_1d(table[axis].values)] for axis in axes
              if table[axis].dtype.kind in "OU"}
    status = columns.pop("status", np.empty(0))
    wrong = status[~((status >= 0) & (status < 2**32) & (status == np.floor(status)))]
    if wrong.size:
        raise InputError(f"Dataset: status has entries without a value from 0 to 2^32 - 1, as {wrong[0]}; take the Dataset "
                         "before it was masked or interpolated")
    stokes = next((table[name] for name in ("stokes_i", "stokes_q", "stokes_u", "stokes_v") if name in table), None)
    units = "" if stokes is None else str(stokes.attrs.get("units", ""))
    return _native.Table.of(columns, labels, status.astype(np.uint32), units, attributes, "Dataset")


def _values_of_keys(table: xr.Dataset, computed: str) -> list[str]:
    """Returns an override KEY=VALUE of the scene for each coordinate of `table` whose name is a scene key."""
    known = {key: json.loads(values) for key, _, values in (line.partition("=") for line in computed.split("\n")) if key}
    overrides = []
    for key in [str(name) for name in table.coords if name in KEY_ATTRIBUTES]:
        if table[key].ndim > 0:
            raise InputError(f"Dataset: has {table[key].size} values of {key}; take one, as with sel({{{key!r}: VALUE}})")
        value = float(table[key])
        if value not in known.get(key, [value]):
            raise InputError(f"Dataset: {key} = {value}: is not among the values that were computed, {short(known[key])}; "
                             "compute it, as a value of its own in dolp.table")
        overrides.append(f"{key}={value!r}")
    return overrides


def _attributes_of(table: xr.Dataset) -> dict[str, str | float]:
    """The attributes of a Dataset, with the long texts that files of dolp 0.2 have as variables."""
    attributes = {name: value if isinstance(value, str) else float(floats(f"Dataset: attribute {name}", value))
                  for name, value in table.attrs.items() if isinstance(value, (str, int, float, np.integer, np.floating))}
    return attributes | {name: os.fsdecode(variable.values.item()) for name, variable in table.data_vars.items()
                         if variable.ndim == 0 and variable.dtype.kind == "S"}


def _text(dims: Iterable[Hashable]) -> str:
    return f"({', '.join(map(str, dims))})"


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


@functools.lru_cache(maxsize=None)
def _status_attributes() -> dict[str, Any]:
    bits = _native.status_bits()
    return {"long_name": "status bits of the entry; 0 where nothing is wrong", "units": "1",
            "flag_masks": np.array([mask for mask, _ in bits], dtype=np.int32),
            "flag_meanings": " ".join(meaning for _, meaning in bits)}
