"""What is said of input that makes no sense."""
from . import _beamid


class InputError(ValueError):
    """Bad input: the message names what was found and what was expected.

    >>> import beamid
    >>> beamid.Beam(lenght_m=1.1)
    Traceback (most recent call last):
    ...
    beamid.InputError: Beam has no keyword 'lenght_m'; did you mean 'length_m'?
    """


InputError.__module__ = "beamid"


def unknown(owner, word, known):
    return InputError(f"{owner} has no keyword {word!r}; {_beamid.known_names(word, sorted(known))}")
