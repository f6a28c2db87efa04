"""Converts the user's points to columns for the library, and makes the coordinates of the result."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Hashable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from . import _native
from ._arguments import Array, check_names, encodable, floats, input_path, short
from ._native import InputError

# Name and attributes of the coordinate that belongs to each column of points. Table files have the same names.
COORDINATES = {column: (name, {"long_name": long_name, "units": units})
                for column, name, long_name, units in _native.axes()}
COORDINATES |= {name: (name, {"long_name": long_name, "units": "degree"}) for name, long_name in (
    ("theta_i_deg", "zenith angle of incidence"), ("theta_r_deg", "zenith angle of the view"),
    ("delta_phi_deg", "azimuth between the directions, 180 on the specular side"))}
KEY_ATTRIBUTES = {key: {"long_name": meaning, "units": unit} for key, unit, _, _, meaning in _native.keys()}


class Frame(NamedTuple):
    shape: tuple[int, ...]
    dims: tuple[Hashable, ...]
    coordinates: dict[Hashable, xr.Variable]


def columns_of(points: Mapping[str, Array], labels: Mapping[str, list[str]] = {},
               has_keys: bool = False) -> tuple[Frame, dict[str, np.ndarray]]:
    """Broadcasts the arrays of `points`. Returns the shape, dimensions and coordinates of the result, and the points as
    columns for the library. A column has one value for all points, or one value per point.

    `labels`: the known names of materials and bands. Columns have positions in these lists instead of names.
    """
    check_names("points", [name for name in points if not (has_keys and "." in name)], list(COORDINATES))
    points = {name: _positions(name, values, labels[name]) if name in labels else values
              for name, values in with_real_index(points).items()}
    if any(isinstance(values, xr.DataArray) for values in points.values()):
        arrays = {name: values.copy(data=floats(name, values)) if isinstance(values, xr.DataArray)
                  else xr.DataArray(floats(name, values)) for name, values in points.items()}
        try:
            xr.align(*arrays.values(), join="exact")
        except ValueError as error:
            raise InputError(f"points: the coordinates or sizes of DataArrays differ: {error}") from None
        coordinates = {name: coordinate.variable.copy(deep=False)
                       for array in arrays.values() for name, coordinate in array.coords.items()}
        own = {column: array.variable for column, array in arrays.items()}
        arrays = dict(zip(arrays, xr.broadcast(*arrays.values())))
        template = next(iter(arrays.values()))
        points = {name: array.values for name, array in arrays.items()}
        shape, dims = template.shape, template.dims
    else:
        points = {name: floats(name, values) for name, values in points.items()}
        try:
            shape = np.broadcast_shapes(*(values.shape for values in points.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {values.shape}" for name, values in points.items())
            raise InputError(f"points: shapes do not broadcast: {shapes}") from None
        dims, coordinates = _dimensions(points, shape)
        own = {}
    for column, values in points.items():
        name, known = COORDINATES.get(column) or (column, KEY_ATTRIBUTES.get(column, {}))
        if name in coordinates:
            coordinates[name].attrs.update(known)
        elif name in dims and column in own and own[column].dims in ((), (name,)):
            coordinates[name] = own[column].set_dims({name: shape[dims.index(name)]}).copy()
            coordinates[name].attrs.update(known)
        elif name in dims and own:
            raise InputError(f"points: {column} varies along more dimensions than {name}, which are {', '.join(map(str, dims))}; "
                             f"rename the dimension {name}")
        else:
            along = dims if values.ndim > 0 else ()
            coordinates[name] = xr.Variable(along, np.broadcast_to(values, shape) if along else values, known)
    for column in labels.keys() & points.keys():
        at = coordinates[COORDINATES[column][0]]
        if at.dtype.kind == "f":  # positions; a DataArray with a coordinate of names keeps it
            at.data = np.array(labels[column], object)[at.values.astype(int)]
    columns = {name: np.broadcast_to(values, shape if values.ndim > 0 else ()).ravel()
               for name, values in points.items()}
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


def _dimensions(points: Mapping[str, np.ndarray],
                shape: tuple[int, ...]) -> tuple[tuple[str, ...], dict[str, xr.Variable]]:
    """Names and coordinates of the dimensions. Only dimensions along which a single column varies have coordinates."""
    dims, coordinates = [], {}
    for axis, size in enumerate(shape):
        along = [column for column, values in points.items()
                 if values.ndim >= len(shape) - axis and values.shape[axis - len(shape)] == size]
        name = COORDINATES.get(along[0], along)[0] if len(along) == 1 else None
        if name and points[along[0]].size == size and name not in coordinates:
            dims.append(name)
            coordinates[name] = xr.Variable(name, points[along[0]].ravel())
        else:
            dims.append("point" if len(shape) == 1 else f"point_{axis}")
    return tuple(dims), coordinates


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
