"""Computes response tables, and from such a table the reflectances of a rough surface of any material."""
from __future__ import annotations

import numpy as np
import xarray as xr

from . import _native
from ._arguments import Array, check_names, floats
from ._datasets import table_dataset
from ._native import InputError
from ._points import columns_of
from ._runs import native_evaluator, native_surface, with_axes
from ._scene import Scene

_HINT = "take entries by sel or isel, and compute others instead of interpolating, as in dolp.response(scene, theta_deg=65)"
_ORDER, _ANGLE = "order of a polynomial", "angle between beta"  # dimensions that no user has
_ANGLES = 256  # number of angles at which _distance compares reflectances with polynomials
_AXES = ("theta", "sigma", "q")
_ENTRY = ("albedo", "response_error")  # with the axes and the weights, in the order of dolp::response_fingerprint
_WEIGHTS = ("response_i", "response_q")


def response(scene: Scene, *, evaluator: str | None = None, device: str = "", **axes: Array) -> xr.Dataset:
    """The response table over the scene's grid, with the contents of its file. `moments` converts it to reflectances.

    `axes` (theta_deg, sigma or wind_m_s, q) replace axes of the scene. Material, wavelength and radiation of the scene
    do not matter: for a surface without a material use Scene.for_response. The dimension beta has angles of incidence on a facet. Let r_s and r_p be reflectances of a smooth
    surface at these angles. Then rho_i is the sum of response_i * (r_s + r_p) / 2 over beta, and rho_q is the sum of
    response_q * (r_s - r_p) / 2, if k_s is 1 and there is no diffuse part. With masking smith or v-cavity, emission_i
    and emission_q give the direct emissivities in the same way, from 1 - r_s and 1 - r_p.

    >>> r = dolp.response(scene, theta_deg=[0, 60], sigma=[0.1, 0.2])
    >>> r.response_i.dims, bool(abs(r.response_i.sum("beta") - r.albedo).max() < 1e-12)
    (('theta', 'sigma', 'q', 'beta'), True)
    """
    check_names("axes", axes, ["theta_deg", "sigma", "wind_m_s", "q"])
    contents, (beta, long_name, units, variables) = native_evaluator(scene, evaluator, device).response(with_axes(native_surface(scene), axes))
    table = table_dataset(*contents)
    dims, shape = table.albedo.dims, table.albedo.shape
    table.coords["beta"] = xr.Variable("beta", beta, {"long_name": long_name, "units": units}, {"dtype": beta.dtype})
    for name, meaning, ancillary, has_beta, values in variables:
        known = {"long_name": meaning, "units": "1"} | ({"ancillary_variables": ancillary} if ancillary else {})
        table[name] = xr.Variable((*dims, "beta") if has_beta else dims, values.reshape(*shape, -1) if has_beta
                                  else values.reshape(shape), known, dict(table.albedo.encoding))
    table.albedo.attrs["ancillary_variables"] = "response_error"
    return table


def moments(response: xr.Dataset, *, n: Array | None = None, k: Array | None = None, r_s: xr.DataArray | None = None,
            r_p: xr.DataArray | None = None) -> xr.Dataset:
    """Computes the reflectances rho_i and rho_q of rough materials, their error bound rho_error, and the albedo. The
    specular weight k_s is 1, and there is no diffuse part. `response` is a response table or a part of a table, such as
    `r.sel(theta=60)`. Weights that were not computed, such as after `r.interp(theta=65)` or `r.mean("sigma")`, give an
    InputError: compute them instead, as in `dolp.response(scene, theta_deg=65)`.

    Give n and k of the materials, as for `evaluate`, or the reflectances r_s and r_p of smooth surfaces. r_s and r_p
    are DataArrays over the beta of `response` and may have more dimensions. Between the values of beta, polynomials
    replace the smooth reflectances. If you give n and k, rho_error includes the error of these polynomials, which is
    computed at 256 angles. If you give r_s and r_p, you must add this error, multiplied by the albedo, yourself.

    >>> r = dolp.response(scene, theta_deg=60)
    >>> m = dolp.moments(r, n=[1.3, 1.5, 4], k=0.05)
    >>> m.rho_i.dims, bool(abs(m.rho_i[..., 1] - dolp.table(scene, theta_deg=60).rho_i).max() < 1e-4)
    (('theta', 'sigma', 'q', 'n'), True)
    """
    has_both = r_s is not None and r_p is not None
    if has_both == (n is not None) or (r_s is None) != (r_p is None) or (n is None and k is not None):
        raise InputError("moments: needs either n, and k where it is not 0, or both r_s and r_p")
    _check_entries(response)
    beta = response.beta
    distance = 0.0
    if n is None:
        r_s, r_p = (_at_beta(name, values, beta) for name, values in (("r_s", r_s), ("r_p", r_p)))
        beyond = "; the distance of r_s and r_p from their interpolants comes on top"
    else:
        index, beyond = _index(n, k), ""
        r_s, r_p = _fresnel(index, np.cos(np.deg2rad(beta)))
        distance = _distance(response, index, r_s, r_p)
    try:
        xr.align(response, r_s, r_p, join="exact")
    except ValueError as error:
        raise InputError(f"moments: the coordinates or sizes of the materials and of the response differ: {error}") from None
    mean, half = (r_s + r_p) / 2, (r_s - r_p) / 2
    known = {"rho_i": (response.response_i.dot(mean, "beta"), "hemispherical-directional reflectance, mean of s and p"),
             "rho_q": (response.response_q.dot(half, "beta"),
                       "hemispherical-directional reflectance, half the difference of s and p"),
             "albedo": (response.albedo, response.albedo.attrs.get("long_name", "")),
             "rho_error": (response.response_error * _size(mean, half) + distance * response.albedo,
                           f"bound of the absolute errors of rho_i and rho_q{beyond}")}
    return xr.Dataset({name: values.assign_attrs(long_name=meaning, units="1") for name, (values, meaning) in known.items()})


def _check_entries(response: xr.Dataset) -> None:
    """Errors: InputError if `response` is no response table, or if xarray changed an entry since it was computed."""
    if not isinstance(response, xr.Dataset):
        raise TypeError(f"response: must be an xarray.Dataset, not {type(response).__name__}")
    if "response_i" not in response:
        raise InputError("response: has no response_i, so it is no response table; dolp.response(scene) computes one")
    lacks = [name for name in (*_AXES, "beta", *_ENTRY, *_WEIGHTS, "fingerprint") if name not in response.variables]
    if lacks or "c0" not in response.attrs:
        raise InputError(f"response: lacks {', '.join(lacks) or 'the attribute c0'}, without which nothing shows that its weights "
                         f"are as dolp.response computed them; {_HINT}")
    dims = response.fingerprint.dims
    try:
        columns = [response[name].broadcast_like(response.fingerprint).transpose(*dims) for name in (*_AXES, *_ENTRY)]
        weights = [response[name].transpose(*dims, "beta") for name in _WEIGHTS]
    except ValueError:
        raise InputError(f"response: its variables are not over the same axes, as those of dolp.response are; {_HINT}") from None
    stated = np.atleast_1d(response.fingerprint.values).ravel()
    entries = np.column_stack([*(floats(one.name, one).ravel() for one in columns),
                               *(floats(one.name, one).reshape(stated.size, -1) for one in weights)])
    is_empty = np.isnan(stated) & np.isnan(entries[:, len(columns):]).all(axis=1)  # such entries give NaN
    wrong = np.flatnonzero(~is_empty & (_native.response_fingerprints(entries) != stated))
    if wrong.size:
        where = ", ".join(f"{name} {value:g}" for name, value in zip(_AXES, entries[wrong[0]]))
        raise InputError(f"response: {wrong.size} of {stated.size} entries, the first at {where}, are not as dolp.response computed "
                         f"them; {_HINT}")


def _index(n: Array, k: Array | None) -> xr.DataArray:
    given = {"n": n}
    if k is not None or not np.iscomplexobj(n):
        given["k"] = 0.0 if k is None else k
    frame, columns = columns_of(given)
    if not (np.all(columns["n"] > 0) and np.all(columns["k"] >= 0)):
        raise InputError("moments: n must be above 0, and k from 0 on")
    index = np.broadcast_to(columns["n"] + 1j * columns["k"], int(np.prod(frame.shape))).reshape(frame.shape)
    return xr.DataArray(index, frame.coordinates, frame.dims)


def _fresnel(index: xr.DataArray, cosine: xr.DataArray) -> tuple[xr.DataArray, xr.DataArray]:
    w = np.sqrt((index - 1) * (index + 1) + cosine ** 2)
    return abs((cosine - w) / (cosine + w)) ** 2, abs((index ** 2 * cosine - w) / (index ** 2 * cosine + w)) ** 2


def _coefficients(beta: xr.DataArray) -> xr.DataArray:
    """Matrix that turns values at the angles beta into Chebyshev coefficients of the polynomial through the values."""
    count = beta.size
    values = np.polynomial.chebyshev.chebvander(np.polynomial.chebyshev.chebpts1(count)[::-1], count - 1).T
    return xr.DataArray(values * np.where(np.arange(count) == 0, 1, 2)[:, None] / count, {"beta": beta}, (_ORDER, "beta"))


def _size(mean: xr.DataArray, half: xr.DataArray) -> xr.DataArray:
    """The largest 2^m |a_m|, the factor of response_error in rho_error. The a_m are Chebyshev coefficients of `mean`
    and of `half` / sin^2 beta. `mean` and `half` are half the sum and half the difference of r_s and r_p."""
    growth = xr.DataArray(2.0 ** np.arange(mean.sizes["beta"]), dims=_ORDER)
    curves = mean, half / np.sin(np.deg2rad(mean.beta)) ** 2
    return np.maximum(*((growth * abs(curve.dot(_coefficients(mean.beta), "beta"))).max(_ORDER) for curve in curves))


def _distance(response: xr.Dataset, index: xr.DataArray, r_s: xr.DataArray, r_p: xr.DataArray) -> xr.DataArray:
    """Largest error of the polynomials that replace (r_s + r_p) / 2 and (r_s - r_p) / 2 between the angles beta."""
    beta, c0 = response.beta, float(response.attrs["c0"])
    x = np.polynomial.chebyshev.chebpts1(_ANGLES)
    cosine = xr.DataArray(c0 * np.sinh(0.5 * (1 + x) * np.arcsinh(1 / c0)), dims=_ANGLE)
    polynomials = xr.DataArray(np.polynomial.chebyshev.chebvander(x, beta.size - 1), dims=(_ANGLE, _ORDER))
    between = polynomials.dot(_coefficients(beta), _ORDER)
    s, p = _fresnel(index, cosine)
    mean_off = abs(s + p - (r_s + r_p).dot(between, "beta"))
    half_off = abs(s - p - (1 - cosine ** 2) * ((r_s - r_p) / np.sin(np.deg2rad(beta)) ** 2).dot(between, "beta"))
    return np.maximum(mean_off, half_off).max(_ANGLE) / 2


def _at_beta(name: str, values: xr.DataArray, beta: xr.DataArray) -> xr.DataArray:
    """Returns the reflectances `values`. Errors: InputError if they are not at the angles beta, or not in [0, 1]."""
    if not isinstance(values, xr.DataArray) or "beta" not in values.coords or values.beta.shape != beta.shape \
            or not np.allclose(values.beta, beta):
        raise InputError(f"{name}: must be a DataArray at the angles beta of the response; "
                         f"{name}.interp(beta=response.beta) of one over degrees brings it there")
    checked = floats(name, values)
    if not np.all((checked >= 0) & (checked <= 1)):
        raise InputError(f"{name}: must be numbers in [0, 1]")
    return values.copy(data=checked).assign_coords(beta=beta)
