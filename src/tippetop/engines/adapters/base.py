"""What an adapter of another program is, and helpers for writing one."""

import hashlib
import importlib.metadata
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.cases import Case

Array = NDArray[np.float64]


class Setting(NamedTuple):
    """A way to set a program, with the place in its documentation that recommends it."""

    name: str
    about: str
    """What is set, in a few words."""
    source: str
    """Where the program's documentation says so."""
    options: dict[str, Any]
    width: float | None = None
    """Slip speed over which friction is regularized at every step, m/s; None without such a one."""


class EngineState(NamedTuple):
    """The state of a body in another program, table frame, SI."""

    axis: Array
    omega: Array
    velocity: Array
    """Velocity of the centre of mass."""
    height: float


class EngineRun(Protocol):
    """A case that is under way in another program."""

    def advance(self, steps: int) -> None:
        """Take a number of steps."""

    def read(self) -> EngineState:
        """Return the state."""

    def close(self) -> None:
        """Give back what the program holds."""


class Adapter(Protocol):
    """How a program follows cases."""

    name: str
    """Its name in tables."""
    package: str | None
    """The package that is installed for it; None for this one. A file of one's own may leave it
    out, and state a `version` instead."""
    module: str | None
    """The module that is imported; None for this one. A file of one's own may leave it out."""
    settings: tuple[Setting, ...]
    """Ways to set it: the first is its defaults."""

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""

    def start(self, case: Case, step: float, setting: Setting) -> EngineRun:
        """Return a case at its launch, with steps of this length, s."""


def settings_of(adapter: Adapter, case: Case) -> list[Setting]:
    """Return the settings at which an adapter's program can state a case."""
    return [one for one in adapter.settings if adapter.refusal(case, one) is None]


def refusals(adapter: Adapter, cases: Iterable[Case]) -> dict[str, str]:
    """Return why an adapter's program can state cases at none of its settings, by their names."""
    reasons = {}
    for case in cases:
        if not settings_of(adapter, case):
            reasons[case.name] = str(adapter.refusal(case, adapter.settings[0]))
    return reasons


def is_installed(adapter: Adapter) -> bool:
    """Return whether an adapter's program is installed."""
    return adapter.module is None or find_spec(adapter.module) is not None


def version_of(adapter: Adapter) -> str:
    """Return the version of an adapter's program."""
    file = getattr(adapter, "file", None)
    if file is not None:
        # Another text of the file is another version: its results are computed again.
        text = hashlib.sha256(Path(file).read_bytes()).hexdigest()[:8]
        stated = getattr(adapter, "version", None) or (
            adapter.package and importlib.metadata.version(adapter.package)
        )
        return f"{stated}, file {text}" if stated else f"file {text}"
    if adapter.package is None:
        return tt.__version__
    return importlib.metadata.version(adapter.package)


def no_film(case: Case) -> str | None:
    """Return why a program without viscous friction cannot state a case."""
    if isinstance(case.problem.friction, tt.ViscousFriction):
        return "no friction in proportion to slip and normal force"
    return None


def no_drilling(case: Case) -> str | None:
    """Return why a program without drilling friction cannot state a case."""
    return (
        "no drilling friction" if isinstance(case.problem.friction, tt.ContensouFriction) else None
    )


def no_rolling(case: Case) -> str | None:
    """Return why a program without rolling friction cannot state a case."""
    return "no dry rolling friction" if case.problem.rolling_resistance else None


def no_rebound(case: Case) -> str | None:
    """Return why a program without a coefficient of restitution cannot state a case."""
    return "rebounds by stiffness and damping only" if case.problem.contact.restitution else None


def axis_of(quaternion: Array) -> Array:
    """Return the body's axis from an orientation, scalar first and of any length."""
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])
