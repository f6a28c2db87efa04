#!/usr/bin/env python3
"""Tests lookups, and tables that they read."""
import unittest

import numpy as np
import xarray as xr

import dolp
from package_case import PackageCase


class Lookup(PackageCase):
    def test_lookup_takes_a_file_or_a_dataset(self):
        table = dolp.table(self.scene, theta_deg=np.linspace(0, 85, 40), sigma=0.2, q=3)
        dolp.write_table(self.scene, self.folder / "t.nc", theta_deg=np.linspace(0, 85, 40), sigma=0.2, q=3)
        for source in (table, self.folder / "t.nc"):
            found = dolp.lookup(source, theta_deg=[33.3, 71])
            exact = dolp.evaluate(self.scene, theta_deg=[33.3, 71])
            self.assertTrue((abs(found.dolp - exact.dolp) <= found.error_estimate + exact.error_estimate).all())

    def test_lookup_reads_a_file_that_has_changed(self):
        for sigma in (0.1, 0.3):
            dolp.write_table(self.scene, self.folder / "t.nc", theta_deg=np.linspace(0, 85, 40), sigma=sigma, q=3, evaluator="cpu")
            exact = dolp.evaluate(self.scene, theta_deg=33, sigma=sigma, evaluator="cpu")
            for _ in range(2):
                found = dolp.lookup(self.folder / "t.nc", theta_deg=33)
                self.assertLessEqual(float(abs(found.dolp - exact.dolp)), float(found.error_estimate + exact.error_estimate))

    def test_lookup_takes_parts_of_a_table(self):
        table = dolp.table(self.scene, theta_deg=np.linspace(0, 80, 21), sigma=[0.1, 0.2, 0.3], q=3, k=[0.05, 0.1, 0.2])
        whole = dolp.lookup(table, theta_deg=[33.3, 71], sigma=0.2, k=0.1)
        for part, points in ((table.sel(k=0.1), {"sigma": 0.2}), (table.sel(k=0.1, sigma=0.2), {}),
                             (table.isel(k=slice(1, 3)), {"sigma": 0.2, "k": 0.1}),
                             (table.transpose("q", "theta", "sigma", "k", ...), {"sigma": 0.2, "k": 0.1}),
                             (table.isel(theta=slice(None, None, -1)), {"sigma": 0.2, "k": 0.1}),
                             (table.drop_vars(["rho_i", "rho_q", "rho_error_estimate", "albedo"]), {"sigma": 0.2, "k": 0.1})):
            found = dolp.lookup(part, theta_deg=[33.3, 71], **points)
            np.testing.assert_array_equal(found.dolp, whole.dolp)
        path = self.folder / "part.nc"
        table.sel(k=0.1).to_netcdf(path)
        with self.assertRaisesRegex(dolp.InputError, r"k: has one value and no dimension.*xarray.load_dataset\(FILE\)"):
            dolp.lookup(path, theta_deg=33.3)
        np.testing.assert_array_equal(dolp.lookup(xr.load_dataset(path), theta_deg=[33.3, 71], sigma=0.2).dolp, whole.dolp)
        for part, message in ((table.isel(k=1, drop=True), "axis k is missing"), (table.drop_vars("status"), "status is missing"),
                              (table.isel(theta=3, drop=True), "axis theta is missing"),
                              (table.drop_vars(["stokes_i", "dolp"]), "variables dolp, stokes_i are missing"),
                              (xr.Dataset(table.variables), "attribute"),
                              (table.where(table.theta > 30), "status has entries without a value"),
                              (table.assign_coords(k=[0.1, 0.1, 0.2]), "twice")):
            with self.assertRaisesRegex(dolp.InputError, message):
                dolp.lookup(part, theta_deg=33.3, sigma=0.2)

    def test_lookup_finds_dimensions_by_their_coordinates(self):
        sea = self.scene.with_({"surface.distribution": "gaussian", "grid.wind_m_s": [2, 5, 9, 14]})
        table = dolp.table(sea, theta_deg=np.linspace(0, 80, 5), q=[2, 3, 4, 5, 6], evaluator="cpu")
        points = {"theta_deg": [33.3, 71], "wind_m_s": [4, 7], "q": 2.5}
        expected = dolp.lookup(table, **points)
        for other in (table.swap_dims(sigma="wind_m_s"), table.rename_dims(theta="zenith", q="exponent"),
                      table.transpose("q", "sigma", "theta", ...), table.transpose("theta", ...).rename_dims(theta="q_")):
            np.testing.assert_array_equal(dolp.lookup(other, **points).dolp, expected.dolp)
        wrong = table.assign(dolp=table.dolp.isel(sigma=0, drop=True))
        for other, message in ((wrong, r"dolp is over \(theta, q\); must be over \(theta, sigma, q\)"),
                               (table.stack(point=("theta", "q")).reset_index("point"), "along a dimension of its own")):
            with self.assertRaisesRegex(dolp.InputError, message):
                dolp.lookup(other, **points)

    def test_lookup_refuses_what_was_not_computed(self):
        temperatures = {"emission.temperature_K": [260, 320], "surroundings.temperature_K": [240, 250]}
        table = dolp.table(self.scene, theta_deg=np.linspace(0, 80, 9), sigma=0.2, q=3, evaluator="cpu", **temperatures)
        table.to_netcdf(self.folder / "t.nc")
        for whole in (table, xr.load_dataset(self.folder / "t.nc")):
            part = whole.sel({"surroundings.temperature_K": 250})
            self.assertTrue(dolp.lookup(part.sel({"emission.temperature_K": 320}), theta_deg=33))
            for other, message in ((part.interp({"emission.temperature_K": 290}),
                                    r"emission.temperature_K = 290.0: is not among the values .* \[260.0, 320.0\]"),
                                   (part.sel({"emission.temperature_K": 260}).interp(theta=[0, 10, 25, 40]),
                                    "theta = 25: is not among the values"),
                                   (part.sel({"emission.temperature_K": 260}).assign_coords(sigma=[0.21]), "sigma = 0.21")):
                other["status"] = xr.zeros_like(other.dolp, dtype=int)
                with self.assertRaisesRegex(dolp.InputError, message):
                    dolp.lookup(other, theta_deg=15)
        part = table.isel({name: 0 for name in temperatures})
        single = part.assign_coords(sigma=part.sigma.astype("float32"))
        self.assertEqual(float(dolp.lookup(single, theta_deg=33).dolp), float(dolp.lookup(part, theta_deg=33).dolp))
        for value in (-1, 0.5, 2.0**32, np.nan):
            with self.assertRaisesRegex(dolp.InputError, f"status has entries without a value .* as {value}"):
                dolp.lookup(part.assign(status=part.status * 0 + value), theta_deg=33)

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
        self.assertEqual(float(dolp.lookup(part, theta_deg=40).dolp), float(part.dolp.sel(theta=40)))
        single = dolp.table(water, **axes)
        self.assertEqual((single.index_n.dims, float(single.index_n)), ((), float(material.n(10))))
        band = dolp.table(water.with_({"spectrum.band_um": [8, 12]}), **axes)
        self.assertNotIn("index_n", band.variables)
        self.assertEqual(set(band.sizes), {"theta", "sigma", "q"})
        several = dolp.table(self.scene, **axes, **{"source.irradiance": [1, 2]})
        np.testing.assert_array_equal(several.irradiance, [1, 2])

    def test_tables_of_dolp_0_2_are_read(self):
        water = self.scene.with_({"surface.material": "water"})
        table = dolp.table(water, theta_deg=np.linspace(0, 80, 9), wavelength_um=[8, 9, 10], sigma=0.2, q=3, evaluator="cpu")
        old = table.drop_vars(["index_n", "index_k"])
        for name in ("index_n", "index_k"):
            old[name] = (f"{name}_wavelength", table[name].values)
            old = old.assign_coords({f"{name}_wavelength": table.wavelength.values})
        del old.attrs["spectral_data"]
        self.assertEqual(float(dolp.lookup(old, theta_deg=33, wavelength_um=8.5).dolp),
                         float(dolp.lookup(table, theta_deg=33, wavelength_um=8.5).dolp))

    def test_a_table_of_a_scene_with_removed_keys_is_read(self):
        water = {"surface.n": None, "surface.k": None, "surface.material": "water", "surroundings.temperature_K": None,
                 "surroundings.profile": "clear-sky", "surface.diffuse": "none", "title": None}
        for changes in (water, {"surroundings": None, "path": None, "surface.masking": None, "source.preset": None}):
            scene = self.scene.with_(changes)
            dolp.write_table(scene, self.folder / "t.nc", evaluator="cpu")
            table = dolp.table(scene, evaluator="cpu")
            for source in (self.folder / "t.nc", table):
                self.assertEqual(float(dolp.lookup(source, theta_deg=30, sigma=0.1, q=2).dolp), float(table.dolp[1, 0, 0]))
            self.run_program("verify", "t.nc", "--samples", "2")


if __name__ == "__main__":
    unittest.main()
