"""Figures of results and records, drawn by Matplotlib in the colours and styles of the command's own pictures."""
import base64
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


def picture(figure, most_bytes=150_000):
    """An <img> of a figure for notebooks; nothing without Matplotlib, or where it would be large."""
    try:
        drawn = figure.plot()
    except ImportError:
        return ""
    stream = io.BytesIO()
    drawn.savefig(stream, format="png", dpi=80)
    if stream.tell() > most_bytes:
        return ""
    data = base64.b64encode(stream.getvalue()).decode()
    return f'<img alt="{html.escape(figure["caption"], quote=True)}" src="data:image/png;base64,{data}">\n'


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
    import matplotlib.pyplot  # pylint: disable=import-outside-toplevel,unused-import  # notebooks then show figures

    if figure is None:
        return matplotlib.figure.Figure(figsize=size, layout="constrained")
    return figure


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
