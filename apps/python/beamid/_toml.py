"""Nested dictionaries as the text of an experiment file."""
import os
import re

import numpy as np

from ._errors import InputError

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")
_ESCAPED = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def _text(value):
    return '"' + "".join(_ESCAPED.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}") for c in value) + '"'


def value_text(value, key):
    """One value as TOML has it: numbers as the shortest text that reads back the same."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (str, os.PathLike)):
        return _text(os.fspath(value))
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {value_text(v, k)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(value_text(one, key) for one in value) + "]"
    raise InputError(f"{key} is a {type(value).__name__}; expected a number, a text, a truth or a list of them")


def _key(key):
    return key if _BARE.match(key) else _text(key)


def _is_tables(value):
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(one, dict) for one in value)


def _lines(table, name):
    for key, value in table.items():
        if value is not None and not isinstance(value, dict) and not _is_tables(value):
            yield f"{_key(key)} = {value_text(value, key)}"
    for key, value in table.items():
        path = f"{name}.{_key(key)}" if name else _key(key)
        if isinstance(value, dict):
            yield f"\n[{path}]"
            yield from _lines(value, path)
        elif _is_tables(value):
            for one in value:
                yield f"\n[[{path}]]"
                yield from _lines(one, path)


def toml_text(root):
    """The text of a file; None says nothing.

    >>> from beamid._toml import toml_text
    >>> print(toml_text({"title": "a beam", "beam": {"length_m": 1.1, "springs": [{"position_m": 0.5}]}}), end="")
    title = "a beam"
    <BLANKLINE>
    [beam]
    length_m = 1.1
    <BLANKLINE>
    [[beam.springs]]
    position_m = 0.5
    """
    return "\n".join(_lines(root, "")).lstrip("\n") + "\n"
