"""Times and signals as arrays, in place of a record: beamid.modal(t, a), beamid.identify(a, rate=200, mass=1.2)."""
import os

import numpy as np

from . import _beamid
from ._errors import InputError


def is_array(argument):
    """Whether it is numbers: an array of NumPy, a Series, DataFrame or DataArray, or a list of numbers."""
    if isinstance(argument, (list, tuple)):
        return len(argument) > 0 and isinstance(argument[0], (int, float, np.number))
    return hasattr(argument, "__array__") and not isinstance(argument, (str, bytes))


class ArrayRecord:
    """A record of arrays that nothing else describes: a command recognises it as it does a file of somebody's.

    :param arrays: signals, (N) or (N, p); or times [s], datetime64 or timedelta64, and signals. A Series or DataFrame of
        pandas and a DataArray of xarray bring their times as index. NaN is a sample that was not read
    :param rate: of sampling [Hz], where there are no times
    :param quantity: of the signals, or of each: "displacement"; without it acceleration
    :param unit: of their numbers, or of each: "g"; without it SI
    """
    path, keys = None, {}

    def __init__(self, arrays, rate=None, quantity=None, unit=None):
        if len(arrays) > 2:
            raise InputError(f"{len(arrays)} arrays; expected signals, or times and signals (N, p)")
        signals = arrays[-1]
        names = [str(name) for name in getattr(signals, "columns", [])]
        times = arrays[0] if len(arrays) == 2 else _times_of(signals)
        self.signals = _numbers(signals, "signals")
        if self.signals.ndim == 1:
            self.signals = self.signals[:, np.newaxis]
        if self.signals.ndim != 2:
            raise InputError(f"signals have the shape {self.signals.shape}; expected (N) or (N, p)")
        self.times = None if times is None else _seconds(times)
        if self.times is None and rate is None:
            raise InputError("signals without times; expected times and signals, or rate=HZ")
        if self.times is not None and len(self.times) != len(self.signals):
            raise InputError(f"times have {len(self.times)} samples and signals {len(self.signals)}; expected as many")
        self.header = self._header(names, quantity, unit)
        self.name, self.file_name = "record", "record.csv"

    def _header(self, names, quantity, unit):
        count = self.signals.shape[1]
        each = {}
        for keyword, value, usual in (("quantity", quantity, "acceleration"), ("unit", unit, None)):
            values = [usual if value is None else value] if isinstance(value, str) or value is None else list(value)
            if len(values) not in (1, count):
                raise InputError(f"{keyword} has {len(values)} values for {count} signals; expected one, or one for each")
            each[keyword] = values * (count // len(values))
        header = []
        for k, (one, symbol) in enumerate(zip(each["quantity"], each["unit"])):
            word = names[k] if quantity is None and k < len(names) else one if count == 1 else f"{one} {k + 1}"
            header.append(word + (f" [{symbol}]" if symbol else ""))
        return header

    @property
    def numbers(self):
        """How many there are, times included."""
        return self.signals.size + len(self.signals)

    def save(self, path):
        """Writes the samples as comma-separated text."""
        names = ([] if self.times is None else ["time [s]"]) + self.header
        columns = ([] if self.times is None else [self.times]) + list(self.signals.T)
        _beamid.write_columns(os.fspath(path), ",".join('"' + name.replace('"', '""') + '"' for name in names), columns)


def _times_of(signals):
    """Times that come with the signals; None: they have only been counted."""
    if hasattr(signals, "dims") and hasattr(signals, "coords"):  # xarray
        return np.asarray(signals.coords[signals.dims[0]]) if signals.dims[0] in signals.coords else None
    index = getattr(signals, "index", None)
    if index is None or callable(index) or type(index).__name__ == "RangeIndex":
        return None
    return np.asarray(index)


def _seconds(times):
    array = np.asarray(times)
    if array.ndim != 1:
        raise InputError(f"times have the shape {array.shape}; expected (N)")
    if array.dtype.kind in "mM":
        return (array - array[0]) / np.timedelta64(1, "s")
    return _numbers(array, "times")


def _numbers(values, name):
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name} are no numbers; expected an array of them") from None
