"""Tests fits."""
import unittest
import warnings

import numpy as np

import dolp
from package_case import PackageCase


class Fit(PackageCase):
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
        few = {"starts": 4, "evaluator": "cpu"}
        ranked = dolp.fit(scene, columns, vary, compare={"surface.masking": ["smith", "v-cavity"]}, loss="huber",
                          plot=self.folder / "picture.png", **few)
        self.assertEqual(len(ranked.values["models"]), 2)
        self.assertTrue((self.folder / "picture.png").exists())
        wider = dolp.fit(scene, columns, vary, model_error="bracket", **few)
        self.assertEqual((list(wider.params), wider.stderr["surface.n"]), (list(found.params), None))
        (low, high), (narrow_low, narrow_high) = (one.conf_interval()["surface.n"] for one in (wider, found))
        self.assertTrue((low or 1.1) < narrow_low < 1.62 < narrow_high < (high or 3))
        line = found.plot().lines[-1]
        points = found.values["points"]
        np.testing.assert_allclose(np.interp([p["theta_deg"] for p in points], line.get_xdata(), line.get_ydata()),
                                   [100 * p["model"] for p in points], atol=2e-2)
        two = dolp.fit(scene, [(columns, {"emission.temperature_K": 300.0}), columns], vary, **few)
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
                self.assertEqual((found.fit_quality, caught[0].filename), ("doubtful", __file__))
                self.assertGreater(found.values["p_value"], 0.05)
                self.assertEqual(found.conf_interval(scaled=True), found.conf_interval())
        with warnings.catch_warnings(record=True):
            wrong = dolp.fit(metal.with_({"surface.k": 3.0}), data, vary, evaluator="cpu", starts=4)
        self.assertEqual(wrong.fit_quality, "doubtful")
        self.assertEqual(list(wrong.conf_interval(0.68, scaled=True)["surface.sigma"]), wrong.values["parameters"][0]["scaled_68"])
        self.assertNotEqual(wrong.conf_interval(0.68, scaled=True), wrong.conf_interval(0.68))

    def test_a_fit_warns_if_further_bounces_may_change_it(self):
        """Single scattering fits paint with all bounces well, by a wrong n and sigma. No point has status 32."""
        theta = np.arange(10, 61, 10.0)
        grooves = self.scene.with_({"surface.masking": "v-cavity", "surroundings": None})
        truth = dolp.evaluate(grooves.with_({"surface.scattering": "multiple"}), theta_deg=theta, sigma=0.2)
        vary = {"surface.n": (1.1, 3), "surface.sigma": (0.05, 0.6)}
        for uncertainty, quality in ((0.001, "doubtful"), (0.05, "good")):
            data = {"theta_deg": theta, "dolp": truth.dolp.values, "uncertainty": uncertainty}
            scene = dolp.Scene(grooves)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                found = dolp.fit(scene, data, vary, evaluator="cpu", starts=4)
            self.assertEqual((found.fit_quality, found.values["status"] & 32), (quality, 0), found)
            self.assertGreater(found.values["p_value"], 0.05, found)
            self.assertEqual(found.values["model_gap_in_uncertainties"] > 1, quality == "doubtful")
            self.assertEqual(["light of further bounces can move the model by" in str(one.message) for one in caught],
                             [True] if quality == "doubtful" else [])

    def test_a_fit_keeps_the_order_of_its_numbers(self):
        theta = np.arange(10, 61, 10.0)
        data = {"theta_deg": theta, "q_over_i": dolp.evaluate(self.scene, theta_deg=theta, sigma=0.2, q=3).q_over_i.values,
                "uncertainty": 1e-3}
        vary = {"surface.sigma": (0.05, 0.5), "surface.n": (1.2, 2)}
        found = dolp.fit(self.scene, data, vary, starts=4, evaluator="cpu")
        self.assertEqual(list(found.params), list(vary))
        self.assertAlmostEqual(found.params["surface.n"], 1.5, delta=1e-3)
