"""Experiments: the computations that figures and claims are made from, each giving one dataset."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, TypeAlias

import xarray as xr

Compute: TypeAlias = Callable[[bool], xr.Dataset]


@dataclass(frozen=True)
class Experiment:
    """A computation that depends on nothing else."""

    id: str
    """What it is called."""
    title: str
    """What it finds out, in a few words."""
    cost: float
    """About how long it takes, s: for the order of work and for the time left."""
    compute: Compute
    """Does it; the argument says whether a coarser version is enough."""

    def run(self, quick: bool) -> xr.Dataset:
        """Compute, and note on the result what it is."""
        data = self.compute(quick)
        data.attrs = {
            "title": self.title,
            "experiment": self.id,
            "quick": int(quick),
            "tippetop_version": version("tippetop"),
            "Conventions": "CF-1.11",
            **data.attrs,
        }
        return data


EXPERIMENTS: dict[str, Experiment] = {}
"""Those registered so far; take all from `tippetop.report.experiments.registry`."""


def experiment(name: str, title: str, cost: float) -> Callable[[Compute], Compute]:
    """Register the decorated function as what does an experiment, which no other may; see
    `Experiment`.
    """

    def register(compute: Compute) -> Compute:
        if name in EXPERIMENTS:
            raise ValueError(f"two experiments are called {name}")
        EXPERIMENTS[name] = Experiment(name, title, cost, compute)
        return compute

    return register


_ALONG = {
    "spin": ("rad s-1", "spin at launch"),
    "tilt": ("rad", "tilt at launch"),
    "mu": ("s m-1", "friction coefficient"),
    "restitution": ("1", "coefficient of restitution"),
    "time": ("s", "time"),
    "step": ("s", "length of a step"),
    "window": ("s", "length of the runs"),
    "margin": ("rad", "what counts as 0"),
}
"""Units and meanings of what experiments go over."""


def dataset(
    coordinates: Mapping[str, Any], attrs: Mapping[str, Any] | None = None, /, **variables: Any
) -> xr.Dataset:
    """Return a dataset whose variables are told as values, unit, meaning and dimensions, as
    `variable` takes them.

    Coordinates are told as values, unit and meaning, or as values alone: words, or what `_ALONG`
    knows by what it is, and perhaps what of, as in spin and spin_listing.
    """
    own = {name: told for name, told in coordinates.items() if isinstance(told, tuple)}
    kinds = {name: _ALONG.get(name.partition("_")[0]) for name in coordinates}
    own |= {
        name: (coordinates[name], *kind) for name, kind in kinds.items() if kind and name not in own
    }
    return xr.Dataset(
        {name: variable(*told) for name, told in variables.items()},
        {**coordinates, **{name: variable(*told, name) for name, told in own.items()}},
        attrs,
    )


def variable(
    values: object, units: str | None, long_name: str, *dimensions: str
) -> tuple[tuple[str, ...], object, dict[str, str]]:
    """Return a variable of a dataset with its meaning and its unit, None for words."""
    unit = {} if units is None else {"units": units}
    return (dimensions, values, {**unit, "long_name": long_name})
