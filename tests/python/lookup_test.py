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
        self.assertEqual(float(dolp.lookup(self.folder / "part.nc", theta_deg=33.3).dolp), float(exact.dolp))

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
        np.testing.assert_array_equal(dolp.lookup(table.sel({key: [240]}), theta_deg=20).dolp,
                                      dolp.lookup(table, theta_deg=20, **{key: 240}).dolp)
        for several, count in ((table, 3), (table.stack(point=(key, "theta")), 12), (table.isel({key: [0]}).drop_vars(key), 1)):
            with self.assertRaisesRegex(dolp.InputError, f"surroundings.temperature_K is missing; the table has {count} values of it"):
                dolp.lookup(several, theta_deg=20)

    def test_a_part_of_a_sea_has_its_wind(self):
        sea = self.scene.with_({"surface.distribution": "gaussian", "surface.masking": "v-cavity", "surface.wind_m_s": 5,
                                "grid.q": None})
        point = {"theta_deg": 75, "surface_azimuth_deg": 45, "evaluator": "cpu"}
        for model in ("directional", "isotropic"):
            scene = sea.with_({"surface.wind_model": model})
            table = dolp.table(scene, wind_m_s=[5, 10], **{**point, "theta_deg": [60, 75]})
            right = dolp.evaluate(scene, wind_m_s=10, **point)
            self.assertEqual(bool(right.stokes_u != 0), model == "directional")
            by_wind = table.swap_dims(sigma="wind_m_s")
            by_wind.sel(wind_m_s=10).to_netcdf(self.folder / "part.nc")
            joined = xr.concat([table.isel(sigma=[i]) for i in (0, 1)], "sigma")
            for part in (by_wind.sel(wind_m_s=10), table.isel(sigma=[1]), table.isel(sigma=[1]).squeeze(), joined.isel(sigma=1),
                         xr.load_dataset(self.folder / "part.nc"), table.isel(sigma=1).drop_vars("sigma"), right):
                for found in (dolp.lookup(part, **point), dolp.evaluate(dolp.Scene(part), **point),
                              dolp.lookup(table, wind_m_s=10, **point)):
                    self.assertEqual((float(found.dolp), float(found.stokes_u)), (float(right.dolp), float(right.stokes_u)))
                again = dolp.table(dolp.Scene(part), theta_deg=75)
                self.assertLess(float(abs(again.stokes_u - right.stokes_u).max()), 1e-3)
                self.assertEqual(dolp.Scene(part)["surface.wind_m_s"], 10)
                self.assertEqual(float(dolp.lookup(part, wind_m_s=5, **point).dolp), float(dolp.evaluate(scene, wind_m_s=5, **point).dolp))
            by_wind.interp(wind_m_s=7).to_netcdf(self.folder / "between.nc")
            for source in (by_wind.interp(wind_m_s=7), self.folder / "between.nc"):
                with self.assertRaisesRegex(dolp.InputError, "sigma = .* is not the sigma of wind_m_s = 7, as after interpolating"):
                    dolp.lookup(source, **point)
            self.assertEqual(float(dolp.lookup(self.folder / "part.nc", **point).stokes_u), float(right.stokes_u))
        directional = sea.with_({"surface.wind_model": "directional"})
        for call in (lambda: dolp.Scene(dolp.table(directional, **point).drop_vars("wind_m_s")),
                     lambda: dolp.table(directional, sigma=[0.1, 0.2], **point)):
            with self.assertRaisesRegex(dolp.InputError, "sigma: .*directional.*give only wind_m_s"):
                call()
        for keys in ({"sigma": 0.1, "surface.wind_m_s": 5}, {"wind_m_s": 5, "surface.sigma": 0.1}):
            with self.assertRaisesRegex(dolp.InputError, "cannot be combined"):
                dolp.evaluate(sea, **keys, **point)

    def test_a_part_has_the_values_of_all_its_axes(self):
        brushed = self.scene.with_({"surface.masking": "v-cavity", "surface.sigma_cross": 0.3})
        steel = dolp.table(brushed, sigma_cross=[0.05, 0.1], surface_azimuth_deg=[0, 45], **{**ZENITHS, "sigma": [0.1, 0.2]})
        names = dolp.table(self.scene, material=MATERIALS[1:], band_um=[(8, 9), (10, 12)], temperature_K=[280, 300], **ZENITHS)
        last = {"material": 1, "band": 1, "temperature": 0}
        for part in (steel.isel(sigma_cross=1, sigma=0, surface_azimuth_deg=1), names.isel(last),
                     names.isel({name: [i] for name, i in last.items()}), names.drop_vars(["material", "band"]).isel(last),
                     names.swap_dims(band="band_low").sel(band_low=10, material="PET", temperature=280)):
            entry = part.squeeze().sel(theta=60)
            found = dolp.lookup(part, theta_deg=60)
            self.assertLess(float(abs(found.dolp - entry.dolp)), 2e-4)  # twice the tolerance
            self.assertEqual(float(found.dolp), float(dolp.lookup(part.squeeze().isel(theta=3)).dolp))

    def test_a_file_has_the_values_of_its_table(self):
        for axes in ({"sigma": 0.33, "q": 2}, {"sigma": [0.1, 0.2], "q": 2.5}):
            dolp.write_table(self.scene, self.folder / "t.nc", evaluator="cpu", **axes)
            scenes = [dolp.Scene(source) for source in (self.folder / "t.nc", xr.load_dataset(self.folder / "t.nc"))]
            for key in ("surface.sigma", "surface.q"):
                self.assertEqual(scenes[0][key], scenes[1][key])
            self.assertEqual(scenes[0]["surface.q"], axes["q"])
            self.assertEqual(dolp.Scene(self.folder / "t.nc", {"surface.q": 4})["surface.q"], 4)

    def test_a_table_over_a_key_keeps_the_key_of_its_scene(self):
        zenith = "surroundings.zenith_temperature_K"
        sky = self.scene.with_({"surroundings": None}).with_({zenith: 210, "surroundings.horizon_temperature_K": 290})
        table = dolp.table(sky, theta_deg=[20, 60], evaluator="cpu", **{zenith: [200, 220]})
        self.assertEqual(dolp.Scene(table)[zenith], 210)
        right = dolp.evaluate(sky.with_({zenith: 220}), theta_deg=60, evaluator="cpu")
        part = table.sel({zenith: 220})
        part.to_netcdf(self.folder / "part.nc")
        for source in (part, self.folder / "part.nc"):
            self.assertEqual(float(dolp.lookup(source, theta_deg=60, evaluator="cpu").dolp), float(right.dolp))

    def test_results_over_keys_have_the_scene(self):
        scene = self.scene.with_({"surface.masking": "v-cavity"})
        found = dolp.evaluate(scene, theta_deg=[30, 40], evaluator="cpu", **{"surroundings.temperature_K": [200, 240]})
        self.assertEqual(dolp.Scene(found)["surface.masking"], "v-cavity")
        one = found.isel(point=1)
        self.assertEqual(float(dolp.lookup(one, theta_deg=40).dolp), float(one.dolp))

    def test_lookup_computes_every_effect_on_demand(self):
        table = dolp.table(self.scene.with_({"accuracy.tolerance": 1e-2, "surface.k": 1e-6}), **{**ZENITHS, "k": 1e-6})
        kept, left = (dolp.lookup(table, theta_deg=60, keep_all=keep_all).attrs["effects"] for keep_all in (True, False))
        self.assertIn("all are kept", kept)
        self.assertNotIn("all are kept", left)
