#!/usr/bin/env python3
"""The Python package: python_test.py PROGRAM, with the package on PYTHONPATH and PROGRAM the command line beside it."""
import csv
import doctest
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
import xarray as xr

import dolp

PROGRAM = sys.argv.pop(1)
TEXT = """title = "painted plate"
[surface]
n = 1.5
k = 0.05
sigma = 0.2
q = 3.0
masking = "smith"
[emission]
temperature_K = 300.0
[surroundings]
temperature_K = 250.0
[spectrum]
wavelength_um = 10.0
[grid]
theta_deg = [0, 30, 60, 85]
sigma = [0.1, 0.4]
q = [2, 3.5, 5]
"""
# Some seconds of one core.
LONG = {"accuracy.tolerance": 1e-9, "surface.masking": "integral"}
LONG_AXES = "theta_deg=np.linspace(0, 89, 200), sigma=np.linspace(0.05, 2, 100), q=np.linspace(1.6, 6, 50)"


class Package(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "scene.toml").write_text(TEXT)
        self.scene = dolp.Scene(self.folder / "scene.toml")

    def run_program(self, *words):
        subprocess.run([PROGRAM, *words, "--quiet"], cwd=self.folder, check=True)

    def test_examples_in_the_documentation_hold(self):
        failed, tried = doctest.testmod(dolp, extraglobs={"dolp": dolp, "np": np, "scene": dolp.Scene(text="""
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
""")})
        self.assertEqual(failed, 0)
        self.assertGreater(tried, 15)

    def test_a_table_is_what_the_file_holds(self):
        self.run_program("table", "scene.toml", "-o", "t.nc")
        expected = xr.load_dataset(self.folder / "t.nc")
        table = dolp.table(self.scene)
        xr.testing.assert_equal(table, expected)
        for name in expected.variables:
            self.assertEqual(str(table[name].attrs), str(expected[name].attrs), name)
        self.assertEqual(set(table.attrs), set(expected.attrs))
        self.assertEqual(table.attrs["values_hash"], expected.attrs["values_hash"])

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

    def test_lookup_takes_a_file_or_a_dataset(self):
        table = dolp.table(self.scene, theta_deg=np.linspace(0, 85, 40), sigma=0.2, q=3)
        dolp.write_table(self.scene, self.folder / "t.nc", theta_deg=np.linspace(0, 85, 40), sigma=0.2, q=3)
        for source in (table, self.folder / "t.nc"):
            found = dolp.lookup(source, theta_deg=[33.3, 71])
            exact = dolp.evaluate(self.scene, theta_deg=[33.3, 71])
            self.assertTrue((abs(found.dolp - exact.dolp) <= found.error_estimate + exact.error_estimate).all())

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
        two = dolp.fit(scene, [(columns, {"emission.temperature_K": 300.0}), columns], vary)
        self.assertLess(two.values["parameters"][0]["standard_error"], found.values["parameters"][0]["standard_error"])

    def test_errors_are_one_line(self):
        for call in (lambda: dolp.Scene(self.folder / "none.toml"), lambda: dolp.Scene(),
                     lambda: dolp.Scene(self.scene, {"surface.sigma": -1}), lambda: dolp.Scene(self.scene, {"a": 1}),
                     lambda: dolp.evaluate(self.scene, theta_deg=95), lambda: dolp.evaluate(self.scene, zenith=3),
                     lambda: dolp.evaluate(self.scene, theta_deg=np.nan), lambda: dolp.table(self.scene, theta_deg=[]),
                     lambda: dolp.lookup(self.folder / "scene.toml", theta_deg=3),
                     lambda: dolp.fit(self.scene, {"theta_deg": [1]}, {"surface.n": (1, 2)}),
                     lambda: dolp.fit(self.scene, {"theta_deg": [1], "dolp": [0.1]}, {"surface.colour": (1, 2)}),
                     lambda: dolp.evaluate(self.scene, theta_deg=3, evaluator="abacus")):
            with self.assertRaises(ValueError) as caught:
                call()
            self.assertIsInstance(caught.exception, dolp.InputError)
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaises(dolp.DeviceError):
            dolp.evaluate(self.scene, theta_deg=3, device="no such device")
        with self.assertRaises(dolp.IoError):
            dolp.write_table(self.scene, self.folder / "none" / "t.nc")

    def test_scenes_and_plans_read_well(self):
        self.assertIn("masking = 'smith'", repr(self.scene))
        again = dolp.Scene(text=repr(dolp.Scene(self.scene, {"surface.sigma": 0.7, "emission.bracket": False})))
        self.assertIn("sigma = 0.7", repr(again))
        plan = dolp.plan(self.scene)
        self.assertEqual(plan.values["entries"], 24)
        self.assertIn("24", repr(plan))
        self.assertIn("version", dolp.citation())
        self.assertTrue(any(device["usable"] for device in dolp.devices()))

    def test_other_threads_run_during_a_call(self):
        ticks = []
        ends = threading.Event()

        def tick():
            while not ends.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.001)

        thread = threading.Thread(target=tick)
        thread.start()
        start = time.monotonic()
        dolp.table(dolp.Scene(self.scene, LONG), theta_deg=np.linspace(0, 89, 30), sigma=np.linspace(0.1, 1, 8))
        end = time.monotonic()
        ends.set()
        thread.join()
        self.assertGreater(sum(start < t < end for t in ticks), 3)

    def test_ctrl_c_ends_a_long_call(self):
        script = (f"import dolp, numpy as np\nscene = dolp.Scene('scene.toml', {LONG!r})\nprint('begins', flush=True)\n"
                  f"try:\n    dolp.write_table(scene, 't.nc', {LONG_AXES})\n"
                  "except KeyboardInterrupt:\n    print('interrupted', flush=True)\n"
                  "print(float(dolp.evaluate(dolp.Scene('scene.toml'), theta_deg=0).status))\n")
        with subprocess.Popen([sys.executable, "-c", script], cwd=self.folder, stdout=subprocess.PIPE,
                              text=True) as process:
            self.assertEqual(process.stdout.readline(), "begins\n")
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            out, _ = process.communicate(timeout=60)
        self.assertEqual(out, "interrupted\n0.0\n")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["scene.toml"])

    def test_a_forked_process_gets_an_error_and_the_cpu(self):
        dolp.evaluate(self.scene, theta_deg=30)
        child = os.fork()
        if child == 0:
            status = 1
            try:
                dolp.evaluate(self.scene, theta_deg=30)
            except dolp.DeviceError as error:
                on_cpu = dolp.evaluate(self.scene, theta_deg=30, evaluator="cpu")
                status = 0 if "fork" in str(error) and on_cpu.dolp > 0 else 2
            finally:
                os._exit(status)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)


if __name__ == "__main__":
    unittest.main()
