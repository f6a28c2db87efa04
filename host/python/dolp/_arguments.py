"""Checks arguments of calls, and converts them to the types that the library takes."""
from __future__ import annotations

import difflib
import operator
import os
import sys
import warnings
from collections.abc import Iterable, Mapping
from typing import Any, Union

import numpy as np
import xarray as xr

from . import _native
from ._native import InputError

Path = Union[str, bytes, "os.PathLike[str]"]
Array = Union[float, "np.ndarray", "xr.DataArray", "list[float]"]


class MissingFileError(InputError, FileNotFoundError):
    """A file that a call should read does not exist."""


def warn(text: str, category: type[Warning]) -> None:
    """Issues a warning at the line of the user's program that called this package."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back and frame.f_code.co_filename.startswith(os.path.dirname(__file__) + os.sep):
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)


def check_mapping(name: str, values: Mapping[str, Any] | None) -> Mapping[str, Any]:
    if values is None or isinstance(values, Mapping):
        return values or {}
    raise TypeError(f"{name}: must be a dictionary with keys of a scene, not {type(values).__name__}")


def native_path(name: str, path: Path) -> str:
    if isinstance(path, (str, bytes, os.PathLike)):
        text = os.fsdecode(path)
        if "\0" in text:
            raise InputError(f"{name} = {short(text)}: no path holds a zero byte")
        return encodable(name, text, "surrogateescape")
    raise TypeError(f"{name}: must be a path, not {type(path).__name__}")


def encodable(name: str, text: str, errors: str = "strict") -> str:
    """Returns `text` if UTF-8 can encode it. Errors: InputError for a surrogate without the other half of its pair."""
    try:
        text.encode("utf-8", errors)
    except UnicodeEncodeError:
        raise InputError(f"{name} = {short(text)}: holds a surrogate without its other half, which is no character") from None
    return text


def input_path(name: str, path: Path) -> str:
    text = native_path(name, path)
    try:
        os.stat(text)
    except (FileNotFoundError, NotADirectoryError, ValueError):
        raise MissingFileError(f"{text}: there is no such file") from None
    except OSError as error:
        raise InputError(f"{text}: cannot be read: {error.strerror}") from None
    return text


def check_key(key: str) -> str:
    if isinstance(key, str):
        return encodable("key", key)
    raise TypeError(f"{short(key)}: a key of a scene must be a str, not {type(key).__name__}")


def word_list(key: str, words: Iterable[str]) -> list[str]:
    if isinstance(words, str) or not isinstance(words, Iterable):
        raise TypeError(f"{key}: must be a list of values, not {type(words).__name__}")
    return [encodable(key, str(word)) for word in words]


def whole_number(name: str, value: int) -> int:
    try:
        if 0 <= (count := operator.index(value)) < 2**63:
            return count
    except TypeError:
        raise TypeError(f"{name}: must be a whole number, not {type(value).__name__}") from None
    raise InputError(f"{name} = {short(value)}: must be a whole number from 0 to 2^63 - 1")


def word(name: str, value: Any) -> str:
    if isinstance(value, str):
        return encodable(name, value)
    raise TypeError(f"{name}: must be a str, not {type(value).__name__}")


def device_name(device: Any) -> str:
    """A device as text: a part of its name, or its position in `devices()`."""
    return str(device) if isinstance(device, (int, np.integer)) else word("device", device)


def flag(name: str, value: Any) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise TypeError(f"{name}: must be True or False, not {short(value)}")


def axis_values(name: str, values: Any) -> list[float]:
    if isinstance(values, str):
        raise InputError(f"{name}: {short(values)} is a text; numpy.linspace(first, last, count) makes a range of numbers")
    array = floats(name, values)
    if array.ndim > 1:
        raise InputError(f"{name}: must be a number or a list, not an array of shape {array.shape}")
    return np.atleast_1d(array).tolist()


def label_values(values: Any) -> Any:
    """The values of an axis of materials (one name or several) or of bands (one pair of wavelengths or several)."""
    return values if isinstance(values, str) else np.asarray(values).tolist()


def check_names(what: str, given: Iterable[str], known: list[str]) -> None:
    """Checks that `known` contains all `given` names. Errors: InputError, which suggests a similar name."""
    for name in given:
        if name in known:
            continue
        meant = (_native.key_by_meaning(name) or "").split(".")[-1]
        near = ([axis for axis in known if axis.startswith(f"{name}_")] or [axis for axis in known if axis == meant]
                or difflib.get_close_matches(name, known, 1))
        keys = [key for key, *_ in _native.keys() if key.split(".")[-1] == name]
        if "." in name:
            near, keys = [], [name]
        hint = f"; did you mean {near[0]}?" if near else f'; it is a key of the scene: scene.with_({{"{keys[0]}": ...}})' if keys else ""
        raise InputError(f"{what}: {name} is none of {', '.join(known)}{hint}")


def floats(name: str, values: Any) -> np.ndarray:
    """Converts values to floats. Errors: InputError for values that are not numbers, and for masked arrays."""
    if isinstance(values, np.ma.MaskedArray):
        raise InputError(f"{name}: is a masked array, and results have no mask: fill or compress it")
    try:
        array = np.asarray(values)
        if array.dtype.kind in "biuf" or (array.dtype.kind == "O" and None not in array.ravel().tolist()):
            return array.astype(float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name}: {short(values)} are no numbers of double precision") from None
    raise InputError(f"{name}: {short(values)} are no numbers but {array.dtype}")


def short(value: Any) -> str:
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # Python does not print whole numbers of several thousand digits
        return f"a {type(value).__name__} of very many digits"
    return text if len(text) <= 60 else f"{text[:57]}..."


def native_values(overrides: Mapping[str, Any] | None) -> list[tuple[str, Any]]:
    values: list[tuple[str, Any]] = []
    for key, value in check_mapping("overrides", overrides).items():
        check_key(key)
        if isinstance(value, Mapping) and "." not in key:  # a whole table of keys
            if not value:
                raise InputError(f"{key}: is an empty dictionary; None removes a table")
            values += native_values({f"{key}.{check_key(name)}": item for name, item in value.items()})
        elif key == "surface.coating" and value is not None:
            values += [(key, None), *native_values(_film_keys(key, value))]
        elif key.endswith(".n") and np.ndim(value) == 0 and np.iscomplexobj(value):
            if (k := f"{key[:-1]}k") in overrides:
                raise InputError(f"{key}: is complex, so that {k} cannot be given too")
            values += [(key, float(np.real(value))), (k, float(np.imag(value)))]
        else:
            values.append((key, _value(key, value)))
    return values


def _film_keys(key: str, films: Any) -> dict[str, Any]:
    """Keys of single films, such as surface.coating.1.thickness_um, from a list with a dictionary for each film."""
    if not isinstance(films, (list, tuple)) or not all(isinstance(film, Mapping) and film for film in films):
        raise InputError(f"{key}: must be a list of dictionaries, as in [{{'material': 'PMMA acrylic', 'thickness_um': 2}}]")
    return {f"{key}.{i}.{check_key(name)}": value for i, film in enumerate(films, 1) for name, value in film.items()}


def _value(key: str, value: Any) -> Any:
    """Converts the value of a scene key to None, bool, float, str, a list, or (for a range of numbers) a dictionary."""
    if value is None or isinstance(value, (bool, np.bool_)):
        return None if value is None else bool(value)
    if isinstance(value, (str, bytes, os.PathLike)):
        return os.fsdecode(value)
    if isinstance(value, Mapping):
        return {name: str(item) if name == "spacing" else whole_number(f"{key}.count", item) if name == "count"
                else float(floats(f"{key}.{name}", item)) for name, item in value.items()}
    if key in ("grid.material", "grid.band_um"):
        return label_values(value)
    numbers = floats(key, value)
    return float(numbers) if numbers.ndim == 0 else axis_values(key, numbers)
