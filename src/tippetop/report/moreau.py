"""Moreau's time-stepping for a top of several spheres, as Leine and Glocker (2003) computed theirs.

A step of fixed length moves the top freely for its first half, applies all impulses of contact, and
moves the top freely for its second half (Moreau 1988). A contact acts if its gap is closed at the
middle of the step: plastically, with friction of a patch that has an ellipsoidal limit surface.
Events are known to within a step; what happens between two steps is lost.

The module shares no equations with the package, so that it is an independent check.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from tippetop.mechanics.vectors import VERTICAL, add, cross, dot, scale

Triple = tuple[float, float, float]

CLOSE = 1e-9
"""Relative change of the impulses in one iteration at which they count as converged."""

ROUNDS = 300
"""Largest number of iterations."""


class Ball(NamedTuple):
    """Sphere of the top: its radius, and the height of its centre above the centre of mass, m."""

    radius: float
    center: float


class SphereTop(NamedTuple):
    """Top of several spheres, SI units; `patch` is the semi-axis of the limit surface, m."""

    mass: float
    I1: float
    I3: float
    balls: Sequence[Ball]
    mu: float
    patch: float
    gravity: float


class History(NamedTuple):
    """Results at every step: the tilt, rad, and which spheres received an impulse."""

    step: float
    tilts: list[float]
    touching: list[tuple[bool, ...]]


def follow(body: SphereTop, tilt: float, spin: float, duration: float, step: float) -> History:
    """Return the motion of a top that is set down at this tilt (rad) and spin (rad/s).

    Its centre of mass is at rest at launch. `duration` and `step` are in s.
    """
    axis = (math.sin(tilt), 0.0, math.cos(tilt))
    momentum = scale(body.I3 * spin, axis)
    height = max(ball.radius - ball.center * axis[2] for ball in body.balls)
    velocity = (0.0, 0.0, 0.0)
    impulses: list[list[float]] = [[0.0] * 4 for _ in body.balls]
    tilts, touching = [], []
    for _ in range(round(duration / step)):
        axis, height = (
            _turned(axis, momentum, 0.5 * step / body.I1),
            height + 0.5 * step * velocity[2],
        )
        velocity = (velocity[0], velocity[1], velocity[2] - step * body.gravity)
        arms = [
            add(scale(b.center, axis), (0.0, 0.0, -b.radius))
            if height + b.center * axis[2] <= b.radius
            else None
            for b in body.balls
        ]
        if any(arms):
            velocity, momentum = _impulses(body, axis, velocity, momentum, arms, impulses)
        axis, height = (
            _turned(axis, momentum, 0.5 * step / body.I1),
            height + 0.5 * step * velocity[2],
        )
        tilts.append(math.acos(max(-1.0, min(1.0, axis[2]))))
        touching.append(
            tuple(
                arm is not None and impulse[3] > 0.0
                for arm, impulse in zip(arms, impulses, strict=True)
            )
        )
    return History(step, tilts, touching)


def _impulses(
    body: SphereTop,
    axis: Triple,
    velocity: Triple,
    momentum: Triple,
    arms: Sequence[Triple | None],
    impulses: list[list[float]],
) -> tuple[Triple, Triple]:
    """Return velocity and angular momentum after the impulses of all contacts.

    The impulses are iterated over the contacts, starting from those of the step before, which
    `impulses` has and which are replaced in it. Each contact has four: along x, along y, about z
    over the patch radius, and upwards.
    """
    across, along = 1.0 / body.I1, 1.0 / body.I3 - 1.0 / body.I1
    patch, mass = body.patch, body.mass
    u, L = velocity, momentum
    contacts = []
    for number, arm in enumerate(arms):
        if arm is None:
            impulses[number] = [0.0] * 4
            continue
        turns = [
            cross(arm, (1.0, 0.0, 0.0)),
            cross(arm, (0.0, 1.0, 0.0)),
            (0.0, 0.0, patch),
            cross(arm, VERTICAL),
        ]
        masses = [
            across * dot(t, t) + along * dot(t, axis) ** 2 + (1.0 / mass if k != 2 else 0.0)
            for k, t in enumerate(turns)
        ]
        contacts.append((number, turns, masses[3], 0.5 / max(masses[:3])))
        u, L = _with_impulse(u, L, mass, turns, impulses[number])
    for _ in range(ROUNDS):
        worst = 0.0
        for number, turns, resisted, weight in contacts:
            old = impulses[number]
            w = add(scale(across, L), scale(along * dot(L, axis), axis))
            up = max(0.0, old[3] - (u[2] + dot(turns[3], w)) / resisted)
            slid = [
                old[0] - weight * (u[0] + dot(turns[0], w)),
                old[1] - weight * (u[1] + dot(turns[1], w)),
                old[2] - weight * patch * w[2],
            ]
            size, limit = math.sqrt(slid[0] ** 2 + slid[1] ** 2 + slid[2] ** 2), body.mu * up
            share = limit / size if size > limit else 1.0
            new = [share * slid[0], share * slid[1], share * slid[2], up]
            change = (new[0] - old[0], new[1] - old[1], new[2] - old[2], new[3] - old[3])
            u, L = _with_impulse(u, L, mass, turns, change)
            impulses[number] = new
            worst = max(worst, max(map(abs, change)) - CLOSE * up)
        if worst <= 0.0:
            break
    return u, L


def _with_impulse(
    u: Triple, L: Triple, mass: float, turns: Sequence[Triple], impulse: Sequence[float]
) -> tuple[Triple, Triple]:
    """Return velocity and angular momentum after an impulse in the four directions of a contact."""
    fx, fy, drill, up = impulse
    a, b, c, d = turns
    turned = (
        L[0] + fx * a[0] + fy * b[0] + drill * c[0] + up * d[0],
        L[1] + fx * a[1] + fy * b[1] + drill * c[1] + up * d[1],
        L[2] + fx * a[2] + fy * b[2] + drill * c[2] + up * d[2],
    )
    return (u[0] + fx / mass, u[1] + fy / mass, u[2] + up / mass), turned


def _turned(axis: Triple, momentum: Triple, time: float) -> Triple:
    """Return the axis of a free top after a time over I1: it turns evenly about the angular
    momentum.
    """
    size = math.sqrt(dot(momentum, momentum))
    if size == 0.0:
        return axis
    about = scale(1.0 / size, momentum)
    angle = size * time
    c, s, on = math.cos(angle), math.sin(angle), dot(about, axis)
    turned = add(add(scale(c, axis), scale(s, cross(about, axis))), scale((1.0 - c) * on, about))
    return scale(1.0 / math.sqrt(dot(turned, turned)), turned)
