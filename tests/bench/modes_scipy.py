#!/usr/bin/python3
"""Lowest modes of a uniform beam by scipy.sparse.linalg.eigsh with shift-invert at zero.

    modes_scipy.py clamped-free 500000 10

prints the same line as modes_bench: the matrices are the textbook's, assembled from Hermite cubics with L = EI = rho A = 1.
"""
import resource
import sys
import time

import numpy as np
import scipy.sparse
from scipy.sparse.linalg import eigsh

ROOTS = {"clamped-free": 1.8751040687119611664, "clamped-clamped": 4.7300407448627040260}


def main(supports, elements, count):
    start = time.perf_counter()
    h = 1.0 / elements
    stiffness = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) / h**3
    mass = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) * h / 420
    place = 2 * np.arange(elements)[:, None] + np.arange(4)
    rows, columns = np.repeat(place, 4, axis=1).ravel(), np.tile(place, 4).ravel()
    size = 2 * elements + 2
    free = slice(2, size - 2 if supports == "clamped-clamped" else size)

    def assembled(element):
        entries = np.tile(element.ravel(), elements)
        return scipy.sparse.csc_matrix((entries, (rows, columns)), shape=(size, size))[free, free]

    k, m = assembled(stiffness), assembled(mass)
    middle, ticks = time.perf_counter(), time.process_time()
    squares = eigsh(k, count, m, sigma=0)[0]
    end, processor = time.perf_counter(), time.process_time() - ticks
    error = abs(np.sqrt(np.min(np.abs(squares))) / ROOTS[supports] ** 2 - 1)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    times = f"{middle - start:.4f} {end - middle:.4f} {processor:.4f}"
    print(f"scipy {supports} {elements} {times} {error:.2e} {peak:.0f}")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
