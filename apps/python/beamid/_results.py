"""What a command found."""
import functools
import html
import json
import math
import os
import shutil

import numpy as np

from . import _beamid
from ._errors import InputError
from ._plots import Figure, html_table, picture, plot_figure


class Estimate(float):
    """A quantity with its uncertainty; a float wherever a number is due.

    >>> import beamid
    >>> found = beamid.Estimate(0.0045, 1e-5, "", 0.0044804, 0.0045196)
    >>> found.value, found.interval(0.95)
    (0.0045, (0.0044804, 0.0045196))
    >>> found
    0.004500 +- 0.000010
    """

    def __new__(cls, value, standard_deviation, unit="", lower_95=None, upper_95=None):
        self = super().__new__(cls, math.nan if value is None else value)
        self.standard_deviation = math.nan if standard_deviation is None else standard_deviation
        self.unit = unit
        self._interval_95 = (lower_95, upper_95)
        return self

    @property
    def value(self):
        return float(self)

    def interval(self, probability=0.95):
        """(lower, upper) that hold the true value with this probability; for 0.95 the limits of results.json."""
        if not 0 < probability < 1:
            raise InputError(f"probability is {probability!r}; expected a number between 0 and 1")
        if probability == 0.95 and None not in self._interval_95:
            return self._interval_95
        import statistics  # pylint: disable=import-outside-toplevel

        half = statistics.NormalDist().inv_cdf((1 + probability) / 2) * self.standard_deviation
        return self.value - half, self.value + half

    def __repr__(self):
        deviation = self.standard_deviation
        if not (math.isfinite(deviation) and deviation > 0 and math.isfinite(self.value)):
            text = f"{self.value:g}"
        else:
            digits = max(0, 1 - math.floor(math.log10(deviation)))  # two of the deviation's
            text = f"{self.value:.{digits}f} +- {deviation:.{digits}f}"
        return f"{text} {self.unit}".rstrip()

    __str__ = __repr__

    def __getnewargs__(self):
        return self.value, self.standard_deviation, self.unit, *self._interval_95


def _estimate(found):
    """Of a result with an estimate or a bound; None where it is something else."""
    if not isinstance(found, dict):
        return None
    for value, deviation in (("estimate", "standard_deviation"), ("value", "bound")):
        if value in found and deviation in found:
            return Estimate(found[value], found[deviation], found.get("unit", ""), found.get("lower_95"),
                            found.get("upper_95"))
    return None


class Results:
    """What a command found; shown as its report.

    found["damping_ratio"]      an estimate with .value, .standard_deviation, .unit, .interval(0.95), or any other
                                value of results.json
    found.values                the whole of results.json, as dictionaries and lists
    found.tables["modes"]       a dictionary of columns, numpy arrays (N)
    found.frame("modes")        the same as a pandas DataFrame; without a name the first table
    found.covariance            (q, q) of the estimates, in the order of found.parameters
    found.innovations           (N, p) of the filter's last pass, and found.reproduced (N, p), the motion that the estimates
                                make, both at found.time (N); numpy arrays that share memory with the results
    found.figures["spectrum"]   captions and curves, numpy arrays (N) that share memory with the results
    found.plot("spectrum")      the same as a Matplotlib figure; without a name the first
    found.messages              notes, warnings and failures in the order of the report
    found.verdict               "status", "objections" (name, statistic, limit, sentence) and "limitations"
    found.code                  the command's exit code: 3 where there is no estimate to rely on
    found.write("folder")       what the command's --out writes: report.html, tables, figures, results.json
    found.command               the shell command that finds the same, to the last bit
    found.write_inputs("here")  the files of that command that have only been in memory

    >>> import beamid
    >>> found = beamid.modes(tip_mass=0.36049, modes=2)
    >>> found.command
    'beamid modes --tip-mass 0.36049 --modes 2'
    >>> found.tables["modes"]["frequency_hz"].round(2)
    array([ 3.46, 22.79])
    """

    def __init__(self, outcome, command, inputs):
        self._outcome, self.command, self._inputs = outcome, command, inputs
        self.code = outcome.code

    @functools.cached_property
    def json(self):
        """results.json, as the command's --json prints it."""
        return self._outcome.json()

    @functools.cached_property
    def report(self):
        """What the command prints."""
        return self._outcome.report()

    @functools.cached_property
    def values(self):
        return json.loads(self.json)

    @functools.cached_property
    def figures(self):
        return {name: Figure(one) for name, one in self._outcome.figures().items()}

    def plot(self, name=None, figure=None):
        """A figure as a matplotlib.figure.Figure, in the style of the command's pictures.

        :param name: of found.figures; without it the first
        :param figure: of Matplotlib, such as plt.figure(), to draw in
        :raises ImportError: where Matplotlib is not installed
        """
        return plot_figure(self.figures, name, figure)

    @functools.cached_property
    def arrays(self):
        """Innovations, reproduced (N, p) and time_s (N, 1) by name; where there are several runs, by (run, name)."""
        return {name if run == "" else (run, name): values for (run, name), values in self._outcome.arrays().items()}

    def _array(self, name):
        if name in self.arrays:
            return self.arrays[name]
        runs = [key[0] for key in self.arrays if isinstance(key, tuple) and key[1] == name]
        if runs:
            raise AttributeError(f"{len(runs)} runs have {name}; expected found.arrays[run, {name!r}] with one of {', '.join(map(repr, runs))}")
        raise AttributeError(f"{self.values.get('command', 'this command')} has no {name}; expected an identification")

    @property
    def innovations(self):
        return self._array("innovations")

    @property
    def reproduced(self):
        return self._array("reproduced")

    @property
    def time(self):
        return self._array("time_s")[:, 0]

    def _alone(self):
        """What one run found. :raises AttributeError: where several did, or none"""
        runs = self.values.get("runs", [self.values])
        if len(runs) != 1 or "covariance" not in runs[0]:
            raise AttributeError(f"{self.values.get('command', 'this command')} has no covariance of one run; expected an identification of "
                                 "one record, or found.values['runs'][i]['covariance']")
        return runs[0]

    @functools.cached_property
    def covariance(self):
        return np.array(self._alone()["covariance"], dtype=float)

    @functools.cached_property
    def parameters(self):
        """Names of the estimates, in the order of found.covariance."""
        run = self._alone()
        source = run.get("parameters", run)
        return [name for name, one in source.items() if _estimate(one) is not None]

    @functools.cached_property
    def tables(self):
        return {name: _columns(rows) for name, rows in self.values["tables"].items()}

    @property
    def messages(self):
        return self.values["messages"]

    @property
    def verdict(self):
        return self.values["verdict"]

    def frame(self, table=None):
        """A table as a pandas DataFrame. :raises ImportError: where pandas is not installed"""
        import pandas  # pylint: disable=import-outside-toplevel

        table = next(iter(self.tables)) if table is None else table
        if table not in self.tables:
            raise KeyError(f"no table {table!r}; {_beamid.known_names(table, sorted(self.tables))}")
        return pandas.DataFrame(self.tables[table])

    @functools.cached_property
    def estimates(self):
        """Every estimate by its name; where several runs estimate it, by (run, name), the run as tables name it."""
        found = {}
        runs = self.values.get("runs")
        runs = [run for run in runs if isinstance(run, dict)] if isinstance(runs, list) else []
        sources = [(None, self.values), (None, self.values.get("parameters"))]
        sources += [(_run_name(self, n) if len(runs) > 1 else None, run.get("parameters")) for n, run in
                    enumerate(runs)]
        for run, source in sources:
            for name, one in (source.items() if isinstance(source, dict) else ()):
                estimate = _estimate(one)
                if estimate is not None:
                    found[name if run is None else (run, name)] = estimate
        return found

    def __getitem__(self, name):
        if name in self.estimates:
            return self.estimates[name]
        if name in self.values:
            return self.values[name]
        runs = [key for key in self.estimates if isinstance(key, tuple) and key[1] == name]
        if runs:
            raise KeyError(f"{len(runs)} runs estimate {name!r}; expected one of {', '.join(map(repr, runs))}")
        known = [*self.values, *(key for key in self.estimates if isinstance(key, str))]
        raise KeyError(f"no result {name!r}; {_beamid.known_names(str(name), sorted(set(known)))}")

    def __contains__(self, name):
        return name in self.estimates or name in self.values

    def keys(self):
        """Names that found[...] knows."""
        return [*self.values, *(key for key in self.estimates if key not in self.values)]

    def write(self, folder, force=False):
        """Writes what the command's --out writes into a new folder, whole or not at all.

        :param force: replace the results that the folder holds
        """
        if self._outcome is None:
            raise InputError("results that were copied or pickled cannot be written; expected those of a run")
        try:
            self._outcome.write(os.fspath(folder), force, self.command, self._inputs.get("experiment.toml", ""))
        except ValueError as error:
            raise InputError(str(error)) from None

    def write_inputs(self, folder="."):
        """Writes the record and the experiment that found.command names, where they have only been in memory.

        :returns: the names of the files
        """
        os.makedirs(folder, exist_ok=True)
        for name, content in self._inputs.items():
            path = os.path.join(folder, name)
            if os.path.exists(path):
                raise InputError(f"{path} exists; expected another folder")
            write_input(content, path)
        return list(self._inputs)

    def __getstate__(self):
        state = {name: getattr(self, name) for name in ("code", "command", "_inputs", "json", "report")}
        return {**state, "_outcome": None, "figures": _copied(self.figures), "arrays": _copied(self.arrays)}

    def __repr__(self):
        return self.report.rstrip("\n")

    def _repr_html_(self):
        """For notebooks: a verdict, the estimates or the first table, the first figure, and the report, folded."""
        return _cell(self)


def _cell(found):
    escaped = html.escape
    heard = [one for one in found.messages if one["severity"] in ("warning", "failure")]
    failed = [one for one in heard if one["severity"] == "failure"]
    limits = found.verdict["limitations"]
    word, colour = (
        ("Not to be used", "#a32000") if failed
        else ("With warnings", "#8a5a00") if heard
        else ("With reservations", "#8a5a00") if limits
        else ("No warnings", "#00614a")
    )
    text = f'<p style="border-left: 6px solid {colour}; padding-left: .6em"><b style="color: {colour}">{word}.</b>'
    text += "".join(f" {escaped(one[:500])}" for one in ([one["text"] for one in failed or heard] or limits)[:1]) + "</p>\n"
    names = list(found.estimates)
    if names:
        head, rows = ["", "estimate", "95 % interval", "unit"], []
        for name in names:
            one = found.estimates[name]
            lower, upper = one.interval()
            label = name if isinstance(name, str) else ", ".join(name)
            rows.append([label, f"{one.value:.6g}", f"{lower:.6g} to {upper:.6g}", one.unit])
    else:
        columns = next(iter(found.tables.values()), {})
        head = list(columns)
        rows = [[f"{cell:.6g}" if isinstance(cell, float) else str(cell) for cell in row] for row in zip(*columns.values())]
    text += html_table(head, rows) if rows else ""
    text += "".join(picture(figure.plot, figure["caption"]) for figure in list(found.figures.values())[:1])
    report = escaped(found.report[:30_000])  # every letter takes six at most
    return text + f"<details><summary>{escaped(found.command[:2000])}</summary><pre>{report[:50_000]}</pre></details>"


def write_input(content, path):
    """A text, or a Record."""
    if isinstance(content, str):
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(content)
    elif content.path is None:
        content.save(path)
    else:
        shutil.copyfile(content.path, path)


def _run_name(results, number):
    return str(results.tables["runs"][next(iter(results.tables["runs"]))][number])


def _columns(rows):
    """Columns of a table: float64 with NaN for null or nothing, else texts. Tables for people round some numbers to the
    digits that mean something; found.values has them all."""
    columns = {}
    for key in (rows[0] if rows else ()):
        cells = [row.get(key) for row in rows]
        try:
            columns[key] = np.array([math.nan if cell in (None, "") else float(cell) for cell in cells])
        except ValueError:
            columns[key] = np.array(["" if cell is None else cell for cell in cells], dtype=object)
    return columns


def _copied(value):
    if isinstance(value, dict):
        return type(value)({key: _copied(one) for key, one in value.items()})
    if isinstance(value, list):
        return [_copied(one) for one in value]
    return np.array(value) if isinstance(value, np.ndarray) else value


Results.__module__ = Estimate.__module__ = "beamid"
