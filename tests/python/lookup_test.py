"""Tests tables as scenes, their axes, and lookups."""
import pickle
import unittest
import warnings

import numpy as np
import xarray as xr

import dolp
from package_case import PackageCase

MATERIALS = ["gold (Ordal)", "SiO2 amorphous quartz", "PET"]
ZENITHS = {"theta_deg": [0, 20, 40, 60], "sigma": 0.2, "q": 3, "evaluator": "cpu"}
AXES = {"theta_deg": [0, 30, 60, 80], "sigma": [0.1, 0.2, 0.3], "q": 3, "k": [0.05, 0.1], "evaluator": "cpu"}
POINTS = {"theta_deg": [33.3, 71], "sigma": 0.17, "k": 0.07}


class Lookup(PackageCase):
    def test_lookup_computes_values_between_the_entries(self):
        table = dolp.table(self.scene, **AXES)
        dolp.write_table(self.scene, self.folder / "t.nc", **AXES)
        exact = dolp.evaluate(self.scene, q=3, evaluator="cpu", **POINTS)
        for source in (table, self.folder / "t.nc"):
            found = dolp.lookup(source, **POINTS)
            np.testing.assert_array_equal(found.dolp, exact.dolp)
            self.assertEqual((found.attrs["evaluator"], int(found.status.max())), ("cpu", int(exact.status.max())))
            self.assertEqual(dolp.lookup(source, evaluator="reference", **POINTS).attrs["evaluator"], "reference")
            slopes = dolp.lookup(source, derivatives=["surface.sigma"], **POINTS).d_dolp__surface_sigma
            np.testing.assert_array_equal(slopes, dolp.evaluate(self.scene, q=3, evaluator="cpu", derivatives=["surface.sigma"],
                                                                **POINTS).d_dolp__surface_sigma)

    def test_only_attributes_and_single_values_of_a_dataset_count(self):
        table = dolp.table(self.scene, **AXES)
        found = dolp.lookup(table, **POINTS)
        for other in (table.interp(theta=[5, 50]), table.mean("theta", keep_attrs=True), table.where(table.theta > 30),
                      table.assign(dolp=table.dolp * 0), table.drop_vars(["dolp", "status"]), table.isel(theta=3, drop=True),
                      table.transpose("q", "theta", "k", ...), table.isel(theta=slice(None, None, -1))):
            np.testing.assert_array_equal(dolp.lookup(other, **POINTS).dolp, found.dolp)
        part = table.sel(sigma=0.2, k=0.1)
        exact = dolp.evaluate(self.scene, theta_deg=33.3, sigma=0.2, k=0.1, q=3, evaluator="cpu")
        for one in (part, table.sel(sigma=[0.2], k=[0.1]), part.interp(theta=[1, 2])):
            self.assertEqual(float(dolp.lookup(one, theta_deg=33.3).dolp), float(exact.dolp))
        self.assertEqual(float(dolp.lookup(part.sel(theta=30)).dolp),
                         float(dolp.lookup(table, theta_deg=30, sigma=0.2, k=0.1).dolp))
        part.to_netcdf(self.folder / "part.nc")
        self.assertEqual(float(dolp.lookup(xr.load_dataset(self.folder / "part.nc"), theta_deg=33.3).dolp), float(exact.dolp))
        self.assertEqual(float(dolp.lookup(self.folder / "part.nc", theta_deg=33.3, sigma=0.2, k=0.1).dolp), float(exact.dolp))

    def test_a_table_is_its_scene(self):
        table = dolp.table(self.scene.with_({"surface.masking": "v-cavity", "accuracy.tolerance": 1e-6}), **AXES)
        scene = dolp.Scene(table, {"surface.q": 4})
        self.assertEqual((scene["surface.masking"], scene["accuracy.tolerance"], scene["surface.q"]), ("v-cavity", 1e-6, 4))
        again = dolp.table(dolp.Scene(table))
        self.assertEqual(again.attrs["evaluator"], "cpu")
        np.testing.assert_array_equal(again.dolp, table.dolp)
        chosen = dolp.Scene(table.sel(sigma=0.2, theta=[30]))
        self.assertEqual((chosen["grid.sigma"], chosen["surface.sigma"]), ([0.2], 0.2))
        for form in ("NETCDF4", "NETCDF3_64BIT"):
            dolp.table(self.scene, **AXES).to_netcdf(self.folder / "saved.nc", format=form)
            np.testing.assert_array_equal(dolp.table(dolp.Scene(self.folder / "saved.nc")).dolp, dolp.table(self.scene, **AXES).dolp)
        copy = pickle.loads(pickle.dumps(scene))
        self.assertEqual(float(dolp.evaluate(copy, theta_deg=30).dolp), float(dolp.evaluate(scene, theta_deg=30).dolp))
        with self.assertRaisesRegex(dolp.InputError, "Dataset: has no attribute \"scene\""):
            dolp.Scene(xr.Dataset(table.variables))
        with self.assertRaisesRegex(dolp.InputError, "scene_hash.*the scene was changed"):
            dolp.Scene(table.assign_attrs(scene=table.attrs["scene"] + "\n"))

    def test_only_axes_are_dimensions(self):
        water = self.scene.with_({"surface.n": None, "surface.k": None, "surface.material": "water", "source.preset": "sun"})
        axes = {"theta_deg": [0, 40, 60, 80], "sigma": 0.2, "q": 3, "evaluator": "cpu"}
        table = dolp.table(water, wavelength_um=[11, 8, 9, 10], **axes)
        self.assertEqual((set(table.sizes), len(table.to_dataframe())), ({"wavelength", "theta", "sigma", "q"}, 16))
        material = dolp.material("water")
        np.testing.assert_array_equal(table.index_n, material.n(table.wavelength))
        np.testing.assert_array_equal(table.index_k, material.k(table.wavelength))
        dolp.write_table(water, self.folder / "t.nc", wavelength_um=[11, 8, 9, 10], **axes)
        self.assert_same(table, xr.load_dataset(self.folder / "t.nc"))
        table.to_netcdf(self.folder / "again.nc")
        found = dolp.lookup(table, theta_deg=33, wavelength_um=9.5)
        for source in (self.folder / "t.nc", self.folder / "again.nc", xr.load_dataset(self.folder / "again.nc")):
            self.assertEqual(float(dolp.lookup(source, theta_deg=33, wavelength_um=9.5).dolp), float(found.dolp))
        self.run_program("verify", "t.nc", "--samples", "4")
        part = table.isel(wavelength=[3])
        self.assertAlmostEqual(float(dolp.lookup(part, theta_deg=40).dolp), float(part.dolp.sel(theta=40).squeeze()), delta=2e-4)
        single = dolp.table(water, **axes)
        self.assertEqual((single.index_n.dims, float(single.index_n)), ((), float(material.n(10))))
        band = dolp.table(water.with_({"spectrum.band_um": [8, 12]}), **axes)
        self.assertNotIn("index_n", band.variables)
        self.assertEqual(set(band.sizes), {"theta", "sigma", "q"})
        several = dolp.table(self.scene, **axes, **{"source.irradiance": [1, 2]})
        np.testing.assert_array_equal(several.irradiance, [1, 2])

    def test_a_table_of_a_scene_with_removed_keys_is_read(self):
        water = {"surface.n": None, "surface.k": None, "surface.material": "water", "surroundings.temperature_K": None,
                 "surroundings.profile": "clear-sky", "surface.diffuse": "none", "title": None}
        for changes in (water, {"surroundings": None, "path": None, "surface.masking": None, "source.preset": None}):
            scene = self.scene.with_(changes)
            dolp.write_table(scene, self.folder / "t.nc", evaluator="cpu")
            table = dolp.table(scene, evaluator="cpu")
            for source in (self.folder / "t.nc", table):
                self.assertAlmostEqual(float(dolp.lookup(source, theta_deg=30, sigma=0.1, q=2).dolp), float(table.dolp[1, 0, 0]),
                                       delta=2e-4)  # twice the tolerance
            self.run_program("verify", "t.nc", "--samples", "2")


class Axes(PackageCase):
    def setUp(self):
        super().setUp()
        warnings.simplefilter("ignore", dolp.ModelWarning)

    def test_a_table_of_materials_bands_and_temperatures_has_names_as_coordinates(self):
        table = dolp.table(self.scene, material=["gold (Ordal)", "quartz", "PET"], band_um=[(8, 9), (10, 12)],
                           temperature_K=[280, 300, 320, 340], **ZENITHS)
        self.assertEqual(table.dolp.dims[:3], ("material", "band", "temperature"))
        self.assertEqual(table.material.values.tolist(), MATERIALS)
        self.assertEqual(table.band.values.tolist(), ["8-9", "10-12"])
        for material, band, ends in (("PET", "8-9", (8, 9)), ("gold (Ordal)", "10-12", (10, 12))):
            alone = self.scene.with_({"surface.material": material, "spectrum.band_um": ends, "emission.temperature_K": 320})
            right = dolp.table(alone, **ZENITHS)
            own = table.sel(material=material, band=band, temperature=320)
            bound = own.error_estimate + right.error_estimate
            self.assertTrue(bool((abs(own.dolp - right.dolp) <= bound).all()))
        path = self.folder / "t.nc"
        axes = {"material": MATERIALS[:2], "band_um": [(8, 9), (10, 12)], **ZENITHS}
        dolp.write_table(self.scene, path, **axes)
        self.assert_same(dolp.table(self.scene, **axes).drop_vars(["material", "band"]), xr.load_dataset(path))
        self.assertEqual(float(dolp.lookup(xr.load_dataset(path), material="quartz", band_um="8-9", theta_deg=40).dolp),
                         float(dolp.lookup(path, material="quartz", band_um="8-9", theta_deg=40).dolp))
        found = dolp.lookup(table, material=["PET", "quartz"], band_um="8-9", temperature_K=310, theta_deg=40)
        of_all = dolp.lookup(table, material=table.material, band_um="8-9", temperature_K=310, theta_deg=40)
        np.testing.assert_array_equal(of_all.material, table.material)
        np.testing.assert_array_equal(of_all.dolp.sel(material=found.material.values), found.dolp)
        self.assertEqual(found.material.values.tolist(), ["PET", "SiO2 amorphous quartz"])
        with self.assertRaisesRegex(dolp.InputError, "material = 'lead': must be one of gold"):
            dolp.lookup(table, material="lead", band_um="8-9", temperature_K=310, theta_deg=40)

    def test_tables_and_points_over_the_view_agree(self):
        glint = self.scene.with_({"geometry.mode": "bistatic", "source.irradiance": 5})
        table = dolp.table(glint, view_zenith_deg=[10, 40, 70], relative_azimuth_deg=[0, 120], **{**ZENITHS, "theta_deg": 30})
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
            dolp.table(warm, **{"emission.temperature_K": [250, 310]}, **ZENITHS)
        for call in (dolp.table, dolp.evaluate):
            with self.assertRaisesRegex(dolp.InputError, "grid.sigma is a list of the grid; the name of this argument is sigma"):
                call(self.scene, **{"grid.sigma": [0.1, 0.2]}, theta_deg=20)

    def test_a_key_is_looked_up_between_its_values(self):
        key = "surroundings.temperature_K"
        table = dolp.table(self.scene, **{key: [200, 240, 280]}, **ZENITHS)
        right = dolp.evaluate(self.scene.with_({key: 207}), theta_deg=[20, 60], sigma=0.2, q=3, evaluator="cpu")
        np.testing.assert_array_equal(dolp.lookup(table, theta_deg=[20, 60], **{key: 207}).dolp, right.dolp)
        np.testing.assert_array_equal(dolp.lookup(table.sel({key: 240}), theta_deg=20).dolp,
                                      dolp.lookup(table, theta_deg=20, **{key: 240}).dolp)
        with self.assertRaisesRegex(dolp.InputError, "surroundings.temperature_K is missing; the table has 3 values of it"):
            dolp.lookup(table, theta_deg=20)
