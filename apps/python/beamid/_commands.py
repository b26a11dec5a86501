"""A function for every command, made of the core's own list of options."""
import inspect

from ._call import NOT_OFFERED, call, stream
from ._specification import commands, keyword_of

SHELL_ONLY = ("help", "completion", "man")  # Python has its own: help(beamid.identify), the Tab key


def _described(name):
    """The docstring of a command's function."""
    about = commands()[name]
    lines = [about["summary"][0].upper() + about["summary"][1:] + ".", ""]
    places = ["a record or several" if word["name"] == "record" and word["several"] else
              "a record" if word["name"] == "record" else word["name"] for word in about["words"]]
    if _takes_structure(about):
        places.append("a structure: Beam, Chain, Frame, SpaceFrame, System or Experiment, or an experiment file, NAME.toml")
    if places and places[0].startswith("a record"):
        places[0] += ", or arrays in its place: times [s] and signals (N) or (N, p), or signals alone with rate"
    if places:
        lines += [f":param arguments: {'; '.join(places)}"]
    for option in about["options"]:
        if option["name"] in NOT_OFFERED:
            continue
        several = "; several as a list" if option["repeats"] else ""
        lines.append(f":param {keyword_of(option)}: {option['help']}{several}")
    if _takes_structure(about):
        lines += [":param config: an experiment file (TOML); what else is given takes the place of its keys",
                  ":param keys: tables and keys of an experiment file: filter=\"ukf\", window_s=(0.8, 1.6), ..."]
    lines += [":returns: Results" if about["has_results"] else ":returns: what the command prints",
              ":raises InputError: naming what was found and what was expected"]
    if name in EXAMPLES:
        lines += ["", EXAMPLES[name].strip("\n")]
    return "\n".join(lines)


def _takes_structure(about):
    return any(option["name"] == "config" for option in about["options"]) or about["name"] == "validate"


def _signature(name):
    kinds = inspect.Parameter
    about = commands()[name]
    parameters = [kinds("arguments", kinds.VAR_POSITIONAL)]
    if _takes_structure(about):
        parameters.append(kinds("config", kinds.KEYWORD_ONLY, default=None))
    parameters += [kinds(keyword_of(option), kinds.KEYWORD_ONLY, default=None)
                   for option in about["options"] if option["name"] not in NOT_OFFERED]
    if _takes_structure(about):
        parameters.append(kinds("keys", kinds.VAR_KEYWORD))
    return inspect.Signature(parameters)


def function(name):
    """The function of a command."""
    if name == "stream":
        return stream

    def run(*arguments, **keywords):
        return call(name, arguments, keywords)

    run.__name__ = run.__qualname__ = name
    run.__module__ = "beamid"
    run.__doc__ = _described(name)
    run.__signature__ = _signature(name)
    return run


def names():
    """Of all functions: the commands of the core but those that only a shell needs."""
    return [name for name in commands() if name not in SHELL_ONLY]


EXAMPLES = {
    "identify": """
>>> import beamid
>>> record = beamid.read("docs/tutorials/02_identify_a_record/tip_acceleration.csv")
>>> beam = beamid.Beam(length_m=1.1, width_m=0.06, height_m=0.006, youngs_modulus_pa=2.12e11, mass_kg=3.055,
...                    tip_mass_kg=0.36049)
>>> found = beamid.identify(record, beam, window_s=(2, 10))
>>> found["damping_ratio"], found["frequency_hz"]
(0.004498 +- 0.000012, 3.455519 +- 0.000041)
""",
    "modal": """
>>> import beamid
>>> found = beamid.modal("docs/tutorials/02_identify_a_record/tip_acceleration.csv", window=(2, 10))
>>> found.tables["modes"]["frequency_hz"].round(3)
array([3.456])
>>> import numpy as np
>>> t = np.arange(2000) / 200
>>> a = np.exp(-0.3 * t) * np.cos(40 * t)
>>> beamid.modal(t, a).tables["modes"]["frequency_hz"].round(3), beamid.modal(a, rate=200).report == ""
(array([6.366]), False)
""",
    "frf": """
>>> import beamid
>>> found = beamid.frf(damping_ratio=0.01, from_=1, to=30)
>>> found.command
'beamid frf --damping-ratio 0.01 --from 1 --to 30'
""",
    "list": """
>>> import beamid
>>> print(beamid.list("smoothers").splitlines()[2])   # doctest: +NORMALIZE_WHITESPACE
rts   Rauch-Tung-Striebel smoother, linear about the filtered mean    -
"""}
