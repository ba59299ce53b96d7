"""Pictures of curves and bodies, by Matplotlib."""

import itertools
from collections.abc import Mapping
from typing import Any, Union

import matplotlib.pyplot
import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection

from feldspar import _core

_crack_colours = {"tension": "#c1272d", "shear": "#0050a0"}


def curve_figure(curves: Mapping[str, pandas.DataFrame], axes: Union[Axes, None] = None) -> Axes:
    """Draws axial stress over axial strain, a line a curve; of a single one the number of cracks too."""
    axes = axes if axes is not None else matplotlib.pyplot.subplots()[1]
    for name, curve in curves.items():
        axes.plot(1e3 * curve["axial_strain"], 1e-6 * curve["axial_stress_Pa"], label=name.replace("_", " "))
    axes.set_xlabel("axial strain [1e-3]")
    axes.set_ylabel("axial stress [MPa]")
    if len(curves) > 1:
        axes.legend()
    else:
        (curve,) = curves.values()
        cracks = axes.twinx()
        cracks.plot(
            1e3 * curve["axial_strain"], curve["n_tension_cracks"] + curve["n_shear_cracks"], color="0.6", linestyle="--"
        )
        cracks.set_ylabel("broken segments")
    return axes


# Markers of the numbers that gnuplot gives them.
_marks = {1: "+", 4: "s", 5: "s", 6: "o", 7: "o", 8: "^", 12: "D", 13: "D"}
_open_marks = (4, 6, 8, 12)
_dashes = {1: "-", 2: "--", 3: ":", 4: "-.", 5: (0, (6, 3, 1, 3, 1, 3))}


def chart_figure(chart: Mapping[str, Any], axes: Union[Axes, None] = None) -> Axes:
    """Draws a chart of a page, one of Run.charts."""
    axes = axes if axes is not None else matplotlib.pyplot.subplots()[1]
    right = axes.twinx() if chart["right"] else axes
    for line in chart["lines"]:
        panel = right if line["right"] else axes
        colour, kind = line["colour"], line["kind"]
        label = "_" if line["goes_with"] else line["label"]  # what begins so is not in the legend
        if kind == "area":
            for is_gap, corners in itertools.groupby(line["points"], lambda point: point is None):
                if not is_gap:
                    panel.fill(*zip(*corners), color=colour, alpha=0.2, linewidth=0.0, label="_")
            continue
        points = numpy.array([point or (numpy.nan, numpy.nan) for point in line["points"]], dtype=float)
        panel.plot(
            *points.T,
            color=colour,
            label=label,
            linewidth=0.75 * line["width"],  # pixels of the page
            linestyle="" if kind == "marks" else _dashes.get(line["dashes"], "-"),
            drawstyle="steps-mid" if kind == "steps" else "default",
            marker=_marks[line["mark"]] if kind == "marks" else "",
            markerfacecolor="white" if line["mark"] in _open_marks else colour,
        )
    axes.set_xlabel(chart["x"])
    axes.set_ylabel(chart["y"])
    if right is not axes:
        right.set_ylabel(chart["right"])
    if "y" in chart["logarithmic"]:
        axes.set_yscale("log")
    if "x" in chart["logarithmic"]:
        axes.set_xscale("log")
    if chart["equal"]:
        axes.set_aspect("equal")
    if "part" in chart:
        axes.axis(tuple(chart["part"]))
    elif chart["from_zero"]:
        axes.set_ylim(bottom=0.0)
    entries = [one.get_legend_handles_labels() for one in {axes: None, right: None}]
    axes.legend(sum((handles for handles, _ in entries), []), sum((labels for _, labels in entries), []))
    return axes


def grains_figure(
    grains: pandas.DataFrame, cracks: Union[pandas.DataFrame, None] = None, axes: Union[Axes, None] = None
) -> Axes:
    """Draws discs and broken segments in the plane; lengths in mm."""
    if "z_m" in grains and numpy.ptp(grains["z_m"]) > 0.0:
        raise _core.Error("this figure is of a body in the plane; a body in space is drawn by the page of feldspar.report()")
    axes = axes if axes is not None else matplotlib.pyplot.subplots(figsize=(4.0, 7.0))[1]
    centres = 1e3 * grains[["x_m", "y_m"]].to_numpy()
    diameters = 2e3 * grains["radius_m"].to_numpy()
    axes.add_collection(
        EllipseCollection(
            diameters,
            diameters,
            numpy.zeros(len(diameters)),
            units="xy",
            offsets=centres,
            transOffset=axes.transData,
            facecolors="#d8d2c4",
            edgecolors="white",
            linewidths=0.2,
        )
    )
    if cracks is not None:
        along = numpy.column_stack([-cracks["normal_y"], cracks["normal_x"]]) * cracks[["size_m"]].to_numpy() / 2.0
        middle = cracks[["x_m", "y_m"]].to_numpy()
        for kind, colour in _crack_colours.items():
            own = (cracks["kind"] == kind).to_numpy()
            ends = 1e3 * numpy.stack([(middle - along)[own], (middle + along)[own]], axis=1)
            axes.add_collection(LineCollection(list(ends), colors=colour, linewidths=0.8, label=kind))
        axes.legend(loc="upper right")
    axes.set_aspect("equal")
    # Pieces that fly off leave the picture, not the body small in it.
    start = 1e3 * grains[["start_x_m", "start_y_m"] if "start_x_m" in grains else ["x_m", "y_m"]].to_numpy()
    low, high = start.min(axis=0), start.max(axis=0)
    margin = 0.1 * (high - low).min() + diameters.max() / 2.0
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    return axes
