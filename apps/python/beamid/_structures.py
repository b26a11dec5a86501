"""Tables of an experiment file as Python objects; their keywords are the file's keys."""
import os
import tomllib

from ._errors import InputError, unknown
from ._matrices import affine_matrices, as_matrices
from ._plots import draw_structure, html_table, picture
from ._specification import STRUCTURES, tables, takes_options


def checked(name, value, owner):
    """A table's keys and values, with those of the tables inside it. A text stands for the table's first key:
    filter="ukf" is filter={"method": "ukf"}."""
    keys = tables()[name]
    if isinstance(value, Table):
        value = value.keywords
    if isinstance(value, str):
        value = {next(iter(keys)): value}
    if not isinstance(value, dict):
        raise InputError(f"{owner} is {value!r}; expected a dictionary of the keys of [{name}], or the "
                         f"{next(iter(keys))} as a text")
    result = {}
    for key, given in value.items():
        about = keys.get(key)
        if about is None and not takes_options(name):
            raise unknown(owner, key, keys)
        inner = f"{name}.{key}" if name else key
        if given is None:
            continue
        if about is not None and about["type"] == "table":
            result[key] = checked(inner, given, inner)
        elif about is not None and about["type"] == "tables":
            several = given if isinstance(given, (list, tuple)) else [given]
            result[key] = [checked(inner, one, inner) for one in several]
        else:
            result[key] = given
    return result


class Table:
    """Keywords of one table, checked against the core's keys. Equal where all keywords are."""

    _table = ""

    def __init__(self, **keywords):
        self.keywords = checked(self._table, keywords, type(self).__name__)

    def replace(self, **keywords):
        """A copy with other values; None takes a keyword away."""
        return type(self)(**{**self.keywords, **keywords})

    def __getattr__(self, name):
        if name != "keywords" and name in self.keywords:
            return self.keywords[name]
        raise AttributeError(f"this {type(self).__name__} has no {name!r}; it has {', '.join(self.keywords)}"
                             if name != "keywords" else name)

    def __dir__(self):
        return [*super().__dir__(), *self.keywords]

    def __eq__(self, other):
        return type(self) is type(other) and self.keywords == other.keywords

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(f'{key}={value!r}' for key, value in self.keywords.items())})"

    def _repr_html_(self):
        """For notebooks: its keywords, of lists how many they hold, and a sketch of the structure."""
        rows = [[key, f"{len(value)}: {value!r:.160}" if isinstance(value, (list, tuple)) else f"{value!r:.160}"]
                for key, value in self.keywords.items()]
        table, keys = next(((key, value) for key, value in self.keywords.items() if key in STRUCTURES), (self._table, self.keywords))

        def draw():
            try:
                return draw_structure(table, keys)
            except (KeyError, IndexError, TypeError, ValueError):  # such as a member of a joint that is not there
                return None

        return f"<p><b>{type(self).__name__}</b></p>\n" + html_table(["key", "value"], rows) + picture(draw, f"sketch of the {table}")


class Beam(Table):
    """A straight beam, as [beam] of an experiment file describes it.

    It has a length_m, a section (width_m, height_m or diameter_m) of a material (youngs_modulus_pa, and
    density_kg_per_m3 or mass_kg), or bending_stiffness_n_m2 [N m2] and mass_per_length_kg_per_m [kg/m] themselves;
    supports, bodies, springs, dashpots, absorbers, damages and segments as lists of dictionaries.

    >>> import beamid
    >>> beam = beamid.Beam(length_m=1.1, width_m=0.06, height_m=0.006, youngs_modulus_pa=2.12e11, mass_kg=3.055)
    >>> loaded = beam.replace(tip_mass_kg=0.36049)
    >>> round(beamid.modes(loaded, modes=1).tables["modes"]["frequency_hz"][0], 4)
    3.4555
    """

    _table = "beam"


class Chain(Table):
    """A chain of masses, springs and dashpots, such as a shear building, as [chain] describes it.

    >>> import beamid
    >>> building = beamid.Chain(masses_kg=[1e5, 1e5], stiffnesses_n_per_m=[1e8, 1e8])
    >>> beamid.modes(building, modes=2).tables["modes"]["frequency_hz"].round(3)
    array([3.111, 8.143])
    """

    _table = "chain"


class Frame(Table):
    """A plane frame of beams, as [frame] describes it: joints, members, supports, bodies, springs."""

    _table = "frame"


class SpaceFrame(Table):
    """A frame in three dimensions, as [space_frame] describes it: joints, sections, members, supports, bodies, springs.

    >>> import beamid
    >>> pipe = {"name": "pipe", "shape": "tube", "diameter_m": 0.1683, "wall_m": 0.008, "youngs_modulus_pa": 2.1e11,
    ...         "poissons_ratio": 0.3, "density_kg_per_m3": 7850}
    >>> mast = beamid.SpaceFrame(sections=[pipe], members=[{"first": 1, "second": 2, "section": "pipe"}],
    ...                          joints=[{"x_m": 0, "y_m": 0, "z_m": 0}, {"x_m": 0, "y_m": 0, "z_m": 6}],
    ...                          supports=[{"joint": 1, "kind": "clamped"}])
    >>> beamid.modes(mast, modes=2).tables["modes"]["frequency_hz"].round(4)
    array([4.5622, 4.5622])
    """

    _table = "space_frame"


class System(Table):
    """User-supplied mass, stiffness and damping matrices, as [system] describes them: K = K_0 + sum theta_j K_j, likewise
    M and C. A matrix is a numpy array, a sparse matrix of scipy, or the name of a Matrix Market file.

    >>> import beamid, numpy as np
    >>> lower, upper = np.diag([2e6, 0.0]), 1.5e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    >>> building = beamid.System(mass=np.diag([1000.0, 800.0]), stiffness=upper, labels=["floor", "roof"],
    ...                          parameters=[{"name": "lower", "stiffness": lower}])
    >>> beamid.modes(building, modes=2).tables["modes"]["frequency_hz"].round(3)
    array([ 4.569, 10.737])
    """

    _table = "system"

    def __init__(self, **keywords):
        super().__init__(**as_matrices(keywords, "System"))

    @classmethod
    def of(cls, function, values, **keywords):
        """The system of a function `function(p)` -> M, C, K of parameters p.name, each matrix (n, n) and affine in them; C may be
        None. `values` are the parameters' own by name; each can be asked for as a factor of its name.

        >>> import beamid, numpy as np
        >>> def system(p):
        ...     return np.diag([p.m, 800.0]), None, p.k * np.array([[2.0, -1.0], [-1.0, 1.0]])
        >>> building = beamid.System.of(system, {"m": 1000.0, "k": 1.5e6}, labels=["floor", "roof"])
        >>> beamid.modes(building, modes=2).tables["modes"]["frequency_hz"].round(3)
        array([ 4.115, 10.322])

        :raises InputError: where a matrix is not affine in the parameters, or has no value other than numbers
        """
        return cls(**affine_matrices(function, values), **keywords)


class Experiment(Table):
    """A whole experiment file: its tables as keywords, a structure among them.

    >>> import beamid
    >>> beam = beamid.Beam(length_m=1.1, bending_stiffness_n_m2=229.0, mass_kg=3.055)
    >>> beamid.Experiment(beam=beam, filter="ukf", damping={"ratio": 0.002}).filter
    {'method': 'ukf'}
    """

    @classmethod
    def read(cls, path):
        """The experiment of a TOML file; the files that it names are found from any folder.

        :raises InputError: where it cannot be read, or holds a key that no table has
        """
        path = os.path.abspath(os.fspath(path))
        try:
            with open(path, "rb") as stream:
                root = tomllib.load(stream)
        except (OSError, ValueError) as error:
            raise InputError(f"{path}: {error}") from None
        return cls(**_with_absolute_files(root, os.path.dirname(path)))


def _with_absolute_files(value, folder):
    """Names of files in an experiment are relative to its folder: keys `file` and `..._file`."""
    if isinstance(value, list):
        return [_with_absolute_files(one, folder) for one in value]
    if not isinstance(value, dict):
        return value
    return {key: os.path.join(folder, one) if isinstance(one, str) and (key == "file" or key.endswith("_file") or
                                                                         one.endswith(".mtx"))
            else _with_absolute_files(one, folder) for key, one in value.items()}


def keys_text(name):
    """The keys of a table for a docstring, a line each."""
    lines = []
    for key, about in tables()[name].items():
        unit = f" [{about['unit']}]" if about["unit"] else ""
        if about["type"] in ("table", "tables"):
            lines.append(f"    {key}: {'a list of dictionaries, ' if about['type'] == 'tables' else 'a dictionary, '}"
                         f"keys {', '.join(tables()[f'{name}.{key}'])}")
        else:
            lines.append(f"    {key}{unit}: {about['meaning']}".replace("`", ""))
    return "\n".join(lines)


for _class in (Beam, Chain, Frame, SpaceFrame, System):
    _class.__doc__ += f"\n    Keywords\n\n{keys_text(_class._table)}\n    "
assert {_class._table for _class in (Beam, Chain, Frame, SpaceFrame, System)} == set(STRUCTURES)
for _class in (Beam, Chain, Frame, SpaceFrame, System, Experiment):
    _class.__module__ = "beamid"
