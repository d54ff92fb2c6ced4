"""Section of a turned body along its axis, with its materials and the surfaces that it stands
on.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import tippetop.figures.annotation as mark
import tippetop.figures.drawing as draw
from tippetop.figures.drawing import Array
from tippetop.figures.style import ACCENT, CONVERGED, CYCLE, INK, MUTED, REPORT, WIDTH, house_style
from tippetop.lathe.hull import Zone
from tippetop.lathe.profile import Profile
from tippetop.lathe.workpiece import Workpiece

BODY, WEIGHT, CAVITY = "#E9D8B8", "#9AA5B1", "white"
ZONES = (CONVERGED, REPORT, CYCLE[2], ACCENT, CYCLE[5])
"""Colours of the surfaces, used in turn."""

STEPS = 96
"""Number of points on an arc."""

MM = 1e3
"""Millimetres in a metre."""


@house_style()
def section(workpiece: Workpiece) -> Figure:
    """Draw the section of a turned body, to scale, with its centre of mass and the surfaces it
    stands on.
    """
    points = MM * workpiece.outline.points(STEPS)
    reach, low, high = points.real.max(), points.imag.min(), points.imag.max()
    room = 0.12 * max(reach, (high - low) / 2.0)
    tall = (high - low + 2.0 * room) / (2.0 * reach + 2.0 * room)
    figure, axes = mark.panels(min(8.0, max(2.4, 0.62 * WIDTH * tall)))
    axes.set(xlim=(-reach - room, reach + room), ylim=(low - room, high + room), aspect="equal")
    # The layout reserves room for labels beside the box that equal scales have not yet narrowed.
    axes.set(xlabel="Distance from the axis (mm)", ylabel="Height (mm)", anchor="W")
    axes.set_xticks([tick for tick in axes.get_xticks() if abs(tick) <= reach + room])
    axes.xaxis.set_major_formatter(lambda value, _: f"{abs(value):g}")
    _cut(axes, workpiece.outline, BODY, 1.2)
    for inner, insert in zip(workpiece.insides, workpiece.inserts, strict=True):
        _cut(axes, inner, WEIGHT if insert.density else CAVITY, 0.9)
    draw.line(axes, [(0.0, low - room), (0.0, high + room)], MUTED, 0.8, dashed=True, z=3)
    _zones(axes, workpiece)
    draw.mass_centre(axes, (0.0, MM * workpiece.mass_properties.center), radius=0.35 * room)
    figure.legend(loc="outside right upper")
    return figure


def _cut(axes: Axes, profile: Profile, face: str, width: float) -> None:
    """Fill a profile and its mirror image."""
    points = MM * profile.points(STEPS)
    right = np.stack([points.real, points.imag], axis=-1)
    left = right[::-1] * (-1.0, 1.0)
    for part in [np.concatenate([right, left])] if profile.reaches_axis else [right, left]:
        draw.filled(axes, draw.outline(part), face, INK, width, z=2)


def _zones(axes: Axes, workpiece: Workpiece) -> None:
    """Draw the part of each surface that comes to touch the table, and its full circle thinly."""
    surfaces = list(dict.fromkeys(zone[:3] for zone in workpiece.hull.zones))
    for number, zone in enumerate(workpiece.hull.zones):
        color = ZONES[surfaces.index(zone[:3]) % len(ZONES)]
        tilts = np.linspace(zone.low, zone.high, STEPS)
        text = (
            f"{_described(zone)},\ntilt {np.degrees(zone.low):.4g}° to {np.degrees(zone.high):.4g}°"
        )
        contact = _contact_points(zone, tilts)
        for side in (1.0, -1.0):
            label = text if side > 0 else None
            if zone.tube:
                axes.plot(
                    side * contact[:, 0], contact[:, 1], color=color, lw=3.0, label=label, zorder=4
                )
            else:
                dot: dict[str, Any] = {
                    "marker": "o",
                    "ls": "",
                    "markersize": 6,
                    "markeredgecolor": "white",
                }
                axes.plot(
                    side * contact[:1, 0], contact[:1, 1], color=color, label=label, zorder=5, **dot
                )
        if zone.tube and number == surfaces.index(zone[:3]):
            circle = _contact_points(zone, np.linspace(0.0, 2.0 * np.pi, 4 * STEPS))
            for side in (1.0, -1.0) if zone.radius else (1.0,):
                axes.plot(side * circle[:, 0], circle[:, 1], color=color, lw=0.8, ls=":", zorder=3)


def _contact_points(zone: Zone, tilts: Array) -> Array:
    """Return the points of a surface that touch the table at these tilts, mm, shape (k, 2)."""
    across = zone.radius + zone.tube * np.sin(tilts)
    return np.asarray(MM * np.stack([across, zone.height - zone.tube * np.cos(tilts)], axis=-1))


def _described(zone: Zone) -> str:
    """Return the description of a surface, lengths in millimetres."""
    radius, tube = MM * zone.radius, MM * zone.tube
    match zone.name:
        case "sphere":
            return f"sphere, radius {tube:.4g} mm"
        case "ring":
            return f"ring, radius {radius:.4g} mm,\ntube {tube:.4g} mm"
        case "edge":
            return f"edge, radius {radius:.4g} mm"
    return "tip"
