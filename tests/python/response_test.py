"""Tests responses and the moments that follow from them."""
import pickle
import unittest

import numpy as np
import xarray as xr

import dolp
from package_case import PackageCase


def fresnel(index, beta):
    """(R_s + R_p) / 2 and (R_s - R_p) / 2 of a smooth surface."""
    cosine = np.cos(np.deg2rad(beta))
    root = np.sqrt(index ** 2 - 1 + cosine ** 2)
    r_s = abs((cosine - root) / (cosine + root)) ** 2
    r_p = abs((index ** 2 * cosine - root) / (index ** 2 * cosine + root)) ** 2
    return (r_s + r_p) / 2, (r_s - r_p) / 2


class Response(PackageCase):
    def test_a_response_is_what_the_file_holds(self):
        self.run_program("response", str(self.folder / "scene.toml"), "-o", "r.nc", "--evaluator", "cpu")
        self.assert_same(dolp.response(self.scene, evaluator="cpu"), xr.load_dataset(self.folder / "r.nc"))

    def test_moments_of_a_response_are_those_of_tables(self):
        """Moments of a response differ from those of a table by at most the sum of the stated errors.

        The indices are like those of water, aluminium, glass and silver.
        """
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
        crossed = dolp.moments(response, n=xr.DataArray([1.3, 1.5], dims="a"), k=xr.DataArray([0.05], dims="b"))
        self.assertEqual(crossed.rho_i.dims, ("theta", "sigma", "q", "a", "b"))
        self.assertEqual(float(several.rho_i.sel(n=1.5)), float(expected.rho_i.sel(theta=60)))
        elsewhere = mean.assign_coords(beta=mean.beta + 1)
        for arguments, message in (({}, "needs either n"), ({"n": 1.5, "r_s": mean, "r_p": mean}, "needs either n"),
                                   ({"r_s": mean}, "needs either n"), ({"n": 0}, "n must be above 0"),
                                   ({"n": 1.5, "k": -1}, "k from 0 on"), ({"n": 1.3 + 0.1j, "k": 0.2}, "n: is complex, so that k cannot"),
                                   ({"r_s": mean, "r_p": mean, "k": 0.2}, "needs either n"),
                                   ({"n": xr.DataArray([1.3, 1.5], {"theta": [0, 50]}, "theta")}, "of the response differ"),
                                   ({"r_s": layers * mean, "r_p": layers[:1] * mean}, "of the response differ"),
                                   ({"r_s": elsewhere, "r_p": mean}, "r_s: must be a DataArray"),
                                   ({"r_s": mean, "r_p": mean.values}, "r_p: must be a DataArray"),
                                   ({"r_s": 2 + mean, "r_p": mean}, "r_s: must be numbers in")):
            with self.assertRaisesRegex(dolp.InputError, message):
                dolp.moments(response, **arguments)
        with self.assertRaisesRegex(dolp.InputError, "axes: n is none of theta_deg, sigma, wind_m_s, q"):
            dolp.response(self.scene, n=1.5)
        multiple = self.scene.with_({"surface.masking": "v-cavity", "surface.scattering": "multiple"})
        with self.assertRaisesRegex(dolp.InputError, "must be \"single\" for a response table"):
            dolp.response(multiple)

    def test_parts_of_a_response_keep_their_moments(self):
        response = dolp.response(self.scene, evaluator="cpu", theta_deg=[0, 60, 90])
        expected = dolp.moments(response, n=1.5, k=0.05).rho_i
        response.to_netcdf(self.folder / "r.nc")
        sea = {"surface.distribution": "gaussian", "grid.wind_m_s": [2, 5]}
        winds = dolp.response(self.scene.with_({**sea, "grid.q": None}), evaluator="cpu")
        part = {"theta": 60, "sigma": 0.1, "q": 2}
        for whole in (response, xr.load_dataset(self.folder / "r.nc"), response.transpose("beta", "q", "theta", "sigma"),
                      response.isel(sigma=slice(None, None, -1)), response.stack(shape=("sigma", "q")).unstack("shape"),
                      response.drop_vars("emission_i"), response.where(response.theta < 80),
                      xr.concat([response.isel(theta=[i]) for i in range(3)], "theta"), response.copy(deep=True)):
            # The order of the sum over beta, and so its last digits, may depend on the order of the dimensions.
            self.assertAlmostEqual(float(dolp.moments(whole, n=1.5, k=0.05).rho_i.sel(part)), float(expected.sel(part)), 14)
        self.assertAlmostEqual(float(dolp.moments(response.sel(part), n=1.5, k=0.05).rho_i), float(expected.sel(part)), 14)
        one = dolp.moments(winds.swap_dims(sigma="wind_m_s").sel(wind_m_s=5), n=1.5)
        self.assertEqual(one.rho_i.sizes, dolp.moments(winds.isel(sigma=1), n=1.5).rho_i.sizes)
        others = [response, dolp.response(self.scene.with_({"surface.masking": "v-cavity"}), evaluator="cpu", theta_deg=[0, 60, 90])]
        joined = dolp.moments(xr.concat(others, "masking"), n=1.5, k=0.05).rho_i
        self.assertAlmostEqual(float(joined.isel(masking=0).sel(part)), float(expected.sel(part)), 14)

    def test_weights_that_were_not_computed_are_refused(self):
        response = dolp.response(self.scene, evaluator="cpu", theta_deg=[0, 58, 60, 62])
        hint = r"compute others instead of interpolating, as in dolp.response\(scene, theta_deg=65\)"
        for changed in (lambda r: r.interp(theta=59), lambda r: r.interp(theta=[58, 61]), lambda r: r.interp(sigma=0.2),
                        lambda r: r.mean("sigma"), lambda r: r.mean("q", keep_attrs=True), lambda r: r.sum("theta"),
                        lambda r: r.coarsen(theta=2).mean(), lambda r: r.rolling(theta=2).mean(), lambda r: r * 1.01,
                        lambda r: (r * 1.01).assign_attrs(r.attrs), lambda r: r + r, lambda r: r.assign(response_i=r.response_q),
                        lambda r: r.reindex(theta=[0, 65], method="nearest"), lambda r: r.assign_coords(theta=r.theta + 1),
                        lambda r: r.sortby("theta", ascending=False).assign_coords(theta=r.theta.values), lambda r: r.astype("float32"),
                        lambda r: r.isel(beta=slice(3, None)), lambda r: r.drop_vars("fingerprint"),
                        lambda r: r.interp(theta=60.0000001), lambda r: r.shift(theta=1),
                        lambda r: 0.5 * r.isel(theta=1) + 0.5 * r.isel(theta=2)):
            with self.assertRaisesRegex(dolp.InputError, f"^response: .*{hint}"):
                dolp.moments(changed(response), n=1.5)
        with self.assertRaisesRegex(dolp.InputError, "6 of 6 entries, the first at theta 59, sigma 0.1, q 2, are not as"):
            dolp.moments(response.interp(theta=59), n=1.5)
        empty = dolp.moments(response.reindex(theta=[60, 65]), n=1.5)
        self.assertTrue(np.isnan(empty.rho_i.sel(theta=65)).all() and np.isfinite(empty.rho_i.sel(theta=60)).all())
        with self.assertRaisesRegex(dolp.InputError, "has no response_i, so it is no response table; dolp.response"):
            dolp.moments(dolp.table(self.scene, evaluator="cpu"), n=1.5)
        with self.assertRaisesRegex(TypeError, "response: must be an xarray.Dataset, not DataArray"):
            dolp.moments(response.response_i, n=1.5)

    def test_a_response_needs_no_material(self):
        text = "surface = { sigma = 0.2, q = 3, masking = 'smith' }"
        (self.folder / "bare.toml").write_text(text)
        with self.assertRaisesRegex(dolp.InputError, "surface.n: missing"):
            dolp.Scene(text=text)
        expected = dolp.response(self.scene, evaluator="cpu", theta_deg=60, sigma=0.2, q=3)
        for bare in (dolp.Scene.for_response(text=text), dolp.Scene.for_response(self.folder / "bare.toml"),
                     dolp.Scene.for_response(self.scene), dolp.Scene.for_response(self.scene).with_({"title": "a"}),
                     pickle.loads(pickle.dumps(dolp.Scene.for_response(text=text))),
                     dolp.Scene.for_response(text="surface.sigma = 0.2", overrides={"surface": {"q": 3, "masking": "smith"}})):
            found = dolp.response(bare, evaluator="cpu", theta_deg=60, sigma=0.2, q=3)
            np.testing.assert_array_equal(found.response_i.values, expected.response_i.values)
            with self.assertRaisesRegex(dolp.InputError, "has no material.*only dolp.response takes it"):
                dolp.table(bare, evaluator="cpu")

    def test_a_response_table_is_no_scene_with_a_material(self):
        response = dolp.response(self.scene, evaluator="cpu", theta_deg=60, sigma=0.2, q=3)
        response.to_netcdf(self.folder / "r.nc")
        with self.assertRaisesRegex(dolp.InputError, "r.nc: is a response table, which has no material"):
            dolp.lookup(self.folder / "r.nc", theta_deg=60, evaluator="cpu")
        with self.assertRaisesRegex(dolp.InputError, "has no material.*only dolp.response takes it"):
            dolp.evaluate(dolp.Scene(response), theta_deg=60, evaluator="cpu")
        for surface in (dolp.Scene(response), dolp.Scene.for_response(self.folder / "r.nc")):
            again = dolp.response(surface, evaluator="cpu")
            np.testing.assert_array_equal(again.response_i.values, response.response_i.values)

    def test_dimensions_of_materials_have_any_name(self):
        response = dolp.response(self.scene, theta_deg=60, sigma=0.1, q=3, evaluator="cpu")
        n, k = np.r_[0.4, np.full(23, 1.5)], np.r_[0.3, np.full(23, 0.1)]
        own, other = (dolp.moments(response, n=xr.DataArray(n, dims=dim), k=xr.DataArray(k, dims=dim)) for dim in ("m", "material"))
        np.testing.assert_array_equal(own.rho_error.values, other.rho_error.values)
