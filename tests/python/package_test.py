"""Tests scenes, points, tables and materials of the package."""
import doctest
import importlib
import tempfile
import unittest

import numpy as np
import pandas as pd
import xarray as xr

import dolp
from package_case import TEXT, PackageCase


class Package(PackageCase):
    def test_examples_in_the_documentation_hold(self):
        names = {"dolp": dolp, "np": np, "tempfile": tempfile, "scene": dolp.Scene(text=TEXT, overrides={
            "title": None, "surroundings": None, "grid": None, "grid.theta_deg": {"from": 0, "to": 80, "count": 5}})}
        rooms = [dolp, *(importlib.import_module(f"dolp.{room}") for room in ("_scene", "_camera", "_runs", "_fit", "_response"))]
        results = [doctest.testmod(room, extraglobs=names) for room in rooms]
        self.assertEqual(sum(failed for failed, _ in results), 0)
        self.assertGreater(sum(tried for _, tried in results), 25)

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
        chosen = ["status", "dolp"]
        dolp.write_table(self.scene, self.folder / "t.nc", evaluator="cpu", quantities=chosen)
        table = dolp.table(self.scene, evaluator="cpu", quantities=chosen)
        self.assertEqual(set(table.data_vars), set(chosen))
        self.assert_same(table, xr.load_dataset(self.folder / "t.nc"))
        with self.assertRaisesRegex(dolp.InputError, "quantities: dlop: must be one of dolp, q_over_i,.* status"):
            dolp.table(self.scene, quantities=["dlop"])

    def test_csv_and_npy_tables_open_in_numpy_and_pandas(self):
        self.run_program("table", "scene.toml", "-o", "t.csv", "--set", "title=\"a, b # c\"")
        by_numpy = np.genfromtxt(self.folder / "t.csv", names=True, delimiter=",")
        by_pandas = pd.read_csv(self.folder / "t.csv", comment="#", float_precision="round_trip")
        self.assertEqual(by_numpy.dtype.names, tuple(by_pandas.columns))
        self.assertEqual(by_numpy.dtype.names[:3], ("theta_deg", "sigma", "q"))
        dolp_of_table = dolp.table(self.scene).dolp.values.ravel()
        np.testing.assert_array_equal(by_numpy["dolp"], dolp_of_table)
        np.testing.assert_array_equal(by_pandas["dolp"], dolp_of_table)
        self.run_program("table", "scene.toml", "-o", "t.npy")
        by_name = np.load(self.folder / "t.npy")
        self.assertEqual((by_name.shape, by_name["theta_deg"][:, 0, 0].tolist()), ((4, 2, 3), [0, 30, 60, 85]))
        np.testing.assert_array_equal(by_name["dolp"].ravel(), dolp_of_table)
        by_program = self.folder / "again.csv"
        self.run_program("eval", "scene.toml", "--points", "t.csv", "-o", str(by_program))
        self.assertEqual(len(pd.read_csv(by_program)), len(by_pandas))

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
        on_axes = dolp.evaluate(self.scene, theta_deg=xr.DataArray(theta, dims="theta"), sigma=xr.DataArray([0.1, 0.2], dims="sigma"))
        np.testing.assert_array_equal(on_axes.dolp.sel(theta=60), named.dolp[2])
        np.testing.assert_array_equal(on_axes.sigma, [0.1, 0.2])
        constant = dolp.evaluate(self.scene, theta_deg=60, sigma=xr.DataArray([0.1, 0.2], dims="theta"), evaluator="cpu")
        np.testing.assert_array_equal(constant.theta, [60, 60])
        for wrong, message in ((xr.DataArray(np.ones((2, 2)), dims=("theta", "x")), "rename the dimension theta"),
                               (xr.DataArray([1.0, 2, 3], dims="part", coords={"part": [7, 8, 9]}), "DataArrays differ")):
            with self.assertRaisesRegex(dolp.InputError, message):
                dolp.evaluate(self.scene, theta_deg=wrong, sigma=xr.DataArray([0.1, 0.2, 0.3], dims="part", coords={"part": [1, 2, 3]}))
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

    def test_arrays_without_dimensions_join_data_arrays_of_their_shape(self):
        theta, sigma = xr.DataArray([30.0, 60, 85], dims="pixel"), [0.1, 0.2, 0.3]
        right = dolp.evaluate(self.scene, theta_deg=theta.values, sigma=sigma, q=3, evaluator="cpu")
        found = dolp.evaluate(self.scene, sigma=sigma, theta_deg=theta, q=3, evaluator="cpu")
        self.assertEqual((found.dolp.dims, found.sigma.dims, found.q.dims), (("pixel",), ("pixel",), ()))
        np.testing.assert_array_equal(found.dolp, right.dolp)
        table = dolp.table(self.scene, evaluator="cpu")
        np.testing.assert_array_equal(dolp.lookup(table.sel(q=5), theta_deg=theta, sigma=sigma).dolp,
                                      dolp.lookup(table.sel(q=5), theta_deg=theta.values, sigma=sigma).dolp)
        angles = {"theta_i_deg": 20, "delta_phi_deg": 180}
        self.assertEqual(dolp.mueller(self.scene, theta_r_deg=theta, sigma=sigma, **angles).shape, (3, 4, 4))
        response = dolp.response(self.scene, theta_deg=60, sigma=0.2, q=3, evaluator="cpu")
        self.assertEqual(dict(dolp.moments(response, n=theta, k=[0.1, 0.2, 0.3]).rho_i.sizes)["pixel"], 3)
        for wrong in (sigma[:2], [sigma]):
            with self.assertRaisesRegex(dolp.InputError, r"sigma has the shape .*dimensions pixel with the shape \(3,\); give an array"):
                dolp.evaluate(self.scene, theta_deg=theta, sigma=wrong, evaluator="cpu")

    def test_coordinates_are_the_numbers_that_the_call_uses(self):
        table = dolp.table(self.scene, evaluator="cpu")
        part = table.sel(sigma=0.4, q=5)
        found = dolp.evaluate(self.scene, theta_deg=part.theta.isel(theta=[0, 1]) + 5, q=3, evaluator="cpu")
        self.assertEqual((found.theta.values.tolist(), float(found.q), set(found.coords)), ([5, 35], 3, {"theta", "q"}))
        self.assertEqual(float(dolp.lookup(found, theta_deg=35).dolp), float(found.dolp.sel(theta=35)))
        stacked = table.isel(q=0).stack(point=("theta", "sigma"))
        again = dolp.evaluate(self.scene, theta_deg=stacked.theta, sigma=stacked.sigma, q=2, evaluator="cpu").unstack("point")
        self.assertEqual(dict(again.sizes), {"theta": 4, "sigma": 2})
        by_q = xr.DataArray([0.1, 0.2], {"q": [2, 3]}, "q")
        for points, message in (({"theta_deg": 30, "sigma": by_q}, "a value for each q, but q is not given"),
                                ({"theta_deg": stacked.theta}, "a value for each sigma, but sigma is not given"),
                                ({"theta_deg": stacked.theta / 2, "sigma": stacked.sigma}, "theta_deg differs from the theta")):
            with self.assertRaisesRegex(dolp.InputError, message):
                dolp.evaluate(self.scene, evaluator="cpu", **points)

    def test_names_may_come_from_a_generator(self):
        key = {"surroundings.temperature_K": [200, 240]}
        found = dolp.evaluate(self.scene, theta_deg=40, derivatives=iter(["surface.n"]), evaluator="cpu", **key)
        right = dolp.evaluate(self.scene, theta_deg=40, derivatives=["surface.n"], evaluator="cpu", **key)
        xr.testing.assert_equal(found, right)
        table = dolp.table(self.scene, quantities=iter(["dolp"]), evaluator="cpu", **key)
        self.assertEqual(set(table.data_vars), {"dolp"})

    def test_a_complex_n_gives_n_and_k(self):
        apart = dolp.evaluate(self.scene, theta_deg=60, n=[1.5, 2], k=[0.1, 3], evaluator="cpu")
        self.assertEqual(dolp.Scene(self.scene, {"surface.n": 2 + 3j})["surface.k"], 3.0)
        for index in ([1.5 + 0.1j, 2 + 3j], xr.DataArray([1.5 + 0.1j, 2 + 3j], dims="row")):
            together = dolp.evaluate(self.scene, theta_deg=60, n=index, evaluator="cpu")
            np.testing.assert_array_equal(together.dolp, apart.dolp)
        for call in (lambda: dolp.evaluate(self.scene, theta_deg=60, n=2j, k=1),
                     lambda: self.scene.with_({"surface": {"n": 2j, "k": 1}}),
                     lambda: dolp.table(self.scene, theta_deg=60, n=[1.5 + 1j, 2])):
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
        self.assertEqual(dolp.material("germanium").name, "Ge germanium")
        axes = iron.plot()
        self.assertEqual(([line.get_label() for line in axes.lines], axes.get_title()), (["n", "k"], "iron"))
        for call, message in ((lambda: dolp.material("irn"), "iron"), (lambda: iron.n(1000), "iron"), (lambda: iron.n([8, np.nan]), "NaN")):
            with self.assertRaisesRegex(dolp.InputError, message):
                call()

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
