"""Figures of the page: their titles and captions from `figures.toml`, and how each is drawn."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from tippetop.figures import dry, flights, methods, real, runs, sweeps, theory, theory_runs
from tippetop.figures.euler_angles import euler_angles_drawing
from tippetop.figures.model import model_drawing
from tippetop.figures.tippe_top import tippe_top_drawing
from tippetop.report import printed_numbers
from tippetop.report.claim import Data
from tippetop.report.experiments.runs import likely_end
from tippetop.report.texts import filled_tables

Draw = Callable[[xr.Dataset], Figure]


@dataclass(frozen=True)
class Plate:
    """A figure of the page: one of the report's redone, or an added one."""

    id: str
    """Name, and stem of the names of its files."""
    draw: Draw
    """Function that draws the figure from its dataset, which is empty for a drawing without
    data.
    """
    title: str
    """Heading."""
    caption: str
    """Description of what is seen, in a few sentences."""
    needs: tuple[str, ...]
    """Names of the experiments whose data it shows."""
    section: str
    """Section of the page that it belongs to; see `tippetop.report.outline`."""
    finding: str = ""
    """Result that the report does not have, in a sentence; "" if there is none."""

    def dataset(self, data: Data) -> xr.Dataset:
        """Return the merged data of the experiments that the figure shows."""
        parts = [data[name] for name in self.needs]
        return xr.merge(parts, combine_attrs="drop_conflicts", compat="no_conflicts", join="outer")


_CRITICAL = (float(printed_numbers.CRITICAL_SPINS[0]), float(printed_numbers.CRITICAL_SPINS[1]))
_ABNORMAL = float(printed_numbers.ABNORMAL_SPIN)


def _printed_times(figure: str) -> dict[str, Any]:
    """Return the times that the report prints for a figure, as arguments of its drawing."""
    times = tuple(float(time) for time in printed_numbers.REVERSALS[figure])
    return {"reported_turn": float(printed_numbers.TURNED_AT[figure]), "reported_reversals": times}


def _slow_launch(run: xr.Dataset) -> Figure:
    return runs.motion_figure(
        run,
        precession_limit=80.0,
        **_printed_times("fig05"),
        reported_end=(float(likely_end(run)["window"]), printed_numbers.END_OF_FIG_5),
        zoom=(0.0, 1.6),
        inset=(0.12, 0.57, 0.34, 0.38),
    )


DRAWN: dict[str, Draw] = {
    "fig01": lambda _: tippe_top_drawing(),
    "fig02": lambda _: euler_angles_drawing(),
    "fig03": lambda _: model_drawing(),
    "fig04": partial(runs.motion_figure, zoom=(5.2, 5.6), **_printed_times("fig04")),
    "fig05": _slow_launch,
    "fig06": partial(sweeps.final_tilt_figure, reported=(*_CRITICAL, _ABNORMAL)),
    "windows": partial(sweeps.windows_figure, reported=_CRITICAL),
    "fig07": partial(sweeps.flip_time_figure, reported=float(printed_numbers.EXPONENT)),
    "fig08": partial(runs.tilt_figure, zoom=(12.8, 13.8)),
    "fig09": partial(runs.tilt_figure, zoom=(5.3, 5.8), inset=(0.6, 0.52, 0.38, 0.44)),
    "fig10": partial(
        runs.energy_figure,
        reported=(float(printed_numbers.ENERGY_TIME), float(printed_numbers.ENERGY)),
    ),
    "fig11": runs.force_figure,
    "fig12": partial(runs.stopped_figure, reported_stop=float(printed_numbers.STOP)),
    "fig13": runs.upright_figure,
    "fig14": partial(runs.tilt_figure, zoom=(5.5, 6.0)),
    "fig15": partial(runs.tilt_figure, zoom=(5.5, 6.0)),
    "fig16": partial(runs.tilt_figure, zoom=(5.5, 6.0)),
    "onset-mu": partial(flights.onset_figure, over="mu", reported=_ABNORMAL),
    "onset-tilt": partial(flights.onset_figure, over="tilt", reported=_ABNORMAL),
    "flights": flights.flights_figure,
    "order": methods.order_figure,
    "stiffness": methods.stiffness_figure,
    "why-bifurcation": theory.bifurcation_figure,
    "why-growth": partial(theory.growth_figure, reported=_CRITICAL),
    "why-groups": theory.groups_figure,
    "why-collapse": theory_runs.collapse_figure,
    "why-exponent": theory_runs.exponent_figure,
    "why-balance": theory_runs.balance_figure,
    "why-potential": theory_runs.potential_figure,
    "dry-rolling": dry.rolling_figure,
    "dry-cohen": dry.cohen_figure,
    "dry-smoothed": dry.smoothed_figure,
    "dry-patch": dry.patch_figure,
    "dry-viscous": dry.viscous_figure,
    "real-leine": real.leine_figure,
    "real-stepping": real.stepping_figure,
    "real-stems": real.stems_figure,
    "real-egg": real.egg_figure,
    "real-rolling": real.rolling_figure,
}
"""Function that draws each figure from the merged data of its experiments."""

PLATES: dict[str, Plate] = {
    name: Plate(name, DRAWN[name], **{"needs": (name,), **fields})
    for name, fields in filled_tables("figures").items()
}
"""All figures by name, in the order of the page."""
