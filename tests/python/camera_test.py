"""Tests Stokes parameters in the axes of a camera."""
import unittest

import numpy as np
import xarray as xr

import dolp
from package_case import PackageCase

ROUNDING_DEG = 1e-5  # near the view direction an angle has the error of a root of the rounding of a cosine
ROUNDING = 1e-12
Z = np.array([0, 0, 1.0])


def turned(angle_deg):
    """A direction of view for a random camera, and its right and up axes, turned by `angle_deg` about the view."""
    view = np.array([0.48, -0.6, 0.64])
    right = np.array([0.6, 0.48, 0]) / np.hypot(0.6, 0.48)
    above = np.cross(view, right)
    cos, sin = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    return view, cos * right + sin * above, cos * above - sin * right


class Camera(PackageCase):
    def setUp(self):
        super().setUp()
        self.emission = self.scene.with_({"surroundings": None})
        self.curve = dolp.evaluate(self.emission, theta_deg=np.linspace(0, 89, 90), evaluator="cpu")

    def test_emission_of_a_horizontal_surface_is_vertical(self):
        for azimuth in np.radians([0, 100, 250]):
            view = [np.cos(azimuth), np.sin(azimuth), 1.2]
            seen = dolp.camera_stokes(self.curve, Z, view, Z)
            own = dolp.evaluate(self.emission, theta_deg=seen.theta_deg, evaluator="cpu")
            self.assertAlmostEqual(float(seen.aolp_deg), 90, delta=ROUNDING_DEG)
            self.assertEqual(float(own.aolp_deg), 90)
            self.assertLess(float(seen.stokes_q), 0)
            self.assertAlmostEqual(float(seen.theta_deg), np.degrees(np.arctan2(1, 1.2)), delta=ROUNDING_DEG)
            # The error of linear interpolation in theta over 1 degree.
            self.assertAlmostEqual(float(seen.dolp), float(own.dolp), delta=1e-5)

    def test_emission_of_a_sphere_points_from_its_middle(self):
        for angle in (0, 40, 205):
            view, right, above = turned(angle)
            azimuth, theta = np.meshgrid(np.radians([10, 77, 160, 300]), np.radians([5, 50, 85]))
            parts = np.sin(theta) * np.cos(azimuth), np.sin(theta) * np.sin(azimuth), np.cos(theta)
            normals = np.stack(parts, axis=-1) @ np.stack([right, above, view])
            seen = dolp.camera_stokes(self.curve, 3 * normals, 2 * view, above + 0.3 * view)
            apart = (seen.aolp_deg.values - np.degrees(azimuth) + 90) % 180 - 90
            np.testing.assert_allclose(apart, 0, atol=ROUNDING_DEG)
            np.testing.assert_allclose(seen.theta_deg, np.degrees(theta), atol=ROUNDING_DEG)

    def test_axes_turn_q_and_u_and_keep_the_rest(self):
        glint = self.scene.with_({"geometry": {"mode": "bistatic", "view_zenith_deg": 40, "relative_azimuth_deg": 130},
                                  "source.irradiance": 20})
        own = dolp.evaluate(glint, theta_deg=35, evaluator="cpu")
        self.assertNotEqual(float(own.stokes_u), 0)
        view = [np.sin(np.radians(40)), 0, np.cos(np.radians(40))]
        upright = dolp.camera_stokes(own, Z, view, Z)
        for name in ("stokes_i", "stokes_q", "stokes_u", "dolp"):
            np.testing.assert_allclose(upright[name], own[name], rtol=ROUNDING)
        self.assertAlmostEqual(float(upright.aolp_deg), float(own.aolp_deg), delta=ROUNDING_DEG)
        # The camera turns clockwise by 25 degrees as its user sees it, so angles from its right axis grow by 25.
        right, above = np.array([0, 1.0, 0]), np.array([-view[2], 0, view[0]])
        leaning = dolp.camera_stokes(own, Z, view, np.cos(np.radians(25)) * above + np.sin(np.radians(25)) * right)
        apart = (float(leaning.aolp_deg) - float(own.aolp_deg) - 25 + 90) % 180 - 90
        self.assertAlmostEqual(apart, 0, delta=ROUNDING_DEG)
        np.testing.assert_allclose(leaning.dolp, own.dolp, rtol=ROUNDING)

    def test_normals_without_a_value_are_nan(self):
        normals = [[[0, 0, 1], [np.nan, 0, 1], [0, 0, -1]], [[1, 0, 0], [0, 0, 0], [1, 0, 0.001]]]
        seen = dolp.camera_stokes(self.curve, normals, Z, [0, 1, 0])
        self.assertEqual(seen.dolp.shape, (2, 3))
        np.testing.assert_array_equal(np.isfinite(seen.stokes_i), [[True, False, False], [False] * 3])
        self.assertGreater(float(seen.theta_deg[1, 2]), 89.9)  # beyond the zeniths of the result
        unpolarised = xr.Dataset({"stokes_i": 2.0, "stokes_q": 0.0, "stokes_u": 0.0})
        self.assertTrue(np.isnan(dolp.camera_stokes(unpolarised, Z, Z, [0, 1, 0]).aolp_deg))

    def test_pixels_without_axes_have_no_angle(self):
        light = xr.Dataset({"stokes_i": 2.0, "stokes_q": 0.2, "stokes_u": 0.0})
        normals = [[0, 0, 1], [0.1, 0, 1], [0, 0.2, 1], [np.nan] * 3]
        views = [[0, 0, 2], [0, 0, 1], [0, 1, 0], [np.nan] * 3]
        seen = dolp.camera_stokes(light, normals, views, [0, 1, 0])
        np.testing.assert_array_equal(np.isfinite(seen.aolp_deg), [False, True, False, False])
        np.testing.assert_array_equal(np.isfinite(seen.stokes_q), [False, True, False, False])
        np.testing.assert_allclose(seen.dolp, [0.1, 0.1, 0.1, np.nan])
        self.assertEqual(dolp.camera_stokes(light, np.zeros((0, 3)), np.zeros((0, 3)), Z).dolp.shape, (0,))
        toward = dolp.camera_stokes(self.curve, Z, Z, [0, 1, 0])  # unpolarised
        self.assertAlmostEqual(float(toward.stokes_q), 0, delta=1e-6)

    def test_values_for_each_normal_are_taken_as_they_are(self):
        normals = np.array([[[0.1, 0, 1], [0.5, 0.2, 1]], [[0, -1, 1], [0.3, 2, 1]]])
        views = np.array([[[0, 0, 1.0], [0.1, 0, 1]], [[0, 0.2, 1], [0.3, 0.1, 1]]])
        theta = dolp.camera_stokes(self.curve, normals, views, [0, 1, 0]).theta_deg
        own = dolp.evaluate(self.emission, theta_deg=theta, evaluator="cpu")
        each = dolp.camera_stokes(own, normals, views, [0, 1, 0])
        table = dolp.table(self.emission, theta_deg=np.linspace(0, 80, 161), sigma=0.2, q=3.0, evaluator="cpu")
        np.testing.assert_allclose(dolp.camera_stokes(table, normals, views, [0, 1, 0]).dolp, each.dolp, atol=1e-5)
        values = {"stokes_i": 2.0, "stokes_q": 1.0, "stokes_u": 0.0}
        images = xr.Dataset({name: (("y", "x"), np.full((2, 2), value)) for name, value in values.items()})
        np.testing.assert_allclose(dolp.camera_stokes(images, normals, views, [0, 1, 0]).dolp, 0.5, rtol=ROUNDING)

    def test_a_zenith_outside_the_result_is_nan(self):
        normals = [[np.sin(np.radians(t)), 0, np.cos(np.radians(t))] for t in (0, 40, 60)]
        table = dolp.table(self.emission, theta_deg=60, sigma=0.2, q=3, evaluator="cpu")
        for result in (table, table.squeeze(), dolp.evaluate(self.emission, theta_deg=60, evaluator="cpu"),
                       dolp.evaluate(self.emission, theta_deg=[60, 60.5], evaluator="cpu")):
            seen = dolp.camera_stokes(result, normals, Z, [0, 1, 0])
            np.testing.assert_array_equal(np.isnan(seen.dolp), [True, True, False])
            self.assertAlmostEqual(float(seen.dolp[2]), float(self.curve.dolp[60]), delta=2e-4)  # twice the tolerance
        one = dolp.camera_stokes(dolp.evaluate(self.emission, theta_deg=60, evaluator="cpu"), Z, Z, [0, 1, 0])
        self.assertTrue(np.isnan(one.dolp))

    def test_axes_of_a_table_are_no_pixels(self):
        table = dolp.table(self.emission, theta_deg=[0, 30, 60], sigma=[0.1, 0.2, 0.3, 0.4], q=[3, 4], evaluator="cpu")
        glint = dolp.evaluate(self.scene.with_({"geometry.mode": "bistatic", "source.irradiance": 20}), theta_deg=[0, 40], evaluator="cpu")
        for result, shape in ((table.isel(q=0), (3, 4)), (table.isel(theta=1), (4, 2)), (table.isel(theta=1, q=0), (4,))):
            with self.assertRaisesRegex(dolp.InputError, "select one value of each but theta"):
                dolp.camera_stokes(result, np.ones((*shape, 3)), Z, [0, 1, 0])
        for result in (glint, self.curve.drop_vars("theta")):
            with self.assertRaisesRegex(dolp.InputError, "theta has no zeniths of the camera"):
                dolp.camera_stokes(result, np.ones((5, 3)), Z, [0, 1, 0])

    def test_vectors_have_any_length(self):
        normals, view = np.array([[0, 0.3, 1], [0.5, 0.2, 1]]), np.array([0.1, 0, 1])
        right = dolp.camera_stokes(self.curve, normals, view, [0, 1, 0])
        for length in (1e-310, 1e-200, 1e155, 1e308):
            seen = dolp.camera_stokes(self.curve, length * normals, length * view, [0, length, 0])
            for name in right:
                np.testing.assert_allclose(seen[name], right[name], rtol=1e-9)

    def test_mistakes_are_named(self):
        table = dolp.table(self.emission, sigma=[0.1, 0.2], q=3.0, evaluator="cpu")
        for result, normals, view, up, message in (
                (self.curve, [1, 2], Z, Z, "normals: must have the shape"),
                (self.curve, [Z, Z], [[1, 0, 0]], Z, "view: must have shape"),
                (self.curve, [Z], Z, [0, 0, 2], "up: must not be parallel"),
                (table, [Z], Z, [0, 1, 0], "select one value of each but theta"),
                (self.curve[["dolp"]], [Z], Z, [0, 1, 0], "has no stokes_i")):
            with self.assertRaisesRegex(dolp.InputError, message):
                dolp.camera_stokes(result, normals, view, up)
