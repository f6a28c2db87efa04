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

Scene                   a scene, from a file or a text, with changed values of keys
table, write_table      DOLP and the other quantities over the scene's grid: as a Dataset, or in a file
evaluate, mueller       DOLP and the other quantities at points; Mueller matrices for pairs of directions
lookup                  values between the entries of a table, computed
camera_stokes           Stokes parameters in the axes of a camera, for a map of surface normals
response, moments       a response table, which serves any material; reflectances of materials from such a table
fit                     values of a scene's keys from measured data
plan                    what a table would compute and cost
material                n and k of a built-in material
devices, keys, materials, citation

Names and units are the same as in scene files and table files: angles in degrees, wavelengths in um, temperatures in
K. Results are xarray Datasets with the variables, units and meanings of table files. They equal the results of the
command line bit for bit. `dataset.dolp.plot()` draws DOLP; `dataset.error_estimate` bounds its error.

The package keeps the device and its kernels between calls. During a long call Python's other threads run, and Ctrl-C
ends the call. If a process has used a Vulkan device, its forked children get a DeviceError: start new processes instead
(multiprocessing.set_start_method("spawn")), or use evaluator="cpu".

Errors: InputError (a ValueError) with one line that states what is allowed; MissingFileError (an InputError and a
FileNotFoundError) if a file to read does not exist; DeviceError (a RuntimeError); IoError (an OSError); TypeError for
an argument of a wrong type; MemoryError. Results have no mask, so masked arrays give an InputError: fill or compress
them.
Warnings: InputWarning for input that you probably meant differently (percent, Celsius, nanometres), and for a material
file without values of k; ModelWarning, once for each scene, if single scattering is not enough (status 32).
"""
from __future__ import annotations

from . import _native
from ._arguments import MissingFileError
from ._camera import camera_stokes
from ._fit import Fit, fit
from ._native import DeviceError, InputError, InputWarning, IoError
from ._response import moments, response
from ._runs import Plan, devices, evaluate, lookup, mueller, plan, table, write_table
from ._scene import Material, ModelWarning, Scene, keys, material, materials

# Omits the exceptions: for each of them `help` would print many inherited methods. The text above names them.
__all__ = ["Fit", "Material", "Plan", "Scene", "camera_stokes", "citation", "devices", "evaluate", "fit", "keys", "lookup", "material", "materials",
           "moments", "mueller", "plan", "response", "table", "write_table"]
__version__ = _native.version()


def citation() -> str:
    """The citation of the program and its model, in the Citation File Format."""
    return _native.citation()


# Makes every public name show as a member of this package instead of the module that defines it.
for _public in (*map(globals().get, __all__), MissingFileError, ModelWarning):
    _public.__module__ = __name__
