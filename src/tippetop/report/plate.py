"""What a figure is: which experiments it is drawn from, how, and what to say under it."""

from collections.abc import Callable
from dataclasses import dataclass

import xarray as xr
from matplotlib.figure import Figure

from tippetop.report.claim import Data

Draw = Callable[[xr.Dataset], Figure]


@dataclass(frozen=True)
class Plate:
    """A figure of the report redone, or one of our own."""

    id: str
    """Name, and stem of its files."""
    draw: Draw
    """Makes the figure from their merged dataset (empty for a drawing that needs none)."""
    title: str
    """Heading."""
    caption: str
    """What is seen, in a few sentences."""
    needs: tuple[str, ...]
    """Names of the experiments it shows."""
    section: str
    """The section of the page that it belongs to; see `tippetop.report.outline`."""
    finding: str = ""
    """What it finds out, in a few words, where that is news or one of the pictures that the page opens
    with."""

    def dataset(self, data: Data) -> xr.Dataset:
        """The data behind the figure."""
        parts = [data[name] for name in self.needs]
        return xr.merge(parts, combine_attrs="drop_conflicts", compat="no_conflicts", join="outer")
