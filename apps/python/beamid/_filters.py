"""Filters on arrays: a filter by name, a model of one's own."""
import numpy as np

from . import _beamid
from ._errors import InputError


class FilterRun:
    """What a filter made of a record.

    mean, covariance            of the last state (n,), (n, n)
    innovations                 (N, p), NaN where nothing was read; whitened_innovations of unit covariance
    log_likelihood, failure     of all readings; why the run ended early, or None
    means, deviations           of every state (N, n), where keep="all"

    run_oscillator keeps mean, covariance, log_likelihood and failure alone.
    """

    def __init__(self, found):
        self.__dict__.update(found)

    def __getattr__(self, name):
        if name in ("means", "deviations", "innovations", "whitened_innovations", "remarks"):
            wanted = 'keep="all"' if name in ("means", "deviations") else "a run of run_filter"
            raise AttributeError(f"{name} were not kept; expected {wanted}")
        raise AttributeError(f"FilterRun has no {name!r}")

    def __repr__(self):
        ended = f"failed: {self.failure}" if self.failure else f"log-likelihood {self.log_likelihood:.6g}"
        return f"FilterRun of {len(self.mean)} states, {ended}"


def run_filter(filter, model, outputs, mean, covariance, *, inputs=None, keep="last", **options):
    """Any filter of beamid (`beamid.list("filters")`) on a model that is a Python object.

    The model z+ = F(z, u) + w, y = h(z, u) + v has the methods `transition(z, u)` -> (n,) and `output(z, u)` -> (p,), the attributes
    `output_noise` R (p, p) and, unless there is none, `process_noise` Q (n, n); `transition_jacobian(z, u)` (n, n) and
    `output_jacobian(z, u)` (p, n) where it knows them, else they are differences.

    :param outputs: (N,) or (N, p); NaN where nothing was read. :param inputs: (N,) or (N, m)
    :param mean: (n,); :param covariance: (n, n), or the standard deviations (n,)
    :param keep: "last" or "all" states; :param options: of the filter

    >>> import beamid, numpy as np
    >>> class Walk:
    ...     process_noise, output_noise = np.array([[0.01]]), np.array([[1.0]])
    ...     def transition(self, z, u): return z
    ...     def output(self, z, u): return z
    >>> run = beamid.run_filter("kf", Walk(), [1.0, 2.0, 1.5], mean=[0.0], covariance=[10.0])
    >>> run.mean.round(4), run.covariance.round(4)
    (array([1.4967]), array([[0.3378]]))

    :raises InputError: for an unknown filter or option, or shapes that do not fit
    """
    outputs = _columns(outputs, "outputs")
    samples = len(outputs)
    inputs = np.zeros((samples, 0)) if inputs is None else _columns(inputs, "inputs")
    if len(inputs) not in (0, samples) and inputs.shape[1] > 0:
        raise InputError(f"inputs have {len(inputs)} rows; expected {samples}, as the outputs")
    if keep not in ("last", "all"):
        raise InputError(f"keep is {keep!r}; expected 'last' or 'all'")
    mean, covariance = _estimate(mean, covariance)
    interval = float(getattr(model, "interval", 1.0))
    inputs = inputs if inputs.shape[1] > 0 else np.zeros((0, 0))
    try:
        return FilterRun(_beamid.run_filter(filter, _numbers(options), model, mean, covariance, outputs, inputs,
                                            interval * np.arange(samples), keep == "all"))
    except (ValueError, TypeError, AttributeError) as error:
        raise InputError(str(error)) from None


def run_oscillator(outputs, interval_s, *, mass_kg, mean, covariance, noise, observed="acceleration",
                   discretisation="exponential"):
    """The extended Kalman filter on M x'' + C x' + K x = 0 of unknown K and C, by the vector engine: state [x, v, K, C].

    :param outputs: (N,) or (N, p) of `observed`, one name or p of displacement, velocity, acceleration
    :param mean: (4,); :param covariance: (4, 4), or the standard deviations (4,)
    :param noise: standard deviation of the sensors; :param discretisation: "exponential" or "forward_euler"

    >>> import beamid, numpy as np
    >>> t = 0.004 * np.arange(500)
    >>> x = 0.012 * np.exp(-1.3 * t) * np.cos(13.1 * t)
    >>> run = beamid.run_oscillator(x, 0.004, mass_kg=3.0, mean=[0.012, 0, 480, 7], covariance=[1e-3, 0.1, 60, 3], noise=1e-6,
    ...                             observed="displacement")
    >>> K = run.mean[2]; abs(K - 3.0 * (13.1**2 + 1.3**2)) < 1.0
    True
    """
    outputs = _columns(outputs, "outputs")
    observed = [observed] if isinstance(observed, str) else list(observed)
    if discretisation not in ("exponential", "forward_euler"):
        raise InputError(f"discretisation is {discretisation!r}; expected 'exponential' or 'forward_euler'")
    mean, covariance = _estimate(mean, covariance)
    noise = np.broadcast_to(np.asarray(noise, dtype=float), (len(observed),))
    try:
        mean, covariance, likelihood, failed = _beamid.run_oscillator(
            mass_kg, interval_s, observed, noise, discretisation == "forward_euler", mean, covariance, outputs)
    except ValueError as error:
        raise InputError(str(error)) from None
    return FilterRun({"mean": mean, "covariance": covariance, "log_likelihood": likelihood,
                      "failure": None if failed is None else f"the filter failed at sample {failed}"})


def register_filter(name, make, summary="a filter in Python", options=None):
    """A filter of one's own, for `identify(filter=name)`, `compare` and `run_filter` until Python ends.

    `make(model, **options)` returns an object with `reset(mean, covariance)`, `predict(u)`, `correct(y, u)` -> (innovation (p,), its
    covariance S (p, p)), and the attributes `mean` (n,) and `covariance` (n, n). The model has the methods of `run_filter`'s, with
    both Jacobians.

    :param options: names with their defaults
    :raises InputError: where the name is taken
    """
    try:
        _beamid.register_filter(name, summary, "no source stated",
                                [(key, _number(value), "of a filter in Python") for key, value in (options or {}).items()], make)
    except ValueError as error:
        raise InputError(str(error)) from None


def _number(value):
    return value if isinstance(value, (bool, str)) else float(value)


def _numbers(options):
    return {key: _number(value) if np.isscalar(value) else [float(one) for one in value] for key, value in options.items()}


def _columns(values, name):
    values = np.asarray(values, dtype=float)
    if values.ndim not in (1, 2):
        raise InputError(f"{name} has the shape {values.shape}; expected (N,) or (N, p)")
    return values.reshape(len(values), -1)


def _estimate(mean, covariance):
    mean, covariance = np.asarray(mean, dtype=float), np.asarray(covariance, dtype=float)
    if covariance.ndim == 1:
        covariance = np.diag(covariance**2)
    if mean.ndim != 1 or covariance.shape != (mean.size, mean.size):
        raise InputError(f"mean {mean.shape} and covariance {covariance.shape} do not fit; expected (n,) and (n, n) or (n,)")
    return mean, covariance


for _one in (FilterRun, run_filter, run_oscillator, register_filter):
    _one.__module__ = "beamid"
