"""Tests `pip install ./host/python`, without a network, in a folder of its own."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["DOLP_BUILD"])
PROGRAM = """
import dolp, importlib.metadata, pathlib
print(pathlib.Path(dolp.__file__).parent)
print(importlib.metadata.version("dolp") == dolp.__version__, importlib.metadata.requires("dolp"))
scene = dolp.Scene(ROOT / "host/scenes/night_paint.toml")
print(dolp.evaluate(scene, theta_deg=60, evaluator="cpu").dolp.item())
"""


class PipInstall(unittest.TestCase):
    def test_it_installs_a_package_that_works_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--target", folder,
                            f"--config-settings=build-dir={BUILD}", str(ROOT / "host/python")], check=True)
            program = PROGRAM.replace("ROOT", f"pathlib.Path({str(ROOT)!r})")
            out = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True, cwd=folder,
                                 env={"PATH": os.environ["PATH"], "PYTHONPATH": folder}).stdout.splitlines()
            self.assertEqual(out[:2], [str(pathlib.Path(folder, "dolp")), "True ['numpy', 'xarray']"])
            self.assertAlmostEqual(float(out[2]), 0.0511, places=4)
            libraries = subprocess.run(["ldd", *pathlib.Path(folder, "dolp").glob("_native*.so")], check=True,
                                       capture_output=True, text=True).stdout
            self.assertIn(f"libdolp.so.0 => {folder}/dolp/libdolp.so.0", libraries)
