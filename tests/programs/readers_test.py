#!/usr/bin/env python3
"""Reads tables by ncdump, nccopy, SciPy, netCDF4 and xarray: readers_test.py PROGRAM FOLDER_OF_OLD_TABLES

All readers must find the same numbers and names. dolp must read what nccopy makes of tables, of dolp 0.2 too.
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import netCDF4
import numpy as np
import xarray as xr
from scipy.io import netcdf_file

PROGRAM, OLD = sys.argv[1], pathlib.Path(sys.argv[2])
NAMES = ["gold (Ordal)", "iron"]
SCENE = """
[surface]
sigma = 0.1
masking = "v-cavity"
[spectrum]
wavelength_um = 10
[emission]
temperature_K = 300
[grid]
material = ["gold (Ordal)", "iron"]
theta_deg = [0, 40, 80]
"""


def run(*words):
    return subprocess.run(list(map(str, words)), check=True, capture_output=True, text=True).stdout


class Readers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "scene.toml").write_text(SCENE)
        self.table = self.folder / "table.nc"
        run(PROGRAM, "table", self.folder / "scene.toml", "-o", self.table, "--evaluator", "cpu", "--quiet")

    def test_readers_agree(self):
        xarray = xr.load_dataset(self.table)
        self.assertEqual(xarray.material_name.values.tolist(), NAMES)
        self.assertEqual(xarray.dolp.dims, ("material", "theta", "sigma", "q"))
        right = xarray.dolp.values
        self.assertTrue(np.all(right[:, 1:] > 0))
        with netCDF4.Dataset(self.table) as table:
            self.assertEqual(table["material_name"][:].tolist(), NAMES)
            np.testing.assert_array_equal(table["dolp"][:], right)
        with netcdf_file(self.table, mmap=False) as table:
            self.assertEqual([name.tobytes().rstrip(b"\0").decode() for name in table.variables["material_name"][:]], NAMES)
            np.testing.assert_array_equal(table.variables["dolp"][:], right)
        text = run("ncdump", "-p", "9,17", "-v", "material_name,dolp", self.table)
        self.assertIn('"gold (Ordal)",\n  "iron"', text)
        numbers = text.rpartition(" dolp =")[2].rstrip(" ;}\n").replace("_", "nan").split(",")
        np.testing.assert_array_equal(np.array(numbers, float), right.ravel())
        self.assertEqual(run("ncdump", "-k", self.table), "64-bit offset\n")

    def assert_read(self, table):
        self.assertIn("passed", run(PROGRAM, "verify", table, "--samples", 1))

    def test_converted_tables_are_read(self):
        copy = self.folder / "copy.nc"
        for options in (["-3"], ["-6"], ["-7"], ["-k", "cdf5"], ["-4", "-d", "1", "-s", "-c", "theta/1"]):
            run("nccopy", *options, self.table, copy)
            self.assert_read(copy)

    def test_tables_of_0_2_are_read(self):
        self.assert_read(OLD / "materials.nc")  # nccopy does not convert the texts in this file and in bands.nc
        self.assert_read(OLD / "bands.nc")
        run("nccopy", "-3", OLD / "response.nc", self.folder / "copy.nc")
        self.assert_read(self.folder / "copy.nc")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
