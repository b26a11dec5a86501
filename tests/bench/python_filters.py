#!/usr/bin/python3
"""Filters of beamid called from Python beside the same job in NumPy, in one sitting:

    ./bootstrap python tests/bench/python_filters.py [samples]

prints "name microseconds_per_step ratio stiffness": the oscillator [x v K C] read in displacement and velocity, as in
filters_numpy.py, whose EKF is the unit of the ratios; best of three, of run_oscillator of twenty. Then the time of a call on two samples.
"""
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import filters_numpy as plain  # noqa: E402  (first: it keeps numpy to one thread)
import numpy as np  # noqa: E402

import beamid  # noqa: E402


class Oscillator:
    """The model of filters_numpy.py for run_filter."""
    interval, process_noise, output_noise = plain.DT, plain.PROCESS, plain.NOISE

    def transition(self, z, u):
        return plain.step(z)

    def transition_jacobian(self, z, u):
        j = plain.rate_jacobian(z) * plain.DT
        return np.eye(4) + j + j @ j / 2.0 + j @ j @ j / 6.0

    def output(self, z, u):
        return z[:2]

    def output_jacobian(self, z, u):
        return plain.SENSOR


def best(runs, call):
    times = []
    for _ in range(runs):
        begin = time.perf_counter()
        found = call()
        times.append(time.perf_counter() - begin)
    return min(times), found


samples = int(sys.argv[1]) if len(sys.argv) > 1 else 25_000
t = plain.DT * np.arange(samples)
decay, omega = plain.DAMPING / (2 * plain.MASS), np.sqrt(plain.STIFFNESS / plain.MASS)
x = 0.012 * np.exp(-decay * t) * np.cos(omega * t)
record = np.column_stack([x, np.gradient(x, plain.DT)])
record += np.random.default_rng(1).normal(size=record.shape) * np.sqrt(np.diag(plain.NOISE))


def fast():
    return beamid.run_oscillator(record, plain.DT, mass_kg=plain.MASS, mean=plain.GUESS, covariance=plain.PRIOR,
                                 noise=np.sqrt(np.diag(plain.NOISE)), observed=["displacement", "velocity"]).mean[2]


def general(name):
    return beamid.run_filter(name, Oscillator(), record, plain.GUESS, plain.PRIOR).mean[2]


unit = None
for name, runs, call in (("NumPy EKF", 3, lambda: plain.ekf(record)), ("run_oscillator", 20, fast),
                         ("run_filter ekf, model in Python", 3, lambda: general("ekf")),
                         ("run_filter ukf, model in Python", 3, lambda: general("ukf"))):
    seconds, stiffness = best(runs, call)
    unit = unit or seconds
    print(f"{name:32} {1e6 * seconds / samples:9.3f} {seconds / unit:8.4f} {stiffness:9.3f}")

two = record[:2].copy()
begin = time.perf_counter()
for _ in range(2000):
    beamid.run_oscillator(two, plain.DT, mass_kg=plain.MASS, mean=plain.GUESS, covariance=plain.PRIOR, noise=[1e-4, 1e-3],
                          observed=["displacement", "velocity"])
print(f"a call on two samples            {1e6 * (time.perf_counter() - begin) / 2000:9.1f} us")
