"""Headings of columns as people write them: names and units in English and German."""

import re
from typing import NamedTuple

from tippetop.support.units import named_unit

NAMES = {
    **dict.fromkeys(("t", "time", "zeit", "temps", "seconds", "sekunden"), "t"),
    **dict.fromkeys(
        ("theta", "tilt", "θ", "inclination", "neigung", "neigungswinkel", "kippwinkel", "winkel"),
        "tilt",
    ),
    **dict.fromkeys(
        (
            "rpm",
            "u/min",
            "1/min",
            "min-1",
            "upm",
            "revolutions per minute",
            "f",
            "freq",
            "frequency",
            "frequenz",
            "drehfrequenz",
            "n",
            "drehzahl",
        ),
        "rpm",
    ),
    **dict.fromkeys(("spin", "omega", "omega3", "ω3", "ω", "w", "winkelgeschwindigkeit"), "spin"),
    **dict.fromkeys(("event", "ereignis", "what", "was"), "event"),
    **dict.fromkeys(("frame", "step", "bild", "bildnummer"), "frame"),
    **dict.fromkeys(("height", "höhe", "hoehe"), "height"),
    **dict.fromkeys(("theta_dot", "θ'"), "tilt_rate"),
    **dict.fromkeys(("phi_dot", "φ'", "präzession", "praezession", "wobble"), "precession"),
}
"""Names of columns, in lower case, and what they are called here."""

UNITS = {
    **dict.fromkeys(("grad", "°", "degree", "degrees"), "deg"),
    **dict.fromkeys(("hz", "u/s"), "rev/s"),
    **dict.fromkeys(("1/min", "u/min", "min-1", "min^-1", "min⁻¹", "upm", "r/min"), "rpm"),
    **dict.fromkeys(("sek", "sekunden", "sec", "seconds"), "s"),
    **dict.fromkeys(("minuten", "minutes"), "min"),
    **dict.fromkeys(("px", "pixel", "pixels"), "px"),
}
"""Units as pint writes them, by other names, in lower case. "Grad" is degrees, as in German, and a
hertz a turn a second; angles in gon are written "gon"."""

EVENTS = {
    **dict.fromkeys(
        (
            "turns over",
            "turned over",
            "dreht sich um",
            "dreht um",
            "kippt um 90°",
            "ist umgedreht",
        ),
        "turnover_time",
    ),
    **dict.fromkeys(
        (
            "stands on its stem",
            "stands",
            "stands up",
            "steht auf dem stift",
            "steht auf dem stiel",
            "steht",
        ),
        "arrival_time",
    ),
    **dict.fromkeys(("lifts off", "hebt ab"), "liftoff_time"),
    **dict.fromkeys(("sticks", "haftet"), "stick"),
    **dict.fromkeys(("slips", "gleitet", "rutscht"), "slip"),
    **dict.fromkeys(("touches", "setzt auf"), "touchdown"),
    **dict.fromkeys(("hits", "strikes", "stößt auf", "schlägt auf"), "impact"),
}
"""Words for events, in lower case."""

BRACKETED = re.compile(
    r"(?P<name>[^(\[/]*?)\s*(?:[(\[](?P<unit>[^)\]]*)[)\]]|/\s*(?P<slash>\S+)|\s+in\s+(?P<word>\S+))?"
)
"""A column's name, and its unit as in "t (s)", "t [s]", "t / s" or "t in s"."""


class Heading(NamedTuple):
    """A column's name and unit."""

    name: str
    """In lower case, one of the values of `NAMES` where it is known."""
    unit: str
    """As pint writes it; empty if none is stated."""


def heading_of(text: str) -> Heading:
    """Return what the heading of a column says."""
    written = text.strip().lower()
    if written in NAMES:
        return Heading(NAMES[written], "")
    match = BRACKETED.fullmatch(text.strip())
    if match is None:
        return Heading(written, "")
    name = match["name"].strip().lower()
    unit = plain_unit(match["unit"] or match["slash"] or match["word"] or "")
    head, _, tail = name.rpartition("_")
    if not unit and (head in NAMES or head in ("x", "y")) and _is_unit(tail):
        name, unit = head, plain_unit(tail)
    return Heading(NAMES.get(name, name), unit)


def plain_unit(text: str) -> str:
    """Return a unit as pint writes it."""
    return UNITS.get(text.strip().lower(), text.strip())


def event_of(text: str) -> str:
    """Return the name of an event from a word for it; other texts unchanged."""
    written = " ".join(text.strip().split())
    return EVENTS.get(written.lower(), written)


def _is_unit(text: str) -> bool:
    return text.lower() in UNITS or named_unit(text) is not None
