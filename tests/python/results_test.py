"""What results hold. Oracles: results.json and the CSV files of the same run, numpy, the normal distribution."""
import copy
import csv
import json
import pickle
import unittest

import numpy as np

import beamid
from support import STEEL, TUTORIAL, beamid as command, working_folder


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


if __name__ == "__main__":
    unittest.main()
