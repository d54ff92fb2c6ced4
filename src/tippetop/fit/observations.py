"""Observation models: what a run would have shown to a camera, a microphone or a clock.

Each is a function of a run, sampled at the times of the data, and of a few numbers of the
instrument that are fitted beside those of the problem, such as the direction of a camera.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, Protocol

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tippetop.integrators.base import Array
from tippetop.mechanics.surfaces.hull import outer_height
from tippetop.problem.problem import Problem, top_of
from tippetop.results.catalogue import SAMPLED
from tippetop.results.event_functions import KINDS

View = Literal["above", "side"]
VIEWS = ("above", "side")

Point = str | tuple[float, float]
"""A point of the body: "tip", "center", or its distances from the axis and, along the axis, from
the centre of mass, m."""

INSTANTS = ("turnover_time", "arrival_time", "liftoff_time")
"""Metrics of a run that are times of events."""


class Observation(Protocol):
    """What data show of a run."""

    @property
    def labels(self) -> tuple[str, ...]:
        """Name of each column."""

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each column, which residuals and noise have too."""

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the instrument's numbers that are fitted."""

    def guess(self, run: xr.Dataset, values: Array) -> dict[str, float]:
        """Return those numbers near the best ones for a run and data, shape (times, columns)."""

    def __call__(self, run: xr.Dataset, numbers: Mapping[str, float]) -> Array:
        """Return what would be observed, shape (times, columns)."""


@dataclass(frozen=True)
class Variables:
    """Scalar variables of the run, by name."""

    labels: tuple[str, ...]

    parameters: tuple[str, ...] = ()

    @property
    def units(self) -> tuple[str, ...]:
        """SI units of the variables."""
        return tuple(SAMPLED[name].units for name in self.labels)

    def guess(self, run: xr.Dataset, values: Array) -> dict[str, float]:
        """Return nothing: there is no instrument."""
        return {}

    def __call__(self, run: xr.Dataset, numbers: Mapping[str, float]) -> Array:
        """Return the variables."""
        return np.stack([run[name].values for name in self.labels], axis=-1)


@dataclass(frozen=True)
class SpinRate:
    """Number of turns about the axis, without its sign, as a sound or a stroboscope tells it."""

    labels: tuple[str, ...] = ("rpm",)
    units: tuple[str, ...] = ("rpm",)
    parameters: tuple[str, ...] = ()

    def guess(self, run: xr.Dataset, values: Array) -> dict[str, float]:
        """Return nothing: there is no instrument."""
        return {}

    def __call__(self, run: xr.Dataset, numbers: Mapping[str, float]) -> Array:
        """Return |omega3| in turns a minute."""
        rate: Array = np.abs(run["spin"].values[:, None]) * (30.0 / np.pi)
        return rate


@dataclass(frozen=True)
class Camera:
    """Position of a point of the body in a picture, from far above or from far at the side.

    A picture from above shows x and y of the table, turned by an angle. One from the side shows the
    horizontal distance along a direction at that angle from x, and the height. The angle, the
    picture's origin and, unless it is stated, the scale are fitted. Perspective is left out.
    """

    view: View
    point: Point
    scale: float | None
    """Metres per unit of the picture; None to fit it."""
    unit: str = "px"
    """Unit of the picture."""

    labels: tuple[str, ...] = ("x", "y")

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of the picture, twice."""
        return (self.unit, self.unit)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Angle and origin of the camera, its scale, and the direction of a mark on the body."""
        mark = () if isinstance(self.point, str) else ("mark.angle",)
        scale = ("camera.scale",) if self.scale is None else ()
        return ("camera.angle", "camera.x", "camera.y", *scale, *mark)

    def guess(self, run: xr.Dataset, values: Array) -> dict[str, float]:
        """Return the camera that sees the run nearest to the data, by linear least squares."""
        numbers = {"mark.angle": 0.0} if "mark.angle" in self.parameters else {}
        x, y, z = self.position(run, numbers).T
        seen = np.isfinite(values).all(axis=1) & np.isfinite(x)
        one, zero = np.ones(seen.sum()), np.zeros(seen.sum())
        x, y, z, (across, up) = x[seen], y[seen], z[seen], values[seen].T
        if self.view == "above":
            rows = [np.stack([x, -y, one, zero], 1), np.stack([y, x, zero, one], 1)]
            c, s, x0, y0 = np.linalg.lstsq(np.concatenate(rows), np.append(across, up))[0]
            per_metre = np.hypot(c, s)
        else:
            c, s, x0 = np.linalg.lstsq(np.stack([x, y, one], 1), across)[0]
            per_metre, y0 = np.linalg.lstsq(np.stack([z, one], 1), up)[0]
        numbers |= {"camera.angle": float(np.arctan2(s, c)), "camera.x": x0, "camera.y": y0}
        if self.scale is None:
            numbers["camera.scale"] = 1.0 / max(abs(per_metre), 1e-9)
        return numbers

    def __call__(self, run: xr.Dataset, numbers: Mapping[str, float]) -> Array:
        """Return the coordinates in the picture."""
        x, y, z = self.position(run, numbers).T
        scale = self.scale or numbers["camera.scale"]
        c, s = np.cos(numbers["camera.angle"]), np.sin(numbers["camera.angle"])
        seen = (c * x - s * y, s * x + c * y) if self.view == "above" else (c * x + s * y, z)
        origin = (numbers["camera.x"], numbers["camera.y"])
        return np.stack([part / scale + o for part, o in zip(seen, origin, strict=True)], axis=-1)

    def position(self, run: xr.Dataset, numbers: Mapping[str, float]) -> Array:
        """Return the point's coordinates on the table, m, shape (times, 3)."""
        center: Array = np.stack([run[name].values for name in ("x", "y", "height")], axis=-1)
        if self.point == "center":
            return center
        if isinstance(self.point, str):
            end: Array = center + tip_height(run.attrs["problem"]) * run["axis"].values
            return end
        radius, along = self.point
        angle = numbers["mark.angle"]
        w, *q = run["orientation"].values.T
        vector, arm = np.stack(q, axis=-1), radius * np.array([np.cos(angle), np.sin(angle), 0.0])
        arm = arm + np.array([0.0, 0.0, along])
        half = np.cross(vector, arm)
        turned = arm + 2.0 * (w[:, None] * half + np.cross(vector, half))
        position: Array = center + turned
        return position


@lru_cache(maxsize=1)
def tip_height(problem: str) -> float:
    """Return how far the tip of a body is from its centre of mass, m, from a problem's JSON text.

    A search asks again for each number of the camera.
    """
    return float(outer_height(top_of(Problem.from_json(problem)).surface, -1.0))


@dataclass(frozen=True)
class EventTimes:
    """Times of events: metrics such as `turnover_time`, or the first event of a kind."""

    labels: tuple[str, ...]
    parameters: tuple[str, ...] = ()

    @property
    def units(self) -> tuple[str, ...]:
        """Seconds."""
        return ("s",) * len(self.labels)

    def guess(self, run: xr.Dataset, values: Array) -> dict[str, float]:
        """Return nothing: there is no instrument."""
        return {}

    def __call__(self, run: xr.Dataset, numbers: Mapping[str, float]) -> Array:
        """Return the times, NaN for events that do not happen, in one row."""
        return np.array([[_instant(run, name) for name in self.labels]])


def _instant(run: xr.Dataset, name: str) -> float:
    if name in INSTANTS:
        return float(run[name])
    times = run["event_time"].values[run["event_kind"].values == name]
    return float(times[0]) if len(times) else float("nan")


EVENT_NAMES = (*INSTANTS, *KINDS)


@dataclass(frozen=True)
class OwnObservation:
    """A function of the run that users bring."""

    function: Callable[[xr.Dataset], ArrayLike]
    labels: tuple[str, ...]
    units: tuple[str, ...]
    parameters: tuple[str, ...] = ()

    def guess(self, run: xr.Dataset, values: Array) -> dict[str, float]:
        """Return nothing: there is no instrument."""
        return {}

    def __call__(self, run: xr.Dataset, numbers: Mapping[str, float]) -> Array:
        """Return what the function returns, as columns."""
        values: Array = np.asarray(self.function(run), dtype=float)
        return values[:, None] if values.ndim == 1 else values
