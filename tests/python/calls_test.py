"""Tests scenes as values, wrong calls, threads and processes."""
import copy
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings

import numpy as np

import dolp
from package_case import TEXT, PackageCase

# A table with these settings and axes takes some seconds of one core.
LONG = {"accuracy.tolerance": 1e-9, "surface.masking": "integral"}
LONG_AXES = "theta_deg=np.linspace(0, 89, 200), sigma=np.linspace(0.05, 2, 100), q=np.linspace(1.6, 6, 50)"


class Calls(PackageCase):
    def test_input_probably_meant_otherwise_is_a_warning_at_the_call(self):
        with self.assertWarnsRegex(dolp.InputWarning, "emission.temperature_K = 25: 25 K is cold") as caught:
            cold = self.scene.with_({"title": "cold"}), dolp.Scene(self.scene, {"emission.temperature_K": 25})
        self.assertEqual(caught.filename, __file__)
        for call in (lambda: dolp.table(self.scene, theta_deg=[3, 1, 2], evaluator="cpu"), lambda: dolp.Scene(cold[1], {"title": "b"})):
            with self.assertWarns(dolp.InputWarning) as caught:
                call()
            self.assertEqual(caught.filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            dolp.Scene(self.scene, {"emission.temperature_K": 290})
            dolp.evaluate(self.scene, theta_deg=[0, 0.1, 0.2, 0.3, 0.4], evaluator="cpu")
            dolp.evaluate(self.scene, theta_deg=[0, 1], evaluator="cpu")
            pickle.loads(pickle.dumps(cold[1]))
            with self.assertRaises(dolp.InputWarning):
                cold[1].with_({"title": "still cold"})
        with self.assertWarnsRegex(dolp.InputWarning, "points: theta_deg: is at most 1.5 degrees; is it in radians?") as caught:
            dolp.evaluate(self.scene, theta_deg=[0, 0.5, 1, 1.5], evaluator="cpu")
        self.assertEqual(caught.filename, __file__)
        with self.assertWarnsRegex(dolp.InputWarning, r"points\[0\]: temperature_K: 10 K is cold"):
            dolp.evaluate(self.scene, theta_deg=30, temperature_K=[10, 300], evaluator="cpu")
        with self.assertWarnsRegex(dolp.InputWarning, "data: theta_deg is at most 1.2 degrees"):
            dolp.fit(self.scene, {"theta_deg": [0.5, 1.2], "dolp": [0.01, 0.1]}, {"surface.n": (1.4, 1.6)}, starts=1, evaluator="cpu")

    def test_scenes_can_be_copied_and_sent(self):
        (self.folder / "n.csv").write_text("wavelength_um,n,k\n8,1.5,0.1\n14,1.45,0.2\n")
        with open(self.folder / "scene.toml", encoding="utf-8") as file:
            text = file.read().replace("n = 1.5\nk = 0.05\n", 'material_file = "n.csv"\n')
        (self.folder / "other.toml").write_text(text)
        scene = dolp.Scene(self.folder / "other.toml", {"surface.q": 4, "surroundings": None,
                                                        "grid.sigma": {"from": 0.1, "to": 1, "count": 3, "spacing": "log"}})
        scene = scene.with_({"surface.q": 5, "emission.bracket": True, "title": "ä"})
        for again in (pickle.loads(pickle.dumps(scene)), copy.copy(scene), copy.deepcopy(scene)):
            self.assertEqual(again.toml(), scene.toml())
            self.assertEqual(repr(again), repr(scene))
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            self.assertEqual(pool.map(dolp.Scene.toml, [scene, self.scene]), [scene.toml(), self.scene.toml()])
            points = pool.apply(dolp.evaluate, (scene,), {"theta_deg": 30, "evaluator": "cpu"})
        self.assertEqual(float(points.dolp), float(dolp.evaluate(scene, theta_deg=30, evaluator="cpu").dolp))

    def test_paths_need_not_be_utf_8(self):
        folder = os.fsencode(self.folder) + b"/\xff\xe9"
        os.mkdir(folder)
        for form in (os.fsencode, os.fsdecode):
            with self.assertRaisesRegex(dolp.InputError, "none.toml"):
                dolp.Scene(form(folder + b"/none.toml"))
            with open(folder + b"/scene.toml", "w", encoding="utf-8") as file:
                file.write(TEXT)
            scene = dolp.Scene(form(folder + b"/scene.toml"))
            self.assertIn("written", dolp.write_table(scene, form(folder + b"/t.nc"), evaluator="cpu"))
            found = dolp.lookup(form(folder + b"/t.nc"), theta_deg=30, sigma=0.1, q=2)
            self.assertEqual(float(found.dolp), float(dolp.lookup(dolp.table(scene, evaluator="cpu"), theta_deg=30, sigma=0.1, q=2).dolp))
            self.assertEqual(pickle.loads(pickle.dumps(scene)).toml(), scene.toml())
            self.assertIn("scene.toml", repr(scene))

    def test_dictionaries_and_complex_indices_are_taken_as_python_has_them(self):
        films = [{"material": "PMMA acrylic", "thickness_um": 2}, {"n": 1.5 + 0.05j, "thickness_um": 0.5}]
        coated = self.scene.with_({"surface.coating": [{"n": 2, "thickness_um": 1}] * 3}).with_({"surface.coating": films})
        keys = ("material", "thickness_um"), ("n", "k", "thickness_um")
        self.assertEqual([coated[f"surface.coating.{i}.{key}"] for i, own in enumerate(keys, 1) for key in own],
                         ["PMMA acrylic", 2, 1.5, 0.05, 0.5])
        self.assertIsNone(coated["surface.coating.3.n"])
        self.assertIsNone(coated.with_({"surface.coating": []})["surface.coating.1.thickness_um"])
        nested = self.scene.with_({"surface": {"n": 1.7 + 0.2j, "coating": films}, "grid": {"q": {"from": 2, "to": 4, "count": 3}}})
        self.assertEqual((nested["surface.n"], nested["surface.k"], nested["surface.masking"], nested["grid.q"]),
                         (1.7, 0.2, "smith", [2, 3, 4]))
        self.assertEqual(nested["surface.coating.2.k"], 0.05)
        table = dolp.table(self.scene, n=1.6 + 0.1j, evaluator="cpu")
        self.assertEqual((float(table.n), float(table.k)), (1.6, 0.1))
        self.assertTrue((table.dolp == dolp.table(self.scene, n=1.6, k=[0.1], evaluator="cpu").dolp).all())

    def test_wrong_kinds_are_told_in_the_words_of_python(self):
        table = dolp.table(self.scene, evaluator="cpu")
        dates = np.array(["2026-01-01"], dtype="datetime64[ns]")
        masked = np.ma.masked_array([10.0, 20.0], [False, True])
        for kind, message, call in (
                (TypeError, "scene: must be a dolp.Scene, not str", lambda: dolp.table("scene.toml")),
                (TypeError, "scene: must be a dolp.Scene, not NoneType", lambda: dolp.mueller(None, theta_i_deg=1)),
                (TypeError, "scene: must be a dolp.Scene, not PosixPath", lambda: dolp.fit(self.folder, {}, {})),
                (TypeError, "overrides: must be a dictionary", lambda: dolp.Scene(self.scene, ["surface.n", 1])),
                (TypeError, "overrides: must be a dictionary", lambda: self.scene.with_("surface.n=1")),
                (TypeError, "vary: must be a dictionary", lambda: dolp.fit(self.scene, {"theta_deg": [1], "dolp": [0]}, ["a"])),
                (TypeError, "data: must be a path or columns", lambda: dolp.fit(self.scene, 3, {"surface.n": (1, 2)})),
                (TypeError, "path: must be a path, not int", lambda: dolp.Scene(3)),
                (TypeError, "text: must be a str, not bytes", lambda: dolp.Scene(text=b"")),
                (TypeError, "path: must be a path, not list", lambda: dolp.write_table(self.scene, [])),
                (TypeError, "table: must be a path or an xarray.Dataset, not DataArray", lambda: dolp.lookup(table.dolp, theta_deg=3)),
                (TypeError, "table: must be a path or an xarray.Dataset, not NoneType", lambda: dolp.lookup(None, theta_deg=3)),
                (TypeError, "a key of a scene must be a str, not list", lambda: self.scene.without(["surface.k"])),
                (TypeError, "material: must be a str, not NoneType", lambda: dolp.material(None)),
                (TypeError, "evaluator: must be a str, not list", lambda: dolp.evaluate(self.scene, theta_deg=3, evaluator=["cpu"])),
                (TypeError, "keep_all: must be True or False, not 'yes'", lambda: dolp.table(self.scene, keep_all="yes")),
                (dolp.InputError, r"theta_deg: must be a number or a list, not an array of shape \(2, 1\)",
                 lambda: dolp.table(self.scene, theta_deg=[[1], [2]])),
                (dolp.InputError, "grid.theta_deg: must be a number or a list", lambda: self.scene.with_({"grid.theta_deg": [[1], [2]]})),
                (dolp.InputError, "emission.temperature_K is no axis of a file",
                 lambda: dolp.write_table(self.scene, self.folder / "t.nc", **{"emission.temperature_K": [280, 300]})),
                (dolp.InputError, "surface.foo: unknown key; the nearest known key is", lambda: self.scene.without("surface.foo")),
                (dolp.InputError, "starts = 0: must be a whole number from 1 to 10000", lambda: self.fit_points(starts=0)),
                (dolp.InputError, "plot .*fit.jpg: must end in .png", lambda: self.fit_points(plot=self.folder / "fit.jpg")),
                (TypeError, "starts: must be a whole number, not str", lambda: self.fit_points(starts="many")),
                (dolp.InputError, "seed = -1: must be a whole number", lambda: self.fit_points(seed=-1)),
                (dolp.InputError, "loss = square: must be one of squares", lambda: self.fit_points(loss="square")),
                (TypeError, "3: a key of a scene must be a str", lambda: self.scene.with_({3: 1})),
                (TypeError, "compare: must be a dictionary", lambda: self.fit_points(compare=["a"])),
                (TypeError, "surface.masking: must be a list", lambda: self.fit_points(compare={"surface.masking": 1})),
                (dolp.InputError, "surface.masking: is compared without a value",
                 lambda: self.fit_points(compare={"surface.masking": []})),
                (dolp.InputError, "the nearest is surface.sigma", lambda: self.scene["surface.sgma"]),
                (dolp.InputError, "roughness is none of .*; did you mean sigma?", lambda: dolp.evaluate(self.scene, roughness=0.1)),
                (dolp.InputError, "angle is none of .*; did you mean theta_deg?", lambda: dolp.table(self.scene, angle=30)),
                (dolp.InputError, "emission: is an empty dictionary; None removes a table", lambda: self.scene.with_({"emission": {}})),
                (dolp.InputError, "surface.coating: must be a list of dictionaries",
                 lambda: self.scene.with_({"surface.coating": {"n": 1.5, "thickness_um": 1}})),
                (dolp.InputError, "n: several complex values form no grid", lambda: dolp.table(self.scene, n=[1.5 + 0.1j, 1.6 + 0.1j])),
                (dolp.InputError, "n: is complex, so that k cannot be given too", lambda: dolp.table(self.scene, n=1.5 + 0.1j, k=0.1)),
                (dolp.InputError, "wavelength_um.* set spectrum.wavelength_um in the scene, which replaces the band",
                 lambda: dolp.evaluate(self.scene.with_({"spectrum.band_um": [8, 12]}), theta_deg=30, wavelength_um=10)),
                (dolp.InputError, "fit: surface.k is none of surface.n", lambda: self.fit_points()["surface.k"]),
                (dolp.InputError, "level = 0.9", lambda: self.fit_points().conf_interval(0.9)),
                (TypeError, "grid.q.count: must be a whole number, not float",
                 lambda: self.scene.with_({"grid.q": {"from": 2, "to": 3, "count": 2.5}})),
                (dolp.InputError, "grid.q.count = -3: must be a whole number",
                 lambda: self.scene.with_({"grid.q": {"from": 2, "to": 3, "count": -3}})),
                (dolp.InputError, "data: columns of different lengths", lambda: dolp.fit(
                    self.scene, {"theta_deg": [1, 2], "dolp": [0.1, 0.2, 0.3]}, {"surface.n": (1, 2)})),
                (dolp.InputError, "theta_deg: None are no numbers", lambda: dolp.evaluate(self.scene, theta_deg=None)),
                (dolp.InputError, "grid.q.from: .* no numbers", lambda: self.scene.with_({"grid.q": {"from": "a", "to": 3, "count": 2}})),
                (dolp.InputError, "must be a pair", lambda: dolp.fit(self.scene, [(1, 2, 3)], {"surface.n": (1, 2)})),
                (FileNotFoundError, "none.toml: there is no such file", lambda: dolp.Scene(self.folder / "none.toml")),
                (FileNotFoundError, "none.nc: there is no such file", lambda: dolp.lookup(self.folder / "none.nc", theta_deg=3)),
                (FileNotFoundError, "none.csv: there is no such file",
                 lambda: dolp.fit(self.scene, self.folder / "none.csv", {"surface.n": (1, 2)})),
                *((dolp.InputError, "cannot be read: File name too long", call) for call in (
                    lambda: dolp.Scene("n" * 300), lambda: dolp.lookup("n" * 300, theta_deg=3),
                    lambda: dolp.fit(self.scene, "n" * 300, {"surface.n": (1, 2)}),
                    lambda: self.scene.with_({"surface.material_file": "n" * 300}))),
                (dolp.InputError, "cannot be read: Is a directory", lambda: dolp.fit(self.scene, self.folder, {"surface.n": (1, 2)})),
                (dolp.InputError, r'axes: tolerance is .*scene.with_\({"accuracy.tolerance": ...}\)',
                 lambda: dolp.table(self.scene, tolerance=1e-3)),
                (dolp.InputError, r'points: masking is .*scene.with_\({"surface.masking": ...}\)',
                 lambda: dolp.evaluate(self.scene, masking="smith")),
                (dolp.InputError, "theta_deg: '0:90:10' is a text; numpy.linspace", lambda: dolp.table(self.scene, theta_deg="0:90:10")),
                (dolp.InputError, "is the text of a scene; write Scene", lambda: dolp.Scene("[surface]\nn = 1.5")),
                (dolp.InputError, "did you mean wavelength_um", lambda: dolp.lookup(table, wavelength=3)),
                (dolp.InputError, "points: thetadeg is none of theta_deg, sigma, (?!.*theta_i_deg).*; did you mean theta_deg",
                 lambda: dolp.evaluate(self.scene, thetadeg=[30])),
                (dolp.InputError, r'temperature_K is none of theta_i_deg, (?!.* theta_deg).*scene.with_\({"emission.temperature_K": ...}\)',
                 lambda: dolp.mueller(self.scene, theta_i_deg=1, temperature_K=300)),
                (dolp.InputError, r'points: surface.specular is none of .*scene.with_\({"surface.specular": ...}\)',
                 lambda: dolp.mueller(self.scene, theta_i_deg=1, **{"surface.specular": 0.1})),
                (dolp.InputError, r'scene: has .*iron.* on the axis material, .*scene.with_\({"surface.material": ...}\)',
                 lambda: dolp.mueller(self.scene.with_({"grid.material": ["iron", "PET"]}), theta_i_deg=1, theta_r_deg=1, delta_phi_deg=1)),
                (dolp.InputError, "theta_deg: .* no numbers but datetime64", lambda: dolp.evaluate(self.scene, theta_deg=dates)),
                (dolp.InputError, "surface.n: .* no numbers but datetime64", lambda: self.scene.with_({"surface.n": dates})),
                (dolp.InputError, "theta_deg: is a masked array", lambda: dolp.evaluate(self.scene, theta_deg=masked)),
                (dolp.InputError, "dolp: is a masked array",
                 lambda: dolp.fit(self.scene, {"theta_deg": [1, 2], "dolp": masked}, {"surface.n": (1, 2)})),
                (dolp.InputError, "theta_deg: .* no numbers", lambda: dolp.evaluate(self.scene, theta_deg=[[1], [2, 3]])),
                (dolp.InputError, "theta_deg: 1000.* no numbers of double", lambda: dolp.evaluate(self.scene, theta_deg=10**400)),
                (dolp.InputError, "surface.n: a int of very many digits", lambda: self.scene.with_({"surface.n": 10**5000})),
                (dolp.InputError, "starts = 1000.*: must be a whole", lambda: self.fit_points(starts=10**400)),
                (dolp.InputError, "attribute rule: 1000.* no numbers",
                 lambda: dolp.lookup(table.assign_attrs(rule=10**400), theta_deg=3)),
                *((dolp.InputError, r"ud800.*surrogate without its other half", call) for call in (
                    lambda: dolp.Scene(text="\ud800"), lambda: self.scene.with_({"title": "\ud800"}),
                    lambda: self.scene.with_({"\ud800": 1}), lambda: self.scene["\ud800"], lambda: dolp.material("\ud800"),
                    lambda: dolp.lookup(table.assign_attrs(rule="\ud800"), theta_deg=3),
                    lambda: dolp.table(self.scene, evaluator="\ud800"), lambda: dolp.write_table(self.scene, "\ud800.nc"),
                    lambda: self.fit_points(compare={"surface.masking": ["\ud800"]}),
                    lambda: dolp.fit(self.scene, {"theta_deg": [1], "\ud800": [1]}, {"surface.n": (1, 2)}))),
                (dolp.InputError, "path = .*: no path holds a zero byte", lambda: dolp.write_table(self.scene, "a\0.nc"))):
            with self.assertRaisesRegex(kind, message) as caught:
                call()
            self.assertNotIn("\n", str(caught.exception))
            self.assertNotIn("_native", str(caught.exception))
        self.assertEqual(dolp.evaluate(self.scene, theta_deg=30, device=0).dolp.shape, ())
        self.assertEqual(dolp.plan(self.scene, device=0).values["entries"], 24)

    def fit_points(self, **options):
        return dolp.fit(self.scene, {"theta_deg": [20, 40, 60], "dolp": [0.01, 0.03, 0.06]}, {"surface.n": (1.1, 3)},
                        evaluator="cpu", **options)

    def test_errors_are_one_line_and_bear_the_name_of_the_package(self):
        for error, call in ((dolp.InputError, lambda: dolp.Scene()),
                            (dolp.InputError, lambda: dolp.Scene(self.scene, {"surface.sigma": -1})),
                            (dolp.InputError, lambda: dolp.evaluate(self.scene, theta_deg=np.nan)),
                            (dolp.InputError, lambda: dolp.table(self.scene, theta_deg=[])),
                            (dolp.InputError, lambda: dolp.lookup(self.folder / "scene.toml", theta_deg=3)),
                            (dolp.DeviceError, lambda: dolp.evaluate(self.scene, theta_deg=3, device="no such device")),
                            (dolp.IoError, lambda: dolp.write_table(self.scene, self.folder / "none" / "t.nc"))):
            self.assertEqual(error.__module__, "dolp")
            self.assertTrue(error.__doc__)
            with self.assertRaises(error) as caught:
                call()
            self.assertNotIn("\n", str(caught.exception))
        self.assertTrue(issubclass(dolp.InputError, ValueError))

    def test_scenes_and_plans_read_well(self):
        self.assertIn("painted plate", repr(self.scene))
        self.assertNotIn("\n", repr(self.scene))
        again = dolp.Scene(text=dolp.Scene(self.scene, {"surface.sigma": 0.7, "emission.bracket": False}).toml())
        self.assertIn("sigma = 0.7", again.toml())
        self.assertEqual((self.scene["surface.sigma"], self.scene["surface.masking"], self.scene["grid.q"]), (0.2, "smith", [2, 3.5, 5]))
        self.assertEqual((self.scene["emission.bracket"], self.scene["path.radiance"], self.scene["spectrum.band_um"]), (False, None, None))
        self.assertLess(len(repr(dolp.Scene(text=TEXT, overrides={"grid.theta_deg": np.arange(90)}))), 200)
        self.assertIn("surface.sigma=0.7", repr(dolp.Scene(self.scene, {"surface.sigma": 0.7})))
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
                beams = dolp.mueller(self.scene, theta_i_deg=30, theta_r_deg=40, delta_phi_deg=170)
                status = 0 if "fork" in str(error) and on_cpu.dolp > 0 and beams[0, 0] > 0 else 2
            finally:
                os._exit(status)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)
