"""Whether a filter, a model or a structure of one's own keeps what beamid asks of its own."""
import os
import pickle
import sys
import types

import numpy as np

from ._errors import InputError
from ._structures import System

CONTRACTS = {
    "exact_on_linear_gaussian": "equals the Kalman filter to 1e-10 where the model is linear",
    "sampled_on_linear_gaussian": "approaches it as its sample, option particles or members, grows",
    "consistent": "its covariance is that of its errors; 300 runs, a minute or more in Python",
    "identifies": "finds stiffness and damping from a record without noise to six digits",
    "robust": "outlying readings move its estimate by a few of its deviations at most",
    "linear_models_only": "refuses models that are not linear",
    "linear_motion_only": "refuses models whose motion is not linear with their constants held",
    "unknown_inputs": "estimates inputs that nobody measured",
}


def check_filter(make, *, options=None, contracts=()):
    """The conformance suite that beamid's own filters must pass, on a filter of `register_filter`'s kind.

    :param make: `make(model, **options)`, as for `register_filter`; :param options: names with their defaults
    :param contracts: what the filter promises, names of `beamid.testing.CONTRACTS`; what is common to all filters is
        asked of every one
    :returns: {test: "passed" or "skipped"}
    :raises AssertionError: with every test that failed and what it found
    """
    unknown = sorted(set(contracts) - set(CONTRACTS))
    if unknown:
        raise InputError(f"contract {unknown[0]!r} is unknown; known: {', '.join(CONTRACTS)}")
    found = _in_a_process_of_its_own(_run_suite, make, options or {}, set(contracts))
    failed = [f"{test}\n{said}" for test, how, said in found if how == "failed"]
    if failed:
        raise AssertionError(f"{len(failed)} of {len(found)} tests failed\n\n" + "\n\n".join(failed))
    return {test: how for test, how, said in found}


def check_model(model, mean, inputs=0, *, relative=1e-5):
    """Whether a model of `run_filter` is one: shapes, noises that are covariances, the same answer twice, arguments left
    alone, and Jacobians that are the derivatives, against central differences.

    :param mean: (n,) a state about which to ask; :param inputs: their number m
    :param relative: what a Jacobian may be off by, of its largest entry
    :raises AssertionError: with what is wrong
    """
    mean, u = np.array(mean, dtype=float), np.full(inputs, 0.3)
    output_noise = np.atleast_2d(model.output_noise)
    for name, noise, size in (("output_noise", output_noise, len(output_noise)),
                              ("process_noise", getattr(model, "process_noise", None), len(mean))):
        if noise is not None:
            _check_covariance(name, np.atleast_2d(noise), size)
    for name, size in (("transition", len(mean)), ("output", len(output_noise))):
        function, kept = getattr(model, name), mean.copy()
        first, second = np.array(function(mean, u)), np.array(function(mean, u))
        _hold(first.shape == (size,), f"{name} returned the shape {first.shape}; expected ({size},)")
        _hold(np.array_equal(first, second), f"{name} returned two answers to one question")
        _hold(np.array_equal(mean, kept), f"{name} changed the state that it was given")
        jacobian = getattr(model, name + "_jacobian", None)
        if jacobian is not None:
            _check_jacobian(name + "_jacobian", np.array(jacobian(mean, u)), _differences(function, mean, u), relative)


def check_system(function, parameters):
    """Whether `function(p)` -> (M, C, K) is a structure for `System.of`: matrices of one size, symmetric, M positive definite,
    K and C not negative, each affine in every parameter.

    :param parameters: names with values, as for `System.of`
    :raises AssertionError: with what is wrong
    :returns: natural frequencies (n,) [Hz]
    """
    try:
        System.of(function, parameters)
    except InputError as error:
        raise AssertionError(str(error)) from None
    mass, damping, stiffness = (None if one is None else _dense(one) for one in
                                function(types.SimpleNamespace(**parameters)))
    for name, matrix in (("mass", mass), ("damping", damping), ("stiffness", stiffness)):
        if matrix is not None:
            _check_covariance(name, matrix, len(mass))
    try:
        factor = np.linalg.cholesky(mass)
    except np.linalg.LinAlgError:
        raise AssertionError("mass is not positive definite") from None
    scaled = np.linalg.solve(factor, np.linalg.solve(factor, stiffness).T)
    return np.sqrt(np.linalg.eigvalsh((scaled + scaled.T) / 2).clip(min=0)) / (2 * np.pi)


def _run_suite(make, options, contracts):
    from . import _testing  # pylint: disable=import-outside-toplevel
    from ._filters import _number  # pylint: disable=import-outside-toplevel

    return _testing.check_filter([(name, _number(value)) for name, value in options.items()], contracts, make)


def _in_a_process_of_its_own(call, *arguments):
    """Its result: what the suite registers and remembers, or a crash of it, is not the caller's."""
    sys.stdout.flush()
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            result = True, call(*arguments)
        except BaseException as error:  # pylint: disable=broad-exception-caught
            result = False, f"{type(error).__name__}: {error}"
        with os.fdopen(writing, "wb") as pipe:
            pickle.dump(result, pipe)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        sent = pipe.read()
    status = os.waitpid(child, 0)[1]
    if not sent:
        raise RuntimeError(f"the suite's process ended with status {status} before it had a result")
    worked, result = pickle.loads(sent)
    if not worked:
        raise RuntimeError(result)
    return result


def _hold(holds, otherwise):
    if not holds:
        raise AssertionError(otherwise)


def _dense(matrix):
    return np.asarray(matrix.toarray() if hasattr(matrix, "toarray") else matrix, dtype=float)


def _check_covariance(name, matrix, size):
    _hold(matrix.shape == (size, size), f"{name} has the shape {matrix.shape}; expected ({size}, {size})")
    largest = np.abs(matrix).max(initial=0.0)
    _hold(np.abs(matrix - matrix.T).max(initial=0.0) <= 1e-9 * largest, f"{name} is not symmetric")
    lowest = np.linalg.eigvalsh(matrix).min(initial=0.0)
    _hold(lowest >= -1e-9 * largest, f"{name} has the negative eigenvalue {lowest:g}")


def _differences(function, state, u):
    """Central differences (p, n)."""
    columns = []
    for i in range(len(state)):
        step = np.zeros(len(state))
        step[i] = 6e-6 * max(abs(state[i]), 1e-3)
        columns.append((np.array(function(state + step, u)) - np.array(function(state - step, u))) / (2 * step[i]))
    return np.array(columns).T


def _check_jacobian(name, said, expected, relative):
    _hold(said.shape == expected.shape, f"{name} has the shape {said.shape}; expected {expected.shape}")
    for column in range(said.shape[1]):  # states have units of their own
        off = np.abs(said[:, column] - expected[:, column]).max()
        largest = np.abs(expected[:, column]).max()
        _hold(off <= relative * largest + 1e-12, f"{name}: column {column} is off by {off:g}; the derivative's largest entry there is {largest:g}")
