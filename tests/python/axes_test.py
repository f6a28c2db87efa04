#!/usr/bin/env python3
"""Tests axes of materials, bands, temperatures and views, and lookups over keys."""
import unittest
import warnings

import numpy as np
import xarray as xr

import dolp
from package_case import PackageCase

MATERIALS = ["gold (Ordal)", "SiO2 amorphous quartz", "PET"]
AXES = {"theta_deg": [0, 20, 40, 60], "sigma": 0.2, "q": 3, "evaluator": "cpu"}


class Axes(PackageCase):
    def setUp(self):
        super().setUp()
        warnings.simplefilter("ignore", dolp.ModelWarning)

    def test_a_table_of_materials_bands_and_temperatures_has_names_as_coordinates(self):
        table = dolp.table(self.scene, material=["gold (Ordal)", "quartz", "PET"], band_um=[(8, 9), (10, 12)],
                           temperature_K=[280, 300, 320, 340], **AXES)
        self.assertEqual(table.dolp.dims[:3], ("material", "band", "temperature"))
        self.assertEqual(table.material.values.tolist(), MATERIALS)
        self.assertEqual(table.band.values.tolist(), ["8-9", "10-12"])
        for material, band, ends in (("PET", "8-9", (8, 9)), ("gold (Ordal)", "10-12", (10, 12))):
            alone = self.scene.with_({"surface.material": material, "spectrum.band_um": ends, "emission.temperature_K": 320})
            right = dolp.table(alone, **AXES)
            own = table.sel(material=material, band=band, temperature=320)
            bound = own.error_estimate + right.error_estimate
            self.assertTrue(bool((abs(own.dolp - right.dolp) <= bound).all()))
        path = self.folder / "t.nc"
        axes = {"material": MATERIALS[:2], "band_um": [(8, 9), (10, 12)], **AXES}
        dolp.write_table(self.scene, path, **axes)
        self.assert_same(dolp.table(self.scene, **axes).drop_vars(["material", "band"]), xr.load_dataset(path))
        self.assertEqual(float(dolp.lookup(xr.load_dataset(path), material="quartz", band_um="8-9", theta_deg=40).dolp),
                         float(dolp.lookup(path, material="quartz", band_um="8-9", theta_deg=40).dolp))
        found = dolp.lookup(table, material=["PET", "quartz"], band_um="8-9", temperature_K=310, theta_deg=40)
        self.assertEqual(found.material.values.tolist(), ["PET", "SiO2 amorphous quartz"])
        with self.assertRaisesRegex(dolp.InputError, "material = 'lead': must be one of gold"):
            dolp.lookup(table, material="lead", band_um="8-9", temperature_K=310, theta_deg=40)

    def test_tables_and_points_over_the_view_agree(self):
        glint = self.scene.with_({"geometry.mode": "bistatic", "source.irradiance": 5})
        table = dolp.table(glint, view_zenith_deg=[10, 40, 70], relative_azimuth_deg=[0, 120], **{**AXES, "theta_deg": 30})
        self.assertEqual(table.dolp.dims, ("view_zenith_deg", "relative_azimuth_deg", "theta", "sigma", "q"))
        points = dolp.evaluate(glint, view_zenith_deg=[[10], [40], [70]], relative_azimuth_deg=[[0, 120]], theta_deg=30,
                               evaluator="cpu")
        self.assertEqual(points.dolp.dims, ("view_zenith_deg", "relative_azimuth_deg"))
        own = table.squeeze(["theta", "sigma", "q"])
        self.assertTrue(bool((abs(own.dolp - points.dolp) <= own.error_estimate + points.error_estimate).all()))
        found = dolp.lookup(table, view_zenith_deg=55, relative_azimuth_deg=60)
        self.assertEqual(float(found.dolp), float(dolp.evaluate(glint, view_zenith_deg=55, relative_azimuth_deg=60, theta_deg=30,
                                                                evaluator="cpu").dolp))
        with self.assertRaisesRegex(dolp.InputError, "are the same"):
            dolp.evaluate(glint, theta_deg=3, view_zenith_deg=3, **{"geometry.view_zenith_deg": 4})

    def test_a_key_that_an_axis_replaces_is_refused(self):
        warm = self.scene.with_({"grid.temperature_K": [280, 300]})
        with self.assertRaisesRegex(dolp.InputError, "axes: emission.temperature_K and temperature_K are the same"):
            dolp.table(warm, **{"emission.temperature_K": [250, 310]}, **AXES)
        for call in (dolp.table, dolp.evaluate):
            with self.assertRaisesRegex(dolp.InputError, "grid.sigma is a list of the grid; the name of this argument is sigma"):
                call(self.scene, **{"grid.sigma": [0.1, 0.2]}, theta_deg=20)

    def test_a_key_is_looked_up_between_its_values(self):
        key = "surroundings.temperature_K"
        table = dolp.table(self.scene, **{key: [200, 240, 280]}, **AXES)
        right = dolp.evaluate(self.scene.with_({key: 207}), theta_deg=[20, 60], sigma=0.2, q=3, evaluator="cpu")
        np.testing.assert_array_equal(dolp.lookup(table, theta_deg=[20, 60], **{key: 207}).dolp, right.dolp)
        np.testing.assert_array_equal(dolp.lookup(table.sel({key: 240}), theta_deg=20).dolp,
                                      dolp.lookup(table, theta_deg=20, **{key: 240}).dolp)
        with self.assertRaisesRegex(dolp.InputError, "surroundings.temperature_K is missing; the table has 3 values of it"):
            dolp.lookup(table, theta_deg=20)


if __name__ == "__main__":
    unittest.main()
