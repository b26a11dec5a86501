"""Vibration records: numpy arrays, or files of any kind that beamid reads."""
import html
import os

import numpy as np

from . import _beamid
from ._errors import InputError, unknown
from ._plots import plot_record, record_cell
from ._specification import quantities, tables
from ._structures import checked
from ._toml import toml_text


class Record:
    """Samples of one or more channels.

    :param time: (N) [s], increasing; or None with sampling_rate_hz
    :param acceleration: (N), or (N, p) of p sensors [m/s2], where no channel is named: Record(t, a); with a rate also
        alone, Record(a, rate_hz=200)
    :param rate_hz: the same as sampling_rate_hz
    :param channels: QUANTITY_UNIT=values, such as acceleration_g, displacement_mm, force_n: (N), or (N, p) of p
        sensors, float64 in any order of memory, read where they lie
    :param position_m: of the sensors along the beam [m]: a number, or one for each motion channel in their order;
        without it the tip
    :param name: of the record in reports
    :param keys: other keys of [record]: sampling_rate_hz, window_s, prepare, stamps, ...

    >>> import numpy as np, beamid
    >>> t = np.arange(1000) / 500.0
    >>> record = beamid.Record(t, acceleration_g=np.exp(-0.2 * t) * np.sin(40 * t), position_m=1.1)
    >>> record
    Record 'record': 1000 samples of acceleration [g]
    >>> beamid.modal(record, band=(1, 20)).tables["modes"]["frequency_hz"].round(3)
    array([6.366])
    """

    def __init__(self, time=None, acceleration=None, *, position_m=None, name="record", rate_hz=None, **keywords):
        self.name = name
        if rate_hz is not None:
            keywords["sampling_rate_hz"] = rate_hz
            if acceleration is None and len(keywords) == 1:
                time, acceleration = None, time
        if acceleration is not None:
            keywords["acceleration_m_per_s2"] = acceleration
        self._columns, self._units, rest = [], [], {}
        known = {f"{quantity}_{suffix}": (quantity, symbol)
                 for quantity, units in quantities().items() for suffix, symbol in units.items()}
        for keyword, values in keywords.items():
            if keyword in known:
                self._take(keyword, values, known[keyword])
            elif keyword in tables()["record"] and keyword not in ("file", "channels", "time"):
                rest[keyword] = values
            else:
                raise unknown("Record", keyword, [*known, *tables()["record"], "position_m", "name"])
        if not self._columns:
            raise InputError("a Record without a channel; expected one such as acceleration_m_per_s2=values")
        self.keys = checked("record", rest, "Record")
        self._time = None if time is None else _vector(time, "time")
        if self._time is None and "sampling_rate_hz" not in self.keys:
            raise InputError("a Record without time; expected time, (N) [s], or sampling_rate_hz")
        for values, _ in ([] if self._time is None else self._columns):
            if len(values) != len(self._time):
                raise InputError(f"time has {len(self._time)} samples and a channel {len(values)}; expected as many")
        self._describe_channels(position_m)

    def _take(self, keyword, values, unit):
        array = np.asarray(values, dtype=np.float64)
        if array.ndim not in (1, 2):
            raise InputError(f"{keyword} has the shape {array.shape}; expected (N) or (N, p)")
        for column in ([array] if array.ndim == 1 else array.T):
            self._columns.append((column, unit))

    def _describe_channels(self, position_m):
        sensors = [unit for _, unit in self._columns if unit[0] not in ("force", "base_acceleration")]
        places = list(np.atleast_1d(position_m)) if position_m is not None else []
        if len(places) == 1:
            places *= len(sensors)
        if places and len(places) != len(sensors):
            raise InputError(f"position_m has {len(places)} places for {len(sensors)} sensors; expected one for each")
        first = 1 if self._time is None else 2
        if self._time is not None:
            self.keys["time"] = {"column": 1, "unit": "s"}
        self.keys["channels"] = []
        for number, (_, (quantity, symbol)) in enumerate(self._columns):
            channel = {"quantity": quantity, "column": number + first, "unit": symbol}
            if places and (quantity, symbol) in sensors and quantity not in ("force", "base_acceleration"):
                channel["position_m"] = float(places.pop(0))
            self.keys["channels"].append(channel)

    def save(self, path):
        """Writes the samples as comma-separated text that reads back the same numbers."""
        names = [] if self._time is None else ["time_s"]
        suffixes = {symbol: suffix for units in quantities().values() for suffix, symbol in units.items()}
        names += [f"{quantity}_{suffixes[symbol]}" for _, (quantity, symbol) in self._columns]
        columns = [column for column, _ in self._columns]
        _beamid.write_columns(os.fspath(path), ",".join(names),
                              columns if self._time is None else [self._time, *columns])

    def plot(self, figure=None):
        """The samples over time, a panel for each quantity, as a matplotlib.figure.Figure.

        :param figure: of Matplotlib, such as plt.figure(), to draw in
        :raises ImportError: where Matplotlib is not installed
        """
        return plot_record(*self._drawn(), self.name, figure)

    def _drawn(self):
        """Time [s], columns, and of each its name and quantity with its unit."""
        count = len(self._columns[0][0])
        time = np.arange(count) / self.keys["sampling_rate_hz"] if self._time is None else self._time
        labels = [(f"column {k + 1}", f"{quantity} [{symbol}]") for k, (_, (quantity, symbol)) in enumerate(self._columns)]
        return time, [column for column, _ in self._columns], labels

    def _repr_html_(self):
        """For notebooks: length, channels and plot."""
        return record_cell(self, *self._drawn())

    @property
    def numbers(self):
        """How many there are, times included."""
        return (len(self._columns) + 1) * len(self._columns[0][0])

    @property
    def path(self):
        """Of its file; None: it has none."""
        return None

    @property
    def file_name(self):
        return self.name if "." in self.name else self.name + ".csv"

    def __repr__(self):
        kinds = ", ".join(f"{quantity} [{symbol}]" for _, (quantity, symbol) in self._columns)
        return f"Record {self.name!r}: {len(self._columns[0][0])} samples of {kinds}"


class RecordFile:
    """A record in a file, read when its samples are asked for. Made by read()."""

    def __init__(self, path, keys):
        self.path = os.fspath(path)
        self.keys = checked("record", keys, "read")
        self._read = None

    @property
    def name(self):
        return os.path.basename(self.path)

    @property
    def file_name(self):
        return self.name

    def _contents(self):
        if self._read is None:
            try:
                self._read = _beamid.read_record(self.path, toml_text({"record": self.keys}))
            except (ValueError, RuntimeError) as error:
                raise InputError(str(error)) from None
        return self._read

    @property
    def time(self):
        """(N) [s]"""
        return self._contents()["time"]

    @property
    def samples(self):
        """(N, p) in SI units, prepared and cut as the commands see them; not to be written to"""
        return self._contents()["samples"]

    @property
    def channels(self):
        """p dictionaries: name, quantity, unit, position_m"""
        return self._contents()["channels"]

    @property
    def remarks(self):
        """What was done to the samples, and what may be wrong with them."""
        return self._contents()["remarks"] + self._contents()["warnings"]

    def plot(self, figure=None):
        """The samples over time, prepared and cut, a panel for each quantity, as a matplotlib.figure.Figure.

        :param figure: of Matplotlib, such as plt.figure(), to draw in
        :raises ImportError: where Matplotlib is not installed
        """
        return plot_record(*self._drawn(), self.name, figure)

    def _drawn(self):
        labels = [(channel["name"], f"{channel['quantity']} [{channel['unit']}]") for channel in self.channels]
        return self.time, list(self.samples.T), labels

    def _repr_html_(self):
        """For notebooks: length, channels and plot; of a file that cannot be read the reason."""
        try:
            return record_cell(self, *self._drawn())
        except InputError as error:
            return f"<p>{html.escape(repr(self)[:500])}: {html.escape(str(error)[:2000])}</p>"

    def replace(self, **keys):
        """The same file, read otherwise."""
        return RecordFile(self.path, {**self.keys, **keys})

    def __getstate__(self):
        return {"path": self.path, "keys": self.keys, "_read": None}

    def __repr__(self):
        return f"Record {self.path!r}"


def read(path, **keys):
    """A record in a file of any kind that beamid reads: text, LVM, UFF 58, HDF5, MATLAB.

    :param keys: those of [record] where the file does not say it all: time, channels, sampling_rate_hz, window_s,
        header_lines, separator, reader, prepare, ...; see help(beamid.read)

    >>> import beamid
    >>> record = beamid.read("docs/tutorials/02_identify_a_record/tip_acceleration.csv")
    >>> record.samples.shape, record.channels[0]["unit"]
    ((2501, 1), 'm/s2')
    >>> bare = dict(time={"column": 1, "unit": "s"}, channels=[{"quantity": "acceleration", "column": 2, "unit": "g"}])
    >>> record = beamid.read("docs/tutorials/02_identify_a_record/tip_acceleration.csv", **bare)
    >>> round(record.samples[0, 0] / 9.80665, 4)
    -10.4247
    """
    return RecordFile(path, keys)


def _vector(values, name):
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != 1:
        raise InputError(f"{name} has the shape {array.shape}; expected (N)")
    return array


Record.__module__ = RecordFile.__module__ = read.__module__ = "beamid"
