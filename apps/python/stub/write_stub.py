#!/usr/bin/python3
"""Prints the stub of the package from the core's own list of options and tables:
./bootstrap python apps/python/stub/write_stub.py > stub.pyi && mv stub.pyi apps/python/beamid/__init__.pyi
(straight into the package it would be empty while it is read)"""
from beamid import _commands, _specification
from beamid._structures import Beam, Chain, Experiment, Frame, SpaceFrame, System

HEAD = '''# Written by apps/python/stub/write_stub.py: do not edit.
import builtins  # `list` is a command
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import pandas

_Path = str | os.PathLike[str]
_Number = float | np.floating[Any] | np.integer[Any]
_Table = str | Mapping[str, Any]
_Tables = _Table | Sequence[_Table]
_Argument = Record | RecordFile | npt.ArrayLike | _Structure | _Path | Sequence[Record | RecordFile | _Path]

__version__: str

class InputError(ValueError): ...

class _Structure:
    keywords: dict[str, Any]
    def replace(self, **keywords: Any) -> Any: ...
    def __getattr__(self, name: str) -> Any: ...

class Estimate(float):
    standard_deviation: float
    unit: str
    def __new__(cls, value: float | None, standard_deviation: float | None, unit: str = ..., lower_95: float | None = ...,
                upper_95: float | None = ...) -> Estimate: ...
    @property
    def value(self) -> float: ...
    def interval(self, probability: float = ...) -> tuple[float, float]: ...

class Results:
    command: str
    code: int
    json: str
    report: str
    values: dict[str, Any]
    figures: dict[str, Any]
    arrays: dict[str | tuple[str, str], npt.NDArray[np.float64]]
    covariance: npt.NDArray[np.float64]
    parameters: builtins.list[str]
    @property
    def innovations(self) -> npt.NDArray[np.float64]: ...
    @property
    def reproduced(self) -> npt.NDArray[np.float64]: ...
    @property
    def time(self) -> npt.NDArray[np.float64]: ...
    tables: dict[str, dict[str, npt.NDArray[Any]]]
    estimates: dict[str | tuple[str, str], Estimate]
    @property
    def messages(self) -> builtins.list[dict[str, str]]: ...
    @property
    def verdict(self) -> dict[str, Any]: ...
    def frame(self, table: str | None = ...) -> pandas.DataFrame: ...
    def plot(self, name: str | None = ..., figure: Any = ...) -> Any: ...
    def __getitem__(self, name: str | tuple[str, str]) -> Any: ...
    def __contains__(self, name: object) -> bool: ...
    def keys(self) -> builtins.list[str | tuple[str, str]]: ...
    def write(self, folder: _Path, force: bool = ...) -> None: ...
    def write_inputs(self, folder: _Path = ...) -> builtins.list[str]: ...

class FilterRun:
    mean: npt.NDArray[np.float64]
    covariance: npt.NDArray[np.float64]
    innovations: npt.NDArray[np.float64]
    whitened_innovations: npt.NDArray[np.float64]
    means: npt.NDArray[np.float64]
    deviations: npt.NDArray[np.float64]
    log_likelihood: float
    failure: str | None
    remarks: builtins.list[str]

def run_filter(filter: str, model: Any, outputs: npt.ArrayLike, mean: npt.ArrayLike, covariance: npt.ArrayLike, *,
               inputs: npt.ArrayLike | None = ..., keep: Literal["last", "all"] = ..., **options: Any) -> FilterRun: ...
def run_oscillator(outputs: npt.ArrayLike, interval_s: float, *, mass_kg: float, mean: npt.ArrayLike, covariance: npt.ArrayLike,
                   noise: npt.ArrayLike, observed: str | Sequence[str] = ...,
                   discretisation: Literal["exponential", "forward_euler"] = ...) -> FilterRun: ...
def register_filter(name: str, make: Any, summary: str = ..., options: Mapping[str, Any] | None = ...) -> None: ...

class RecordFile:
    path: str
    keys: dict[str, Any]
    @property
    def name(self) -> str: ...
    @property
    def file_name(self) -> str: ...
    @property
    def time(self) -> npt.NDArray[np.float64]: ...
    @property
    def samples(self) -> npt.NDArray[np.float64]: ...
    @property
    def channels(self) -> builtins.list[dict[str, Any]]: ...
    @property
    def remarks(self) -> builtins.list[str]: ...
    def plot(self, figure: Any = ...) -> Any: ...
    def replace(self, **keys: Any) -> RecordFile: ...
'''

TYPES = {"number": "_Number", "whole": "int", "truth": "bool", "text": "str", "texts": "Sequence[str]",
         "numbers": "npt.ArrayLike", "interval": "Sequence[_Number]", "column": "int | str",
         "table": "_Table | _Structure", "tables": "_Tables"}


def option_type(option):
    if option["type"] == "flag":
        return "bool"
    if option["value"] in ("FILE", "DIR", "RECORD", "STATE"):
        one = "_Path | _Structure" if option["name"] in ("truth", "config") else "_Path"
    elif option["choices"] and option["type"] == "text":
        one = "str"
    else:
        one = {"number": "_Number", "whole": "int", "text": "str"}[option["type"]]
    if option["type"] == "number" and option["values"] != 1:
        return "Sequence[_Number] | Sequence[Sequence[_Number]]" if option["repeats"] else "Sequence[_Number]"
    return f"{one} | Sequence[{one}]" if option["repeats"] or option["values"] != 1 else one


def keywords_of_table(table):
    matrices = ("mass", "damping", "stiffness") if table == "system" else ()
    return [f"{key}: {'Any' if key in matrices else TYPES[about['type']]} | None = ..."
            for key, about in _specification.tables()[table].items()]


def signature(name, first, keywords, result, indent=""):
    words = [first, *keywords]
    lines, line = [], f"{indent}def {name}("
    for number, word in enumerate(words):
        end = ", " if number + 1 < len(words) else f") -> {result}: ..."
        if len(line) + len(word) + len(end) > 118:
            lines.append(line.rstrip())
            line = indent + "    "
        line += word + end
    return "\n".join([*lines, line])


def main():
    print(HEAD)
    channels = [f"{quantity}_{suffix}: npt.ArrayLike = ..." for quantity, units in _specification.quantities().items()
                for suffix in units]
    keys = [f"{key}: {TYPES[about['type']]} = ..." for key, about in _specification.tables()["record"].items()
            if key not in ("file", "channels", "time")]
    print("class Record:\n    name: str\n    keys: dict[str, Any]")
    print(signature("__init__", "self", ["time: npt.ArrayLike | None = ...",
                                         "acceleration: npt.ArrayLike | None = ...", "*",
                                         "position_m: npt.ArrayLike | None = ...", "name: str = ...",
                                         "rate_hz: _Number | None = ...", *channels, *keys],
                    "None", "    "))
    print("    @property\n    def numbers(self) -> int: ...\n    @property\n    def path(self) -> None: ...\n    @property\n    def file_name(self) -> str: ...")
    print("    def plot(self, figure: Any = ...) -> Any: ...\n    def save(self, path: _Path) -> None: ...\n")
    for one in (Beam, Chain, Frame, SpaceFrame, System, Experiment):
        print(f"class {one.__name__}(_Structure):")
        print(signature("__init__", "self", ["*", *keywords_of_table(one._table)], "None", "    "))
        print("    @classmethod\n    def read(cls, path: _Path) -> Experiment: ...\n" if one is Experiment
              else "    @classmethod\n    def of(cls, function: Any, values: Mapping[str, float], **keywords: Any) -> System: ...\n"
              if one is System else "")
    read = [f"{key}: {TYPES[about['type']]} = ..." for key, about in _specification.tables()["record"].items()
            if key != "file"]
    print(signature("read", "path: _Path", ["*", *read], "RecordFile"))
    for name in _commands.names():
        about = _specification.commands()[name]
        keywords = [f"{_specification.keyword_of(option)}: {option_type(option)} | None = ..."
                    for option in about["options"] if option["name"] not in _commands.NOT_OFFERED]
        structure = _commands._takes_structure(about)
        if structure:
            keywords.insert(0, "config: _Path | Sequence[_Path] | None = ...")
            keywords.append("**keys: Any")
        result = "Results" if about["has_results"] else "str"
        if name == "stream":
            print(signature(name, "record: Record | RecordFile | _Path", ["*arguments: _Argument", *keywords],
                            "dict[str, npt.NDArray[Any]]"))
        else:
            print(signature(name, "*arguments: _Argument", keywords, result))


main()
