"""Stiffness, damping and modes of structures from vibration records.

Records and structures go in, results come out; every command of `beamid` is a function of the same name, and the
words are those of the command's options and of the experiment file:

>>> import beamid
>>> beam = beamid.Beam(length_m=1.1, width_m=0.06, height_m=0.006, youngs_modulus_pa=2.12e11, mass_kg=3.055,
...                    tip_mass_kg=0.36049)
>>> record = beamid.read("docs/tutorials/02_identify_a_record/tip_acceleration.csv")
>>> found = beamid.identify(record, beam, window_s=(2, 10), unknown=["bending_stiffness", "damping_ratio"])
>>> found["damping_ratio"].value, found["damping_ratio"].interval(0.95)   # doctest: +ELLIPSIS
(0.00449..., (0.00447..., 0.00452...))

All numbers are in SI units, and names carry the unit. Documentation: docs/python.md.
"""
from . import _commands, _specification
from ._errors import InputError
from ._filters import FilterRun, register_filter, run_filter, run_oscillator
from ._record import Record, RecordFile, read
from ._results import Estimate, Results
from ._structures import Beam, Chain, Experiment, Frame, SpaceFrame, System

__version__ = _specification.specification()["version"]
__all__ = ["Beam", "Chain", "Estimate", "Experiment", "FilterRun", "Frame", "InputError", "Record", "RecordFile", "Results", "SpaceFrame", "System",
           "read", "register_filter", "run_filter", "run_oscillator",
           *(name for name in _commands.names() if name != "list")]  # `from beamid import *` leaves Python's list alone

globals().update({name: _commands.function(name) for name in _commands.names()})
