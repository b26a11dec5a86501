#!/usr/bin/python3
"""The job of filters_bench in NumPy, written as filterpy writes its EKF and UKF: one function call per matrix operation.

    filters_numpy.py [samples]

prints "name nanoseconds_per_step stiffness" of each: joint identification of [x v K C] from displacement and velocity.
"""
import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # matrices of four rows are no work for threads

import numpy as np  # noqa: E402

MASS, DT, STIFFNESS, DAMPING = 3.0, 1e-3, 515.8, 0.4
PROCESS = np.diag([1e-16, 1e-14, 1e-8, 1e-10])
NOISE = np.diag([1e-8, 1e-6])
GUESS = np.array([0.012, 0.0, 400.0, 1.0])
PRIOR = np.diag([1e-4, 1e-2, 1e4, 1.0])
SENSOR = np.eye(2, 4)


def rate(z):
    return np.array([z[1], -(z[2] * z[0] + z[3] * z[1]) / MASS, 0.0, 0.0])


def rate_jacobian(z):
    return np.array([[0.0, 1.0, 0.0, 0.0], [-z[2] / MASS, -z[3] / MASS, -z[0] / MASS, -z[1] / MASS],
                     [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]])


def step(z):
    k1 = rate(z)
    k2 = rate(z + 0.5 * DT * k1)
    k3 = rate(z + 0.5 * DT * k2)
    k4 = rate(z + DT * k3)
    return z + DT / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def ekf(record):
    mean, covariance, identity = GUESS.copy(), PRIOR.copy(), np.eye(4)
    for k, y in enumerate(record):
        if k > 0:
            j = rate_jacobian(mean) * DT
            tangent = identity + j + j @ j / 2.0 + j @ j @ j / 6.0
            mean = step(mean)
            covariance = tangent @ covariance @ tangent.T + PROCESS
        s = SENSOR @ covariance @ SENSOR.T + NOISE
        gain = covariance @ SENSOR.T @ np.linalg.inv(s)
        mean = mean + gain @ (y - SENSOR @ mean)
        kept = identity - gain @ SENSOR
        covariance = kept @ covariance @ kept.T + gain @ NOISE @ gain.T
    return mean[2]


def ukf(record):
    n = 4
    weights = np.full(2 * n + 1, 0.5 / n)  # alpha = 1, beta = 2, kappa = 0
    weights[0] = 0.0
    covariance_weights = weights.copy()
    covariance_weights[0] = 2.0
    mean, covariance = GUESS.copy(), PRIOR.copy()

    def points():
        root = np.linalg.cholesky(n * covariance).T
        return np.vstack([mean, mean + root, mean - root])

    def transform(values, noise):
        centre = weights @ values
        apart = values - centre
        return centre, apart.T @ np.diag(covariance_weights) @ apart + noise

    for k, y in enumerate(record):
        if k > 0:
            mean, covariance = transform(np.array([step(z) for z in points()]), PROCESS)
        sigmas = points()
        seen = np.array([SENSOR @ z for z in sigmas])
        expected, s = transform(seen, NOISE)
        cross = (sigmas - mean).T @ np.diag(covariance_weights) @ (seen - expected)
        gain = cross @ np.linalg.inv(s)
        mean = mean + gain @ (y - expected)
        covariance = covariance - gain @ s @ gain.T
    return mean[2]


def main(samples):
    random, z, record = np.random.default_rng(1), np.array([0.012, 0.0, STIFFNESS, DAMPING]), []
    for _ in range(samples):
        record.append(z[:2] + np.array([1e-4, 1e-3]) * random.standard_normal(2))
        z = step(z)
    for name, run in (("numpy_ekf", ekf), ("numpy_ukf", ukf)):
        start = time.process_time()
        stiffness = run(record)
        print(name, f"{(time.process_time() - start) / samples * 1e9:.0f} {stiffness:.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 25000)
