"""A second solver of every case of the reference suite that shares no line with the package.

Newton's and Euler's equations stand in the frame of the table, with the angular velocity and the
full 6 x 6 mass matrix; contact forces are multipliers of the constraints on accelerations, one
dense linear system an evaluation. SciPy's DOP853 takes the steps, and an event is located by
integrating up to it again until it is hit. Slip near its end runs in a clock of its own,
dt = s dtau with the slip speed s; slip begins by polynomials that satisfy the equations at a few
instants. Slip that hardly grows turns quickly into its direction, a stiff problem for which there
is SciPy's Radau. Impacts are integrated over the normal impulse.
"""

import math

import numpy as np
from scipy.integrate import DOP853, Radau, solve_ivp
from scipy.optimize import brentq, fsolve

UP = np.array([0.0, 0.0, 1.0])
RTOL = 1e-13
SLOW = 1e-4
"""Slip speed below which slip of dry friction runs in its own clock, m/s."""

STOPPED = 1e-18
"""Slip speed that is none, m/s."""

STIFF = 0.05
"""Growth of slip over friction's acceleration below which the slip's direction is stiff."""

STIFF_RTOL = 1e-11
"""Relative tolerance of Radau, which has order 5 and estimates its error at order 3."""

STRAIGHT = 1e-13
"""Slip speed from which stiff slip ends along a straight line, m/s: its last 1e-10 s."""

BEGINS, INSTANTS = 1.5e-4, 4
"""How long at most slip begins as a polynomial, s, and at how many instants it is exact.
"""


def cross(a, b):
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def on(guard, dense):
    """A guard as a function of x alone on a dense solution."""
    return lambda x: guard(x, dense(x))


# Support functions: (h, h', h'') at the cosine of the tilt.


def sphere(radius, center):
    return lambda c: (radius - center * c, -center, 0.0)


def ring(radius, center):
    def support(c):
        s = math.sqrt(1.0 - c * c)
        return radius * s - center * c, -radius * c / s - center, -radius / s**3

    return support


def spheroid(across, along, center):
    d = along**2 - across**2

    def support(c):
        q = math.sqrt(across**2 + d * c * c)
        return q - center * c, d * c / q - center, d * across**2 / q**3

    return support


# Laws: force and drilling torque per unit normal force, of slip v (2) and drilling w.


def viscous(mu):
    return lambda v, w: (-mu * v, 0.0)


def ellipsoidal(mu, rho):
    def law(v, w):
        size = math.sqrt(v[0] ** 2 + v[1] ** 2 + (rho * w) ** 2)
        return -mu * v / size, -mu * rho**2 * w / size

    return law


def hertz(mu, radius):
    def law(v, w):
        speed, turn = math.hypot(v[0], v[1]), abs(w) * radius
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
        scaled = v / speed if speed else v
        return -mu * force * scaled, -mu * radius * torque * math.copysign(1.0, w)

    law.branch = lambda v, w: math.hypot(v[0], v[1]) - abs(w) * radius
    return law


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
        dense = None
        first, hit = None, None
        for name, g in guards.items():
            looks = [solver.t] if armed[name] else []
            if armed[name]:
                dense = dense or solver.dense_output()
                inner = np.linspace(before, solver.t, 6)[1:-1]
                looks = [*inner, solver.t]
            for look in looks:
                if g(look, solver.y if look == solver.t else dense(look)) <= 0.0:
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
        self.supports = [self.support_of(shape) for shape in body.shapes]
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
    def support_of(shape):
        if shape.kind == "eccentric_sphere":
            return sphere(shape.radius, shape.radius * shape.eccentricity)
        if shape.kind == "sphere":
            return sphere(shape.radius, shape.center)
        if shape.kind == "ring":
            return ring(shape.radius, shape.center)
        return spheroid(shape.across, shape.along, shape.center)

    def launch(self, launch):
        s, c = math.sin(launch.tilt), math.cos(launch.tilt)
        n = np.array([s, 0.0, c])
        first = np.array([c, 0.0, -s])
        w = launch.spin * n - launch.precession * s * first
        w[1] += launch.tilt_rate
        heights = [support(c)[0] for support in self.supports]
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
        h, slope, _ = self.supports[i](n[2])
        return -slope * (n - n[2] * UP) - h * UP

    def gap(self, i, n, z):
        return z - self.supports[i](n[2])[0]

    def gap_rate(self, i, n, w, u):
        return u[2] - self.supports[i](n[2])[1] * cross(w, n)[2]

    def slip(self, i, n, w, u):
        return (u + cross(w, self.contact(i, n)))[:2]

    def solve(self, n, w, contacts):
        """Accelerations and multipliers; contacts are (surface, column or None where it sticks).

        A column is (force (2), torque (3)) per unit normal force. Returns u', w', the normal forces
        and the tangential ones, and the accelerations of the contact points along the table.
        """
        turned = cross(w, n)
        inertia = self.I1 * np.eye(3) + (self.I3 - self.I1) * np.outer(n, n)
        momentum = self.I1 * w + (self.I3 - self.I1) * (n @ w) * n
        size = 6 + sum(1 if column is not None else 3 for _, column in contacts)
        K, right = np.zeros((size, size)), np.zeros(size)
        K[0, 0] = K[1, 1] = K[2, 2] = self.mass
        K[3:6, 3:6] = inertia
        right[:3] = self.mass * self.field
        right[3:6] = -cross(w, momentum)
        resisted = np.zeros(3)
        if self.arm:
            rolling = math.hypot(w[0], w[1])
            resisted = -self.arm / rolling * np.array([w[0], w[1], 0.0])
        place = 6
        arms = []
        for i, column in contacts:
            h, slope, curvature = self.supports[i](n[2])
            a = -slope * (n - n[2] * UP) - h * UP
            rate = -curvature * turned[2] * (n - n[2] * UP) - slope * turned
            arms.append((a, rate))
            force = UP if column is None else np.array([column[0][0], column[0][1], 1.0])
            torque = cross(a, force) + resisted
            if column is not None:
                torque = torque + column[1]
            K[0:3, place] -= force
            K[3:6, place] -= torque
            K[place, 2] = 1.0
            K[place, 3:6] = cross(a, UP)
            right[place] = slope * cross(w, turned)[2] + curvature * turned[2] ** 2
            place += 1
            if column is None:
                bias = cross(w, rate)
                for k in (0, 1):
                    axis = np.zeros(3)
                    axis[k] = 1.0
                    K[k, place] -= 1.0
                    K[3:6, place] -= cross(a, axis)
                    K[place, k] = 1.0
                    K[place, 3:6] = cross(a, axis)
                    right[place] = -bias[k]
                    place += 1
        x = np.linalg.solve(K, right)
        normals, tangents, points, place = [], [], [], 6
        for (_, column), (a, rate) in zip(contacts, arms, strict=True):
            normals.append(x[place])
            tangents.append(x[place + 1 : place + 3] if column is None else None)
            place += 3 if column is None else 1
            points.append((x[:3] + cross(x[3:6], a) + cross(w, rate))[:2])
        return x[:3], x[3:6], normals, tangents, points

    def column(self, i, n, w, u):
        force, torque = self.law(self.slip(i, n, w, u), w[2])
        return force, torque * UP

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
        _, _, (normal,), (tangent,), _ = self.solve(self.n, self.w, [(i, None)])
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
        return [i for i in range(len(self.supports)) if i not in self.closed]

    def on_table(self):
        """Height and vertical velocity of the first closed contact."""
        h, slope, _ = self.supports[self.closed[0]](self.n[2])
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
            i: (lambda _, y, i=i: self.gap(i, y[:3], y[9])) for i in range(len(self.supports))
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
            rates = [self.gap_rate(i, self.n, self.w, self.u) for i in range(len(self.supports))]
            soon = [2.0 * r / self.gravity for r in rates if r > 0.0]
            longest = max(min([0.01, *soon]) / 6.0, 1e-5)
        return longest

    def comes_back(self, i):
        """When a surface that touches and opens comes back, to first order; None for others."""
        if abs(self.gap(i, self.n, self.z)) > 1e-9:
            return None
        rate = self.gap_rate(i, self.n, self.w, self.u)
        u1, w1, *_ = self.solve(
            self.n, self.w, [(j, self.column(j, self.n, self.w, self.u)) for j in self.closed]
        )
        _, slope, curvature = self.supports[i](self.n[2])
        turned = cross(self.w, self.n)
        bend = (
            u1[2]
            - slope * (cross(w1, self.n) + cross(self.w, turned))[2]
            - curvature * turned[2] ** 2
        )
        return -2.0 * rate / bend if rate > 0.0 and bend < 0.0 else None

    def slide(self):
        """Slip with smooth friction, on one surface or two."""

        def parts(y):
            n, w, u = y[:3], y[3:6], y[6:9]
            return self.solve(n, w, [(i, self.column(i, n, w, u)) for i in self.closed])

        def rates(_, y):
            u1, w1, *_ = parts(y)
            return np.concatenate((cross(y[3:6], y[:3]), w1, u1, [y[8]]))

        guards = {("N", i): (lambda _, y, k=k: parts(y)[2][k]) for k, i in enumerate(self.closed)}
        for i in self.opened():
            back = self.comes_back(i)
            if back is not None and back < 1e-4:
                return self.jump(i, back, rates)
            guards[i] = lambda _, y, i=i: (
                self.supports[self.closed[0]](y[2])[0] - self.supports[i](y[2])[0]
            )
        if hasattr(self.law, "branch"):
            i = self.closed[0]

            def inside(_, y):
                return -self.law.branch(self.slip(i, y[:3], y[3:6], y[6:9]), y[5])

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
            contacts = [(i, self.column(i, self.n, self.w, self.u))]
            if self.solve(self.n, self.w, contacts)[2][0] < 0.0:
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

        def parts(y):
            return self.solve(y[:3], y[3:6], [(i, None)])

        def rates(_, y):
            u1, w1, *_ = parts(y)
            return np.concatenate((cross(y[3:6], y[:3]), w1, u1, [y[8]]))

        def reserve(_, y):
            _, _, (normal,), (tangent,), _ = parts(y)
            return (self.mu * normal) ** 2 - tangent @ tangent

        def normal(_, y):
            return parts(y)[2][0]

        guards = {"slips": reserve, ("N", i): normal}
        for j in self.opened():
            guards[j] = lambda _, y, j=j: self.supports[i](y[2])[0] - self.supports[j](y[2])[0]
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
            self.begin_slip()
            return "skid"
        return self.happened(hit)

    longest_rolling = 2e-3

    def skid_rates(self, n, w, phi):
        """u', w', normal force, and the rates of the slip along and across it."""
        e = np.array([math.cos(phi), math.sin(phi)])
        _, w1, (normal,), _, (point,) = self.solve(
            n, w, [(self.closed[0], (-self.mu * e, np.zeros(3)))]
        )
        return w1, normal, point @ e, point[1] * e[0] - point[0] * e[1]

    def begin_slip(self):
        """Leave rolling: t^2 times a polynomial for the slip's speed, and one for its direction."""
        i = self.closed[0]
        _, _, _, (tangent,), _ = self.solve(self.n, self.w, [(i, None)])
        first = math.atan2(-tangent[1], -tangent[0])
        length = min(BEGINS, self.until())
        instants = length * np.arange(1, INSTANTS + 1) / INSTANTS

        def direction(numbers, t):
            """Direction and its rate."""
            x = t / length
            terms = [b * x**k for k, b in enumerate(numbers[INSTANTS:], 1)]
            rates = [k * b * x ** (k - 1) for k, b in enumerate(numbers[INSTANTS:], 1)]
            return first + sum(terms), sum(rates) / length

        def speed(numbers, t):
            """Speed and its rate."""
            x = t / length
            a = 10.0 * numbers[:INSTANTS]
            terms = [a[k] * x ** (k + 2) for k in range(INSTANTS)]
            rates = [(k + 2) * a[k] * x ** (k + 1) for k in range(INSTANTS)]
            return sum(terms) * length**2, sum(rates) * length

        def states(numbers):
            def rates(t, y):
                w1, *_ = self.skid_rates(y[:3], y[3:6], direction(numbers, t)[0])
                return np.concatenate((cross(y[3:6], y[:3]), w1))

            h, y, t = length / INSTANTS, np.concatenate((self.n, self.w)), 0.0
            for end in instants:
                k1 = rates(t, y)
                k2 = rates(t + 0.5 * h, y + 0.5 * h * k1)
                k3 = rates(t + 0.5 * h, y + 0.5 * h * k2)
                k4 = rates(t + h, y + h * k3)
                y, t = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4), end
                yield t, y

        def residual(numbers):
            found = []
            for t, y in states(numbers):
                phi, turn = direction(numbers, t)
                s, s_rate = speed(numbers, t)
                _, _, along, across = self.skid_rates(y[:3], y[3:6], phi)
                found.append((s_rate - along) / t)
                found.append((s * turn - across) / t)
            return np.array(found)

        guess = np.zeros(2 * INSTANTS)
        guess[0] = 1.0
        numbers, _, _, message = fsolve(residual, guess, xtol=1e-12, full_output=True)
        *_, (t, y) = states(numbers)
        self.n, self.w, self.time = y[:3], y[3:6], self.time + t
        self.s, self.phi = speed(numbers, t)[0], direction(numbers, t)[0]
        assert self.s > 0.0, message
        if length < BEGINS:
            slip = self.s * np.array([math.cos(self.phi), math.sin(self.phi), 0.0])
            self.u = slip - cross(self.w, self.contact(i, self.n))
            self.on_table()
            self.time = self.times[self.next]
            self.take(self.n, self.w, self.u, self.z)

    def creep(self):
        """Slip with dry friction where its direction is stiff, to its end."""
        self.methods.add("Radau")
        left = self.until()

        def rates(_, y):
            w1, _, along, across = self.skid_rates(y[:3], y[3:6], y[7])
            return np.concatenate((cross(y[3:6], y[:3]), w1, [along, across / y[6]]))

        y = np.concatenate((self.n, self.w, [self.s, self.phi]))
        size = np.array([1.0] * 3 + [np.linalg.norm(self.w)] * 3 + [1e-7, 1.0])
        solver = Radau(rates, 0.0, y, left, rtol=STIFF_RTOL, atol=1e-12 * size)
        while solver.status == "running" and STRAIGHT < solver.y[6] < SLOW:
            solver.step()
        assert solver.status != "failed", "Radau found no step"
        y, time = solver.y, solver.t
        stops = y[6] <= STRAIGHT
        if stops:
            along = self.skid_rates(y[:3], y[3:6], y[7])[2]
            y, time = y - rates(0.0, y) * y[6] / along, time - y[6] / along
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
        circle = np.linspace(0.0, 2.0 * math.pi, 60)
        jams = min(self.mass * self.answer(self.n, phi) for phi in circle) < 0.0

        def rates(_, y):
            n, w, s, phi = y[:3], y[3:6], y[6], y[7]
            w1, _, along, across = self.skid_rates(n, w, phi)
            changes = np.concatenate((cross(w, n), w1, [along, across / s, 1.0]))
            if jams:
                # Where the contact jams the normal force has no bound: a clock in which it has.
                changes = changes * self.mass * self.answer(n, phi)
            return s * changes if slow else changes

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
            guards[j] = lambda _, y, j=j: self.supports[i](y[2])[0] - self.supports[j](y[2])[0]
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
