#!/usr/bin/env python3
"""Tests the Python package. Usage: python_test.py DOLP, with the package on PYTHONPATH. DOLP is the program."""
import csv
import doctest
import importlib
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

import matplotlib
import numpy as np
import xarray as xr

import dolp
from package_case import TEXT, PackageCase

matplotlib.use("Agg")
PROGRAM = sys.argv.pop(1) if __name__ == "__main__" else ""  # other processes import this file without arguments


def fresnel(index, beta):
    """(R_s + R_p) / 2 and (R_s - R_p) / 2 of a smooth surface."""
    cosine = np.cos(np.deg2rad(beta))
    root = np.sqrt(index ** 2 - 1 + cosine ** 2)
    r_s = abs((cosine - root) / (cosine + root)) ** 2
    r_p = abs((index ** 2 * cosine - root) / (index ** 2 * cosine + root)) ** 2
    return (r_s + r_p) / 2, (r_s - r_p) / 2


class Package(PackageCase):
    def run_program(self, *words):
        subprocess.run([PROGRAM, *words, "--quiet"], cwd=self.folder, check=True)

    def test_examples_in_the_documentation_hold(self):
        names = {"dolp": dolp, "np": np, "tempfile": tempfile, "scene": dolp.Scene(text="""
[surface]
n = 1.5
k = 0.05
sigma = 0.2
q = 3.0
masking = "smith"
[emission]
temperature_K = 300.0
[spectrum]
wavelength_um = 10.0
[grid]
theta_deg = {from = 0, to = 80, count = 5}
""")}
        rooms = [dolp, *(importlib.import_module(f"dolp.{room}") for room in ("_scene", "_runs", "_fit", "_response"))]
        results = [doctest.testmod(room, extraglobs=names) for room in rooms]
        self.assertEqual(sum(failed for failed, _ in results), 0)
        self.assertGreater(sum(tried for _, tried in results), 25)

    def assert_same(self, table, expected):
        """Expects equal values, attributes and encodings of two Datasets."""
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

    def test_a_table_is_what_the_file_holds(self):
        (self.folder / "n.csv").write_text("wavelength_um,n,k\n8,1.5,0.1\n14,1.45,0.2\n")
        material = {"surface.material_file": str(self.folder / "n.csv"), "source.preset": "sun",
                    "spectrum.band_um": [8, 12]}
        for scene in (self.scene, self.scene.with_(material), self.scene.with_({"grid.k": [0.1, 0.2], "grid.n": 1.5}),
                      self.scene.with_({"emission.bracket": True, "grid.wavelength_um": [9, 10]}),
                      self.scene.with_({"surface.distribution": "gaussian", "grid.wind_m_s": [5, 2]}),
                      self.scene.with_({"title": "long " * 20000})):
            for evaluator in ("cpu", "vulkan"):
                dolp.write_table(scene, self.folder / "t.nc", evaluator=evaluator)
                self.assert_same(dolp.table(scene, evaluator=evaluator), xr.load_dataset(self.folder / "t.nc"))
        self.run_program("table", str(self.folder / "scene.toml"), "-o", "t.nc")
        self.assert_same(dolp.table(self.scene), xr.load_dataset(self.folder / "t.nc"))

    def test_points_have_the_bits_of_the_command_line(self):
        random = np.random.default_rng(1)
        columns = {"theta_deg": random.uniform(0, 89, 50), "sigma": random.uniform(0.05, 1, 50),
                   "q": random.uniform(1.6, 6, 50), "n": random.uniform(1.2, 3, 50), "k": random.uniform(0, 1, 50)}
        with open(self.folder / "p.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(columns)
            writer.writerows([[repr(float(x)) for x in row] for row in zip(*columns.values())])
        self.run_program("eval", "scene.toml", "--points", "p.csv", "-o", "r.csv")
        with open(self.folder / "r.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        found = dolp.evaluate(self.scene, **columns)
        for name in set(rows[0]) - set(columns):
            expected = np.array([float(row[name]) for row in rows])
            np.testing.assert_array_equal(found[name].values, expected, name)

    def test_arrays_broadcast(self):
        theta = np.array([0.0, 30.0, 60.0])
        square = dolp.evaluate(self.scene, theta_deg=theta[:, None], sigma=[0.1, 0.2], n=1.7)
        self.assertEqual(dict(square.sizes), {"theta": 3, "sigma": 2})
        one = dolp.evaluate(self.scene, theta_deg=60, sigma=0.2, n=1.7)
        self.assertEqual(one.dolp.shape, ())
        self.assertEqual(float(one.dolp), float(square.dolp[2, 1]))
        self.assertEqual(square.theta.attrs["units"], "degree")
        named = dolp.evaluate(self.scene, theta_deg=xr.DataArray(theta, dims="ray"), sigma=xr.DataArray([0.1, 0.2], dims="part"))
        self.assertEqual(named.dolp.dims, ("ray", "part"))
        labelled = xr.DataArray(theta, dims="ray", coords={"theta": ("ray", theta, {"mine": 1})})
        self.assertEqual(dolp.evaluate(self.scene, theta_deg=labelled).theta.attrs["units"], "degree")
        self.assertEqual(labelled.theta.attrs, {"mine": 1})
        paired = dolp.evaluate(self.scene, theta_deg=theta, sigma=[0.1, 0.2, 0.3])
        self.assertEqual(paired.dolp.dims, ("point",))
        self.assertEqual(paired.sigma.dims, ("point",))
        with self.assertRaisesRegex(dolp.InputError, "do not broadcast"):
            dolp.evaluate(self.scene, theta_deg=theta, sigma=[0.1, 0.2])

    def test_given_coordinates_stay(self):
        theta = xr.DataArray([10.0, 20.0], dims="ray", coords={"ray": ["a", "b"], "pixel": ("ray", [7, 8])})
        sigma = xr.DataArray([0.1, 0.2, 0.3], dims="part", coords={"plate": ("part", [1, 2, 3])})
        found = dolp.evaluate(self.scene, theta_deg=theta, sigma=sigma, evaluator="cpu")
        self.assertEqual(set(found.coords), {"ray", "pixel", "plate", "theta", "sigma"})
        self.assertEqual(found.pixel.dims + found.plate.dims, ("ray", "part"))

    def test_a_complex_n_gives_n_and_k(self):
        apart = dolp.evaluate(self.scene, theta_deg=60, n=[1.5, 2], k=[0.1, 3], evaluator="cpu")
        self.assertEqual(dolp.Scene(self.scene, {"surface.n": 2 + 3j})["surface.k"], 3.0)
        for index in ([1.5 + 0.1j, 2 + 3j], xr.DataArray([1.5 + 0.1j, 2 + 3j], dims="row")):
            together = dolp.evaluate(self.scene, theta_deg=60, n=index, evaluator="cpu")
            np.testing.assert_array_equal(together.dolp, apart.dolp)
        for call in (lambda: dolp.evaluate(self.scene, theta_deg=60, n=2j, k=1),
                     lambda: dolp.table(self.scene, theta_deg=60, n=1.5 + 1j)):
            with self.assertRaisesRegex(dolp.InputError, "n: "):
                call()

    def test_any_number_of_the_scene_varies(self):
        keys = {"emission.temperature_K": np.array([[280.0], [300.0]]), "surface.specular": [1, 0.5, 1]}
        found = dolp.evaluate(self.scene, theta_deg=[20, 40, 60], evaluator="cpu", **keys)
        self.assertEqual(found.dolp.shape, (2, 3))
        for i, j in ((0, 0), (1, 2), (1, 1)):
            own = self.scene.with_({"emission.temperature_K": (280, 300)[i], "surface.specular": (1, 0.5, 1)[j]})
            one = dolp.evaluate(own, theta_deg=(20, 40, 60)[j], evaluator="cpu")
            for name in ("dolp", "stokes_i", "status"):
                self.assertEqual(float(one[name]), float(found[name][i, j]))
        axes = {"emission.temperature_K": [280, 300], "surroundings.temperature_K": [240, 250, 260]}
        table = dolp.table(self.scene, theta_deg=[20, 40], **axes)
        self.assertEqual(table.dolp.dims, (*axes, "theta", "sigma", "q"))
        self.assertEqual(table["emission.temperature_K"].units, "K")
        xr.testing.assert_equal(table.dolp[1, 2].drop_vars([*axes]), dolp.table(self.scene.with_(
            {"emission.temperature_K": 300, "surroundings.temperature_K": 260}), theta_deg=[20, 40]).dolp)
        base = self.scene.with_({"emission.temperature_K": 310, "surface.specular": 0.9})
        table = dolp.table(base, theta_deg=np.linspace(0, 80, 21), sigma=0.2, q=3, evaluator="cpu", **axes)
        own = base.with_({"emission.temperature_K": 280, "surroundings.temperature_K": 250})
        own = dolp.table(own, theta_deg=np.linspace(0, 80, 21), sigma=0.2, q=3, evaluator="cpu")
        part = table.sel({"emission.temperature_K": 280})
        with self.assertRaisesRegex(dolp.InputError, "has 3 values of surroundings.temperature_K; take one"):
            dolp.lookup(part, theta_deg=33.3)
        found = dolp.lookup(part.sel({"surroundings.temperature_K": 250}), theta_deg=33.3)
        self.assertEqual(float(found.dolp), float(dolp.lookup(own, theta_deg=33.3).dolp))
        for key in ("surface.sigma", "surface.masking", "emission.temperature"):
            with self.assertRaisesRegex(dolp.InputError, key):
                dolp.table(self.scene, **{key: [0.1, 2]})
        for key in ("surface.masking", "emission.temperature", "surface.n"):
            with self.assertRaisesRegex(dolp.InputError, key):
                dolp.evaluate(self.scene, theta_deg=20, n=1.5, **{key: [1, 2]})

    def test_a_sea_in_one_key(self):
        sea = dolp.Scene(self.scene, {"surface.distribution": "gaussian", "surface.wind_m_s": 5})
        sigma = np.sqrt((0.003 + 0.00512 * 5) / 2)
        self.assertEqual((sea["surface.sigma"], sea["surface.wind_m_s"], sea["grid.sigma"]), (sigma, 5.0, [sigma]))
        points = dolp.evaluate(sea, theta_deg=60, wind_m_s=[5, 10], evaluator="cpu")
        self.assertEqual(float(points.dolp[0]), float(dolp.evaluate(sea, theta_deg=60, sigma=sigma, evaluator="cpu").dolp))
        self.assertEqual(points.dolp.dims, ("wind_m_s",))
        table = dolp.table(sea, theta_deg=[0, 60], wind_m_s=[5, 10], q=2, evaluator="cpu")
        by_wind = table.swap_dims(sigma="wind_m_s").dolp.sel(theta=60, q=2)
        np.testing.assert_array_equal(by_wind.sel(wind_m_s=[5, 10]), points.dolp)
        np.testing.assert_array_equal(dolp.lookup(table, theta_deg=60, wind_m_s=[5, 10]).dolp, points.dolp)
        self.assertEqual(dolp.table(sea, theta_deg=60, sigma=0.3, evaluator="cpu").sizes["sigma"], 1)
        data = {"theta_deg": np.arange(10, 90, 10.0), "uncertainty": np.full(8, 1e-3),
                "dolp": dolp.evaluate(sea, theta_deg=np.arange(10, 90, 10.0), wind_m_s=7, evaluator="cpu").dolp}
        found = dolp.fit(sea, data, {"surface.wind_m_s": (1, 14)}, evaluator="cpu")
        self.assertAlmostEqual(found.params["surface.wind_m_s"], 7, 2)
        self.assertAlmostEqual(found.scene["surface.sigma"], np.sqrt((0.003 + 0.00512 * 7) / 2), 4)
        for call in (lambda: dolp.evaluate(self.scene, theta_deg=60, wind_m_s=5, evaluator="cpu"),
                     lambda: dolp.evaluate(sea, theta_deg=60, wind_m_s=5, sigma=0.1),
                     lambda: dolp.table(self.scene, wind_m_s=5)):
            with self.assertRaisesRegex(dolp.InputError, "wind_m_s"):
                call()

    def test_materials_have_n_and_k(self):
        iron = dolp.material("iron")
        again = dolp.Scene(self.scene, {"surface.material": "iron", "spectrum.wavelength_um": 10.6})
        self.assertEqual(float(dolp.evaluate(again, theta_deg=60, evaluator="cpu").dolp),
                         float(dolp.evaluate(self.scene, theta_deg=60, n=iron.n(10.6) + 1j * iron.k(10.6), wavelength_um=10.6,
                                             evaluator="cpu").dolp))
        self.assertEqual(iron.n([[8, 9, 10]]).shape, (1, 3))
        self.assertIn("iron", repr(iron))
        self.assertEqual(dolp.material("WATER").name, "water 25C")
        axes = iron.plot()
        self.assertEqual(([line.get_label() for line in axes.lines], axes.get_title()), (["n", "k"], "iron"))
        for call in (lambda: dolp.material("irn"), lambda: iron.n(1000)):
            with self.assertRaisesRegex(dolp.InputError, "iron"):
                call()

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

    def test_none_removes_a_table(self):
        for nothing in (None, "none"):
            for scene in (dolp.Scene(self.scene, {"surroundings": nothing}), self.scene.with_({"surroundings": nothing}),
                          dolp.Scene(text=TEXT, overrides={"surroundings": nothing})):
                self.assertNotIn("surroundings", scene.toml())
        self.assertEqual(self.scene.without("surroundings").toml(), self.scene.with_({"surroundings": "none"}).toml())

    def test_mueller_matrices_have_the_shape_of_the_points(self):
        matrices = dolp.mueller(self.scene, theta_i_deg=[[10], [40]], theta_r_deg=[20, 30, 50], delta_phi_deg=180)
        self.assertEqual(matrices.shape, (2, 3, 4, 4))
        self.assertTrue((matrices[..., 0, 0] > 0).all())

    def test_a_fit_finds_what_made_the_data(self):
        scene = dolp.Scene(self.scene, {"accuracy.tolerance": 1e-5})
        theta = np.arange(5.0, 86.0, 5.0)
        truth = dolp.evaluate(scene, theta_deg=theta, n=1.62, sigma=0.23)
        noise = np.random.default_rng(3).normal(0, 0.002, theta.size)
        columns = {"theta_deg": theta, "q_over_i": (truth.stokes_q / truth.stokes_i).values + noise,
                   "uncertainty": np.full(theta.size, 0.002)}
        vary = {"surface.n": (1.1, 3), "surface.sigma": (0.01, 1)}
        found = dolp.fit(scene, columns, vary)
        for parameter, true in zip(found.values["parameters"], (1.62, 0.23)):
            low, high = parameter["interval_95"]
            self.assertTrue(low < true < high, parameter)
        self.assertIn("surface.n", repr(found))
        self.assertAlmostEqual(float(dolp.evaluate(found.scene, theta_deg=40).dolp),
                               float(dolp.evaluate(scene, theta_deg=40, n=found["surface.n"],
                                                   sigma=found["surface.sigma"]).dolp), 6)
        self.assertEqual(found.params["surface.n"], found["surface.n"])
        np.testing.assert_allclose(np.sqrt(np.diag(found.covariance)), list(found.stderr.values()))
        self.assertEqual(list(found.conf_interval(0.68)["surface.n"]), found.values["parameters"][0]["interval_68"])
        figure = found.plot().figure
        figure.savefig(self.folder / "fit.png")
        axes = figure.axes[0]
        self.assertGreater(len(axes.lines[-1].get_xdata()), 100)
        self.assertEqual((axes.get_ylabel(), axes.get_title()), ("Q/I (%)", "painted plate"))
        self.assertIn("bracket of all bounces", [text.get_text() for text in axes.get_legend().texts])
        ranked = dolp.fit(scene, columns, vary, compare={"surface.masking": ["smith", "v-cavity"]}, loss="huber",
                          plot=self.folder / "picture.png")
        self.assertEqual(len(ranked.values["models"]), 2)
        self.assertTrue((self.folder / "picture.png").exists())
        wider = dolp.fit(scene, columns, vary, model_error="bracket")
        self.assertEqual((list(wider.params), wider.stderr["surface.n"]), (list(found.params), None))
        (low, high), (narrow_low, narrow_high) = (one.conf_interval()["surface.n"] for one in (wider, found))
        self.assertTrue((low or 1.1) < narrow_low < 1.62 < narrow_high < (high or 3))
        line = found.plot().lines[-1]
        points = found.values["points"]
        np.testing.assert_allclose(np.interp([p["theta_deg"] for p in points], line.get_xdata(), line.get_ydata()),
                                   [100 * p["model"] for p in points], atol=2e-2)
        two = dolp.fit(scene, [(columns, {"emission.temperature_K": 300.0}), columns], vary)
        self.assertLess(two.values["parameters"][0]["standard_error"], found.values["parameters"][0]["standard_error"])

    def test_a_fit_has_a_word_for_its_quality_and_warns_of_the_model(self):
        theta = np.arange(20, 81, 10.0)
        metal = dolp.Scene(self.scene, {"surface.masking": "smith", "surface.n": 2.0, "surface.k": 8.0, "surface.q": 3.0})
        with warnings.catch_warnings(record=True):
            truth = dolp.evaluate(metal, theta_deg=theta, sigma=0.2)
        data = {"theta_deg": theta, "dolp": truth.dolp.values, "uncertainty": 1e-3}
        vary = {"surface.sigma": (0.05, 0.5)}
        for scene, options, warned in ((metal.with_({"surface.n": 2.0}), {}, 1),
                                       (metal.with_({"surface.n": 2.0}), {"model_error": "bracket"}, 0),
                                       (metal.with_({"surface.masking": "v-cavity", "surface.scattering": "multiple"}), {}, 0)):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                found = dolp.fit(scene, data, vary, evaluator="cpu", starts=4, **options)
            self.assertEqual([one.category for one in caught], [dolp.ModelWarning] * warned)
            if warned:
                self.assertEqual((found.fit_quality, caught[0].filename), ("good", __file__))
                self.assertEqual(found.conf_interval(scaled=True), found.conf_interval())
        with warnings.catch_warnings(record=True):
            wrong = dolp.fit(metal.with_({"surface.k": 3.0}), data, vary, evaluator="cpu", starts=4)
        self.assertEqual(wrong.fit_quality, "doubtful")
        self.assertEqual(list(wrong.conf_interval(0.68, scaled=True)["surface.sigma"]), wrong.values["parameters"][0]["scaled_68"])
        self.assertNotEqual(wrong.conf_interval(0.68, scaled=True), wrong.conf_interval(0.68))

    def test_a_fit_keeps_the_order_of_its_numbers_and_refuses_what_does_not_fit(self):
        theta = np.arange(10, 81, 10.0)
        data = {"theta_deg": theta, "q_over_i": dolp.evaluate(self.scene, theta_deg=theta, sigma=0.2, q=3).q_over_i.values,
                "uncertainty": 1e-3}
        vary = {"surface.sigma": (0.05, 0.5), "surface.n": (1.2, 2)}
        found = dolp.fit(self.scene, data, vary, starts=4, evaluator="cpu")
        self.assertEqual(list(found.params), list(vary))
        self.assertAlmostEqual(found.params["surface.n"], 1.5, delta=1e-3)
        for wrong, message in ((lambda: dolp.fit(self.scene, {**data, "q_over_i": [0.1]}, vary), "different lengths"),
                               (lambda: dolp.fit(self.scene, data, vary, compare={"surface.masking": ["smith", "foo"]}),
                                "surface.masking = foo: must be one of")):
            with self.assertRaisesRegex(dolp.InputError, message):
                wrong()

    def test_a_sky_over_zenith(self):
        sky = self.folder / "sky.csv"
        sky.write_text("zenith_deg,temperature_K\n0,230\n40,240\n70,262\n90,288\n")
        scene = self.scene.with_({"surroundings.profile": "sky.csv"})
        self.assertEqual((scene["surroundings.profile"], scene["surroundings.temperature_K"]), ("sky.csv", None))
        theta = np.linspace(0, 80, 41)
        table = dolp.table(scene, theta_deg=theta, sigma=0.2, q=3)
        between, exact = (look(theta_deg=33.3) for look in (lambda **at: dolp.lookup(table, **at),
                                                            lambda **at: dolp.evaluate(scene, sigma=0.2, q=3, **at)))
        bound = float(between.error_estimate) + float(exact.error_estimate)
        self.assertLessEqual(abs(float(between.dolp) - float(exact.dolp)), bound)
        reference = dolp.evaluate(scene, theta_deg=60, sigma=0.2, q=3, evaluator="reference")
        own = dolp.evaluate(scene, theta_deg=60, sigma=0.2, q=3)
        self.assertLessEqual(abs(float(reference.dolp) - float(own.dolp)), float(own.error_estimate))
        data = {"theta_deg": theta[5:], "q_over_i": table.q_over_i.values.ravel()[5:], "uncertainty": 1e-3}
        found = dolp.fit(scene, data, {"surface.n": (1.2, 2)}, starts=4)
        self.assertAlmostEqual(found.params["surface.n"], 1.5, delta=1e-3)
        self.run_program("table", "scene.toml", "-o", "t.nc", "--set", "surroundings.profile=sky.csv")
        sky.write_text("zenith_deg,temperature_K\n0,100\n90,100\n")  # the table keeps the sky with which it was computed
        self.run_program("verify", "t.nc")

    def test_a_response_is_what_the_file_holds(self):
        self.run_program("response", str(self.folder / "scene.toml"), "-o", "r.nc", "--evaluator", "cpu")
        self.assert_same(dolp.response(self.scene, evaluator="cpu"), xr.load_dataset(self.folder / "r.nc"))

    def test_moments_of_a_response_are_those_of_tables(self):
        """Compares indices like water, aluminium, glass and silver, within the sum of the stated errors."""
        axes = {"theta_deg": [0, 30, 60, 80, 89.5], "sigma": [0.05, 0.3, 1], "q": [1.75, 3], "evaluator": "cpu"}
        indices = [1.2 + 0.05j, 27 + 90j, 1.5 + 0j, 0.5 + 3j]
        for masking in ("none", "v-cavity", "integral", "smith"):
            for distribution in ("cauchy", "gaussian"):
                scene = self.scene.with_({"surface.masking": masking, "surface.distribution": distribution})
                moments = dolp.moments(dolp.response(scene, **axes), n=xr.DataArray(indices, dims="index"))
                for i, index in enumerate(indices):
                    table = dolp.table(scene.with_({"surface.n": index}), keep_all=True, **axes)
                    own = moments.isel(index=i)
                    for name in ("rho_i", "rho_q"):
                        off = abs(own[name] - table[name])
                        self.assertTrue((off <= own.rho_error + table.rho_error_estimate * table.rho_i).all(), (masking, index))
                        self.assertLess(float((off / table.albedo).max()), 1e-4)
                    self.assertTrue((abs(own.albedo - table.albedo) <= 2e-4 * table.albedo).all())
                    self.assertLess(float((own.rho_error / table.albedo).max()), 2e-4)

    def test_direct_emission_follows_from_a_response(self):
        for masking in ("v-cavity", "smith"):
            scene = self.scene.with_({"surface.masking": masking, "emission.model": "direct"})
            response, table = dolp.response(scene, evaluator="cpu"), dolp.table(scene, evaluator="cpu", keep_all=True)
            mean, half = fresnel(1.5 + 0.05j, response.beta)
            intensity = (response.emission_i * (1 - mean)).sum("beta")
            polarised = -(response.emission_q * half).sum("beta")
            for emissivity, expected in ((intensity + polarised, table.emissivity_s), (intensity - polarised, table.emissivity_p)):
                self.assertLess(float(abs(emissivity - expected).max()), 2e-4)

    def test_moments_take_reflectances_at_the_angles_alone(self):
        response = dolp.response(self.scene, evaluator="cpu", theta_deg=[0, 60], sigma=0.2, q=3)
        mean, half = fresnel(1.5 + 0.05j, response.beta)
        given = dolp.moments(response, r_s=mean + half, r_p=mean - half)
        expected = dolp.moments(response, n=1.5, k=0.05).drop_vars(["n", "k"])
        xr.testing.assert_allclose(given, expected)
        self.assertIn("comes on top", given.rho_error.long_name)
        layers = xr.DataArray([1, 0.5], {"layer": ["a", "b"]}, "layer")
        self.assertEqual(dolp.moments(response, r_s=layers * mean, r_p=layers * mean).rho_q.dims, ("theta", "sigma", "q", "layer"))
        several = dolp.moments(response.sel(theta=60), n=[1.3, 1.5, 4], k=0.05)
        self.assertEqual(several.rho_i.dims, ("sigma", "q", "n"))
        self.assertEqual(float(several.rho_i.sel(n=1.5)), float(expected.rho_i.sel(theta=60)))
        elsewhere = mean.assign_coords(beta=mean.beta + 1)
        for arguments, message in (({}, "needs either n"), ({"n": 1.5, "r_s": mean, "r_p": mean}, "needs either n"),
                                   ({"r_s": mean}, "needs either n"), ({"n": 0}, "n must be above 0"),
                                   ({"n": 1.5, "k": -1}, "k from 0 on"), ({"r_s": elsewhere, "r_p": mean}, "r_s: must be a DataArray"),
                                   ({"r_s": mean, "r_p": mean.values}, "r_p: must be a DataArray"),
                                   ({"r_s": 2 + mean, "r_p": mean}, "r_s: must be numbers in")):
            with self.assertRaisesRegex(dolp.InputError, message):
                dolp.moments(response, **arguments)
        with self.assertRaisesRegex(dolp.InputError, "axes: n is none of theta_deg, sigma, wind_m_s, q"):
            dolp.response(self.scene, n=1.5)
        multiple = self.scene.with_({"surface.masking": "v-cavity", "surface.scattering": "multiple"})
        with self.assertRaisesRegex(dolp.InputError, "must be \"single\" for a response table"):
            dolp.response(multiple)

    def test_pictures_show_what_the_table_has(self):
        host = pathlib.Path(__file__).resolve().parents[2] / "host"
        sys.path[:0] = [str(host), str(host / "tools")]
        import netCDF4
        import plot_fit
        import plot_table
        del sys.path[:2]
        self.assertLessEqual(set(plot_fit.SYMBOLS), {*dolp.keys()})
        for wavelengths, spectrum, title in ((None, [3, 5], "Plate, 3–5 µm"), (None, [9, 9], "Plate, 9 µm"), (8, [9, 9], "Plate")):
            report = {"title": "Plate, 8-14 um", "points": [{"wavelength_um": wavelengths}], "spectrum_um": spectrum}
            self.assertEqual(plot_fit.title_of(report), title)
        self.assertEqual(plot_fit.alike({"alike": [["a=1"], ["a=2"]],
                                         "ranges": [{"key": "surface.n", "models": 3, "interval_95": [1.36, None]}]}),
                         "\n2 models cannot be told apart; 95 % ranges over 3 models of ΔAIC up to 4:   n 1.36 to open")
        self.assertEqual(plot_fit.alike({"alike": []}), "")
        sea = {"title": "Sea, wind 8 m/s, 8-14 um", "surface.distribution": "gaussian", "surface.masking": "smith"}
        theta = {"from": 0, "to": 85, "count": 10}
        winds = {"from": 1, "to": 14, "count": 6}
        for changes, panels, zenith, title, legend in (
                ({"grid.sigma": 0.2}, 1, "zenith angle", "painted plate, 10 µm", "0.2"),
                ({"title": "Plate, 8-14 um", "grid.sigma": [0.1, 0.2, 0.3]}, 1, "zenith angle", "Plate, 10 µm", "0.3"),
                ({"spectrum.band_um": [3, 5], "grid.sigma": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]}, 2, "zenith angle",
                 "painted plate, 3–5 µm", "0.6"),
                ({"geometry.mode": "bistatic", "source.irradiance": 1, "grid.sigma": 0.2}, 1, "zenith of the source",
                 "painted plate, 10 µm", "0.2"),
                ({**sea, "grid.wind_m_s": winds, "emission.bracket": True}, 2, "zenith angle", "Sea, 10 µm", "14 m/s")):
            dolp.write_table(self.scene.with_({"grid.theta_deg": theta, **changes}), self.folder / "t.nc", evaluator="cpu")
            with netCDF4.Dataset(self.folder / "t.nc") as dataset:
                table = plot_table.Slice(dataset, dict.fromkeys(plot_table.SYMBOLS))
            plot_table.draw(table, self.folder / "t.png")
            figure = plot_table.plt.gcf()
            drawn = [axes for axes in figure.axes if axes.get_xlabel()]
            self.assertEqual((len(drawn), table.title), (panels, title))
            for axes in drawn:
                self.assertIn(zenith, axes.get_xlabel())
            self.assertIn(legend, " ".join(text.get_text() for text in drawn[0].get_legend().texts))
            if table.bracket:
                self.assertLess(np.nanmax(table.bracket), drawn[0].get_ylim()[1])
            plot_table.plt.close(figure)
        # By default a picture has the scene's q, n and k, and one of its curves has the scene's sigma.
        own = self.scene.with_({"surface.n": 1.4, "surface.k": 0.2, "surface.q": 5, "surface.sigma": 0.24})
        dolp.write_table(own, self.folder / "t.nc", evaluator="cpu", theta_deg=[0, 60], n=[1.4, 1.5, 1.6], k=[0.2],
                         sigma=np.linspace(0.1, 0.5, 41), q=[2, 3, 5])
        with netCDF4.Dataset(self.folder / "t.nc") as dataset:
            table = plot_table.Slice(dataset, dict.fromkeys(plot_table.SYMBOLS))
        self.assertEqual(table.place, "q = 5, n = 1.4, k = 0.2")
        np.testing.assert_allclose(table.sigma[plot_table.drawn_columns(table)], [0.1, 0.18, 0.24, 0.34, 0.42, 0.5])
        # The frame contains the peak of every curve. If DOLP is only a limit at 90 degrees, no line leads there.
        for diffuse in (0, 0.1):
            dolp.write_table(self.scene.with_({"surface.diffuse": diffuse, "surface.masking": "v-cavity"}), self.folder / "t.nc",
                             evaluator="cpu", theta_deg=np.linspace(0, 90, 91), sigma=[0, *np.linspace(0.5, 2, 60)], q=2)
            with netCDF4.Dataset(self.folder / "t.nc") as dataset:
                table = plot_table.Slice(dataset, dict.fromkeys(plot_table.SYMBOLS))
            self.assertEqual(np.isnan(table.dolp[-1]).all(), diffuse > 0)
            table.dolp[40, 0] = peak = 3 * table.largest()
            plot_table.draw(table, self.folder / "t.png")
            self.assertGreater(plot_table.plt.gcf().axes[0].get_ylim()[1], peak)
            plot_table.plt.close()


if __name__ == "__main__":
    unittest.main()
