"""The launch controls: what can be set, between which bounds, and how it stands in a problem."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from nicegui import events, ui

from tippetop.figures.looks import size
from tippetop.frictions import Friction
from tippetop.lab.setup import Setup

Change = Callable[[dict[str, Any], bool], None]
"""Is told what to change, and whether the browser has asked for the new run already."""

_LAW_NAMES = {
    "viscous": "viscous, −μNv",
    "regularized_coulomb": "Coulomb, smoothed",
    "coulomb": "Coulomb, dry",
    "contensou": "Contensou, dry patch",
}
LAWS = {word: _LAW_NAMES.get(word, word.replace("_", " ")) for word in Friction.kinds}
"""The friction laws by the word that tells them apart in a problem, with names to read."""

PATCH = 1e-4
"""Radius of the contact patch of a law that is chosen, m: about that of a plastic top on a hard table."""


class Dial(NamedTuple):
    """A number to set by a slider or by typing.

    Attributes
    ----------
    field
        The field of the launch that it sets, named with dots; hidden where there is none.
    label, unit
        What it is. Inertias are in units of mass times size squared.
    low, high, step
        Bounds and step of the slider; a number beyond them can be typed.
    logarithmic
        Whether the slider goes by powers of ten.
    """

    field: str
    label: str
    unit: str
    low: float
    high: float
    step: float
    logarithmic: bool = False

    @property
    def plain(self) -> bool:
        """Whether the field is set to the dial's own number: the browser then asks for the run by itself."""
        return self.unit != "mR²"

    def read(self, setup: Setup) -> float | None:
        """Its value in a launch; None where it has no meaning."""
        value: Any = setup if self.field == "duration" else setup.problem
        for part in self.field.split("."):
            value = getattr(value, part, None)
        return None if value is None else float(value) / self._scale(setup)

    def write(self, setup: Setup, value: float) -> dict[str, float]:
        """The change of a launch that sets it."""
        return {self.field: value * self._scale(setup)}

    def _scale(self, setup: Setup) -> float:
        body = setup.problem.body
        return 1.0 if self.plain else body.mass * size(body) ** 2


SPIN = Dial("launch.spin", "Spin ω₃", "rad/s", 0.0, 250.0, 0.5)
MU = Dial("friction.mu", "Friction μ", "", 0.01, 10.0, 0.01, logarithmic=True)
TILT = Dial("launch.tilt", "Tilt θ", "rad", 0.0, math.pi, 0.01)
SMOOTHED = Dial("friction.eps", "Smoothed below a slip of", "m/s", 1e-5, 0.1, 0.01, logarithmic=True)
TABLE = (
    Dial("contact.restitution", "Restitution", "", 0.0, 1.0, 0.01),
    Dial("gravity", "Gravity", "m/s²", 0.1, 25.0, 0.1),
    Dial("rolling_resistance", "Rolling resistance", "m", 0.0, 1e-3, 1e-5),
    Dial("duration", "Duration", "s", 1.0, 60.0, 1.0),
)
TOP = (
    Dial("body.shape.eccentricity", "Eccentricity α", "", 0.02, 0.6, 0.01),
    Dial("body.I1", "Inertia I₁", "mR²", 0.2, 0.7, 0.005),
    Dial("body.I3", "Inertia I₃", "mR²", 0.2, 0.7, 0.005),
    Dial("body.mass", "Mass m", "kg", 0.002, 0.5, 0.001, logarithmic=True),
)
START = (
    Dial("launch.tilt_rate", "Tilt rate θ′", "rad/s", -50.0, 50.0, 0.5),
    Dial("launch.precession", "Precession φ′", "rad/s", -100.0, 100.0, 0.5),
    Dial("launch.gap", "Gap below", "m", 0.0, 0.1, 0.001),
)


class _Slider(ui.slider):
    """A slider that goes where it is moved without waiting for an answer."""

    LOOPBACK = False


def _moved(dial: Dial) -> str:
    """What the browser does when a slider moves: move it, and ask for the new run."""
    value = "Number((10 ** at).toPrecision(3))" if dial.logarithmic else "at"
    asked = f"tippetopLab.tune({dial.field!r}, {value});" if dial.plain else ""
    return f'(at) => {{ element.props["model-value"] = at; {asked} }}'


class DialRow:
    """A dial on the page: its name, a slider and a number, kept in step."""

    def __init__(self, dial: Dial, current: Callable[[], Setup], change: Change) -> None:
        self._dial, self._current, self._change = dial, current, change
        self._quiet = False
        self._marked: dict[str, float] = {}
        name = dial.label + (f" ({dial.unit})" if dial.unit else "")
        with ui.element("div").classes("lab-dial") as self.row:
            ui.label(name).classes("lab-dial-name").props('aria-hidden="true"')
            self.number = ui.number(on_change=None, format="%.6g").props(
                f'dense outlined hide-bottom-space aria-label="{name}" step="any"'
            )
            self.number.on("change", self._typed)
            low, high = self._place(dial.low), self._place(dial.high)
            step = 0.01 if dial.logarithmic else dial.step
            with ui.element("div").classes("lab-dial-slider"):
                self.slider = _Slider(min=low, max=high, step=step, on_change=self._slid)
                self.slider.props(f'aria-label="{name}" dense').mark(dial.label)
                if dial.logarithmic:
                    self.slider.props(f'data-powers data-unit="{dial.unit}"')
                self.slider.on("update:model-value", js_handler=_moved(dial))
                self.marks = ui.element("div").classes("lab-dial-marks")

    def show(self, setup: Setup) -> None:
        """Show the dial's value in a setup."""
        value = self._dial.read(setup)
        self.row.set_visibility(value is not None)
        if value is None:
            return
        self._quiet = True
        self.number.value = float(f"{value:.6g}")
        bounded = min(max(value, self._dial.low), self._dial.high)
        # Not where it stands for that already: it may be on its way, and would lose steps.
        if self.slider.value is None or not math.isclose(self._value(self.slider.value), bounded):
            self.slider.value = self._place(bounded)
        self._quiet = False

    def mark(self, marks: dict[str, float]) -> None:
        """Mark values on the slider, by their names."""
        if marks == self._marked:
            return
        self._marked = marks
        self.marks.clear()
        span = self._place(self._dial.high) - self._place(self._dial.low)
        with self.marks:
            for name, value in marks.items():
                if self._dial.low < value < self._dial.high:
                    share = (self._place(value) - self._place(self._dial.low)) / span
                    ui.label(f"{name} {value:.1f}").style(f"left: {100 * share:.2f}%")

    def _place(self, value: float) -> float:
        return math.log10(value) if self._dial.logarithmic else value

    def _value(self, place: float) -> float:
        """What a place of the slider stands for, as the browser rounds it too."""
        return float(f"{10**place:.3g}") if self._dial.logarithmic else float(place)

    def _slid(self, event: events.ValueChangeEventArguments[float | None]) -> None:
        if self._quiet or event.value is None:
            return
        value = self._value(event.value)
        self._quiet = True
        self.number.value = float(f"{value:.6g}")
        self._quiet = False
        self._change(self._dial.write(self._current(), value), self._dial.plain)

    def _typed(self) -> None:
        if self.number.value is None:
            self.show(self._current())
        else:
            self._change(self._dial.write(self._current(), float(self.number.value)), False)
