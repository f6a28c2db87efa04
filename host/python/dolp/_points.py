"""Converts the user's points to columns for the library, and makes the coordinates of the result."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Hashable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from . import _native
from ._arguments import Array, encodable, floats, input_path, short
from ._native import InputError

# Name and attributes of the coordinate that belongs to each column of points. Table files have the same names.
COORDINATES = {column: (name, {"long_name": long_name, "units": units})
                for column, name, long_name, units in _native.axes()}
COORDINATES |= {name: (name, {"long_name": long_name, "units": "degree"}) for name, long_name in (
    ("theta_i_deg", "zenith angle of incidence"), ("theta_r_deg", "zenith angle of the view"),
    ("delta_phi_deg", "azimuth between the directions, 180 on the specular side"))}
KEY_ATTRIBUTES = {key: {"long_name": meaning, "units": unit} for key, unit, _, _, meaning in _native.keys()}
# The argument of a call that gives each coordinate of tables; some coordinates follow from other numbers.
NUMBERS = {name: column for column, (name, _) in COORDINATES.items()} | {key: key for key in KEY_ATTRIBUTES} | {
    "material_name": "material", "band_low": "band_um", "band_high": "band_um", "index_n": "n", "index_k": "k",
    "irradiance": "source.irradiance"}


class Frame(NamedTuple):
    shape: tuple[int, ...]
    dims: tuple[Hashable, ...]
    coordinates: dict[Hashable, xr.Variable]


def without_unused(points: Mapping[str, Array]) -> dict[str, Array]:
    """Drops coordinates of DataArrays that name numbers of a scene, such as the sigma of `t.sel(sigma=0.4).theta`, because
    the call does not use them. Errors: InputError if an index of a DataArray has values of a number that is not given."""
    used = dict(points)
    for column, values in points.items():
        for name in values.coords if isinstance(values, xr.DataArray) else ():
            if name not in values.indexes:
                used[column] = used[column].drop_vars(name) if name in NUMBERS else used[column]
            elif NUMBERS.get(name, column) not in points and values[name].dtype.kind in "iuf":
                raise InputError(f"points: {column} has a value for each {name}, but {NUMBERS[name]} is not given; give it too, or "
                                 f"rename the coordinate {name}")
    return used


def columns_of(points: Mapping[str, Array], labels: Mapping[str, list[str]] = {}) -> tuple[Frame, dict[str, np.ndarray]]:
    """Broadcasts the arrays of `points`. Returns the shape, dimensions and coordinates of the result, and the points as
    columns for the library. A column has one value for all points, or one value per point.

    `labels`: the known names of materials and bands. Columns have positions in these lists instead of names.
    """
    points = {name: _positions(name, values, labels[name]) if name in labels else values
              for name, values in with_real_index(points).items()}
    arrays = {name: floats(name, values) for name, values in points.items()}
    named = [values for values in points.values() if isinstance(values, xr.DataArray)]
    if any(values.ndim for values in named):
        shape, dims, variables = _along_named(points, arrays)
    else:
        try:
            shape = np.broadcast_shapes(*(values.shape for values in arrays.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {values.shape}" for name, values in arrays.items())
            raise InputError(f"points: shapes do not broadcast: {shapes}") from None
        dims, variables = _along_axes(arrays, shape)
    coordinates = {name: coordinate.variable.copy(deep=False) for values in named for name, coordinate in values.coords.items()}
    levels = {name for values in named for name in values.indexes if name not in values.dims}  # of stacked dimensions
    for column, variable in variables.items():
        name, known = COORDINATES.get(column) or (column, KEY_ATTRIBUTES.get(column, {}))
        if name in dims:
            if not set(variable.dims) <= {name}:
                raise InputError(f"points: {column} varies along more dimensions than {name}, which are {', '.join(map(str, dims))}; "
                                 f"rename the dimension {name}")
            variable = variable.set_dims({name: shape[dims.index(name)]})
        values = np.array(labels[column], object)[variable.values.astype(int)] if column in labels else variable.values
        if name not in levels:
            coordinates[name] = xr.Variable(variable.dims, values, known)
        elif not np.array_equal(coordinates[name].values, values):
            raise InputError(f"points: {column} differs from the {name} that a stacked dimension has; remove it by reset_index")
    columns = {column: (variable.set_dims(dict(zip(dims, shape))) if variable.ndim else variable).values.ravel()
               for column, variable in variables.items()}
    return Frame(shape, dims, coordinates), columns


def _positions(name: str, values: Any, labels: list[str]) -> Any:
    """The position in `labels` of each value. A value is a label, or a part of a label that no other label has."""
    def position(value: Any) -> float:
        wanted = str(value).casefold()
        alike = [i for i, label in enumerate(labels) if wanted in label.casefold()]
        alike = alike if wanted else []
        same = [i for i in alike if labels[i].casefold() == wanted]
        if len(same or alike) != 1:
            known = f"one of {', '.join(labels)}" if labels else f"absent: there is no axis of {name}"
            raise InputError(f"points: {name} = {short(value)}: must be {known}")
        return float((same or alike)[0])

    array = np.asarray(values, object)
    positions = np.array([position(value) for value in array.ravel()]).reshape(array.shape)
    return values.copy(data=positions) if isinstance(values, xr.DataArray) else positions


def _along_named(points: Mapping[str, Array], arrays: Mapping[str, np.ndarray]
                 ) -> tuple[tuple[int, ...], tuple[Hashable, ...], dict[str, xr.Variable]]:
    """The shape and dimensions to which the DataArrays in `points` broadcast, and each column along its dimensions.
    Other arrays have this shape, or are numbers."""
    named = [values for values in points.values() if isinstance(values, xr.DataArray)]
    try:
        xr.align(*named, join="exact")
    except ValueError as error:
        raise InputError(f"points: the coordinates or sizes of DataArrays differ: {error}") from None
    whole = xr.broadcast(*named)[0]
    for name, array in arrays.items():
        if not isinstance(points[name], xr.DataArray) and array.shape not in ((), whole.shape):
            raise InputError(f"points: {name} has the shape {array.shape}, and the DataArrays have the dimensions "
                             f"{', '.join(map(str, whole.dims))} with the shape {whole.shape}; give an array of this shape, or a DataArray")
    dims = {name: getattr(points[name], "dims", whole.dims if array.ndim else ()) for name, array in arrays.items()}
    return whole.shape, whole.dims, {name: xr.Variable(dims[name], array) for name, array in arrays.items()}


def _along_axes(arrays: Mapping[str, np.ndarray], shape: tuple[int, ...]) -> tuple[tuple[str, ...], dict[str, xr.Variable]]:
    """Names of the dimensions of `shape`, and each column along its dimensions. A dimension has the name of a column only
    if no other column varies along it."""
    dims: list[str] = []
    alone = {}
    for axis, size in enumerate(shape):
        along = [column for column, values in arrays.items()
                 if values.ndim >= len(shape) - axis and values.shape[axis - len(shape)] == size]
        name = COORDINATES.get(along[0], along)[0] if len(along) == 1 else None
        if name and arrays[along[0]].size == size and name not in dims:
            dims.append(name)
            alone[along[0]] = xr.Variable(name, arrays[along[0]].ravel())
        else:
            dims.append("point" if len(shape) == 1 else f"point_{axis}")
    return tuple(dims), {column: alone[column] if column in alone else xr.Variable(dims, np.broadcast_to(values, shape)) if values.ndim
                         else xr.Variable((), values) for column, values in arrays.items()}


def with_real_index(points: Mapping[str, Array]) -> Mapping[str, Array]:
    if not np.iscomplexobj(points.get("n")):
        return points
    if "k" in points:
        raise InputError("n: is complex, so that k cannot be given too")
    index = points["n"]
    index = index if isinstance(index, xr.DataArray) else np.asarray(index)
    return {**points, "n": index.real, "k": index.imag}


def csv_of(data: Any) -> str:
    """Measured data as CSV text, from the path of a CSV file or from columns by name."""
    if isinstance(data, (str, bytes, os.PathLike)):
        path = input_path("data", data)
        try:
            return pathlib.Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error.reason}") from None
    if not (isinstance(data, Mapping) or hasattr(data, "keys")):
        raise TypeError(f"data: must be a path or columns by name, not {type(data).__name__}")
    if isinstance(data, xr.Dataset):  # coordinates of a Dataset have other names than columns: theta, not theta_deg
        data = data.rename({name: column for column, (name, _) in COORDINATES.items() if name in data.variables})
    names = list(data.variables) if isinstance(data, xr.Dataset) else list(data.keys())
    columns = [floats(name, data[name]) for name in names]
    if len({column.shape for column in columns if column.ndim > 0}) > 1:
        sizes = ", ".join(f"{name} {column.shape}" for name, column in zip(names, columns))
        raise InputError(f"data: columns of different lengths: {sizes}")
    columns = np.broadcast_arrays(*columns)
    rows = zip(*(column.ravel().tolist() for column in columns))
    return encodable("data", "\n".join([",".join(names), *(",".join(map(repr, row)) for row in rows)]) + "\n")
