"""beamid.testing. Oracles: filters, models and structures of which it is known that they are right, or what is wrong with them."""
import unittest

import numpy as np

import beamid
import beamid.testing
from filters_test import NumpyKalman, Tracked


class Deaf(NumpyKalman):
    """Takes the reading for more certain than it is, once it knows the state."""

    def correct(self, y, u):
        rest, s = super().correct(y, u)
        self.covariance = self.covariance / 2
        return rest, s


class Shapeless(NumpyKalman):
    def correct(self, y, u):
        rest, s = super().correct(y, u)
        return rest, np.hstack([s, s])


class Lopsided(NumpyKalman):
    def correct(self, y, u):
        rest, s = super().correct(y, u)
        return rest, s + np.triu(np.ones_like(s), 1)


class Filters(unittest.TestCase):
    def test_a_right_filter_passes_the_suite_of_the_own_ones(self):
        found = beamid.testing.check_filter(NumpyKalman, options={"inflate": 0.0}, contracts=["exact_on_linear_gaussian", "identifies"])
        for test in ("ReproducesThePublishedCase", "EqualsTheKalmanFilterOnLinearModels", "IdentifiesWithoutNoiseToSixDigits",
                     "EqualsTheKalmanFilterOfWhatWasMeasured", "ReportsWhereItFailed", "CarriesOnOverGaps"):
            self.assertEqual(found[test], "passed", test)
        self.assertEqual(found["ErrsAsMuchAsItSays"], "skipped")
        self.assertNotIn("in_python", beamid.list("filters"))  # the caller's registry is as it was

    def test_a_wrong_one_is_told_where_and_by_how_much(self):
        with self.assertRaisesRegex(AssertionError, "(?s)of 2. tests failed.*ReproducesThePublishedCase.*EqualsTheKalmanFilterOnLinearModels"):
            beamid.testing.check_filter(Deaf, contracts=["exact_on_linear_gaussian"])
        with self.assertRaisesRegex(AssertionError, r"a covariance of the shape \(1, 2\); expected \(1, 1\)"):
            beamid.testing.check_filter(Shapeless)
        with self.assertRaisesRegex(AssertionError, "a covariance that is not symmetric"):
            beamid.testing.check_filter(Lopsided)
        with self.assertRaisesRegex(beamid.InputError, "contract 'exact' is unknown; known: exact_on_linear_gaussian"):
            beamid.testing.check_filter(NumpyKalman, contracts=["exact"])


class Models(unittest.TestCase):
    def test_a_right_model_passes(self):
        beamid.testing.check_model(Tracked(True), [0.3, -0.2], inputs=1)
        beamid.testing.check_model(Tracked(False), [0.3, -0.2])

    def test_what_is_wrong_is_named(self):
        wrong = Tracked(True)
        wrong.transition_jacobian = lambda z, u: np.array([[1.0, 0.1], [0.01, 1.0]])
        with self.assertRaisesRegex(AssertionError, "transition_jacobian: column 0 is off by 0.01"):
            beamid.testing.check_model(wrong, [0.3, -0.2])
        wrong = Tracked(True)
        wrong.process_noise = np.diag([1.0, -1.0])
        with self.assertRaisesRegex(AssertionError, "process_noise has the negative eigenvalue -1"):
            beamid.testing.check_model(wrong, [0.3, -0.2])

        class Moving(Tracked):
            def transition(self, z, u):
                z += 1.0
                return self.a @ z

        with self.assertRaisesRegex(AssertionError, "two answers|changed the state"):
            beamid.testing.check_model(Moving(False), [0.3, -0.2])


class Structures(unittest.TestCase):
    def test_a_right_structure_passes_and_says_its_frequencies(self):
        def chain(p):
            return np.diag([p.m, p.m]), None, p.k * np.array([[2.0, -1.0], [-1.0, 1.0]])

        expected = np.sqrt(1e4) * 2 * np.sin(np.pi / 10 * np.array([1, 3])) / (2 * np.pi)  # two equal storeys
        np.testing.assert_allclose(beamid.testing.check_system(chain, {"m": 2.0, "k": 2e4}), expected, rtol=1e-12)

    def test_what_is_wrong_is_named(self):
        for text, function in (("stiffness is not symmetric", lambda p: (np.eye(2), None, p.k * np.array([[2.0, -1.0], [0.0, 1.0]]))),
                               ("stiffness has the negative eigenvalue -1", lambda p: (np.eye(2), None, p.k * np.diag([1.0, -1.0]))),
                               ("mass is not positive definite", lambda p: (np.diag([1.0, 0.0]), None, p.k * np.eye(2))),
                               ("not affine in k", lambda p: (np.eye(2), None, p.k**2 * np.eye(2)))):
            with self.assertRaisesRegex(AssertionError, text):
                beamid.testing.check_system(function, {"k": 1.0})


if __name__ == "__main__":
    unittest.main()
