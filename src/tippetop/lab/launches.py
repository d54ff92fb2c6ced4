"""Launches to start from: the report's, and those of other tops."""

from collections.abc import Mapping
from typing import Any

from tippetop.bodies import EccentricSphere
from tippetop.lab.setup import Setup, first_setup
from tippetop.presets import BODIES, leine_glocker_problem

REPORT_LAUNCHES: Mapping[str, Mapping[str, Any]] = {
    "Report, Fig. 4: turns over completely (155 rad/s)": {},
    "Report, Fig. 5: turns half-way (50 rad/s)": {"launch.spin": 50.0},
    "Report, section 3.2: too slow to turn over (20 rad/s)": {"launch.spin": 20.0},
    "Report, Fig. 9: leaves the table (175 rad/s)": {"launch.spin": 175.0},
    "Report, Fig. 12: stopped before it flies (175 rad/s)": {
        "launch.spin": 175.0,
        "contact.liftoff": "stop",
    },
    "Report, Fig. 8: a table that holds (μ = 100 s/m)": {"friction.mu": 100.0},
}
"""The report's launches, as changes to the first of them."""


def launches() -> dict[str, Setup]:
    """Every launch to start from, by its name: the report's, the literature's, and those of other bodies."""
    first = first_setup()
    found = {name: first.changed(changes) for name, changes in REPORT_LAUNCHES.items()}
    found["Leine and Glocker 2003: dry friction (180 rad/s)"] = Setup(leine_glocker_problem())
    known = {setup.problem.body for setup in found.values()}
    for name, body in BODIES.items():
        if body not in known and isinstance(body.shape, EccentricSphere):
            found[f"Top: {name.replace('-', ' ')}"] = Setup(first.problem.model_copy(update={"body": body}))
    return found
