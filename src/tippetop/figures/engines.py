"""Figures of other programs against the exact runs."""

import math
from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter, NullLocator

import tippetop as tt
from tippetop.engines.cases import Case
from tippetop.engines.comparison import verdicts
from tippetop.engines.reference import case_of

TILT_DIGIT = 1e-4
"""The last digit of stored tilts, rad: errors below it are drawn there."""


def errors_figure(results: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw the error over the step, a panel a case, each program at its best setting."""
    best = {(one.engine, one.case): one.setting for one in verdicts(results)}
    cases = list(dict.fromkeys(case for _, case in best))
    columns = min(4, max(1, len(cases)))
    rows = -(-len(cases) // columns) or 1
    figure, axes = plt.subplots(rows, columns, figsize=(2.6 * columns, 2.3 * rows), squeeze=False)
    engines = [result["engine"] for result in results.values()]
    for panel, case in zip(axes.flat, cases, strict=False):
        for number, result in enumerate(results.values()):
            setting = best.get((result["engine"], case))
            drawn = [
                (row["step"], row["error"])
                for row in result["rows"]
                if (row["case"], row["setting"]) == (case, setting) and row.get("error")
            ]
            if drawn:
                steps, errors = zip(*sorted(drawn), strict=True)
                panel.loglog(1e3 * np.array(steps), errors, "o-", ms=3, color=f"C{number}")
        if panel.lines:
            _whole_decades(panel)
            _ticks_at_steps(panel)
        panel.set_title(case, fontsize="small")
    for panel in axes.flat[len(cases) :]:
        panel.set_visible(False)
    for panel in axes[-1]:
        panel.set_xlabel("step (ms)")
    for panel in axes[:, 0]:
        panel.set_ylabel("error")
    handles = [Line2D([], [], marker="o", ms=3, color=f"C{k}") for k in range(len(engines))]
    figure.legend(handles, engines, loc="outside upper center", ncols=len(engines), frameon=False)
    figure.set_layout_engine("constrained")
    return figure


def _whole_decades(panel: Axes) -> None:
    """Let the vertical axis go from a power of ten to another, and have its labels there."""
    errors = np.concatenate([line.get_ydata() for line in panel.lines])
    low, high = math.floor(math.log10(errors.min())), math.ceil(math.log10(errors.max()))
    panel.set_ylim(10.0**low, 10.0**high)
    panel.yaxis.set_minor_formatter(NullFormatter())


def _ticks_at_steps(panel: Axes) -> None:
    """Label every other of the steps that are drawn."""
    steps = max((np.array(line.get_xdata(), float) for line in panel.lines), key=len)
    panel.set_xticks(steps[::2], [f"{step:.2g}" for step in steps[::2]])
    panel.xaxis.set_minor_locator(NullLocator())


def launch_figure(results: Mapping[str, Mapping[str, Any]], name: str) -> Figure:
    """Draw the tilt of one launch in all programs and its largest error up to each time.

    Defaults are thin, best settings thick.
    """
    case: Case = case_of(name)
    best = {one.engine: one.setting for one in verdicts(results) if one.case == name}
    figure, (panel, apart) = plt.subplots(
        2, 1, figsize=(7.2, 5.0), sharex=True, layout="constrained"
    )
    end = float(case.times[case.compared - 1])
    run = tt.simulate(case.problem, end, samples=1001)
    panel.plot(run["time"], run["tilt"], color="black", lw=2.0, label="exact", zorder=9)
    for number, result in enumerate(results.values()):
        first = result["settings"][0]["name"]
        for row in result["rows"]:
            if row["case"] != name or "tilt" not in row:
                continue
            is_best = row["setting"] == best.get(result["engine"])
            if not (is_best or row["setting"] == first):
                continue
            time = np.linspace(0.0, end, len(row["tilt"]))
            label = f"{result['engine']}, {row['setting']}, {1e3 * row['step']:.3g} ms"
            style = {"lw": 1.3} if is_best else {"lw": 0.7, "ls": "--"}
            panel.plot(time, row["tilt"], color=f"C{number}", label=label, **style)
            error = np.abs(row["tilt"] - np.interp(time, run["time"], run["tilt"]))
            largest = np.maximum.accumulate(np.maximum(error, TILT_DIGIT))
            apart.semilogy(time, largest, color=f"C{number}", **style)
    panel.set_ylabel(r"tilt $\theta$ (rad)")
    apart.set(xlabel="time (s)", ylabel="largest error so far (rad)")
    figure.legend(fontsize="x-small", frameon=False, loc="outside right upper")
    return figure
