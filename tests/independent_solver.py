"""A second solver of every case of the reference suite that shares no line with the package.

Newton's and Euler's equations stand in the frame of the table, with the angular velocity and the
full inertia; contact forces are multipliers of the constraints on accelerations, one small linear
system an evaluation. SciPy's DOP853 takes the steps, and an event is located by integrating up to
it again until it is hit. Slip near its end runs in a clock of its own, dt = s dtau with the slip
speed s. Slip that hardly grows, as where it begins, turns quickly into its direction, a stiff
problem: it is collocated at Radau's nodes. Impacts are integrated over the normal impulse.

Where Numba is installed, it compiles the functions of numbers; without it they run as they stand.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import DOP853, solve_ivp
from scipy.optimize import brentq

try:
    from numba import njit
except ImportError:

    def compiled(function):
        return function
else:
    compiled = njit(cache=True)


UP = np.array([0.0, 0.0, 1.0])
RTOL = 1e-13
SLOW = 1e-4
"""Slip speed below which slip of dry friction runs in its own clock, m/s."""

STOPPED = 1e-18
"""Slip speed that is none, m/s."""

STIFF = 0.05
"""Growth of slip over friction's acceleration below which the slip's direction is stiff."""

CREEPS, NODES = 1e-4, 5
"""Longest step in which the slip's direction is stiff, s, and the nodes of its polynomials: the
error of 9th order is that of a top's turn by 0.02 rad, 1e-17.
"""

ITERATIONS = 40
"""Iterations that such a step may take."""


@compiled
def cross(a, b):
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


@compiled
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def on(guard, dense):
    """A guard as a function of x alone on a dense solution."""
    return lambda x: guard(x, dense(x))


# Surfaces: rows (kind, radius, half length along the axis, center).

SPHERE, RING, SPHEROID = 0.0, 1.0, 2.0


@compiled
def support(surface, c):
    """Support function (h, h', h'') of a surface at the cosine of the tilt."""
    kind, radius, along, center = surface[0], surface[1], surface[2], surface[3]
    if kind == SPHERE:
        return radius - center * c, -center, 0.0
    if kind == RING:
        s = math.sqrt(1.0 - c * c)
        return radius * s - center * c, -radius * c / s - center, -radius / s**3
    d = along**2 - radius**2
    q = math.sqrt(radius**2 + d * c * c)
    return q - center * c, d * c / q - center, d * radius**2 / q**3


@compiled
def contact_arm(surface, n):
    """Vector from the centre of mass to the lowest point of a surface."""
    h, slope, _ = support(surface, n[2])
    return -slope * (n - n[2] * UP) - h * UP


# Laws: force and drilling torque per unit normal force, of slip v (2) and drilling w.

VISCOUS, ELLIPSOIDAL, HERTZ = 0, 1, 2


class Law(NamedTuple):
    """A law of friction; as a function, the force and the torque per unit normal force."""

    kind: int
    mu: float
    arm: float = 0.0

    def __call__(self, v, w):
        column = friction(self, v, w)
        return column[:2], column[2]


def viscous(mu):
    return Law(VISCOUS, mu)


def ellipsoidal(mu, rho):
    return Law(ELLIPSOIDAL, mu, rho)


def hertz(mu, radius):
    return Law(HERTZ, mu, radius)


@compiled
def friction(law, v, w):
    """Column of a law: force (2) and drilling torque per unit normal force."""
    mu, arm = law.mu, law.arm
    if law.kind == VISCOUS:
        return np.array([-mu * v[0], -mu * v[1], 0.0])
    if law.kind == ELLIPSOIDAL:
        size = math.sqrt(v[0] ** 2 + v[1] ** 2 + (arm * w) ** 2)
        return np.array([-mu * v[0] / size, -mu * v[1] / size, -mu * arm**2 * w / size])
    speed, turn = math.hypot(v[0], v[1]), abs(w) * arm
    k = speed / turn
    if k <= 1.0:
        force = 3.0 * math.pi / 32.0 * k * (4.0 - k * k)
        torque = 3.0 * math.pi / 16.0 * (1.0 - k * k + 3.0 / 8.0 * k**4)
    else:
        sig, q = math.asin(1.0 / k), math.sqrt(k * k - 1.0)
        force = 3.0 / 16.0 * (k * (4.0 - k * k) * sig + q * (k * k + 2.0) / k)
        torque = 3.0 / 8.0 * ((1.0 - k * k + 3.0 / 8.0 * k**4) * sig) + 3.0 / 8.0 * q * (
            3.0 / 4.0 - 3.0 / 8.0 * k * k
        )
    part = -mu * force / speed if speed > 0.0 else 0.0
    return np.array([part * v[0], part * v[1], -mu * arm * torque * math.copysign(1.0, w)])


def branch(law, v, w):
    """Changes sign where the law of Hertz changes its branch."""
    return math.hypot(v[0], v[1]) - abs(w) * law.arm


# Dynamics.


class Solid(NamedTuple):
    """Mass and moments of inertia, gravity, and the arm of rolling resistance."""

    mass: float
    I1: float
    I3: float
    field: np.ndarray
    arm: float


@compiled
def turning(solid, n, torque):
    """Angular acceleration by a torque: the inverse of the inertia times the torque."""
    return torque / solid.I1 + (1.0 / solid.I3 - 1.0 / solid.I1) * dot(n, torque) * n


@compiled
def accelerations(solid, surfaces, columns, n, w):
    """Accelerations, multipliers, and accelerations of the contact points along the table.

    `surfaces` touch the table. Each has a column, (force (2), drilling torque) per unit normal
    force; or there are no columns, and the only surface sticks. Multipliers are the normal forces,
    or the normal force and the tangential ones where it sticks.
    """
    touching, sticks = len(surfaces), len(columns) == 0
    turned = cross(w, n)
    momentum = solid.I1 * w + (solid.I3 - solid.I1) * dot(n, w) * n
    free = turning(solid, n, -cross(w, momentum))
    resisted = np.zeros(3)
    if solid.arm > 0.0:
        rolling = math.hypot(w[0], w[1])
        resisted = -solid.arm / rolling * np.array([w[0], w[1], 0.0])
    # A unit of each multiplier gives `linear` and `angular` accelerations; each constraint is that
    # the acceleration of a point with an arm along an axis is a bias.
    size = 3 if sticks else touching
    linear, angular = np.zeros((size, 3)), np.zeros((size, 3))
    arms, axes, bias = np.zeros((size, 3)), np.zeros((size, 3)), np.zeros(size)
    centripetal = np.zeros((touching, 3))
    for k in range(touching):
        h, slope, curvature = support(surfaces[k], n[2])
        level = n - n[2] * UP
        arms[k] = -slope * level - h * UP
        centripetal[k] = cross(w, -curvature * turned[2] * level - slope * turned)
        force, drilling = UP.copy(), 0.0
        if not sticks:
            force[0], force[1], drilling = columns[k][0], columns[k][1], columns[k][2]
        torque = cross(arms[k], force) + resisted + drilling * UP
        linear[k], angular[k] = force / solid.mass, turning(solid, n, torque)
        axes[k] = UP
        bias[k] = slope * cross(w, turned)[2] + curvature * turned[2] ** 2
    if sticks:
        for k in (1, 2):
            axes[k][k - 1] = 1.0
            arms[k] = arms[0]
            linear[k] = axes[k] / solid.mass
            angular[k] = turning(solid, n, cross(arms[0], axes[k]))
            bias[k] = -centripetal[0][k - 1]
    matrix = np.zeros((size, size))
    for i in range(size):
        bias[i] -= dot(axes[i], solid.field + cross(free, arms[i]))
        for j in range(size):
            matrix[i, j] = dot(axes[i], linear[j] + cross(angular[j], arms[i]))
    multipliers = np.linalg.solve(matrix, bias)
    u1, w1 = solid.field.copy(), free
    for j in range(size):
        u1 = u1 + multipliers[j] * linear[j]
        w1 = w1 + multipliers[j] * angular[j]
    points = np.zeros((touching, 2))
    for k in range(touching):
        points[k] = (u1 + cross(w1, arms[k]) + centripetal[k])[:2]
    return u1, w1, multipliers, points


NO_COLUMNS = np.zeros((0, 3))


@compiled
def law_columns(surfaces, law, n, w, u):
    """Columns of the surfaces that touch the table, by a smooth law."""
    columns = np.zeros((len(surfaces), 3))
    for k in range(len(surfaces)):
        v = u + cross(w, contact_arm(surfaces[k], n))
        columns[k] = friction(law, v, w[2])
    return columns


@compiled
def state_rates(y, u1, w1):
    """Rates of (axis, angular velocity, velocity, height)."""
    rates = np.zeros(10)
    rates[:3] = cross(y[3:6], y[:3])
    rates[3:6] = w1
    rates[6:9] = u1
    rates[9] = y[8]
    return rates


@compiled
def sliding(solid, surfaces, law, y):
    """Rates of the state and the normal forces, of slip with smooth friction."""
    n, w = y[:3], y[3:6]
    columns = law_columns(surfaces, law, n, w, y[6:9])
    u1, w1, normals, _ = accelerations(solid, surfaces, columns, n, w)
    return state_rates(y, u1, w1), normals


@compiled
def rolling(solid, surfaces, y):
    """Rates of the state, and the normal force and the tangential ones that hold the contact."""
    u1, w1, forces, _ = accelerations(solid, surfaces, NO_COLUMNS, y[:3], y[3:6])
    return state_rates(y, u1, w1), forces


@compiled
def skidding(solid, surfaces, mu, n, w, phi):
    """w', the normal force, and the rates of slip with dry friction along and across it."""
    x, y = math.cos(phi), math.sin(phi)
    columns = np.array([[-mu * x, -mu * y, 0.0]])
    _, w1, normals, points = accelerations(solid, surfaces, columns, n, w)
    along = points[0][0] * x + points[0][1] * y
    across = points[0][1] * x - points[0][0] * y
    return w1, normals[0], along, across


@compiled
def creeping(solid, surfaces, mu, rows):
    """Rates of (axis, angular velocity, slip speed), and the slip's across, of several states."""
    rates, across = np.zeros((len(rows), 7)), np.zeros(len(rows))
    for k in range(len(rows)):
        n, w = rows[k, :3], rows[k, 3:6]
        w1, _, rates[k, 6], across[k] = skidding(solid, surfaces, mu, n, w, rows[k, 7])
        rates[k, :3], rates[k, 3:6] = cross(w, n), w1
    return rates, across


def radau_integrals(count):
    """Integrals from 0 to Radau's nodes in (0, 1], the last of which is 1, by values at them."""
    legendre = np.polynomial.legendre
    nodes = 0.5 + 0.5 * legendre.legroots([*[0.0] * (count - 1), -1.0, 1.0])[:, None]
    powers = np.arange(count)
    return nodes ** (powers + 1) / (powers + 1) @ np.linalg.inv(nodes**powers)


INTEGRALS = radau_integrals(NODES)
SLOPES = np.linalg.inv(INTEGRALS)


@compiled
def creep_step(solid, surfaces, mu, y, step):
    """States at the nodes of a step with a stiff direction of slip, by Radau's collocation.

    States are (axis, angular velocity, slip speed s, its direction phi). The equation of the
    direction, s phi' = the acceleration across, is solved for the direction; the others for their
    rates.
    """
    # Accelerations of the contact are differences of larger ones, exact to 1e-14 m/s^2.
    rounding = np.array([2e-15] * 3 + [2e-15 * math.sqrt(dot(y[3:6], y[3:6]))] * 3 + [1e-17, 1e-13])
    low, high = y.copy(), y.copy()
    low[7], high[7] = y[7] - 1e-5, y[7] + 1e-5
    across = creeping(solid, surfaces, mu, np.stack((low, high)))[1]
    stiffness = (across[0] - across[1]) / 2e-5
    rows = np.ones((NODES, 1)) * y
    for _ in range(ITERATIONS):
        earlier = rows.copy()
        rates, across = creeping(solid, surfaces, mu, rows)
        rows[:, :7] = y[:7] + step * (INTEGRALS @ rates)
        turns = rows[:, 6:7] * SLOPES / step
        turned = rows[:, 7] - y[7]
        rows[:, 7] += np.linalg.solve(stiffness * np.eye(NODES) + turns, across - turns @ turned)
        if np.all(np.abs(rows - earlier) < rounding):
            return rows
    raise ValueError("a step of stiff slip is not solved")


@compiled
def skid_state_rates(solid, surfaces, mu, y):
    """Rates of (axis, angular velocity, slip speed, its direction)."""
    w1, _, along, across = skidding(solid, surfaces, mu, y[:3], y[3:6], y[7])
    rates = np.zeros(8)
    rates[:3] = cross(y[3:6], y[:3])
    rates[3:6] = w1
    rates[6], rates[7] = along, across / y[6]
    return rates


def advance(rates, y, guards, bound, scale, longest=np.inf):
    """Step y from 0 until a guard falls through zero or x reaches `bound`; x, y and its name.

    Guards are functions of (x, y); those that are not positive at first are armed once they
    are.
    """
    tiny = 1e-14
    x, armed = 0.0, {name: g(0.0, y) > 0.0 for name, g in guards.items()}
    solver = DOP853(
        rates, x, y, bound, rtol=RTOL, atol=1e-15 * scale, max_step=longest, first_step=None
    )
    while solver.status == "running":
        before, start = solver.t, solver.y.copy()
        solver.step()
        assert solver.status != "failed", "DOP853 found no step"
        looks = []
        first, hit = None, None
        if any(armed.values()):
            dense = solver.dense_output()
            inner = np.linspace(before, solver.t, 6)[1:-1]
            looks = [*zip(inner, dense(inner).T.copy(), strict=True), (solver.t, solver.y)]
        for name, g in guards.items():
            for look, state in looks if armed[name] else ():
                if g(look, state) <= 0.0:
                    at = before
                    if g(before, start) > 0.0:
                        at = brentq(on(g, dense), before, look, xtol=1e-16, rtol=1e-15)
                    if first is None or at < first:
                        first, hit = at, name
                    break
            if not armed[name] and g(solver.t, solver.y) > 0.0:
                armed[name] = True
        if hit is not None:
            at, y = refine(rates, before, start, first, guards[hit], scale, longest)
            return at, y, hit
        if bound - solver.t < tiny * bound:
            break
    return solver.t, solver.y, None


def refine(rates, before, start, at, guard, scale, longest):
    """Integrate up to the event again until it is hit."""

    def reach(end):
        if end <= before:
            return start
        again = DOP853(rates, before, start, end, rtol=RTOL, atol=1e-15 * scale, max_step=longest)
        while again.status == "running":
            again.step()
        return again.y

    y = reach(at)
    value = guard(at, y)
    for _ in range(6):
        step = 1e-6 * max(at - before, 1e-9)
        derivatives = rates(at, y)
        slope = (guard(at + step, y + step * derivatives) - value) / step
        change = -value / slope if slope else 0.0
        if not abs(change) < (at - before) + 1e-9:
            break
        at += change
        y = reach(at)
        value = guard(at, y)
        if abs(change) < 1e-16 * max(1.0, at):
            break
    return at, y


class Solver:
    """A body on a table; the state is (axis, angular velocity, velocity, height)."""

    def __init__(self, problem):
        body = problem.body
        self.mass, self.I1, self.I3 = body.mass, body.I1, body.I3
        slope, azimuth = problem.table.slope, problem.table.azimuth
        down = (math.sin(slope) * math.cos(azimuth), math.sin(slope) * math.sin(azimuth))
        self.field = problem.gravity * np.array([*down, -math.cos(slope)])
        self.gravity, self.arm = -self.field[2], problem.rolling_resistance
        self.restitution = problem.contact.restitution
        self.stops = problem.contact.liftoff == "stop"
        self.surfaces = [self.surface_of(shape) for shape in body.shapes]
        self.solid = Solid(self.mass, self.I1, self.I3, self.field, self.arm)
        friction = problem.friction
        self.mu = friction.mu
        self.dry = friction.kind == "coulomb"
        if friction.kind == "viscous":
            self.law = viscous(friction.mu)
        elif friction.kind == "contensou" and friction.pressure == "ellipsoidal":
            self.law = ellipsoidal(friction.mu, 3.0 * math.pi / 16.0 * friction.patch_radius)
        elif friction.kind == "contensou":
            self.law = hertz(friction.mu, friction.patch_radius)
        self.events, self.samples, self.methods = [], [], {"DOP853"}
        self.launch(problem.launch)

    @staticmethod
    def surface_of(shape):
        if shape.kind == "eccentric_sphere":
            return np.array([SPHERE, shape.radius, 0.0, shape.radius * shape.eccentricity])
        if shape.kind == "sphere":
            return np.array([SPHERE, shape.radius, 0.0, shape.center])
        if shape.kind == "ring":
            return np.array([RING, shape.radius, 0.0, shape.center])
        return np.array([SPHEROID, shape.across, shape.along, shape.center])

    def launch(self, launch):
        s, c = math.sin(launch.tilt), math.cos(launch.tilt)
        n = np.array([s, 0.0, c])
        first = np.array([c, 0.0, -s])
        w = launch.spin * n - launch.precession * s * first
        w[1] += launch.tilt_rate
        heights = [support(surface, c)[0] for surface in self.surfaces]
        low = int(np.argmax(heights))
        # the contact's normal velocity is zero unless a velocity is stated
        a = self.contact(low, n)
        u = -cross(w, a) + np.array([*launch.slip, 0.0])
        if launch.velocity is not None:
            x, y, up = launch.velocity
            keeps = up == 0.0 and launch.gap == 0.0
            u = np.array([x, y, u[2] if keeps else up])
        self.time, self.n, self.w, self.u = 0.0, n, w, u
        self.z = heights[low] + launch.gap
        self.closed = [low] if launch.gap == 0.0 and abs(u[2] + cross(w, a)[2]) < 1e-12 else []

    # ---- geometry and dynamics

    def contact(self, i, n):
        return contact_arm(self.surfaces[i], n)

    def gap(self, i, n, z):
        return z - support(self.surfaces[i], n[2])[0]

    def gap_rate(self, i, n, w, u):
        return u[2] - support(self.surfaces[i], n[2])[1] * cross(w, n)[2]

    def slip(self, i, n, w, u):
        return (u + cross(w, self.contact(i, n)))[:2]

    def touching(self):
        """Surfaces that touch the table."""
        return np.array([self.surfaces[i] for i in self.closed])

    def sliding(self):
        """Rates of the state and normal forces of slip with smooth friction, now."""
        return sliding(self.solid, self.touching(), self.law, self.packed())

    def holding(self):
        """Normal force, and the tangential ones that hold the contact, now."""
        return rolling(self.solid, self.touching(), self.packed())[1]

    # ---- following

    def follow(self, times):
        self.times, self.next = list(times), 0
        self.end = self.times[-1]
        mode = self.first_mode()
        while mode is not None and self.next < len(self.times):
            mode = getattr(self, mode)()
        return self

    def first_mode(self):
        if not self.closed:
            return "fly"
        return self.settle()

    def settle(self):
        """Choose the mode of the closed contacts."""
        if not self.dry:
            return "slide"
        i = self.closed[0]
        slip = self.slip(i, self.n, self.w, self.u)
        speed = math.hypot(*slip)
        if speed > 1e-12:
            self.s, self.phi = speed, math.atan2(slip[1], slip[0])
            return "skid"
        normal, *tangent = self.holding()
        assert math.hypot(*tangent) <= self.mu * normal, "it does not stick"
        self.record("stick")
        return "roll"

    def record(self, kind, surface=None):
        self.events.append((self.time, kind, self.closed[0] if surface is None else surface))

    def take(self, n, w, u, z):
        self.samples.append((self.times[self.next], *n, *w, *u, z))
        self.next += 1

    def until(self):
        return self.times[self.next] - self.time

    @property
    def scale(self):
        size = max(1.0, np.linalg.norm(self.w))
        return np.array([1.0] * 3 + [size] * 3 + [1.0] * 3 + [0.1])

    def opened(self):
        return [i for i in range(len(self.surfaces)) if i not in self.closed]

    def on_table(self):
        """Height and vertical velocity of the first closed contact."""
        h, slope, _ = support(self.surfaces[self.closed[0]], self.n[2])
        self.n = self.n / np.linalg.norm(self.n)
        self.z = h
        self.u[2] = slope * cross(self.w, self.n)[2]

    def unpack(self, y):
        self.n, self.w, self.u, self.z = y[:3].copy(), y[3:6].copy(), y[6:9].copy(), float(y[9])

    def packed(self):
        return np.concatenate((self.n, self.w, self.u, [self.z]))

    def fly(self):
        """Move freely until a surface comes down."""

        def rates(_, y):
            n, w = y[:3], y[3:6]
            momentum = self.I1 * w + (self.I3 - self.I1) * (n @ w) * n
            turned = cross(momentum, n) / self.I1
            # omega = L / I1 + k n with constant k, so that its rate is that of the axis
            k = (self.I1 - self.I3) / self.I1 * (n @ w)
            return np.concatenate((turned, k * turned, self.field, [y[8]]))

        guards = {
            i: (lambda _, y, i=i: self.gap(i, y[:3], y[9])) for i in range(len(self.surfaces))
        }
        return self.smooth(rates, guards, "fly")

    def smooth(self, rates, guards, mode):
        longest = self.longest()
        x, y, hit = advance(rates, self.packed(), guards, self.until(), self.scale, longest)
        self.time += x
        self.unpack(y)
        if self.closed:
            self.on_table()
            if mode == "roll":
                self.u = -cross(self.w, self.contact(self.closed[0], self.n))
        if hit is None:
            self.time = self.times[self.next]
            self.take(self.n, self.w, self.u, self.z)
            return mode
        return self.happened(hit)

    def longest(self):
        """A bound on steps while a surface that just opened is about to come back."""
        longest = np.inf
        for i in self.opened() if self.closed else ():
            back = self.comes_back(i)
            if back is not None:
                longest = min(longest, back / 6.0)
        if not self.closed:
            rates = [self.gap_rate(i, self.n, self.w, self.u) for i in range(len(self.surfaces))]
            soon = [2.0 * r / self.gravity for r in rates if r > 0.0]
            longest = max(min([0.01, *soon]) / 6.0, 1e-5)
        return longest

    def comes_back(self, i):
        """When a surface that touches and opens comes back, to first order; None for others."""
        if abs(self.gap(i, self.n, self.z)) > 1e-9:
            return None
        rate = self.gap_rate(i, self.n, self.w, self.u)
        rates = self.sliding()[0]
        u1, w1 = rates[6:9], rates[3:6]
        _, slope, curvature = support(self.surfaces[i], self.n[2])
        turned = cross(self.w, self.n)
        bend = (
            u1[2]
            - slope * (cross(w1, self.n) + cross(self.w, turned))[2]
            - curvature * turned[2] ** 2
        )
        return -2.0 * rate / bend if rate > 0.0 and bend < 0.0 else None

    def slide(self):
        """Slip with smooth friction, on one surface or two."""

        surfaces = self.touching()

        def rates(_, y):
            return sliding(self.solid, surfaces, self.law, y)[0]

        def normals(y):
            return sliding(self.solid, surfaces, self.law, y)[1]

        guards = {("N", i): (lambda _, y, k=k: normals(y)[k]) for k, i in enumerate(self.closed)}
        for i in self.opened():
            back = self.comes_back(i)
            if back is not None and back < 1e-4:
                return self.jump(i, back, rates)
            guards[i] = lambda _, y, i=i: (
                support(self.surfaces[self.closed[0]], y[2])[0] - support(self.surfaces[i], y[2])[0]
            )
        if self.law.kind == HERTZ:
            i = self.closed[0]

            def inside(_, y):
                return -branch(self.law, self.slip(i, y[:3], y[3:6], y[6:9]), y[5])

            guards["in"], guards["out"] = inside, lambda x, y: -inside(x, y)
        return self.smooth(rates, guards, "slide")

    def jump(self, i, back, rates):
        """Follow a rebound too short to be located by its gap, which a rate of its own carries."""

        def carried(x, y):
            return np.append(rates(x, y[:10]), self.gap_rate(i, y[:3], y[3:6], y[6:9]))

        def after(time):
            y, h = np.append(self.packed(), 0.0), 0.25 * time
            for _ in range(4):
                k1 = carried(0.0, y)
                k2 = carried(0.0, y + 0.5 * h * k1)
                k3 = carried(0.0, y + 0.5 * h * k2)
                k4 = carried(0.0, y + h * k3)
                y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            return y

        for _ in range(4):
            y = after(back)
            back -= y[10] / self.gap_rate(i, y[:3], y[3:6], y[6:9])
        self.unpack(after(back)[:10])
        self.time += back
        self.on_table()
        if back < 1e-13:
            self.closed = sorted([*self.closed, i])
            self.record("double contact", i)
            return "slide"
        return self.happened(i)

    def happened(self, hit):
        """The mode after a guard."""
        if hit in ("in", "out"):
            return "slide"
        if isinstance(hit, tuple):
            _, i = hit
            if len(self.closed) > 1:
                self.closed.remove(i)
                self.record("opening", i)
                return "slide"
            self.record("liftoff")
            if self.stops:
                return None
            self.closed = []
            return "fly"
        self.record("touchdown", hit)
        return self.strike(hit)

    def strike(self, i):
        """Impact of a surface."""
        others = list(self.closed)
        stuck = self.impact(i)
        self.record("impact", i)
        for other in others:
            if self.gap_rate(other, self.n, self.w, self.u) <= 0.0:
                raise AssertionError("the other contact does not open")
            self.record("opening", other)
        if self.restitution:
            self.closed = []
            return "fly"
        self.closed = [i]
        self.on_table()
        if stuck:
            self.u = -cross(self.w, self.contact(i, self.n))
        if not self.dry:
            _, (normal,) = self.sliding()
            if normal < 0.0:
                self.record("liftoff")
                self.closed = []
                return "fly"
        return self.settle()

    def impact(self, i):
        """Change the velocities by Routh's process; whether slip has ended in it."""
        n, a = self.n, self.contact(i, self.n)
        inertia = self.I1 * np.eye(3) + (self.I3 - self.I1) * np.outer(n, n)
        inverse = np.linalg.inv(inertia)
        scale = np.concatenate((np.ones(3), np.full(3, np.linalg.norm(self.w) + 1.0)))

        def response(force, torque=0.0):
            return np.concatenate((force / self.mass, inverse @ (cross(a, force) + torque * UP)))

        def velocity(q):
            return q[:3] + cross(q[3:6], a)

        def rises(_, q):
            return -velocity(q)[2]

        approach = velocity(np.concatenate((self.u, self.w)))[2]
        q = np.concatenate((self.u, self.w))
        if not self.dry:

            def rates(_, q):
                v = velocity(q)
                force, torque = self.law(v[:2], q[5])
                return response(np.array([force[0], force[1], 1.0]), torque)

            most = 20.0 * self.mass * abs(approach)
            p, q, hit = advance(rates, q, {"end": rises}, most, scale, most / 40.0)
            assert hit == "end"
            if self.restitution:
                _, q, _ = advance(rates, q, {}, self.restitution * p, scale)
            self.u, self.w = q[:3].copy(), q[3:6].copy()
            return False
        slip = velocity(q)[:2]
        s, phi = math.hypot(*slip), math.atan2(slip[1], slip[0])

        def clocked(_, x):
            """Rates in the clock dp = s dtau; x is (velocities, s, phi, p)."""
            e = np.array([math.cos(x[7]), math.sin(x[7])])
            change = response(np.array([-self.mu * e[0], -self.mu * e[1], 1.0]))
            point = change[:3] + cross(change[3:6], a)
            along, across = point[:2] @ e, point[1] * e[0] - point[0] * e[1]
            return np.concatenate((x[6] * change, [x[6] * along, across, x[6]]))

        x = np.concatenate((q, [s, phi, 0.0]))
        scale = np.concatenate((scale, [max(s, 1e-6), 1.0, self.mass * max(s, 1e-6)]))
        guards = {"end": lambda _, x: rises(0, x), "stop": lambda _, x: x[6] - STOPPED}
        p, left = None, None
        sticks = False
        while True:
            if p is not None:
                guards["end"] = lambda _, x, left=left: left - x[8]
            _, x, hit = advance(clocked, x, guards, 1e9, scale)
            if hit == "stop":
                sticks = True
                break
            if p is None and self.restitution:
                p, left = x[8], (1.0 + self.restitution) * x[8]
                continue
            break
        q = x[:6]
        if sticks:
            # tangential velocity stays zero: a force that holds it, per unit normal impulse
            columns = [response(np.eye(3)[k]) for k in range(3)]
            D = np.array([[(c[:3] + cross(c[3:6], a))[r] for c in columns] for r in range(3)])
            held = np.linalg.solve(D[:2, :2], -D[:2, 2])
            assert math.hypot(*held) <= self.mu, "it slips on after its stop"
            change = response(np.array([*held, 1.0]))
            normal = (change[:3] + cross(change[3:6], a))[2]
            if p is None:
                compression = -velocity(q)[2] / normal
                p = x[8] + compression
                q = q + compression * change
                q = q + self.restitution * p * change
            else:
                q = q + (left - x[8]) * change
        self.u, self.w = q[:3].copy(), q[3:6].copy()
        return sticks

    # ---- dry friction

    def roll(self):
        """Roll on one surface until the table can hold it no longer."""
        i = self.closed[0]

        surfaces = self.touching()

        def rates(_, y):
            return rolling(self.solid, surfaces, y)[0]

        def reserve(_, y):
            normal, *tangent = rolling(self.solid, surfaces, y)[1]
            return (self.mu * normal) ** 2 - tangent[0] ** 2 - tangent[1] ** 2

        def normal(_, y):
            return rolling(self.solid, surfaces, y)[1][0]

        guards = {"slips": reserve, ("N", i): normal}
        for j in self.opened():
            guards[j] = lambda _, y, j=j: (
                support(self.surfaces[i], y[2])[0] - support(self.surfaces[j], y[2])[0]
            )
        longest = self.longest_rolling
        x, y, hit = advance(rates, self.packed(), guards, self.until(), self.scale, longest)
        self.time += x
        self.unpack(y)
        self.on_table()
        self.u = -cross(self.w, self.contact(i, self.n))
        if hit is None:
            self.time = self.times[self.next]
            self.take(self.n, self.w, self.u, self.z)
            return "roll"
        if hit == "slips":
            self.record("slip")
            _, *tangent = self.holding()
            self.s, self.phi = 0.0, math.atan2(-tangent[1], -tangent[0])
            return "creep"
        return self.happened(hit)

    longest_rolling = 2e-3

    def skid_rates(self, n, w, phi):
        """w', normal force, and the rates of the slip along and across it."""
        return skidding(self.solid, self.touching(), self.mu, n, w, phi)

    def creep(self):
        """Slip with dry friction where its direction is stiff, to its end."""
        self.methods.add("collocation")
        left, time, stops = self.until(), 0.0, False
        surfaces = self.touching()
        y = np.concatenate((self.n, self.w, [self.s, self.phi]))
        while time < left and y[6] < SLOW and not stops:
            step = min(CREEPS, left - time)
            rows = creep_step(self.solid, surfaces, self.mu, y, step)
            stops = rows[-1, 6] <= 0.0
            # The equations hold beyond the end of slip: Newton's steps bring the last node to it.
            for _ in range(4 if stops else 0):
                along = SLOPES[-1] @ (rows[:, 6] - y[6]) / step
                step -= rows[-1, 6] / along
                rows = creep_step(self.solid, surfaces, self.mu, y, step)
            y, time = rows[-1], time + step
        self.n, self.w, self.s, self.phi = y[:3].copy(), y[3:6].copy(), float(y[6]), float(y[7])
        self.time += time
        slip = self.s * np.array([math.cos(self.phi), math.sin(self.phi), 0.0])
        self.u = (0.0 if stops else slip) - cross(self.w, self.contact(self.closed[0], self.n))
        self.on_table()
        if stops:
            return self.settle()
        if time == left:
            self.time = self.times[self.next]
            self.take(self.n, self.w, self.u, self.z)
        return "skid"

    def skid(self):
        """Slip with dry friction, in time or, where it is slow, in its own clock."""
        i = self.closed[0]
        slow = self.s < SLOW
        _, normal, along, _ = self.skid_rates(self.n, self.w, self.phi)
        if slow and abs(along) < STIFF * self.mu * normal / self.mass:
            return "creep"
        surfaces = self.touching()
        circle = np.linspace(0.0, 2.0 * math.pi, 60)
        jams = min(self.mass * self.answer(self.n, phi) for phi in circle) < 0.0

        def rates(_, y):
            changes = np.append(skid_state_rates(self.solid, surfaces, self.mu, y), 1.0)
            if jams:
                # Where the contact jams the normal force has no bound: a clock in which it has.
                changes = changes * self.mass * self.answer(y[:3], y[7])
            return y[6] * changes if slow else changes

        def normal(_, y):
            return self.skid_rates(y[:3], y[3:6], y[7])[1]

        left = self.until()
        guards = {("N", i): normal, "sample": lambda _, y: left - y[8]}
        if jams:
            guards = {
                "jams": lambda _, y: self.mass * self.answer(y[:3], y[7]),
                "sample": lambda _, y: left - y[8],
            }
        for j in self.opened():
            guards[j] = lambda _, y, j=j: (
                support(self.surfaces[i], y[2])[0] - support(self.surfaces[j], y[2])[0]
            )
        if slow:
            guards["stop"] = lambda _, y: y[6] - STOPPED
            guards["fast"] = lambda _, y: 2.0 * SLOW - y[6]
        else:
            guards["slow"] = lambda _, y: y[6] - 0.5 * SLOW
        y = np.concatenate((self.n, self.w, [self.s, self.phi, 0.0]))
        size = max(1.0, np.linalg.norm(self.w))
        scale = np.array([1.0] * 3 + [size] * 3 + [max(self.s, 1e-3), 1.0, 1.0])
        bound = 1e12 if slow or jams else 1.1 * left + 1e-9
        _, y, hit = advance(rates, y, guards, bound, scale, np.inf if slow else 2e-3)
        self.n, self.w, self.s, self.phi = y[:3].copy(), y[3:6].copy(), float(y[6]), float(y[7])
        self.time += float(y[8])
        slip = self.s * np.array([math.cos(self.phi), math.sin(self.phi), 0.0])
        self.u = slip - cross(self.w, self.contact(i, self.n))
        self.on_table()
        if hit == "sample":
            self.time = self.times[self.next]
            self.take(self.n, self.w, self.u, self.z)
            return "skid"
        if hit in ("slow", "fast"):
            return "skid"
        if hit == "stop":
            self.u = -cross(self.w, self.contact(i, self.n))
            return self.settle()
        if hit == "jams":
            return self.strike_without_approach(i)
        return self.happened(hit)

    def answer(self, n, phi):
        """Normal acceleration of the contact point a unit of normal force gives as it slips."""
        a = self.contact(self.closed[0], n)
        force = np.array([-self.mu * math.cos(phi), -self.mu * math.sin(phi), 1.0])
        torque = cross(a, force)
        k = 1.0 / self.I3 - 1.0 / self.I1
        return 1.0 / self.mass + cross(torque / self.I1 + k * (torque @ n) * n, a)[2]

    def strike_without_approach(self, i):
        stuck = self.impact(i)
        self.record("impact", i)
        self.on_table()
        if stuck:
            self.u = -cross(self.w, self.contact(i, self.n))
        return self.settle()


def rocking(problem, times):
    """States and events of a sphere that rocks in a plane against a dry couple, by Lagrange's
    equation in its tilt alone.

    Its contact rolls; the couple turns round with the motion, and where this stops it holds the
    body if the weight's moment is less.
    """
    body = problem.body
    m, inertia, g, arm = body.mass, body.I1, problem.gravity, problem.rolling_resistance
    R, e = body.shape.radius, body.shape.radius * body.shape.eccentricity

    def rates(direction):
        def found(_, y):
            s, c = math.sin(y[0]), math.cos(y[0])
            # J y'' + m R e s y'^2 + m g e s = -d arm m (g + e (s y'' + c y'^2))
            J = inertia + m * (R * R + e * e - 2.0 * R * e * c) + direction * arm * m * e * s
            force = m * R * e * s * y[1] ** 2 + m * g * e * s
            force += direction * arm * m * (g + e * c * y[1] ** 2)
            return [y[1], -force / J]

        return found

    def stops(_, y):
        return y[1]

    stops.terminal = True
    time, y, states, events = 0.0, np.array([problem.launch.tilt, 0.0]), [], [(0.0, "stick", 0)]
    direction = -1.0 if y[0] > 0.0 else 1.0
    end = times[-1]
    while time < end:
        stops.direction = -direction
        settings = {"method": "DOP853", "rtol": RTOL, "atol": 1e-16, "events": stops}
        y[1] = direction * 1e-300
        path = solve_ivp(rates(direction), (time, end), y, max_step=2e-3, **settings)
        last = path.t[-1]
        for t in times:
            if time < t <= last:
                at = solve_ivp(rates(direction), (time, t), y, max_step=2e-3, **settings)
                states.append((t, *at.y[:, -1]))
        if path.status == 0:
            break
        # The rate is zero: one secant step from the located end, by integrating up to it.
        stops.terminal = False
        for _ in range(3):
            back = solve_ivp(rates(direction), (time, last), y, max_step=2e-3, **settings)
            last -= back.y[1, -1] / rates(direction)(0.0, back.y[:, -1])[1]
        stops.terminal = True
        time, y = last, np.array([back.y[0, -1], 0.0])
        if abs(e * math.sin(y[0])) <= arm:
            events.append((time, "rolling stops", 0))
            states += [(t, y[0], 0.0) for t in times if t > time]
            break
        direction = -1.0 if y[0] > 0.0 else 1.0
    rows = []
    for t, tilt, rate in states:
        s, c = math.sin(tilt), math.cos(tilt)
        velocity = ((R - e * c) * rate, 0.0, e * s * rate)
        rows.append((t, s, 0.0, c, 0.0, rate, 0.0, *velocity, R - e * c))
    return rows, events
