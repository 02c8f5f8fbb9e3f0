"""Tables and plots of what `curve` has measured."""

import csv
import io
import json
from pathlib import Path

from ..engine import FileError

SUFFIXES = (".csv", ".json", ".png", ".svg")
CURE = "run it outside of Blender, in a Python with pip install 'glanz[bench]'"


def write(folder, rungs, facts):
    """Write curve.csv, .json, .png and .svg to `folder`; (paths, names of what could not be written for want of matplotlib).

    `facts` {str: value} go to the JSON file beside the rungs. Raises FileError naming the file.
    """
    folder = Path(folder)
    table = io.StringIO()
    rows = [rung.as_dict() for rung in rungs]
    lines = csv.DictWriter(table, rows[0], lineterminator="\n")
    lines.writeheader()
    lines.writerows(rows)
    texts = {"curve.csv": table.getvalue(), "curve.json": json.dumps(facts | {"rungs": rows}, indent=2) + "\n"}
    paths = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
            paths.append(folder / name)
        plots = [folder / f"curve{suffix}" for suffix in (".png", ".svg")]
        if not _plot(plots, rungs, facts):
            return paths, [path.name for path in plots]
    except OSError as error:
        raise FileError(f"cannot write to '{folder}': {error.strerror or error}") from error
    return [*paths, *plots], []


def _plot(paths, rungs, facts):
    """Error against time, a line for each curve and one for the Pareto front; False without matplotlib."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return False
    figure = Figure(figsize=(9, 6), layout="constrained")
    axes = figure.add_subplot(xscale="log", yscale="log")
    for curve in dict.fromkeys(rung.curve for rung in rungs):
        own = [rung for rung in rungs if rung.curve == curve]
        integrator, sampler, depth, precision = curve
        slope = "" if own[0].slope is None else f", noise by N^{own[0].slope:.2f}"
        name = f"{integrator}, {sampler}, depth {depth}, {precision}{slope}"
        line = axes.plot([rung.seconds for rung in own], [rung.rmse for rung in own], marker="o", markersize=4, label=name)[0]
        for rung in own:
            axes.annotate(str(rung.samples), (rung.seconds, rung.rmse), (4, 4), textcoords="offset points", size=7, color=line.get_color())
    best = sorted((rung for rung in rungs if rung.is_best), key=lambda rung: rung.seconds)
    axes.plot([rung.seconds for rung in best], [rung.rmse for rung in best], color="black", linewidth=6, alpha=0.12, label="best of all")
    axes.set(xlabel="time [s], without compiling", ylabel="RMSE / mean", title=f"{facts['scene']}: error against time; numbers are samples")
    axes.grid(which="both", alpha=0.2)
    axes.legend(fontsize=8)
    for path in paths:
        figure.savefig(path, dpi=150)
    return True


def as_lines(rungs):
    """The table for people, line by line; * marks the Pareto front."""
    lines = ["integrator     sampler     depth precision samples     time     RMSE    relMSE    FLIP  slope  error is"]
    for r in rungs:
        flip = "" if r.flip is None else f"{r.flip:.4f}"
        slope = "" if r.slope is None else f"{r.slope:.2f}"
        lines.append(
            f"{r.integrator:<14} {r.sampler:<11} {r.max_depth:>5} {r.precision:<9} {r.samples:>7} {r.seconds:>6.2f} s "
            f"{100 * r.rmse:>6.2f} % {r.relmse:>9.2e} {flip:>7} {slope:>6}  {r.kind}{' *' if r.is_best else ''}"
        )
    return lines
