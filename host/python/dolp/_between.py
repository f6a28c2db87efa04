"""Lookups in a table with a scene key as an axis. They interpolate between the computed values of this key."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from ._arguments import floats
from ._native import InputError

_MOST = 5  # most values of the key that a lookup uses: four give the result, a fifth gives the error estimate
_LEAST = 3  # with fewer values of the key the error estimate is infinite
_SAFETY = 16.0  # error estimate / change of the result by one more value of the key; equal to kInside in core/table
_MISSED, _RHO_MISSED = 2, 16  # status bits: DOLP, or rho, misses its tolerance
_SMOOTH = ("stokes_i", "stokes_q", "stokes_u", "stokes_v", "rho_i", "rho_q", "albedo", "emissivity_s", "emissivity_p",
           "dolp_low", "dolp_high")


def between_tables(table: xr.Dataset, key: str, at: Any, look_up: Callable[[xr.Dataset], xr.Dataset]) -> xr.Dataset:
    """The results at the value `at` of a scene key. The key is a dimension of the table. A polynomial interpolates
    between the results that `look_up` returns at the two to four nearest values of the key.

    A second polynomial uses one more value. The error estimate includes `_SAFETY` times the difference of the two
    polynomials. Errors: InputError if `at` is outside the table.
    """
    value = floats(key, at)
    if value.ndim > 0:
        raise InputError(f"{key}: must be one number; call lookup for each")
    known = np.sort(np.asarray(table[key].values, float))
    if not known[0] <= value <= known[-1]:
        raise InputError(f"{key} = {float(value)!r}: outside the table, which has [{known[0]!r}, {known[-1]!r}]")
    if value in known:
        return look_up(table.sel({key: float(value)}))
    nearest = np.sort(known[np.argsort(abs(known - value), kind="stable")[:_MOST]])
    parts = [look_up(table.sel({key: float(x)})) for x in nearest]
    near = np.argsort(abs(nearest - value), kind="stable")
    used = near[:max(2, min(4, len(near) - 1))]
    weights, others = _weights(nearest, used, float(value)), _weights(nearest, near if len(near) > len(used) else used[:-1],
                                                                      float(value))
    result = parts[int(near[0])].copy()
    change = {}
    for name in set(_SMOOTH) & set(result.data_vars):
        values = np.stack([part[name].values for part in parts])
        result[name] = result[name].copy(data=np.tensordot(weights, values, 1))
        change[name] = _SAFETY * abs(np.tensordot(others - weights, values, 1)) if len(near) >= _LEAST else np.inf
    intensity = abs(result.stokes_i.values)
    polarised = np.hypot(result.stokes_q.values, result.stokes_u.values)
    with np.errstate(divide="ignore", invalid="ignore"):
        result["dolp"] = result.dolp.copy(data=polarised / result.stokes_i.values)
        if "q_over_i" in result:
            result["q_over_i"] = result.q_over_i.copy(data=result.stokes_q.values / result.stokes_i.values)
        own = np.tensordot(abs(weights), np.stack([part.error_estimate.values for part in parts]), 1)
        changed = np.hypot(change["stokes_q"], change["stokes_u"]) + polarised / intensity * change["stokes_i"]
        result["error_estimate"] = result.error_estimate.copy(data=own + changed / intensity)
        if "rho_error_estimate" in result and "rho_i" in change:
            own = np.tensordot(abs(weights), np.stack([part.rho_error_estimate.values for part in parts]), 1)
            changed = np.maximum(change["rho_i"], change["rho_q"]) / abs(result.rho_i.values)
            result["rho_error_estimate"] = result.rho_error_estimate.copy(data=own + changed)
    status = np.bitwise_or.reduce([part.status.values.astype(int) & ~(_MISSED | _RHO_MISSED) for part in parts])
    tolerance = float(table.attrs.get("tolerance", np.inf))
    status |= np.where(result.error_estimate.values > tolerance, _MISSED, 0)
    if "rho_error_estimate" in result:
        status |= np.where(result.rho_error_estimate.values > tolerance, _RHO_MISSED, 0)
    result["status"] = result.status.copy(data=status.astype(result.status.dtype))
    return result.assign_coords({key: float(value)})


def _weights(values: np.ndarray, used: np.ndarray, at: float) -> np.ndarray:
    """Lagrange weights of `values` for interpolation at `at`. Only values at the positions `used` have a weight."""
    weights = np.zeros(len(values))
    for i in used:
        weights[i] = np.prod([(at - values[j]) / (values[i] - values[j]) for j in used if j != i])
    return weights
