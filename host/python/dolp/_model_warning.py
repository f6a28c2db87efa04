"""The warning about scenes for which single scattering is not enough."""
from __future__ import annotations

import warnings

import numpy as np
import xarray as xr

from ._scene import Scene

_MODEL_INACCURATE = 32  # bit of the status


class ModelWarning(UserWarning):
    """Single scattering, or a masking that creates light, changes I by an estimated more than 5 % (status 32)."""


def warn_of_model(scene: Scene, results: xr.Dataset, stacklevel: int = 3) -> None:
    """Warns once for each scene if a result has the bit."""
    if scene._has_model_warning or not np.any(results.get("status", np.zeros(1, np.int32)) & _MODEL_INACCURATE):
        return
    scene._has_model_warning = True
    change = results.attrs.get("model_change")
    much = "an estimated more than 5 %" if change is None else f"up to {100 * float(change):.0f} %"
    warnings.warn(f"{scene!r}: single scattering, or a masking that creates light, changes I by {much} at some entries "
                  '(status 32); surface.masking "v-cavity" with surface.scattering "multiple" follows all bounces',
                  ModelWarning, stacklevel=stacklevel)
