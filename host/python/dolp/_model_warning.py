"""The warning for scenes in which single scattering is not enough."""
from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np

from ._arguments import warn
from ._scene import Scene

_MODEL_INACCURATE = 32  # status bit


class ModelWarning(UserWarning):
    """Warns that the estimated error of the intensity I or of DOLP is above 5 % (status 32), because single scattering
    loses light or the masking function creates light. Also warns that this light may change a fit by more than the
    uncertainties."""


def warn_of_model(scene: Scene, status: Any, attributes: Mapping[Hashable, Any] | None = None) -> None:
    """Warns once for each scene if an entry has status 32. `attributes`: those of the results, with the largest changes
    of I and of DOLP."""
    if scene._has_model_warning or not np.any(np.asarray(status) & _MODEL_INACCURATE):
        return
    scene._has_model_warning = True
    much = "I or DOLP by an estimated more than 5 %"
    if attributes and "model_change_dolp" in attributes:
        much = (f"I by up to {100 * float(attributes['model_change']):.2g} % and DOLP by up to "
                f"{float(attributes['model_change_dolp']):.2g} points")
    warn(f"{scene!r}: light that single scattering loses, or that the masking creates, changes {much} "
         f"(status 32); {scene._native.model_advice()}", ModelWarning)


def warn_of_gap(scene: Scene, gap: float | None) -> None:
    """Warns once for each scene if a bracket reaches more than one uncertainty away from a fit. `gap`: this distance."""
    if scene._has_model_warning or gap is None or gap <= 1:
        return
    scene._has_model_warning = True
    warn(f"{scene!r}: light of further bounces can move the model by {gap:.2g} uncertainties of a point, which the "
         'intervals of the fit ignore; model_error="bracket" includes it', ModelWarning)
