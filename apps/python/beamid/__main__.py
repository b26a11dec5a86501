"""python3 -m beamid ARGS is the command."""
import sys

from . import _beamid

sys.exit(_beamid.main(["beamid", *sys.argv[1:]]))
