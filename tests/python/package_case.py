"""Base of tests of the package: a scene, and a new folder for files. DOLP_PROGRAM in the environment is the program."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import xarray as xr

import dolp

TEXT = """title = "painted plate"
[surface]
n = 1.5
k = 0.05
sigma = 0.2
q = 3.0
masking = "smith"
[emission]
temperature_K = 300.0
[surroundings]
temperature_K = 250.0
[spectrum]
wavelength_um = 10.0
[grid]
theta_deg = [0, 30, 60, 85]
sigma = [0.1, 0.4]
q = [2, 3.5, 5]
"""


class PackageCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "scene.toml").write_text(TEXT)
        self.scene = dolp.Scene(self.folder / "scene.toml")

    def run_program(self, *words):
        subprocess.run([os.environ["DOLP_PROGRAM"], *words, "--quiet"], cwd=self.folder, check=True)

    def assert_same(self, table, expected):
        """Expects equal values, attributes and encodings of two Datasets. Only history and wall_time_s may differ."""
        run = ("history", "wall_time_s")
        self.assertEqual(set(table.attrs), set(expected.attrs))
        for name, value in expected.attrs.items():
            self.assertIs(type(table.attrs[name]), type(value), name)
            if name not in run:
                self.assertEqual(table.attrs[name], value, name)
        self.assertEqual(dict(table.sizes), dict(expected.sizes))
        self.assertEqual(set(table.coords), set(expected.coords))
        xr.testing.assert_equal(table, expected)
        for name, variable in expected.variables.items():
            for key in ("dtype", "_FillValue", "char_dim_name"):
                self.assertEqual(str(table[name].encoding.get(key)), str(variable.encoding.get(key)), (name, key))
            self.assertEqual(str(table[name].attrs), str(variable.attrs), name)
