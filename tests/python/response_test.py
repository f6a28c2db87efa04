#!/usr/bin/env python3
"""Tests responses and the moments that follow from them."""
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


if __name__ == "__main__":
    unittest.main()
