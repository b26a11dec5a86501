"""What results hold. Oracles: results.json and the CSV files of the same run, numpy, the normal distribution."""
import copy
import csv
import importlib.util
import json
import os
import pickle
import subprocess
import sys
import unittest

import numpy as np

import beamid
from support import SOURCE, STEEL, TUTORIAL, beamid as command, working_folder


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.found = beamid.identify(beamid.read(TUTORIAL / "tip_acceleration.csv"), beamid.Beam(**STEEL), window_s=(2, 10),
                                    unknown=["bending_stiffness", "damping_ratio"])

    def test_an_estimate_is_that_of_results_json(self):
        one = json.loads(self.found.json)["runs"][0]["parameters"]["damping_ratio"]
        found = self.found["damping_ratio"]
        self.assertEqual((found, found.value, found.standard_deviation), (one["estimate"], one["estimate"], one["standard_deviation"]))
        self.assertEqual(found.interval(0.95), (one["lower_95"], one["upper_95"]))
        self.assertEqual(found + 1, one["estimate"] + 1)

    def test_other_intervals_are_those_of_a_normal_distribution(self):
        found = beamid.Estimate(2.0, 0.5)
        for quantile, probability in ((1.0, 0.6826894921370859), (2.5758293035489004, 0.99)):  # [abramowitz1964, 26.2]
            np.testing.assert_allclose(found.interval(probability), (2 - 0.5 * quantile, 2 + 0.5 * quantile), rtol=1e-12)
        with self.assertRaises(beamid.InputError):
            found.interval(1.5)

    def test_an_estimate_is_shown_with_two_digits_of_its_deviation(self):
        self.assertEqual(repr(beamid.Estimate(509.38956, 0.01203, "N/m")), "509.390 +- 0.012 N/m")
        self.assertEqual(repr(beamid.Estimate(4321.0, 120.0)), "4321 +- 120")
        self.assertEqual(repr(beamid.Estimate(1.5, None)), "1.5")

    def test_tables_are_those_of_the_csv_files(self):
        with working_folder() as folder:
            self.found.write("out")
            for name, table in self.found.tables.items():
                with open(folder / "out" / (name + ".csv"), encoding="utf-8") as stream:
                    rows = list(csv.DictReader(stream))
                self.assertEqual(list(table), list(rows[0]))
                for key, column in table.items():
                    if column.dtype == object:
                        self.assertEqual(list(column), [row[key] for row in rows])
                    else:
                        np.testing.assert_array_equal(column, [float(row[key] or "nan") for row in rows])

    def test_a_frame_is_a_table(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("no python3-pandas")
        self.assertEqual(list(self.found.frame("runs")["filter"]), ["ekf"])
        self.assertEqual(list(self.found.frame().columns), list(next(iter(self.found.tables.values()))))

    def test_a_figure_has_a_short_repr(self):
        self.assertLess(len(repr(self.found.figures)), 1000)
        self.assertIn("2 panels", repr(self.found.figures["reproduction"]))
        self.assertEqual(repr(pickle.loads(pickle.dumps(self.found)).figures), repr(self.found.figures))

    def test_a_plot_draws_the_curves_of_the_figure(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no python3-matplotlib")
        matplotlib.use("Agg")
        figure = self.found.figures["reproduction"]
        drawn = self.found.plot("reproduction")
        self.assertEqual(len(drawn.axes), len(figure["panels"]))
        for axes, panel in zip(drawn.axes, figure["panels"]):
            self.assertEqual(axes.get_xlabel(), panel["x_label"])
            self.assertEqual(len(axes.lines), len(panel["curves"]))
            for line, curve in zip(axes.lines, panel["curves"]):
                np.testing.assert_array_equal(line.get_ydata(), curve["y"])
        for name in self.found.figures:
            self.found.plot(name).canvas.draw()
        self.assertEqual(len(self.found.plot().axes), len(drawn.axes))
        with self.assertRaisesRegex(beamid.InputError, "no figure 'spectra'; expected one of 'reproduction'"):
            self.found.plot("spectra")
        shown = self.found._repr_html_()
        self.assertEqual(shown.count("<img "), 1)
        self.assertLess(len(shown), 200_000)

    def test_a_plot_of_a_record_has_a_panel_for_each_quantity(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no python3-matplotlib")
        matplotlib.use("Agg")
        time = np.arange(100_000) / 500
        wave = np.sin(40 * time) * np.exp(-0.02 * time)
        wave[70_001] = 7.0
        drawn = beamid.Record(time, acceleration_g=np.c_[wave, -wave], displacement_mm=wave).plot()
        self.assertEqual([axes.get_ylabel() for axes in drawn.axes], ["acceleration [g]", "displacement [mm]"])
        self.assertEqual([len(axes.lines) for axes in drawn.axes], [2, 1])
        shown = drawn.axes[0].lines[0].get_ydata()
        self.assertLess(len(shown), 21_000)
        self.assertEqual((shown.max(), shown.min()), (wave.max(), wave.min()))  # an envelope loses no peak
        read = beamid.read(TUTORIAL / "tip_acceleration.csv")
        np.testing.assert_array_equal(read.plot().axes[0].lines[0].get_ydata(), read.samples[:, 0])

    def test_the_covariance_is_of_the_estimates(self):
        self.assertEqual(self.found.parameters, ["bending_stiffness", "damping_ratio"])
        deviations = [self.found[name].standard_deviation for name in self.found.parameters]
        np.testing.assert_allclose(np.sqrt(np.diag(self.found.covariance)), deviations, rtol=1e-9)
        self.assertLess(abs(self.found.covariance[0, 1]), 0.9 * deviations[0] * deviations[1])
        oscillator = beamid.identify(TUTORIAL / "tip_acceleration.csv", beamid.Beam(**STEEL), window_s=(2, 10))
        self.assertEqual(oscillator.parameters, ["frequency_hz", "damping_ratio", "stiffness_n_per_m", "damping_n_s_per_m"])
        covariance = oscillator.covariance
        np.testing.assert_allclose(np.sqrt(np.diag(covariance)), [oscillator[name].standard_deviation for name in oscillator.parameters],
                                   rtol=1e-9)
        slope = 0.5 * oscillator["frequency_hz"] / oscillator["stiffness_n_per_m"]  # of f = sqrt(K / M) / (2 pi)
        np.testing.assert_allclose(covariance[0], slope * covariance[2], rtol=1e-9)
        self.assertEqual(np.linalg.matrix_rank(covariance / np.sqrt(np.outer(np.diag(covariance), np.diag(covariance))), tol=1e-6), 2)

    def test_the_motion_of_the_estimates_leaves_what_the_report_says(self):
        samples = beamid.read(TUTORIAL / "tip_acceleration.csv", window_s=(2, 10))
        np.testing.assert_array_equal(self.found.time, samples.time)
        self.assertEqual(self.found.reproduced.shape, samples.samples.shape)
        left = 100 * np.linalg.norm(samples.samples - self.found.reproduced) / np.linalg.norm(samples.samples)
        run = self.found.values["runs"][0]
        self.assertAlmostEqual(left / run["response_error_percent"], 1, places=9)
        self.assertEqual(self.found.innovations.shape, samples.samples.shape)
        settled = self.found.innovations[200:]
        self.assertAlmostEqual(settled.std() / run["noise"][0], 1, delta=0.05)  # S is little more than R by then
        self.assertTrue(np.shares_memory(self.found.innovations, self.found._outcome.arrays()["", "innovations"]))

    def test_arrays_that_are_not_there_say_where_others_are(self):
        with self.assertRaisesRegex(AttributeError, "modes has no innovations; expected an identification"):
            beamid.modes(modes=1).innovations

    def test_curves_share_memory_with_the_results_and_outlive_them(self):
        found = beamid.modes(modes=1)
        before, again = found.figures, found._outcome.figures()
        name = next(iter(before))
        x, same = (one[name]["panels"][0]["curves"][0]["x"] for one in (before, again))
        self.assertTrue(np.shares_memory(x, same))
        self.assertFalse(x.flags.writeable or x.flags.owndata)
        kept = x.copy()
        del found, before, again, same
        np.testing.assert_array_equal(x, kept)

    def test_copies_and_pickles_hold_what_was_found(self):
        for other in (pickle.loads(pickle.dumps(self.found)), copy.deepcopy(self.found), copy.copy(self.found)):
            self.assertEqual(other.json, self.found.json)
            self.assertEqual(repr(other), repr(self.found))
            self.assertEqual(other.command, self.found.command)
            np.testing.assert_array_equal(other.innovations, self.found.innovations)
            np.testing.assert_array_equal(other.covariance, self.found.covariance)
            self.assertEqual(other["damping_ratio"].interval(), self.found["damping_ratio"].interval())
            for name, figure in self.found.figures.items():
                for mine, theirs in zip(figure["panels"][0]["curves"], other.figures[name]["panels"][0]["curves"]):
                    np.testing.assert_array_equal(mine["x"], theirs["x"])
            with self.assertRaises(beamid.InputError):
                other.write("anywhere")
        beam = beamid.Beam(**STEEL)
        self.assertEqual(pickle.loads(pickle.dumps(beam)), beam)
        record = beamid.Record(np.arange(3.0), force_n=np.arange(3.0))
        self.assertEqual(repr(pickle.loads(pickle.dumps(record))), repr(record))

    def test_several_runs_have_their_estimates_by_run(self):
        found = beamid.compare(beamid.read(TUTORIAL / "tip_acceleration.csv", window_s=(2, 4)), beamid.Beam(**STEEL),
                               reductions=["rayleigh", "modal_truncation"])
        self.assertIn(("rayleigh", "bending_stiffness"), found.estimates)
        with self.assertRaisesRegex(KeyError, "2 runs estimate 'bending_stiffness'"):
            found["bending_stiffness"]
        self.assertEqual(found.arrays["rayleigh", "innovations"].shape, (501, 1))
        for name in ("innovations", "covariance"):
            with self.assertRaisesRegex(AttributeError, "runs"):
                getattr(found, name)

    def test_a_misspelt_result_is_suggested(self):
        with self.assertRaisesRegex(KeyError, "did you mean 'damping_ratio'"):
            self.found["dampign_ratio"]

    def test_a_result_is_shown_as_the_report_of_the_command(self):
        text = command("modes", "--modes", "2").stdout.decode()
        self.assertTrue(text.startswith(repr(beamid.modes(modes=2))))

    def test_results_are_written_once_unless_forced(self):
        with working_folder():
            self.found.write("out")
            with self.assertRaisesRegex(beamid.InputError, "not empty"):
                self.found.write("out")
            self.found.write("out", force=True)

    def test_a_notebook_shows_verdict_estimates_and_the_report(self):
        page = self.found._repr_html_()
        self.assertIn("No warnings.", page)
        one = self.found["bending_stiffness"]
        self.assertIn(f"<td>bending_stiffness</td><td>{one.value:.6g}</td>", page)
        self.assertIn("<details><summary>beamid identify", page)
        self.assertLess(len(page), 200_000)
        self.assertIn("<th>frequency_hz</th>", beamid.modes(modes=2)._repr_html_())

    def test_the_verdict_has_every_objection_with_its_number(self):
        self.assertEqual(self.found.verdict["status"], "converged")
        time = np.arange(400) / 100.0
        short = beamid.modal(beamid.Record(time, acceleration_g=np.cos(20 * time), name="steady"))
        found = {one["name"]: one for one in short.verdict["objections"]}
        self.assertIn("no_decay", found)
        self.assertIn(found["no_decay"]["sentence"], [one["text"] for one in short.messages])

    def test_a_notebook_shows_records_and_structures(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no python3-matplotlib")
        matplotlib.use("Agg")
        noise = np.random.default_rng(1).standard_normal((1_000_000, 2))
        noise[7, 0], noise[8, 0] = 40.0, np.nan
        record = beamid.Record(np.arange(len(noise)) / 1000, acceleration_g=noise, name="<script>x")
        cell = record._repr_html_()
        self.assertIn("1000000 samples, 0 to 999.999 s", cell)
        self.assertIn("<td>column 1</td><td>acceleration [g]</td>", cell)
        self.assertIn("<td>40</td>", cell)
        self.assertNotIn("<script", cell)
        read = beamid.read(TUTORIAL / "tip_acceleration.csv")._repr_html_()
        self.assertIn("2501 samples, 0 to 10 s", read)
        frame = beamid.Experiment.read(SOURCE / "docs/tutorials/18_space_frame/tower.toml")
        cells = [cell, read, frame._repr_html_(), beamid.Beam(**STEEL)._repr_html_(),
                 beamid.Chain(masses_kg=[1e5] * 3, stiffnesses_n_per_m=[1e8] * 3)._repr_html_()]
        for shown in cells:
            self.assertEqual(shown.count("<img "), 1)
            self.assertLess(len(shown), 200_000)
        matrices = beamid.System(mass=np.eye(300), stiffness=np.eye(300))._repr_html_()
        self.assertLess(len(matrices), 2000)
        self.assertIn("no&lt;b&gt;.csv", beamid.read("no<b>.csv")._repr_html_())

    def test_a_notebook_is_executed(self):
        for module in ("nbconvert", "ipykernel", "matplotlib"):
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"no {module}; packages python3-nbconvert, python3-ipykernel, python3-matplotlib")
        cells = [f"import beamid\nrecord = beamid.read({str(TUTORIAL / 'tip_acceleration.csv')!r})\nrecord",
                 f"found = beamid.identify(record, config={str(TUTORIAL / 'cantilever.toml')!r})\nfound", "found.plot()",
                 f"beamid.Beam(**{STEEL!r})", "found.figures"]
        code = {"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": []}
        notebook = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": {"name": "python3", "display_name": "", "language": "python"}},
                    "cells": [{**code, "id": f"c{k}", "source": cell} for k, cell in enumerate(cells)]}
        with working_folder() as folder:
            (folder / "a.ipynb").write_text(json.dumps(notebook))
            made = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output", "b.ipynb", "a.ipynb"],
                                  capture_output=True, text=True, check=False,
                                  env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "IPYTHONDIR": str(folder), "HOME": str(folder)})
            self.assertEqual(made.returncode, 0, made.stderr)
            outputs = [cell["outputs"] for cell in json.loads((folder / "b.ipynb").read_text())["cells"]]
        for k in (0, 1, 3):
            page = "".join(outputs[k][-1]["data"]["text/html"])
            self.assertIn("<img ", page)
            self.assertLess(len(page), 200_000)
        self.assertIn("image/png", outputs[2][-1]["data"])
        self.assertLess(len("".join(outputs[4][-1]["data"]["text/plain"])), 1000)

    def test_a_notebook_runs_nothing_that_a_name_holds(self):
        time = np.arange(1000) / 500.0
        record = beamid.Record(time, acceleration_g=np.exp(-0.2 * time) * np.sin(40 * time), name="<script>x")
        page = beamid.modal(record, band=(1, 20))._repr_html_()
        self.assertIn("&lt;script&gt;", page)
        self.assertNotIn("<script", page)


if __name__ == "__main__":
    unittest.main()
