"""Matrices of one's own, kept as their entries, and as the text of a Matrix Market file."""
import types

import numpy as np

from ._errors import InputError


class Matrix:
    """A square matrix (n, n), from numpy or scipy.sparse. Equal where all entries are."""

    def __init__(self, values, owner):
        if hasattr(values, "tocoo"):
            values = values.tocoo()
            self.size, rows, columns, entries = values.shape, values.row, values.col, values.data
        else:
            values = np.asarray(values, dtype=float)
            rows, columns = np.nonzero(values)
            self.size, entries = values.shape, values[rows, columns]
        if len(self.size) != 2 or self.size[0] != self.size[1]:
            raise InputError(f"{owner} has the shape {self.size}; expected a square matrix")
        self.entries = list(zip(rows.tolist(), columns.tolist(), entries.tolist()))

    def __eq__(self, other):
        return isinstance(other, Matrix) and (self.size, self.entries) == (other.size, other.entries)

    def __repr__(self):
        return f"<{self.size[0]} x {self.size[1]} matrix, {len(self.entries)} entries>"

    def text(self):
        lines = [f"{row + 1} {column + 1} {value!r}" for row, column, value in self.entries]
        return "\n".join(["%%MatrixMarket matrix coordinate real general",
                          f"{self.size[0]} {self.size[1]} {len(lines)}", *lines, ""])


def as_matrices(value, owner):
    """The keywords of [system] with every array, dense or sparse, as a Matrix."""
    return {key: [as_matrices(part, f"{owner}.{key}") for part in one] if key == "parameters"
            else Matrix(one, f"{owner}.{key}") if key in ("mass", "stiffness", "damping") and hasattr(one, "shape")
            else one for key, one in value.items()}


def affine_matrices(function, values):
    """Keywords of [system] from `function(p)` -> M, C, K: the matrices without parameters, and what each adds for 1 of it."""
    names = ("mass", "damping", "stiffness")

    def at(numbers):
        found = function(types.SimpleNamespace(**numbers))
        if not isinstance(found, tuple) or len(found) != 3:
            raise InputError("the function of a system returned no M, C, K")
        dense = [one.toarray() if hasattr(one, "toarray") else one for one in found]
        size = np.shape(dense[0])
        return [np.zeros(size) if one is None else np.asarray(one, dtype=float) for one in dense]

    values = {name: float(value) for name, value in values.items()}
    base, slopes = at(values), {}
    for name, value in values.items():
        step = value if value != 0 else 1.0
        slopes[name] = [(there - here) / step for there, here in zip(at({**values, name: value + step}), base)]
    further = {name: 0.6 * value + 0.1 * (index + 1) * (value or 1.0) for index, (name, value) in enumerate(values.items())}
    for which, (found, here) in enumerate(zip(at(further), base)):
        expected = here + sum((further[name] - values[name]) * slopes[name][which] for name in values)
        if not np.allclose(found, expected, rtol=1e-9, atol=1e-9 * max(np.abs(found).max(), 1e-300)):
            raise InputError(f"{names[which]} is not affine in {', '.join(values)}; expected M, C, K = A_0 + sum p_j A_j")
    keywords = {name: here - sum(values[one] * slopes[one][which] for one in values)
                for which, (name, here) in enumerate(zip(names, base))}
    if not keywords["damping"].any():
        del keywords["damping"]
    keywords["parameters"] = [
        {"name": name, "value": value,
         **{names[which]: slope for which, slope in enumerate(slopes[name]) if slope.any()}} for name, value in values.items()]
    return keywords


def matrix_files(system, name="system"):
    """The keywords of [system] with a file's name for each Matrix, and the texts of these files by name."""
    files, keywords = {}, {}
    for key, one in system.items():
        if key == "parameters":
            keywords[key] = []
            for number, part in enumerate(one, 1):
                inner, more = matrix_files(part, f"{name}_{number}")
                keywords[key].append(inner)
                files.update(more)
        elif isinstance(one, Matrix):
            keywords[key] = f"{name}_{key}.mtx"
            files[keywords[key]] = one.text()
        else:
            keywords[key] = one
    return keywords, files
