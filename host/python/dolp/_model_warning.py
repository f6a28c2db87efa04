"""The warning for scenes in which single scattering is not enough."""
from __future__ import annotations

import warnings

from typing import Any

import numpy as np

from ._scene import Scene

_MODEL_INACCURATE = 32  # status bit


class ModelWarning(UserWarning):
    """Warns that the estimated error of the intensity I is above 5 % (status 32), because single scattering loses light
    or the masking function creates light. Also warns that this light may change a fit by more than the uncertainties."""


def warn_of_model(scene: Scene, status: Any, change: float | None = None, stacklevel: int = 3) -> None:
    """Warns once for each scene if an entry has status 32. `change`: the largest relative change of I, if known."""
    if scene._has_model_warning or not np.any(np.asarray(status) & _MODEL_INACCURATE):
        return
    scene._has_model_warning = True
    much = "an estimated more than 5 %" if change is None else f"up to {100 * float(change):.0f} %"
    warnings.warn(f"{scene!r}: single scattering, or a masking that creates light, changes I by {much} at some entries "
                  '(status 32); surface.masking "v-cavity" with surface.scattering "multiple" follows all bounces',
                  ModelWarning, stacklevel=stacklevel)


def warn_of_gap(scene: Scene, gap: float | None, stacklevel: int = 3) -> None:
    """Warns once for each scene if a bracket reaches more than one uncertainty away from a fit. `gap`: this distance."""
    if scene._has_model_warning or gap is None or gap <= 1:
        return
    scene._has_model_warning = True
    warnings.warn(f"{scene!r}: light of further bounces can move the model by {gap:.2g} uncertainties of a point, which the "
                  'intervals of the fit ignore; model_error="bracket" includes it', ModelWarning, stacklevel=stacklevel)
