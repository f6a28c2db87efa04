"""Results of the library as Datasets of xarray, and such Datasets as tables of the library."""
from __future__ import annotations

import functools
import os
from collections.abc import Hashable
from typing import Any

import numpy as np
import xarray as xr

from . import _native
from ._native import InputError
from ._points import COORDINATES, KEY_ATTRIBUTES, Frame


def dataset_at(parts: _native.Parts, frame: Frame) -> xr.Dataset:
    return xr.Dataset(_variables(parts, frame.dims, frame.shape, {}), frame.coordinates, parts[2])


def table_dataset(axes: list[tuple[str, np.ndarray]], winds: np.ndarray,
                   curves: list[tuple[str, str, str, np.ndarray, np.ndarray]], parts: _native.Parts) -> xr.Dataset:
    """A table as xarray has it of its file."""
    known = dict(COORDINATES.values())
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


def concatenated(tables: list[xr.Dataset], key: str, values: np.ndarray) -> xr.Dataset:
    """Tables of scenes that differ in one key, along a dimension of that name."""
    if not tables:
        raise InputError(f"{key}: needs at least one value")
    first = tables[0]
    along = [name for name, variable in first.data_vars.items()
             if "theta" in variable.dims or not all(variable.equals(table[name]) for table in tables)]
    joined = xr.concat(tables, xr.Variable(key, values, KEY_ATTRIBUTES.get(key)), data_vars=along, coords="minimal",
                       compat="override", combine_attrs="drop_conflicts")
    joined.attrs.pop("scene_hash", None)
    if "scene_overrides" in first.attrs:  # those of all but for this key, whose value native_table adds again
        before, _, after = f"\n{first.attrs['scene_overrides']}\n".rpartition(f"\n{key}=")
        rest = after.partition("\n")[2]
        joined.attrs["scene_overrides"] = f"{before}\n{rest}".strip("\n")
    return joined


def native_table(table: xr.Dataset) -> _native.Table:
    """The table that a Dataset holds; a coordinate of one value is an axis of one, one that is a key of the scene its value."""
    keys = [str(name) for name in table.coords if name in KEY_ATTRIBUTES]
    for key in keys:
        if table[key].ndim > 0:
            raise InputError(f"Dataset: has {table[key].size} values of {key}; take one, as with sel({{{key!r}: VALUE}})")
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
    if keys:
        added = [f"{key}={float(table[key])!r}" for key in keys]
        attributes["scene_overrides"] = "\n".join(filter(None, [str(attributes.get("scene_overrides", "")), *added]))
    for name, variable in table.data_vars.items():
        if variable.ndim == 0 and variable.dtype.kind == "S":
            attributes[name] = os.fsdecode(variable.values.item())
    stokes = next((table[name] for name in ("stokes_i", "stokes_q", "stokes_u", "stokes_v") if name in table), None)
    units = "" if stokes is None else str(stokes.attrs.get("units", ""))
    return _native.Table.of(columns, status, units, attributes, "Dataset")


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
