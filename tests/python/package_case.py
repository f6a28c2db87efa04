"""Base of tests of the package: a scene, and a new folder for files."""
import pathlib
import tempfile
import unittest

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
