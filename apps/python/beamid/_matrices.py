"""Matrices of one's own, kept as their entries, and as the text of a Matrix Market file."""
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
