"""Warnings of implausible problems: the category and its sentences."""

import sys
import warnings

from tippetop.problem.plausibility import Doubt, doubts
from tippetop.problem.problem import Problem

# translate: skip
SENTENCES = {
    "moment": (
        "{name} = {value} is above m r^2 = {bound}, r = {radius}:"
        " no distribution of the mass inside the surface has so large a moment"
    ),
    "core": "{name} = {value} is less than a thousandth of m r^2 = {bound}, r = {radius}",
    "centre": "the centre of mass is {distance} outside the surface",
    "mass": "the mass is {value}; most tops have 0.1 g to 5 kg",
    "size": "the body is {across} across and {height} high; most tops have 1 mm to 0.5 m",
    "patch": (
        "the contact patch has a radius of {patch}, more than half of the body's, {radius}:"
        " friction is that of a small patch"
    ),
    "tilt": "the tilt at launch is {value}, above pi/2: the axis points down",
    "spin": "the spin at launch is {value}, beyond 10000 rad/s",
    "precession": (
        "a precession of {value} at launch does nothing, as the axis is vertical: the spin is all"
        " of the rotation about it"
    ),
    "heavy": "the centre of mass is {height} above the ball's centre: it does not turn over",
    "light": "a mass of {value} in a volume of {volume} floats on air",
}
"""Sentence of each kind of doubt, with its numbers in braces."""


# translate: skip
class Implausible(UserWarning):
    """Warning of a problem whose numbers no real top has, perhaps because of a wrong unit.

    Examples
    --------
    >>> import tippetop as tt, warnings
    >>> heavy = tt.presets.report_problem().replace({"body.mass": 20.0})
    >>> with warnings.catch_warnings(record=True, action="always") as caught:
    ...     run = tt.simulate(heavy, duration=0.1)
    >>> print(caught[-1].message)
    the mass is 20 kg; most tops have 0.1 g to 5 kg
    >>> warnings.filterwarnings("ignore", category=tt.Implausible)  # no such warnings any more
    """


# translate: skip
def sentence(doubt: Doubt) -> str:
    """Return the sentence of a doubt."""
    return SENTENCES[doubt.kind].format(**dict(doubt.gaps))


# translate: drop
def warn_if_implausible(problem: Problem) -> None:
    """Warn of everything that is implausible about a problem."""
    for doubt in doubts(problem):
        warn(sentence(doubt))


# translate: skip
def warn(text: str, category: type[Warning] = Implausible) -> None:
    """Warn, at the line outside this package that called it."""
    frame, level = sys._getframe(1), 2
    while frame.f_back and frame.f_globals.get("__name__", "").startswith(CALLERS):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, category, stacklevel=level)


# translate: skip
CALLERS = ("tippetop.", "numpy.")
"""Beginnings of the names of modules at whose lines no warning is shown: numpy calls ours."""
