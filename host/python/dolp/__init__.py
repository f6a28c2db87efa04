"""dolp: infrared degree of linear polarisation (DOLP) of rough surfaces.

>>> import dolp
>>> scene = dolp.Scene(text='''
... [surface]
... n = 1.5
... k = 0.05
... sigma = 0.2
... q = 3.0
... masking = "smith"
... [emission]
... temperature_K = 300.0
... [spectrum]
... wavelength_um = 10.0
... [grid]
... theta_deg = {from = 0, to = 80, count = 5}
... ''')
>>> dolp.evaluate(scene, theta_deg=[0, 40, 80]).dolp.values.round(4)
array([0.    , 0.0295, 0.1346])

Scene                   a scene: a file or a text, with other values of its keys
table, write_table      the quantities over the scene's grid: a Dataset, or a file
evaluate, mueller       the same at points; Mueller matrices of pairs of directions
lookup                  a table between its entries
response, moments       a table for any material; reflectances of materials from it
fit                     numbers of a scene from measured data
plan                    what a table would compute and cost
material                n and k of a built-in material
devices, keys, materials, citation

Names and units are those of scene files and tables: angles in degrees, wavelengths in um, temperatures in K. Results are
xarray Datasets with the variables, units and meanings that table files have, and the same bits that the command line
computes; `dataset.dolp.plot()` draws. Every entry has its error bound in `error_estimate`.

The device and its kernels are kept between calls. A long call lets Python's other threads run, and Ctrl-C ends it. A
process that was forked from one that has used a Vulkan device gets a DeviceError: start processes afresh
(multiprocessing.set_start_method("spawn")), or take evaluator="cpu". Errors: InputError (a ValueError) with one line
that says what is allowed, DeviceError (a RuntimeError), IoError (an OSError); a TypeError for arguments of another kind;
MemoryError. A file that is to be read and is not there is a MissingFileError (an InputError and a FileNotFoundError).
Input that was probably meant otherwise (percent, Celsius, nanometres), or a file without k, gives an InputWarning; a scene
for which single scattering is not enough (status 32) gives one ModelWarning. Masked arrays are refused, because results
have no mask: fill or compress them.
"""
from __future__ import annotations

from . import _native
from ._arguments import MissingFileError
from ._fit import Fit, fit
from ._model_warning import ModelWarning
from ._native import DeviceError, InputError, InputWarning, IoError
from ._response import moments, response
from ._runs import Plan, devices, evaluate, lookup, mueller, plan, table, write_table
from ._scene import Material, Scene, keys, material, materials

# The exceptions stand in the text above: with them `help` would print the methods of Python's own.
__all__ = ["Fit", "Material", "Plan", "Scene", "citation", "devices", "evaluate", "fit", "keys", "lookup", "material", "materials",
           "moments", "mueller", "plan", "response", "table", "write_table"]
__version__ = _native.version()


def citation() -> str:
    """How to cite the program and its model, in the Citation File Format."""
    return _native.citation()


# All names show as those of this package, wherever they are defined.
for _public in (*map(globals().get, __all__), MissingFileError, ModelWarning):
    _public.__module__ = __name__
