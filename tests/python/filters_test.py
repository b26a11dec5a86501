"""Filters on arrays. Oracles: a Kalman filter of ten lines in numpy, the closed form of a decay, the command itself."""
import unittest

import numpy as np

import beamid
from support import STEEL, TUTORIAL


class Tracked:
    """Position and velocity under random accelerations; the position is read."""

    def __init__(self, jacobians):
        self.a, self.h = np.array([[1.0, 0.1], [0.0, 1.0]]), np.array([[1.0, 0.0]])
        self.b = np.array([0.005, 0.1])
        self.process_noise, self.output_noise = 0.1 * np.array([[1e-4, 5e-4], [5e-4, 1e-2]]), np.array([[0.04]])
        if jacobians:
            self.transition_jacobian = lambda z, u: self.a
            self.output_jacobian = lambda z, u: self.h

    def transition(self, z, u):
        return self.a @ z + (self.b * u[0] if len(u) else 0)

    def output(self, z, u):
        return self.h @ z


def symmetric(matrix):
    return (matrix + matrix.T) / 2


class NumpyKalman:
    """What register_filter asks for."""

    def __init__(self, model, inflate=0.0):
        self.model, self.inflate = model, inflate

    def reset(self, mean, covariance):
        self.mean, self.covariance = mean, covariance

    def predict(self, u):
        a, q = self.model.transition_jacobian(self.mean, u), self.model.process_noise
        self.mean = self.model.transition(self.mean, u)
        self.covariance = symmetric((1 + self.inflate) * a @ self.covariance @ a.T + (q if q.size else 0))

    def correct(self, y, u):
        h, r = self.model.output_jacobian(self.mean, u), self.model.output_noise
        rest, s = y - self.model.output(self.mean, u), h @ self.covariance @ h.T + r
        gain = np.linalg.solve(s, h @ self.covariance).T
        self.mean = self.mean + gain @ rest
        kept = np.eye(len(self.mean)) - gain @ h
        self.covariance = symmetric(kept @ self.covariance @ kept.T + gain @ r @ gain.T)
        return rest, s


def kalman(model, outputs, inputs, mean, covariance):
    means, filtered = [], NumpyKalman(type("M", (), {"transition_jacobian": lambda s, z, u: model.a, "output_jacobian": lambda s, z, u: model.h,
                                                     "transition": lambda s, z, u: model.transition(z, u),
                                                     "output": lambda s, z, u: model.output(z, u),
                                                     "process_noise": model.process_noise, "output_noise": model.output_noise})())
    filtered.reset(mean, covariance)
    for k, y in enumerate(outputs):
        if k:
            filtered.predict(inputs[k - 1])
        if np.isfinite(y).all():
            filtered.correct(y, inputs[k])
        means.append(filtered.mean)
    return np.array(means), filtered.covariance


class Filters(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(3)
        self.outputs, self.inputs = random.normal(size=(80, 1)), random.normal(size=(80, 1))
        self.outputs[17] = np.nan
        self.start = np.array([0.2, -0.1]), np.diag([1.0, 0.5])

    def test_a_model_in_python_is_filtered_as_numpy_does(self):
        for jacobians in (True, False):
            model = Tracked(jacobians)
            means, covariance = kalman(model, self.outputs, self.inputs, *self.start)
            for name in ("kf", "ekf", "ukf", "srukf"):
                run = beamid.run_filter(name, model, self.outputs, *self.start, inputs=self.inputs, keep="all")
                np.testing.assert_allclose(run.means, means, rtol=0, atol=1e-7, err_msg=name)
                np.testing.assert_allclose(run.covariance, covariance, rtol=0, atol=1e-8)
        self.assertTrue(np.isnan(run.innovations[17, 0]))

    def test_a_filter_in_python_runs_on_arrays_and_in_identify(self):
        if "numpy_kalman" not in beamid.list("filters"):
            beamid.register_filter("numpy_kalman", NumpyKalman, options={"inflate": 0.0})
        own = beamid.run_filter("numpy_kalman", Tracked(True), self.outputs, *self.start, inputs=self.inputs)
        known = beamid.run_filter("kf", Tracked(True), self.outputs, *self.start, inputs=self.inputs)
        np.testing.assert_allclose(own.mean, known.mean, atol=1e-10)
        self.assertAlmostEqual(own.log_likelihood, known.log_likelihood, places=8)
        beam = beamid.Beam(**STEEL)
        found = beamid.identify(TUTORIAL / "tip_acceleration.csv", beam, window_s=(2, 6), filter="numpy_kalman")
        same = beamid.identify(TUTORIAL / "tip_acceleration.csv", beam, window_s=(2, 6), filter="ekf")
        self.assertAlmostEqual(found["stiffness_n_per_m"].value / same["stiffness_n_per_m"].value, 1, places=8)
        self.assertAlmostEqual(found["stiffness_n_per_m"].standard_deviation / same["stiffness_n_per_m"].standard_deviation, 1, places=4)

    def test_an_error_in_python_says_itself(self):
        class Broken(Tracked):
            def output(self, z, u):
                raise RuntimeError("the sensor is asleep")

        self.assertIn("the sensor is asleep", beamid.run_filter("ekf", Broken(True), self.outputs, *self.start).failure)
        with self.assertRaisesRegex(beamid.InputError, "did you mean|known"):
            beamid.run_filter("ekff", Tracked(True), self.outputs, *self.start)
        with self.assertRaisesRegex(beamid.InputError, "do not fit"):
            beamid.run_filter("ekf", Tracked(True), self.outputs, [0.0], np.eye(2))

    def test_the_oscillator_of_the_vector_engine_is_the_registered_filter(self):
        t = 0.004 * np.arange(2000)
        random = np.random.default_rng(1)
        x = 0.012 * np.exp(-1.3 * t) * np.cos(13.1 * t) + 1e-5 * random.normal(size=t.size)

        class Oscillator:
            interval, output_noise = 0.004, np.array([[1e-10]])

            def transition(self, z, u):
                d, w2 = z[3] / 6.0, z[2] / 3.0
                w = np.sqrt(w2 - d * d)
                e, c, s = np.exp(-d * 0.004), np.cos(w * 0.004), np.sin(w * 0.004) / w
                return np.array([e * ((c + d * s) * z[0] + s * z[1]), e * (-w2 * s * z[0] + (c - d * s) * z[1]), z[2], z[3]])

            def output(self, z, u):
                return z[:1]

        start = [0.012, 0, 500, 7.5], [1e-4, 1e-2, 20, 1]
        fast = beamid.run_oscillator(x, 0.004, mass_kg=3.0, mean=start[0], covariance=start[1], noise=1e-5, observed="displacement")
        slow = beamid.run_filter("ekf", Oscillator(), x, *start)
        np.testing.assert_allclose(fast.mean, slow.mean, rtol=1e-5)
        with self.assertRaisesRegex(AttributeError, "innovations were not kept; expected a run of run_filter"):
            fast.innovations
        self.assertAlmostEqual(fast.mean[2], 3.0 * (13.1**2 + 1.3**2), delta=5 * fast.covariance[2, 2]**0.5)

    def test_a_system_is_what_its_function_says(self):
        def system(p):
            return np.diag([p.m, 800.0]), None, p.k * np.array([[2.0, -1.0], [-1.0, 1.0]])

        made = beamid.System.of(system, {"m": 1000.0, "k": 1.5e6})
        found = beamid.modes(made, modes=2).tables["modes"]["frequency_hz"]
        mass, _, stiffness = system(type("P", (), {"m": 1000.0, "k": 1.5e6}))
        expected = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)))) / (2 * np.pi)
        np.testing.assert_allclose(found, expected, rtol=1e-9)
        with self.assertRaisesRegex(beamid.InputError, "stiffness is not affine in k"):
            beamid.System.of(lambda p: (np.eye(2), None, p.k**2 * np.eye(2)), {"k": 3.0})


if __name__ == "__main__":
    unittest.main()
