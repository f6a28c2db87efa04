"""Fits values of a scene's keys to measured data."""
from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from ._arguments import Path, check_key, check_mapping, check_names, floats, native_path, native_values, whole_number, word, word_list
from ._native import InputError
from ._points import csv_of
from ._runs import evaluate, native_evaluator, native_scene
from ._scene import Scene


_SYMBOLS = {"dolp": "DOLP", "q_over_i": "Q/I", "emissivity_s": "ε_s", "emissivity_p": "ε_p"}


class Fit:
    """The result of a fit. `print` shows it as a report.

    `params`: dictionary of the fitted values; `fit[key]` is one of them.
    `stderr`: dictionary of the standard errors of these values. A parameter has no standard error (None) if it is at a
    bound, if its error would reach beyond its range, or if the data do not determine it. `why_no_error` in the
    parameter's entry of values["parameters"] gives the reason. The standard errors of other parameters assume that
    parameters at a bound stay there.
    `covariance`: matrix in the order of `params`; NaN for a parameter without a standard error.
    `scene`: the scene with the fitted values, and with the best of the models that the argument `compare` asks for.
    `fit_quality`: "good", "doubtful" (p < 0.05), "bad" (p < 0.001), or None without a p-value. Also doubtful if light of
    further bounces can move the model by more than an uncertainty, unless model_error="bracket" accounts for it.
    `values`: the report of `dolp fit --json` as a dictionary, with parameters, correlation, chi_square,
    reduced_chi_square, p_value, aic, bic, minima, residuals, models, alike, ranges.
    """

    def __init__(self, text: str, values: dict[str, Any], scene: Scene, overrides: dict[str, Mapping[str, Any]]) -> None:
        self.text, self.values, self.scene, self._overrides = text, values, scene, overrides
        self.params: dict[str, float] = {one["key"]: one["value"] for one in values["parameters"]}
        self.stderr: dict[str, float | None] = {one["key"]: one["standard_error"] for one in values["parameters"]}
        self.fit_quality: str | None = values["fit_quality"]

    def __getitem__(self, key: str) -> float:
        """The fitted value of a parameter."""
        check_names("fit", [key], list(self.params))
        return self.params[key]

    @property
    def covariance(self) -> np.ndarray:
        """The covariance matrix of the parameters, in the order of `params`."""
        errors = np.array(list(self.stderr.values()), dtype=float)
        return np.array(self.values["correlation"], dtype=float) * np.outer(errors, errors)

    def conf_interval(self, level: float = 0.95, *, scaled: bool = False) -> dict[str, tuple[float | None, float | None] | None]:
        """Confidence intervals at a level of 0.68 or 0.95. An end is None if the data do not limit the parameter there.
        An interval is None if the data exclude all values. `scaled`: if the p-value is below 0.05, multiplies
        all uncertainties by sqrt(reduced chi^2).
        """
        if level not in (0.68, 0.95):
            raise InputError(f"level = {level}: must be 0.68 or 0.95")
        ends = {one["key"]: one[f"interval_{100 * level:.0f}"] for one in self.values["parameters"]}
        if scaled:
            ends |= {one["key"]: one.get(f"scaled_{100 * level:.0f}", ends[one["key"]]) for one in self.values["parameters"]}
        return {key: both and tuple(both) for key, both in ends.items()}

    def plot(self, axes: Any = None) -> Any:
        """Draws data, model and bracket (dolp_low to dolp_high) over zenith with Matplotlib. Returns the axes."""
        import matplotlib.pyplot as plt
        axes = plt.subplots()[1] if axes is None else axes
        sets: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
        for point in self.values["points"]:
            sets.setdefault((point["data"], point["quantity"], point["wavelength_um"]), []).append(point)
        for (name, quantity, wavelength_um), points in sets.items():
            theta = [point["theta_deg"] for point in points]
            measured, errors = ([100.0 * (point[column] or 0.0) for point in points] for column in ("measured", "uncertainty"))
            label = ", ".join([_SYMBOLS[quantity], *([f"{wavelength_um:g} µm"] if wavelength_um else []),
                               *([name] if len(self._overrides) > 1 else [])])
            bars = axes.errorbar(theta, measured, errors, fmt="o", markersize=4, label=label)
            zeniths = np.linspace(min(theta), max(theta), 181)
            curve, bracket = self._model(name, quantity, {"theta_deg": zeniths} | (
                {"wavelength_um": wavelength_um} if wavelength_um else {}))
            axes.plot(zeniths, 100.0 * curve, color=bars[0].get_color())
            if bracket:
                axes.fill_between(zeniths, 100.0 * bracket[0], 100.0 * bracket[1], color="0.75", alpha=0.5, linewidth=0.0,
                                  label="bracket of all bounces")
        axes.set(xlabel="zenith angle θ (degree)", title=self.scene.title or "fit",
                 ylabel=", ".join(dict.fromkeys(_SYMBOLS[quantity] for _, quantity, _ in sets)) + " (%)")
        axes.legend()
        return axes

    def _model(self, name: str, quantity: str, points: dict[str, Any]) -> tuple[xr.DataArray, tuple[Any, Any] | None]:
        """Values of the fitted model for a data set, and both ends of its bracket (None if there is no bracket)."""
        scene = self.scene.with_(self._overrides[name])
        try:
            own = evaluate(scene.with_({"emission.bracket": True}), evaluator="cpu", **points)
        except InputError:  # the scene allows no bracket
            return evaluate(scene, evaluator="cpu", **points)[quantity], None
        if quantity == "dolp":
            return own.dolp, (own.dolp_low, own.dolp_high)
        other = evaluate(scene.with_({"emission.model": "moments" if scene["emission.model"] == "direct" else "direct"}),
                         evaluator="cpu", **points)[quantity]
        return own[quantity], (np.minimum(own[quantity], other), np.maximum(own[quantity], other))

    def __repr__(self) -> str:
        return self.text


def fit(scene: Scene, data: Any, vary: Mapping[str, tuple[float, ...]], *, compare: Mapping[str, Iterable[str]] | None = None,
        loss: str = "squares", model_error: str = "none", starts: int = 24, seed: int = 1, plot: Path | None = None,
        evaluator: str | None = None, device: str = "") -> Fit:
    """Fits values of a scene's keys to measured data. Also computes confidence intervals.

    `data`: a CSV file, or columns by name (a dictionary, a Dataset, a pandas DataFrame). A data set needs a zenith
    (theta_deg, or theta_i_deg of a bistatic scene) and one quantity: dolp, q_over_i (signed), or emissivities
    (emissivity_s, emissivity_p, or both). It may have uncertainty (one standard deviation) and wavelength_um. `data`
    can be a list of data sets. An item of the list can be a pair (data set, overrides of the scene for this set).
    `vary`: (low, high) or (low, high, start) for each key to fit.
    `compare`: lists of values for other keys. One model for each combination of these values is fitted and ranked.
    `loss`: squares. For data with outliers: huber, soft-l1, cauchy or tukey.
    `model_error`: none, or bracket. With bracket, the true value at each point may lie anywhere between dolp_low and
    dolp_high. With none, dolp.ModelWarning appears if single scattering is not accurate enough (status 32), or if the
    bracket of a point reaches more than one uncertainty away from the fit.
    `plot`: a .png, .pdf or .svg file, to which the fit draws data, model, residuals and contours.

    >>> truth = dolp.evaluate(scene, theta_deg=np.arange(5, 85, 5), n=1.6)
    >>> data = {"theta_deg": truth.theta, "dolp": truth.dolp, "uncertainty": np.full(16, 0.001)}
    >>> found = dolp.fit(scene, data, {"surface.n": (1.1, 3)})
    >>> round(found.params["surface.n"], 4), found.conf_interval()["surface.n"][0] < 1.6, found.covariance.shape
    (1.6, True, (1, 1))
    """
    native = native_scene(scene)
    sets = [one if isinstance(one, tuple) else (one, {}) for one in (data if isinstance(data, list) else [data])]
    if any(len(one) != 2 for one in sets):
        raise InputError("data: a set of its own must be a pair (data, overrides)")
    texts = [(csv_of(columns), native_values(overrides)) for columns, overrides in sets]
    ranges = [(check_key(key), floats(key, ends).ravel().tolist()) for key, ends in check_mapping("vary", vary).items()]
    compared = [(check_key(key), word_list(key, words)) for key, words in check_mapping("compare", compare).items()]
    text, values, found = native_evaluator(scene, evaluator, device).fit(
        native, texts, ranges, compared, word("loss", loss), word("model_error", model_error), whole_number("starts", starts), whole_number("seed", seed),
        "" if plot is None else native_path("plot", plot))
    fitted = Scene.__new__(Scene)
    fitted._native = found
    report = json.loads(values)
    if model_error == "none":
        scene._warn_of_model(report["status"])
        scene._warn_of_gap(report["model_gap_in_uncertainties"])
    names = ["data"] if len(sets) == 1 else [f"data{i + 1}" for i in range(len(sets))]
    return Fit(text, report, fitted, {name: own or {} for name, (_, own) in zip(names, sets)})
