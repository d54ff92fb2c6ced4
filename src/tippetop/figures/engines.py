"""Figures of other programs against the exact runs."""

from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import tippetop as tt
from tippetop.engines.cases import Case
from tippetop.engines.comparison import verdicts
from tippetop.engines.reference import case_of


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


def launch_figure(results: Mapping[str, Mapping[str, Any]], name: str) -> Figure:
    """Draw the tilt of one launch in all programs, defaults thin and best settings thick."""
    case: Case = case_of(name)
    best = {one.engine: one.setting for one in verdicts(results) if one.case == name}
    figure, panel = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
    run = tt.simulate(case.problem, case.duration, samples=1001)
    panel.plot(run["time"], run["theta"], color="black", lw=2.0, label="exact", zorder=9)
    for number, result in enumerate(results.values()):
        first = result["settings"][0]["name"]
        for row in result["rows"]:
            if row["case"] != name or "tilt" not in row:
                continue
            is_best = row["setting"] == best.get(result["engine"])
            if not (is_best or row["setting"] == first):
                continue
            time = np.linspace(0.0, case.duration, len(row["tilt"]))
            label = f"{result['engine']}, {row['setting']}, {1e3 * row['step']:.3g} ms"
            style = {"lw": 1.3} if is_best else {"lw": 0.7, "ls": "--"}
            panel.plot(time, row["tilt"], color=f"C{number}", label=label, **style)
    panel.set(xlabel="time (s)", ylabel=r"tilt $\theta$ (rad)")
    panel.legend(fontsize="x-small", frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure
