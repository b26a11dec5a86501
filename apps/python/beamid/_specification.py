"""What the core says of itself: commands with their options, tables with their keys, units."""
import functools
import json
import keyword

from . import _beamid


@functools.lru_cache(maxsize=None)
def specification():
    return json.loads(_beamid.specification())


@functools.lru_cache(maxsize=None)
def commands():
    """{"identify": {"summary": ..., "words": [...], "options": [...]}, ...}"""
    return {command["name"]: command for command in specification()["commands"]}


@functools.lru_cache(maxsize=None)
def tables():
    """{"beam": {"length_m": {"type": "number", "unit": "m", "meaning": ...}, ...}, ...}; "" is the file itself."""
    return {table["name"]: {key["name"]: key for key in table["keys"]} for table in specification()["tables"]}


@functools.lru_cache(maxsize=None)
def takes_options(table):
    """Whether a table has keys of the method that it names, which the method checks."""
    return any(one["name"] == table and one["has_options"] for one in specification()["tables"])


def quantities():
    """{"acceleration": {"m_per_s2": "m/s2", "g": "g", ...}, ...}: a unit's suffix and its symbol."""
    return {quantity: {unit["suffix"]: unit["symbol"] for unit in units}
            for quantity, units in specification()["quantities"].items()}


def keyword_of(option):
    """"tip-mass" as tip_mass; "from", a word of Python's, as from_."""
    name = option["name"].replace("-", "_")
    return name + "_" if keyword.iskeyword(name) else name


STRUCTURES = ("beam", "chain", "frame", "space_frame", "system")  # tables that a class of their own describes


@functools.lru_cache(maxsize=None)
def table_of_key():
    """{"window_s": ["record"], ...}: the tables that hold a key, among those that a file has once."""
    found = {}
    root = tables()[""]
    for name, keys in tables().items():
        if name in STRUCTURES or "." in name or (name and root[name]["type"] != "table"):
            continue
        for key, about in keys.items():
            if about["type"] not in ("table", "tables"):
                found.setdefault(key, []).append(name)
    return found
