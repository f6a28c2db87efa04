"""Stokes parameters in the axes of a camera."""
from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from ._arguments import floats
from ._datasets import read_scene
from ._native import InputError
from ._points import NUMBERS

LEAST_SINE = 1e-9  # of theta; below, rounding decides the direction of the plane of incidence
LEAST_DOLP = 1e-6  # below, light counts as unpolarised; in float a result at normal incidence has a DOLP near 1e-9
BEYOND_DEG = 1e-6  # a zenith so little beyond the zeniths of a result takes the value at its end


def camera_stokes(result: xr.Dataset, normals: Any, view: Any, up: Any) -> xr.Dataset:
    """Stokes parameters in the axes of a camera, with DOLP and angle of polarisation, for a map of surface normals.

    `normals`: vectors to the outside of the surface, shape (..., 3), of any length. `view`: from the surface to the
    camera, shape (3,), or (..., 3) for a camera nearby. `up`: the upper side of the image, shape (3,).
    `result`: stokes_i, stokes_q and stokes_u in the surface's own axes, in one of three forms:
    - Over theta, or at one theta, as from `table` with one value of each other axis. The call interpolates linearly.
    - One value for each normal, over dimensions whose names are no axes of tables. The call takes the values as they are.
    - One value without a theta, for all normals.
    In bistatic mode theta is the zenith of the source: give one value for each normal, or one for all.

    The Dataset has theta_deg (zenith of the camera, from the normal), stokes_i, stokes_q, stokes_u, dolp and aolp_deg.
    Q > 0 is horizontal in the image. aolp_deg counts from the image's right, counter-clockwise, from 0 to 180, and is
    NaN without polarisation. All values are NaN where the normal or the view is NaN, where the normal faces away, and
    where theta is outside `result`. stokes_q, stokes_u and aolp_deg are also NaN where the view is parallel to `up`, and
    where the normal points at the camera although the light is polarised (slopes that differ along and across, or a
    source beside the camera): there the axes of the surface are unknown.

    >>> t = dolp.evaluate(scene, theta_deg=[0, 40, 80])
    >>> seen = dolp.camera_stokes(t, normals=[[0, 0, 1]], view=[1, 0, 1], up=[0, 0, 1])
    >>> float(seen.theta_deg[0].round(6)), float(seen.aolp_deg[0].round(6))
    (45.0, 90.0)
    """
    normals, view, up = _vectors("normals", normals), _vectors("view", view), _vectors("up", up)
    shape = normals.shape[:-1]
    if up.ndim != 1 or view.shape not in ((3,), normals.shape):
        raise InputError(f"view: must have shape (3,) or {normals.shape}, and up (3,), not {view.shape} and {up.shape}")
    with np.errstate(invalid="ignore", divide="ignore"):
        normals, view, up = (_unit(vectors) for vectors in (normals, view, up))
        s = np.cross(view, normals)  # the direction s of the surface, times the sine of theta
        cosine = (view * normals).sum(axis=-1)
        theta = np.where(cosine > 0, np.degrees(np.arctan2(np.linalg.norm(s, axis=-1), cosine)), np.nan)
        right = _unit(np.cross(up, view))
    if np.isnan(up).any() or (view.ndim == 1 and np.isnan(right).any()):
        raise InputError("up: must not be parallel to view, and neither may be 0")
    turn = 2 * np.arctan2((s * np.cross(view, right)).sum(axis=-1), (s * right).sum(axis=-1))
    names = ("stokes_i", "stokes_q", "stokes_u")
    i, q, u = (np.where(np.isnan(theta), np.nan, values) for values in _stokes(result, names, theta))
    with np.errstate(invalid="ignore", divide="ignore"):
        polarised = np.hypot(q, u)
        # A normal that points at the camera has no plane of incidence, and so no axes to turn from.
        turn = np.where((np.linalg.norm(s, axis=-1) < LEAST_SINE) & (polarised > LEAST_DOLP * abs(i)), np.nan, turn)
        q, u = q * np.cos(turn) - u * np.sin(turn), q * np.sin(turn) + u * np.cos(turn)
        aolp = np.where(polarised > 0, np.degrees(np.arctan2(u, q)) / 2 % 180 % 180, np.nan)
        dolp = polarised / i
    dims = tuple(f"point_{axis}" for axis in range(len(shape))) if len(shape) > 1 else ("point",) * len(shape)
    units = {name: result[name].attrs.get("units", "") for name in names}
    units |= {"theta_deg": "degree", "dolp": "1", "aolp_deg": "degree"}
    values = {"theta_deg": theta, "stokes_i": i, "stokes_q": q, "stokes_u": u, "dolp": dolp, "aolp_deg": aolp}
    return xr.Dataset({name: (dims, array, {"units": units[name]}) for name, array in values.items()})


def _vectors(name: str, values: Any) -> np.ndarray:
    array = floats(name, values)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise InputError(f"{name}: must have the shape (..., 3), not {array.shape}")
    return array


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors of length 1 in the same directions; NaN for the vector 0. The largest component is 1 before squares are
    taken, which could overflow or vanish."""
    vectors = vectors / abs(vectors).max(axis=-1, keepdims=True)
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def _stokes(result: xr.Dataset, names: tuple[str, ...], theta: np.ndarray) -> list[np.ndarray]:
    """The values of `result` for each normal."""
    if not isinstance(result, xr.Dataset):
        raise TypeError(f"result: must be an xarray.Dataset, not {type(result).__name__}")
    if lacks := [name for name in names if name not in result]:
        raise InputError(f"result: has no {lacks[0]}")
    if _is_bistatic(result):
        result = result.drop_vars("theta", errors="ignore")  # zeniths of the source
    return [_at(result[name], theta) for name in names]


def _is_bistatic(result: xr.Dataset) -> bool:
    try:
        return "scene" in result.attrs and read_scene(result).value("geometry.mode") == "bistatic"
    except InputError:  # edited attributes, or a file of the scene that is elsewhere
        return False


def _at(values: xr.DataArray, theta: np.ndarray) -> np.ndarray:
    if values.ndim > 0 and values.shape == theta.shape and not NUMBERS.keys() & set(values.dims):
        return values.values
    values = values.squeeze()
    if values.ndim == 0 and "theta" not in values.coords:
        return np.broadcast_to(values.values, theta.shape)
    if values.dims not in ((), ("theta",)):
        raise InputError(f"result: has the dimensions {', '.join(map(str, values.dims))}; select one value of each but "
                         f"theta, or give one value for each normal, with shape {theta.shape}, over dimensions with other names")
    if "theta" not in values.coords:
        raise InputError("result: its dimension theta has no zeniths of the camera (theta is of the source in bistatic mode); "
                         f"give one value for each normal, with shape {theta.shape}, over dimensions with other names")
    known, first = np.unique(values.theta.values, return_index=True)
    within = (theta >= known[0] - BEYOND_DEG) & (theta <= known[-1] + BEYOND_DEG)
    return np.where(within, np.interp(theta, known, np.atleast_1d(values.values)[first]), np.nan)
