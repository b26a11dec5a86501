"""Records from numpy. Oracle: numpy.loadtxt of the file that is written, and beamid's own reader of it."""
import unittest

import numpy as np

import beamid
from support import TUTORIAL, beamid as command, working_folder

TIME = np.arange(400) / 200.0
MOTION = np.column_stack([np.sin(30 * TIME), 0.5 * np.sin(30 * TIME) + 1e-3 * np.cos(9 * TIME)])


class Records(unittest.TestCase):
    def test_any_order_of_memory_is_written_as_the_same_numbers(self):
        wide = np.zeros((800, 4))
        wide[::2, 1:3] = MOTION
        with working_folder():
            for name, samples in (("c", np.ascontiguousarray(MOTION)), ("f", np.asfortranarray(MOTION)),
                                  ("strided", wide[::2, 1:3]), ("reversed", MOTION[::-1][::-1])):
                beamid.Record(TIME, displacement_mm=samples).save(name + ".csv")
                read = np.loadtxt(name + ".csv", delimiter=",", skiprows=1)
                np.testing.assert_array_equal(read, np.column_stack([TIME, MOTION]), name)

    def test_units_and_places_reach_the_command(self):
        record = beamid.Record(TIME, acceleration_g=MOTION, force_n=TIME, position_m=[0.5, 1.1])
        self.assertEqual([one["quantity"] for one in record.keys["channels"]], ["acceleration", "acceleration", "force"])
        self.assertEqual([one.get("position_m") for one in record.keys["channels"]], [0.5, 1.1, None])
        with working_folder():
            record.save("record.csv")
            read = beamid.read("record.csv", **record.keys)
            np.testing.assert_allclose(read.samples[:, :2], MOTION * 9.80665, rtol=1e-15)
            self.assertEqual([one["position_m"] for one in read.channels], [0.5, 1.1, None])

    def test_a_rate_takes_the_place_of_times(self):
        record = beamid.Record(acceleration_m_per_s2=MOTION[:, 0], sampling_rate_hz=200.0)
        found = beamid.inspect(record)
        self.assertIn("400 samples", found.report)

    def test_arrays_are_records(self):
        rng = np.random.default_rng(3)
        t = np.arange(2000) / 200.0
        a = 4.0 * np.exp(-0.2 * t) * np.cos(2 * np.pi * 5.0 * t) + 0.01 * rng.normal(size=len(t))
        gaps = a.copy()
        gaps[500:520] = np.nan
        stamps = np.datetime64("2026-11-26T10:00:00") + (t * 1e6).astype("timedelta64[us]")
        for arguments, keywords in (((t, a), {}), ((a,), {"rate": 200}), ((t, gaps), {}), ((stamps, a), {}),
                                    ((t, np.column_stack([a, 0.3 * a + 0.01 * rng.normal(size=len(t))])), {"unit": "g"}),
                                    ((list(t), list(a)), {"quantity": "displacement", "unit": "mm"}),
                                    ((beamid.Record(t, a),), {}), ((beamid.Record(a, rate_hz=200),), {})):
            frequency = beamid.modal(*arguments, **keywords).tables["modes"]["frequency_hz"]
            self.assertAlmostEqual(frequency[0], 5.0, 3)
        self.assertAlmostEqual(beamid.identify(t, a, mass=2)["stiffness_n_per_m"].value / (2 * (10 * np.pi) ** 2), 1.0, 3)
        for call, message in ((lambda: beamid.modal(a), "signals without times"),
                              (lambda: beamid.modal(t, a[1:]), "times have 2000 samples and signals 1999"),
                              (lambda: beamid.modal(t, a, a), "3 arrays"),
                              (lambda: beamid.modal(t, np.array(["x"] * 2000)), "signals are no numbers")):
            with self.assertRaises(beamid.InputError) as refused:
                call()
            self.assertIn(message, str(refused.exception))

    def test_archives_of_numpy_are_read_compressed_or_not(self):
        time = np.arange(2000) / 200.0
        motion = np.exp(-0.15 * time) * np.cos(2 * np.pi * 5 * time)
        with working_folder():
            for rate in ({"fs": 200.0}, {"SampleRate": 200.0}, {"wf_increment": 0.005}):
                np.savez("plain.npz", acc=motion, **rate)
                np.savez_compressed("small.npz", acc=motion, **rate)
                found = [beamid.modal(name).tables["modes"]["frequency_hz"][0] for name in ("plain.npz", "small.npz")]
                self.assertEqual(found[0], found[1])
                self.assertAlmostEqual(found[0], 5.0, 3)
            with open("small.npz", "rb") as stream:
                whole = stream.read()
            with open("cut.npz", "wb") as stream:
                stream.write(whole[:200] + bytes(60) + whole[260:])
            with self.assertRaises(beamid.InputError):
                beamid.modal("cut.npz")

    def test_samples_of_a_file_cannot_be_written_to_and_outlive_it(self):
        samples = beamid.read(TUTORIAL / "tip_acceleration.csv").samples
        self.assertFalse(samples.flags.writeable)
        np.testing.assert_array_equal(samples[:, 0], np.loadtxt(TUTORIAL / "tip_acceleration.csv", delimiter=",", skiprows=1)[:, 1])

    def test_what_makes_no_sense_is_refused(self):
        for call, message in (
                (lambda: beamid.Record(TIME), "without a channel"),
                (lambda: beamid.Record(acceleration_g=TIME), "without time"),
                (lambda: beamid.Record(TIME, acceleration_g=TIME[1:]), "time has 400 samples and a channel 399"),
                (lambda: beamid.Record(TIME, acceleration_g=np.zeros((2, 2, 2))), "expected (N) or (N, p)"),
                (lambda: beamid.Record(TIME, acceleration_g=MOTION, position_m=[1, 2, 3]), "3 places for 2 sensors"),
                (lambda: beamid.read("nowhere.csv").samples, "nowhere.csv"),
                (lambda: beamid.modes(beamid.Record(TIME, force_n=TIME)), "modes takes no record"),
                (lambda: beamid.modes(3), "modes takes no int")):
            with self.assertRaises(beamid.InputError) as refused:
                call()
            self.assertIn(message, str(refused.exception))

    def test_a_stream_gives_what_the_command_prints(self):
        file = TUTORIAL / "tip_acceleration.csv"
        found = beamid.stream(beamid.read(file), config=TUTORIAL / "cantilever.toml")
        import subprocess

        from support import COMMAND
        with open(file, "rb") as samples:
            printed = subprocess.run([COMMAND, "stream", "--config", TUTORIAL / "cantilever.toml"], stdin=samples,
                                     capture_output=True, check=True).stdout.decode().splitlines()
        self.assertEqual(list(found), printed[0].split(","))
        self.assertEqual(len(found["time_s"]), len(printed) - 1)
        self.assertEqual(found["damping_ratio"][-1], float(printed[-1].split(",")[list(found).index("damping_ratio")]))

    def test_an_experiment_file_finds_its_files_from_anywhere(self):
        with working_folder():
            found = beamid.identify(config=TUTORIAL / "cantilever.toml", filter="ukf")
        expected = command("identify", "--config", TUTORIAL / "cantilever.toml", "--json").stdout.decode()
        self.assertNotEqual(found.json, expected)  # another filter
        self.assertEqual(found.values["configuration"]["experiment"]["filter"]["method"], "ukf")


if __name__ == "__main__":
    unittest.main()
