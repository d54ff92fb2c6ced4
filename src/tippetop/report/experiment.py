"""Experiments: independent computations, one dataset each, for the figures and the claims."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, TypeAlias

import xarray as xr

from tippetop.results.dataset import CONVENTIONS

Compute: TypeAlias = Callable[[bool], xr.Dataset]


@dataclass(frozen=True)
class Experiment:
    """A computation that depends on no other."""

    id: str
    """Name."""
    title: str
    """Subject, in a few words."""
    cost: float
    """Approximate duration, s: for the order of work and the remaining time."""
    compute: Compute
    """Function that computes the dataset; its argument says whether a coarser version is enough."""

    def run(self, quick: bool) -> xr.Dataset:
        """Return the computed dataset, with the experiment's name and version as attributes."""
        data = self.compute(quick)
        data.attrs = {
            "title": self.title,
            "experiment": self.id,
            "quick": int(quick),
            "tippetop_version": version("tippetop"),
            "Conventions": CONVENTIONS,
            **data.attrs,
        }
        return data


EXPERIMENTS: dict[str, Experiment] = {}
"""Experiments that are registered; `tippetop.report.experiments.registry` registers all of them."""


def experiment(name: str, title: str, cost: float) -> Callable[[Compute], Compute]:
    """Return a decorator that registers a function as the computation of an experiment.

    See `Experiment` for the arguments. Raises `ValueError` if the name is used twice.
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
"""Units and meanings of common coordinates."""


def dataset(
    coordinates: Mapping[str, Any], attrs: Mapping[str, Any] | None = None, /, **variables: Any
) -> xr.Dataset:
    """Return a dataset of variables and coordinates with units and meanings.

    A variable is a tuple of the arguments of `variable`: values, unit, meaning and dimensions. A
    coordinate is a tuple of values, unit and meaning, or values alone: words, or a quantity of
    `_ALONG`, whose name may have a suffix, as in spin and spin_listing.
    """
    coords: dict[str, Any] = {}
    for name, coordinate in coordinates.items():
        kind = _ALONG.get(name.partition("_")[0])
        if isinstance(coordinate, tuple):
            coords[name] = variable(*coordinate, name)
        elif kind:
            coords[name] = variable(coordinate, *kind, name)
        else:
            coords[name] = coordinate
    return xr.Dataset(
        {name: variable(*arguments) for name, arguments in variables.items()}, coords, attrs
    )


def variable(
    values: object, units: str | None, long_name: str, *dimensions: str
) -> tuple[tuple[str, ...], object, dict[str, str]]:
    """Return a variable of a dataset with its meaning and its unit, which is None for words."""
    unit = {} if units is None else {"units": units}
    return (dimensions, values, {**unit, "long_name": long_name})
