"""Figures of results and records, drawn by Matplotlib in the colours and styles of the command's own pictures."""
import base64
import functools
import html
import io
import re

import numpy as np

from ._errors import InputError

COLOURS = {"blue": "#0072b2", "vermillion": "#d55e00", "green": "#009e73", "purple": "#cc79a7", "orange": "#e69f00",
           "sky": "#56b4e9", "black": "#000000", "grey": "#7f7f7f"}  # distinct for colour-blind readers [okabe2008]
LINES = {"line": {"linewidth": 1.4}, "thin": {"linewidth": 0.8}, "dashed": {"linewidth": 1.2, "linestyle": "--"},
         "dotted": {"linewidth": 1.2, "linestyle": ":"}}


class Figure(dict):
    """Captions, axes and curves of one figure; plot() draws it."""

    def plot(self, figure=None):
        """The figure as a matplotlib.figure.Figure.

        :param figure: of Matplotlib, such as plt.figure(), to draw in; without it a new one that pyplot does not hold
        :raises ImportError: where Matplotlib is not installed
        """
        panels = self["panels"]
        rows, columns = self["rows"], self["columns"]
        figure = _empty((self["width"] / 100, 0.6 + 2.8 * rows), figure)
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for place, panel in zip(axes, panels):
            _draw(place, panel)
        for place in axes[len(panels):]:
            place.set_visible(False)
        return figure

    def __repr__(self):
        curves = sum(len(panel["curves"]) for panel in self["panels"])
        return f"<figure of {len(self['panels'])} panels and {curves} curves: {self['caption'] or self['panels'][0]['y_label']}>"


def plot_figure(found, name, figure):
    """One of several figures, the first without a name."""
    if not found:
        raise InputError("these results have no figure; expected those of a command that draws")
    if name is not None and name not in found:
        raise InputError(f"no figure {name!r}; expected one of {', '.join(map(repr, found))}")
    return found[next(iter(found)) if name is None else name].plot(figure)


def picture(draw, caption, most_bytes=100_000):
    """An <img> for notebooks of what draw() returns, a Matplotlib figure or None; empty without Matplotlib. Where it would be
    large, with fewer pixels: as base64 it takes 133 kB at most."""
    try:
        drawn = draw()
    except ImportError:
        return ""
    for dpi in (80, 56, 40):
        png = b"" if drawn is None else _png(drawn, dpi)
        if 0 < len(png) <= most_bytes:
            data = base64.b64encode(png).decode()
            return f'<img alt="{html.escape(caption[:500], quote=True)}" src="data:image/png;base64,{data}">\n'
    return ""


def html_table(head, rows, most_rows=30, most_letters=200):
    """A table for notebooks, everything in it as text."""
    def row(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell)[:most_letters])}</{tag}>" for cell in cells) + "</tr>\n"

    text = "<table>\n" + row(head, "th") + "".join(row(cells, "td") for cells in rows[:most_rows]) + "</table>\n"
    return text + (f"<p>and {len(rows) - most_rows} more</p>\n" if len(rows) > most_rows else "")


def record_cell(record, time, columns, labels):
    """A record in a notebook: its length, a line for each channel, and its plot. labels: (name, "quantity [unit]")."""
    rows = []
    for values, (name, kind) in zip(columns, labels):
        known = np.asarray(values)[np.isfinite(values)]
        numbers = (known.min(), known.max(), np.sqrt(np.mean(known ** 2))) if known.size else (np.nan,) * 3
        rows.append([name, kind, *(f"{number:.5g}" for number in numbers), len(values) - known.size or ""])
    span = f"{time[0]:g} to {time[-1]:g} s" if len(time) else ""
    text = f"<p><b>{html.escape(record.name[:200])}</b>: {len(time)} samples, {span}</p>\n"
    return text + html_table(["channel", "quantity", "lowest", "highest", "rms", "missing"], rows) + picture(record.plot, record.name)


def draw_structure(table, keys):
    """A sketch of a structure, the keys being those of its table; None where it has no places."""
    keys = {name: [dict(getattr(one, "keywords", one)) for one in values] if name in ("joints", "members", "supports", "bodies") else values
            for name, values in keys.items()}
    supports, bodies = keys.get("supports", []), keys.get("bodies", [])
    if table == "beam":
        length = keys.get("length_m") or sum(one["length_m"] for one in keys["segments"])
        lines = [((0, 0), (length, 0))]
        if "supports" not in keys and keys.get("support", "clamped") != "free":
            supports = [{"position_m": 0}]
        bodies = bodies + [{"position_m": length}] * ("tip_mass_kg" in keys)
        places = [[(one.get("position_m", length), 0) for one in some] for some in (supports, bodies)]
        label = "x [m]", ""
    elif table == "chain" and "masses_kg" in keys:
        heights = np.cumsum(keys.get("heights_m", np.ones(len(keys["masses_kg"]))))
        masses = [(0, height) for height in heights]
        lines, places = list(zip([(0, 0), *masses], masses)), [[(0, 0)], masses]
        label = "", "height [m]" if "heights_m" in keys else "mass"
    elif table in ("frame", "space_frame"):
        view = np.array([[1, 0], [0, 1]]) if table == "frame" else np.array([[0.866, 0.5, 0], [-0.211, 0.366, 0.906]])
        axes = ("x_m", "y_m") if table == "frame" else ("x_m", "y_m", "z_m")
        seen = [tuple(view @ [one.get(axis, 0.0) for axis in axes]) for one in keys["joints"]]
        lines = [(seen[one["first"] - 1], seen[one["second"] - 1]) for one in keys["members"]]
        places = [[seen[one["joint"] - 1] for one in some] for some in (supports, bodies)]
        label = ("x [m]", "y [m]") if table == "frame" else ("across the view [m]", "up [m]")
    else:
        return None
    figure = _empty((5, 1.4) if table == "beam" else (4, 4), None)
    axes = figure.subplots()
    for start, end in lines[:5000]:
        axes.plot([start[0], end[0]], [start[1], end[1]], color=COLOURS["blue"], linewidth=1.4)
    for some, mark, colour, name in zip(places, "^o", ("black", "vermillion"), ("support", "mass")):
        if some:
            axes.plot(*zip(*some), mark, color=COLOURS[colour], markersize=6, label=name)
    axes.set_xlabel(label[0], fontsize="small")
    axes.set_ylabel(label[1], fontsize="small")
    if table in ("frame", "space_frame"):
        axes.set_aspect("equal", "datalim")
    else:
        (axes.set_yticks if table == "beam" else axes.set_xticks)([])
    _finish(axes, legend=False)
    axes.legend(fontsize="small", frameon=False)
    return figure


def plot_record(time, columns, labels, title, figure=None):
    """Panels of one time axis, one for each kind of label; curves of more than 20,000 samples by their envelope."""
    kinds = list(dict.fromkeys(label for _, label in labels))
    figure = _empty((7.5, 1.2 + 2.0 * len(kinds)), figure)
    axes = figure.subplots(len(kinds), 1, squeeze=False, sharex=True).ravel()
    for place, kind in zip(axes, kinds):
        mine = [k for k, (_, label) in enumerate(labels) if label == kind]
        for colour, k in zip(_in_turn(len(mine)), mine):
            place.plot(*_thinned(time, columns[k]), color=colour, linewidth=0.8, label=labels[k][0])
        place.set_ylabel(_text(kind))
        _finish(place, legend=len(mine) > 1)
    axes[-1].set_xlabel("time [s]")
    figure.suptitle(_text(title), fontsize="medium")
    return figure


def _empty(size, figure):
    import matplotlib.figure  # pylint: disable=import-outside-toplevel

    if figure is None:
        figure = matplotlib.figure.Figure(figsize=size, layout="constrained")
        # A notebook displays figures by itself only once pyplot has drawn one, and pyplot does not hold this one.
        figure._repr_png_ = functools.partial(_png, figure)  # pylint: disable=protected-access
    return figure


def _png(figure, dpi=100):
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=dpi)
    return stream.getvalue()


def _in_turn(count):
    names = list(COLOURS)[:6]
    return [COLOURS["black"]] if count == 1 else [COLOURS[names[k % 6]] for k in range(count)]


def _text(label):
    """^{...} and _{...} raise and lower; everything else is literal."""
    return re.sub(r"([\^_])\{([^{}]*)\}", r"$\1{\\mathrm{\2}}$", label.replace("\\", "/").replace("$", r"\$"))


def _thinned(time, samples, most=20_000):
    """The lowest and the highest sample of each interval, in their order."""
    per = -(-2 * len(samples) // most)
    if per < 3:
        return time, samples
    whole = len(samples) // per
    blocks = np.asarray(samples)[:whole * per].reshape(whole, per)
    filled = np.where(np.isfinite(blocks), blocks, blocks[:, :1])
    at = np.sort(np.stack([filled.argmin(axis=1), filled.argmax(axis=1)], axis=1), axis=1) + per * np.arange(whole)[:, None]
    at = np.concatenate([at.ravel(), np.arange(whole * per, len(samples))])
    return np.asarray(time)[at], np.asarray(samples)[at]


def _draw(axes, panel):
    for curve in panel["curves"]:
        _draw_curve(axes, curve)
    axes.set_title(_text(panel["title"]), fontsize="medium")
    for axis, set_label, set_scale, set_range in (("x", axes.set_xlabel, axes.set_xscale, axes.set_xlim),
                                                  ("y", axes.set_ylabel, axes.set_yscale, axes.set_ylim)):
        set_label(_text(panel[axis + "_label"]), fontsize="small")
        if panel[axis + "_logarithmic"]:
            set_scale("log")
        else:
            axes.ticklabel_format(axis=axis, useOffset=False)
        if panel[axis + "_range"] is not None:
            set_range(*panel[axis + "_range"])
    if panel["y_names"]:
        axes.set_yticks(range(1, len(panel["y_names"]) + 1), [_text(name) for name in panel["y_names"]])
        axes.set_ylim(len(panel["y_names"]) + 0.5, 0.5)
    if panel["x_names"]:
        axes.set_xticks(range(1, len(panel["x_names"]) + 1), [_text(name) for name in panel["x_names"]])
    _finish(axes, legend=any(curve["label"] for curve in panel["curves"]))


def _draw_curve(axes, curve):
    style, x, y, lower, upper = (curve[key] for key in ("style", "x", "y", "lower", "upper"))
    common = {"color": COLOURS[curve["colour"]], "label": _text(curve["label"]) if curve["label"] else "_"}
    if style == "band":
        axes.fill_between(x, lower, upper, alpha=0.25, linewidth=0, **common)
    elif style in LINES:
        axes.plot(x, y, **LINES[style], **common)
    elif style == "stems":
        axes.vlines(x, 0, y, linewidth=1.0, **common)
    elif style == "arrows":
        for from_x, to_x, place in zip(lower, upper, y):
            axes.annotate("", (to_x, place), (from_x, place), arrowprops={"arrowstyle": "->", "color": common["color"]})
    elif lower is None:
        axes.plot(x, y, "o", markersize=4, markerfacecolor="none" if style == "open_points" else None, **common)
    else:  # error bars, along x of intervals
        middle = x if style == "intervals" else y
        axes.errorbar(x, y, fmt="o", markersize=4, linewidth=1.0, capsize=2,
                      **{"xerr" if style == "intervals" else "yerr": np.maximum([middle - lower, upper - middle], 0)}, **common)


def _finish(axes, legend):
    axes.grid(True, color="#dcdcdc", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    if legend:
        below = -56 / (axes.bbox.height / axes.figure.dpi * 72)  # [pt] of ticks and label
        axes.legend(fontsize="small", frameon=False, loc="upper center", bbox_to_anchor=(0.5, below), ncols=3)
