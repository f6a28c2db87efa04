"""Tests the pictures of tables and fits."""
import io
import os
import pathlib
import sys
import unittest
import unittest.mock

import netCDF4
import numpy as np

import dolp
from package_case import PackageCase

HOST = pathlib.Path(__file__).resolve().parents[2] / "host"
sys.path[:0] = [str(HOST), str(HOST / "tools")]
import plot_fit  # noqa: E402  (its path has to be known first)
import plot_skies  # noqa: E402
import plot_table  # noqa: E402
import plot_view  # noqa: E402


class Pictures(PackageCase):
    def test_pictures_show_what_the_table_has(self):
        self.assertLessEqual(set(plot_fit.SYMBOLS), {*dolp.keys()})
        for wavelengths, spectrum, title in ((None, [3, 5], "Plate, 3–5 µm"), (None, [9, 9], "Plate, 9 µm"), (8, [9, 9], "Plate")):
            report = {"title": "Plate, 8-14 um", "points": [{"wavelength_um": wavelengths}], "spectrum_um": spectrum}
            self.assertEqual(plot_fit.title_of(report), title)
            self.assertEqual(plot_fit.title_of({**report, "changed": "surface.k=1"}), f"{title}\nwith surface.k=1")
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
                ({"spectrum.response_file": str(HOST / "scenes/microbolometer.csv"), "spectrum.response_per": "photon",
                  "grid.sigma": 0.2}, 1, "zenith angle", "painted plate, response of microbolometer.csv", "0.2"),
                ({"geometry.mode": "bistatic", "source.irradiance": 1, "grid.sigma": 0.2}, 1, "zenith of the source",
                 "painted plate, 10 µm\nwith geometry.mode = bistatic, source.irradiance = 1", "0.2"),
                ({"title": "Plate", "geometry.mode": "bistatic", "source.irradiance": 1, "grid.theta_deg": 50,
                  "grid.view_zenith_deg": theta, "grid.relative_azimuth_deg": [0, 30, 60, 90, 120, 180]}, 2,
                 "zenith of the view", "Plate, 10 µm\nwith geometry.mode = bistatic, source.irradiance = 1", "180°"),
                ({**sea, "grid.wind_m_s": winds, "emission.bracket": True}, 2, "zenith angle",
                 "Sea, 10 µm\nwith surface.distribution = gaussian, surface.masking = smith, emission.bracket = true",
                 "14 m/s")):
            dolp.write_table(self.scene.with_({"grid.theta_deg": theta, **changes}), self.folder / "t.nc", evaluator="cpu")
            with netCDF4.Dataset(self.folder / "t.nc") as dataset:
                table = plot_table.Slice(dataset, dict.fromkeys(plot_table.SYMBOLS))
            plot_table.draw(table, self.folder / "t.png")
            figure = plot_table.plt.gcf()
            drawn = [axes for axes in figure.axes if axes.get_xlabel()]
            self.assertEqual((len(drawn), table.heading()), (panels, title))
            self.assertEqual(figure.texts[0].get_text().split(), title.split())
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
        np.testing.assert_allclose(table.y[plot_table.drawn_columns(table)], [0.1, 0.18, 0.24, 0.34, 0.42, 0.5])
        # The vertical axis of a picture includes the peak of every curve. With a diffuse part, I has no value at 90
        # degrees. A table then has the limit of DOLP towards 90 degrees, but a picture does not show it.
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

    def test_picture_over_view_and_azimuth_has_the_entries_of_the_table(self):
        glint = self.scene.with_({"geometry.mode": "bistatic", "source.irradiance": 1})
        t = dolp.table(glint, evaluator="cpu", theta_deg=[30, 50], view_zenith_deg=[60, 20, 40], relative_azimuth_deg=[180, 90],
                       sigma=0.2, q=3)
        t.to_netcdf(self.folder / "t.nc")
        with netCDF4.Dataset(self.folder / "t.nc") as dataset:
            table = plot_table.Slice(dataset, {**dict.fromkeys(plot_table.SYMBOLS), "theta": 50})
            with self.assertRaisesRegex(plot_table.NotATable, "without a chosen value"):
                plot_table.Slice(dataset, {**dict.fromkeys(plot_table.SYMBOLS), "theta": 50, "view_zenith_deg": 20})
        expected = t.dolp.sel(theta=50, sigma=0.2, q=3).sortby(["view_zenith_deg", "relative_azimuth_deg"])
        np.testing.assert_array_equal(table.dolp, 100 * expected)

    def test_pictures_of_materials_name_what_they_show(self):
        """A picture of several materials has one curve for each, the titles name them, and no curve leaves the axis."""
        table = self.folder / "t.nc"
        dolp.write_table(self.scene, table, evaluator="cpu", sigma=0.2, q=3,
                         theta_deg=np.linspace(0, 85, 18), material=["gold (Ordal)", "iron", "PET"])
        scene = "in “painted plate”, 10 µm"
        for options, title, names in (([], f"3 materials {scene}", ["gold (Ordal)", "iron", "PET"]),
                                      (["--material", "gold"], f"gold (Ordal) {scene}", ["$\\sigma$ = 0.2"]),
                                      (["--rank", "60"], f"3 materials {scene}", [])):
            with unittest.mock.patch("sys.argv", ["plot_table.py", str(table), str(self.folder / "t.png"), *options]):
                self.assertEqual(plot_table.main(), 0)
            axes = plot_table.plt.gcf().axes[0]
            self.assertEqual(plot_table.plt.gcf().texts[0].get_text(), title)
            curves = [line for line in axes.lines if line.get_label() in names]
            self.assertEqual([line.get_label() for line in curves], names)
            for line in axes.lines:
                self.assertLess(np.nanmax(line.get_ydata()), axes.get_ylim()[1])
            plot_table.plt.close()

    def test_plots_of_the_window_have_no_legend_on_a_curve_and_name_the_grey_of_the_map(self):
        theta = [*range(0, 91)]
        curve = {"style": "curve", "at": theta, "values": theta, "good": [True] * 91, "low": [None] * 91, "high": [None] * 91}
        axis = {"label": "x", "from": 0, "to": 90, "is_log": False}
        grid = {"x": axis, "y": axis, "label": "DOLP", "is_log": False, "is_signed": False, "colours": None}
        for count, bad in ((1, None), (6, 2.0)):
            plots = {"title": "Plate", "x": axis, "y": axis, "measured": [], "sweep": None,
                     "map": {**grid, "rows": [[1.0, bad], [2.0, 3.0]]},
                     "curves": [{**curve, "name": f"curve {i} " + 8 * i * "x", "style": i or "curve"} for i in range(count)]}
            with unittest.mock.patch("sys.stdout", unittest.mock.Mock(buffer=io.BytesIO())):
                plot_view.draw(plots, ".svg")
            figure = plot_view.plt.gcf()
            curves, grey = figure.axes[:2]
            self.assertGreaterEqual(curves.get_legend().get_window_extent().y0, curves.get_window_extent().y1)
            self.assertLess(curves.get_legend().get_window_extent().y1, figure.texts[0].get_window_extent().y0)
            self.assertTrue(curves.get_legend().texts[0].get_text().startswith("curve 0"))
            self.assertEqual(max(curves.lines, key=lambda line: line.zorder).get_label(), plots["curves"][0]["name"])
            self.assertEqual(grey.get_legend() is None, bad is not None)
            plot_view.plt.close()

    def test_pictures_of_skies_end_before_a_limit_that_jumps(self):
        """With a diffuse part, I has no value at 90 degrees. The pictures of skies do not show Q/I there."""
        table = plot_skies.results(os.environ["DOLP_PROGRAM"], ["grid.theta_deg=[60, 89, 90]"], 0.15)
        self.assertEqual([*np.isnan(table["q_over_i"])], [False, False, True])
