"""Second methods for motions of the suite that have few variables of their own.

A puck slides and spins on its face: two equations, and friction by a quadrature over the face in
polar coordinates about the instantaneous centre of rotation. A uniform ball drills and rolls: slip,
drilling and rolling speed, of which the axis is a consequence. A disk comes to its end: Newton's
and Euler's equations in the frame that precesses with it, with the tilt as a variable, in a clock
that runs as the root of the tilt. No line is shared with the package.
"""

import math
from typing import NamedTuple

import numpy as np

from independent_solver import UP, advance, compiled, cross, dot, ellipsoidal, hertz

ENDED = 1e-17
"""Part of its value at launch at which a velocity has ended; so much time is left to it."""

SLIPLESS = 1e-12
"""Part of the slip at launch below which a ball that only drills has none."""

# ---- puck

LEVELS = np.arange(-70, 71) * 0.05
"""Arguments of the double-exponential quadrature: its nodes crowd both ends of the interval."""

_BENT = 0.5 * math.pi * np.sinh(LEVELS)
NODES = 1.0 / (1.0 + np.exp(-2.0 * _BENT))
"""Nodes in (0, 1); their distance from 1 is that of the mirror image from 0."""

WEIGHTS = 0.05 * 0.5 * math.pi * np.cosh(LEVELS) * 0.5 / np.cosh(_BENT) ** 2


def disk_friction(slip, drilling, radius):
    """Force against the slip and torque against drilling of a disk, over mu N, both at least 0.

    The disk is a sum of thin sectors about the instantaneous centre, a distance d = v/w from the
    middle: an element at a distance p from the centre moves across p, whatever p. Sectors are
    measured by the angle from the line of centres; integrals over p are polynomials.
    """
    if drilling == 0.0:
        return 1.0, 0.0
    d, area = slip / drilling, math.pi * radius**2
    if d == 0.0:
        return 0.0, 2.0 / 3.0 * radius
    # The middle is at angle 0 and distance d from the centre; p cos(angle) is along that line.
    if d < radius:
        angles = 0.5 * math.pi * NODES
        cosine, weights = np.cos(angles), 0.5 * math.pi * WEIGHTS
        cosine[NODES > 0.5] = np.sin(0.5 * math.pi * NODES[::-1][NODES > 0.5])
        half = np.sqrt((radius - d) * (radius + d) + (d * cosine) ** 2)
        # Both opposite sectors, which reach as far as half + d cos and half - d cos.
        far, near = half + d * cosine, half - d * cosine
        force = 2.0 * weights @ (cosine * (far**2 - near**2)) / 2.0
        moment = 2.0 * weights @ (far**3 + near**3) / 3.0
    else:
        # sin(angle) = (a/d) sin(beta): beta runs over a quarter.
        betas = 0.5 * math.pi * NODES
        cosine, weights = np.cos(betas), 0.5 * math.pi * WEIGHTS
        cosine[NODES > 0.5] = np.sin(0.5 * math.pi * NODES[::-1][NODES > 0.5])
        part = radius / d
        across = np.sqrt((1.0 - part) * (1.0 + part) + (part * cosine) ** 2)
        weights = weights * part * cosine / across
        middle, half = d * across, radius * cosine
        force = 2.0 * weights @ (across * 2.0 * middle * half)
        moment = 2.0 * weights @ (2.0 * half * (3.0 * middle**2 + half**2)) / 3.0
    # The torque about the middle is that about the centre less the force times d.
    return force / area, (moment - d * force) / area


def puck(problem, times):
    """States and events of a disk on its face, under uniform pressure, to its rest."""
    body, launch = problem.body, problem.launch
    mass, radius = body.mass, body.shape[0].radius
    g, mu, height = problem.gravity, problem.friction.mu, -body.shape[0].center
    start = math.hypot(*launch.slip)
    along = np.array([*launch.slip, 0.0]) / start
    turn = math.copysign(1.0, launch.spin)

    # The speeds are exp(y_0) times cosine and sine of y_1: they end together, in a ratio.
    def speeds(y):
        size = math.exp(y[0])
        return size * math.cos(y[1]), size * math.sin(y[1]) / radius

    def rates(_, y):
        force, torque = disk_friction(*speeds(y), radius)
        slip, rim = -mu * g * force, -mu * mass * g * torque / body.I3 * radius
        c, s = math.cos(y[1]), math.sin(y[1])
        return np.array([c * slip + s * rim, c * rim - s * slip, math.exp(y[0])])

    rim = abs(launch.spin) * radius
    first = math.log(math.hypot(start, rim))
    y, rows, events = np.array([first, math.atan2(rim, start), 0.0]), [], []
    while len(rows) < len(times):
        instant = times[len(rows)]
        guards = {
            "sample": lambda _, y, instant=instant: instant - y[2],
            "end": lambda _, y: y[0] - first - math.log(ENDED),
            "inside": lambda _, y: 0.25 * math.pi - y[1],
            "outside": lambda _, y: y[1] - 0.25 * math.pi,
        }
        _, y, hit = advance(rates, y, guards, 1e9, np.ones(3))
        if hit == "end":
            events.append((y[2], "rests", 0))
            rows += [(t, 0, 0, 1, 0, 0, 0, 0, 0, 0, height) for t in times[len(rows) :]]
        elif hit == "sample":
            slip, spin = speeds(y)
            rows.append((instant, 0, 0, 1, 0, 0, turn * spin, *(slip * along), height))
    return rows, events


# ---- ball


def rolling_ball(problem, times):
    """States and events of a ball on a patch, against rolling friction, to its rest.

    Its centre of mass is its middle, so that the normal force is its weight. Variables are the slip
    v, the drilling w and the horizontal angular velocity; Euler's equation in space has the moment
    of friction f per weight, R f x z, its couple, and -e r with the direction r of rolling and the
    arm e of its resistance. Where rolling has ended, resistance holds it, and the ball turns about
    the vertical.
    """
    body, launch, friction = problem.body, problem.launch, problem.friction
    m, I1, I3, radius = body.mass, body.I1, body.I3, body.shape.radius
    g, arm, mu = problem.gravity, problem.rolling_resistance, friction.mu
    patch = friction.patch_radius
    law = hertz(mu, patch)
    if friction.pressure == "ellipsoidal":
        law = ellipsoidal(mu, 3.0 * math.pi / 16.0 * patch)
    s, c = math.sin(launch.tilt), math.cos(launch.tilt)
    n = np.array([s, 0.0, c])
    omega = launch.spin * n - launch.precession * s * np.array([c, 0.0, -s])
    omega[1] += launch.tilt_rate
    first = math.hypot(omega[0], omega[1])
    # slip (2), drilling, logarithm of the rolling speed, its angle, axis (3), time
    angle = math.atan2(omega[1], omega[0])
    y = np.array([*launch.slip, omega[2], math.log(first), angle, *n, 0.0])
    scale = np.array([math.hypot(*launch.slip)] * 2 + [first] + [1.0] * 6)
    rows, events, rolls = [], [], True

    def rolling(y):
        return math.exp(y[3]) if rolls else 0.0

    def motion(y):
        v, w, speed, angle, n = y[:2], y[2], rolling(y), y[4], y[5:8]
        f, t = law(v, w)
        along = np.array([math.cos(angle), math.sin(angle)])
        omega = np.array([*(speed * along), w])
        if rolls:
            momentum = I1 * omega + (I3 - I1) * (n @ omega) * n
            # z x r = (-r_y, r_x); the force at the lowest point has the moment -R z x f.
            moment = radius * np.array([f[1], -f[0]]) - arm * along
            torque = m * g * np.array([*moment, t]) - cross(omega, momentum)
            turning = torque / I1 + (1.0 / I3 - 1.0 / I1) * (n @ torque) * n
        else:
            turning = np.array([0.0, 0.0, m * g * t / (I1 + (I3 - I1) * n[2] ** 2)])
        slipping = g * f + radius * np.array([-turning[1], turning[0]])
        across = turning[1] * along[0] - turning[0] * along[1]
        return slipping, turning[2], turning[:2] @ along, across, cross(omega, n)

    def rates(_, y):
        slipping, drilling, slowing, across, axis = motion(y)
        size = rolling(y) if rolls else math.hypot(*y[:2], patch * y[2])
        turn = (slowing, across) if rolls else (0.0, 0.0)
        return np.array([*size * slipping, size * drilling, *turn, *size * axis, size])

    def state(t, y):
        along = np.array([math.cos(y[4]), math.sin(y[4]), 0.0])
        omega = rolling(y) * along + y[2] * UP
        velocity = np.array([y[0], y[1], 0.0]) - cross(omega, -radius * UP)
        return (t, *y[5:8], *omega, *velocity, radius)

    while len(rows) < len(times):
        instant = times[len(rows)]
        guards = {"sample": lambda _, y, instant=instant: instant - y[8]}
        if rolls:
            guards["end"] = lambda _, y: y[3] - math.log(ENDED * first)
        else:
            # The slip falls far faster than drilling, and then drilling falls evenly.
            guards["end"] = lambda _, y: math.hypot(*y[:2]) / scale[0] - SLIPLESS
        _, y, hit = advance(rates, y, guards, 1e9, scale)
        if hit == "sample":
            rows.append(state(instant, y))
        elif rolls:
            events.append((y[8], "rolling stops", 0))
            rolls = False
        else:
            break
    if len(rows) == len(times):
        return rows, events
    y[:2] = 0.0
    slowing = abs(motion(y)[1])
    end = y[8] + abs(y[2]) / slowing
    axis, begun = y[5:8].copy(), y.copy()
    for t in times[len(rows) :]:
        passed = min(t, end) - begun[8]
        y[2] = begun[2] - math.copysign(slowing * passed, begun[2]) if t < end else 0.0
        angle = begun[2] * passed - math.copysign(0.5 * slowing * passed**2, begun[2])
        c, s = math.cos(angle), math.sin(angle)
        y[5:8] = [c * axis[0] - s * axis[1], s * axis[0] + c * axis[1], axis[2]]
        rows.append(state(t, y))
    if end < times[-1]:
        events.append((end, "stick", 0))
    return rows, events


# ---- disk


FLAT = 1e-24
"""Tilt at which a disk is as good as flat: what is left of its wobble takes some 1e-11 s."""


class Disk(NamedTuple):
    """A disk, of which the edge is b below the middle; gravity, and friction of both kinds."""

    m: float
    I1: float
    I3: float
    radius: float
    b: float
    g: float
    mu: float
    arm: float


@compiled
def leaning_frame(tilt):
    """Vertical and horizontal directions (leaning, and across it) in the frame."""
    s, c = math.sin(tilt), math.cos(tilt)
    return np.array([-s, 0.0, c]), np.array([c, 0.0, s])


@compiled
def leaning_turns(y):
    """Tilt and angular velocity: across the axis it falls as the root of the tilt."""
    root = math.exp(0.5 * y[0])
    return root**2, np.array([root * y[2], root * y[3], y[4]])


@compiled
def ending_rates(disk, y):
    """Rates of the tilt's logarithm, the azimuth, the angular velocity (3), the first two over
    the root of the tilt, the horizontal velocity (2) and the time.
    """
    tilt, w = leaning_turns(y)
    lean, across = y[5], y[6]
    inertia = np.array([disk.I1, disk.I1, disk.I3])
    a = np.array([disk.radius, 0.0, -disk.b])
    up, out = leaning_frame(tilt)
    turn = -w[0] / math.sin(tilt)
    turning = np.array([w[0], w[1], turn * math.cos(tilt)])
    rise = -dot(cross(w, a), up)
    u = lean * out + np.array([0.0, across, 0.0]) + rise * up
    v = u + cross(w, a)
    level = w - dot(w, up) * up
    size = math.sqrt(dot(level, level))
    pull = up - disk.mu * (v - dot(v, up) * up)
    moment = cross(a, pull) - disk.arm * level / size
    # m u' = N pull - m g z, I w' = N moment - turning x I w, and the point of the body that is
    # lowest does not move up: z.(u' + w' x a + w x a') = 0 in space, where a turns too.
    free = -cross(turning, inertia * w) / inertia
    answer = moment / inertia
    along = pull / disk.m
    bias = cross(w, cross(turning, a)) + cross(cross(turning, w), a)
    own = -disk.g + dot(cross(free, a) + bias, up)
    normal = -own / dot(along + cross(answer, a), up)
    w1 = free + normal * answer
    u1 = normal * along
    lean1 = dot(u1, out) + turn * across
    across1 = u1[1] - turn * lean
    root = math.sqrt(tilt)
    tilting = w1[:2] - 0.5 * y[3] * y[2:4]
    rates = np.array(
        [y[3], root * turn, 0.0, 0.0, w1[2] * root, root * lean1, root * across1, root]
    )
    rates[2:4] = tilting
    return rates


def ending_disk(problem, times):
    """States and events of a disk with a sharp edge on viscous friction, to its end and beyond.

    The frame has 3 along the axis, 1 down the steepest line of the disk's plane to its lowest
    point, and 2 horizontal; the lowest point is at (R, 0, -b). It turns with the precession, which
    has no bound as the disk comes down.
    """
    body, launch = problem.body, problem.launch
    m, I1, I3 = body.mass, body.I1, body.I3
    radius, b = body.shape[0].radius, -body.shape[0].center
    g, mu, arm = problem.gravity, problem.friction.mu, problem.rolling_resistance
    a = np.array([radius, 0.0, -b])
    disk = Disk(m, I1, I3, radius, b, g, mu, arm)

    def rates(_, y):
        return ending_rates(disk, y)

    w = np.array([-launch.precession * math.sin(launch.tilt), launch.tilt_rate, launch.spin])
    _, out = leaning_frame(launch.tilt)
    u = -cross(w, a)
    u = np.array([u @ out + launch.slip[0], u[1] + launch.slip[1]])
    root = math.sqrt(launch.tilt)
    y = np.array([2.0 * math.log(root), 0.0, *(w[:2] / root), w[2], u[0], u[1], 0.0])
    scale = np.array([1.0, 1.0, *[np.linalg.norm(w)] * 3, 0.1, 0.1, 1.0])
    rows, down = [], None

    def state(t, y):
        tilt, w = leaning_turns(y)
        up, _ = leaning_frame(tilt)
        s, c = math.sin(tilt), math.cos(tilt)
        x, e = math.cos(y[1]), math.sin(y[1])
        one, two = np.array([c * x, c * e, -s]), np.array([-e, x, 0.0])
        three = np.array([s * x, s * e, c])
        omega = w[0] * one + w[1] * two + w[2] * three
        out = np.array([x, e, 0.0])
        rise = -cross(w, a) @ up
        velocity = y[5] * out + y[6] * two + rise * UP
        return (t, *three, *omega, *velocity, radius * s + b * c)

    while len(rows) < len(times):
        instant = times[len(rows)]
        guards = {
            "sample": lambda _, y, instant=instant: instant - y[7],
            "flat": lambda _, y: y[0] - math.log(FLAT),
        }
        _, y, hit = advance(rates, y, guards, 1e9, scale)
        if hit == "flat":
            # The tilt falls as the square of the time left.
            down = y[7] + 2.0 * math.exp(0.5 * y[0]) / abs(y[3])
            break
        rows.append(state(instant, y))
    if down is None:
        return rows, []
    _, _, _, _, spin, lean, across, _ = y
    x, e = math.cos(y[1]), math.sin(y[1])
    velocity = np.array([lean * x - across * e, lean * e + across * x, 0.0])
    for t in times[len(rows) :]:
        slides = math.exp(-mu * g * (t - down))
        spins = math.exp(-mu * m * g * radius**2 / (2.0 * I3) * (t - down))
        rows.append((t, 0, 0, 1, 0, 0, spin * spins, *(slides * velocity), b))
    return rows, [(down, "lies down", 0)]
