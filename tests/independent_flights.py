"""A second simulation of a hopping tippe top that shares no line with the package.

Sliding follows the published equations in Euler angles, flight the Euler equations of a free
symmetric top, both by the classical Runge-Kutta method in small steps; lift-off and touchdown are
bracketed by a step and found by bisection; the impact is integrated in the normal impulse with an
inertia matrix of skew matrices.
"""

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Toy:
    """An eccentric sphere with viscous friction: m, R, alpha, I1, I3, mu, g."""

    m: float
    R: float
    alpha: float
    I1: float
    I3: float
    mu: float
    g: float

    def normal_force(self, y):
        th, dth, _, dph, w, vx, _ = y
        s, c = sin(th), cos(th)
        top = self.m * self.g * self.I1 + self.m * self.R * self.alpha * (
            c * self.I1 * (dph**2 * s**2 + dth**2) - self.I3 * dph * w * s**2
        )
        friction = self.m * self.R**2 * self.alpha * s * (1 - self.alpha * c) * self.mu * vx
        return top / (self.I1 + self.m * self.R**2 * self.alpha**2 * s**2 - friction)

    def slide(self, y):
        th, dth, _, dph, w, vx, vy = y
        m, R, al, I1, I3 = self.m, self.R, self.alpha, self.I1, self.I3
        s, c = sin(th), cos(th)
        n = self.normal_force(y)
        fx, fy = self.mu * n * vx, self.mu * n * vy
        return np.array(
            [
                dth,
                s / I1 * (I1 * dph**2 * c - I3 * w * dph - R * al * n) + R * fx * (1 - al * c) / I1,
                dph,
                (I3 * dth * w - 2 * I1 * dth * dph * c - fy * R * (al - c)) / (I1 * s),
                -fy * R * s / I3,
                R * s / I1 * (dph * w * (I3 * (1 - al * c) - I1) + n * R * al * (1 - al * c))
                - R * s * al * (dth**2 + dph**2 * s**2)
                - fx / m / I1 * (I1 + m * R**2 * (1 - al * c) ** 2)
                + dph * vy,
                -fy / m / I1 / I3 * (I1 * I3 + m * R**2 * I3 * (al - c) ** 2 + m * R**2 * I1 * s**2)
                + w * dth * R / I1 * (I3 * (al - c) + I1 * c)
                - dph * vx,
            ]
        )

    def fly(self, y):
        """Rates of (theta, theta', phi, phi', omega3, z, z') in the air."""
        th, dth, _, dph, w, _, dz = y
        s, c = sin(th), cos(th)
        return np.array(
            [
                dth,
                s * (dph**2 * c - self.I3 / self.I1 * w * dph),
                dph,
                dth * (self.I3 / self.I1 * w - 2 * dph * c) / s,
                0.0,
                dz,
                -self.g,
            ]
        )

    def gap(self, y):
        return y[5] - self.R * (1 - self.alpha * cos(y[0]))

    # The frame (X, Y, z) turns with phi; vectors are resolved in it.
    def spin(self, y):
        th, dth, _, dph, w = y[:5]
        axis = np.array([sin(th), 0.0, cos(th)])
        first = np.array([cos(th), 0.0, -sin(th)])
        return -dph * sin(th) * first + dth * np.array([0.0, 1.0, 0.0]) + w * axis, axis

    def arm(self, y):
        return self.alpha * self.R * np.array([sin(y[0]), 0.0, cos(y[0])]) - self.R * np.array(
            [0, 0, 1.0]
        )

    def centre_velocity(self, y):
        """Horizontal velocity of the centre of mass of a sliding toy along X and Y."""
        omega, _ = self.spin(y)
        return np.array([y[5], y[6]]) - np.cross(omega, self.arm(y))[:2]

    def hit(self, y, u, dz):
        """Impact with no restitution: new (theta', phi', omega3), new u and z' = 0 at the
        contact.
        """
        omega, axis = self.spin(y)
        arm = self.arm(y)
        inertia = self.I1 * np.eye(3) + (self.I3 - self.I1) * np.outer(axis, axis)
        skew = np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
        response = np.eye(3) / self.m - skew @ np.linalg.inv(inertia) @ skew
        point = np.array([*u, dz]) + np.cross(omega, arm)

        def rates(_, state):
            force = np.array([-self.mu * state[0], -self.mu * state[1], 1.0])
            return np.concatenate((response @ force, force))

        def stopped(_, state):
            return state[2]

        stopped.terminal, stopped.direction = True, 1
        most = 10 * self.m * abs(point[2]) + 1e-300
        path = solve_ivp(
            rates,
            (0, most),
            [*point, 0, 0, 0],
            events=stopped,
            rtol=1e-12,
            atol=1e-16,
            max_step=most / 20,
        )
        impulse = path.y_events[0][0][3:]
        velocity = np.array([*u, dz]) + impulse / self.m
        omega = omega + np.linalg.solve(inertia, np.cross(arm, impulse))
        first = np.array([cos(y[0]), 0.0, -sin(y[0])])
        return (omega[1], -(omega @ first) / sin(y[0]), omega @ axis), velocity[:2]


def rk4(rates, y, h):
    k1 = rates(y)
    k2 = rates(y + h / 2 * k1)
    k3 = rates(y + h / 2 * k2)
    k4 = rates(y + h * k3)
    return y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def bisect(rates, y, h, value):
    """The part of a step after which a value that is positive at its start has fallen to zero."""
    low, high = 0.0, h
    for _ in range(60):
        mid = (low + high) / 2
        low, high = (mid, high) if value(rk4(rates, y, mid)) > 0 else (low, mid)
    return high


def slide_and_fly(toy, y, duration, h):
    """Follow y = (theta, theta', phi, phi', omega3, v_x, v_y) from sliding; no restitution.

    Returns the final (theta, theta', phi, phi', omega3), the times of lift-off and those of
    touchdown.
    """
    t, lifts, lands = 0.0, [], []
    airborne, u, phi_then = False, None, 0.0
    y = np.array(y, dtype=float)
    while t < duration - 1e-15:
        step = min(h, duration - t)
        rates = toy.fly if airborne else toy.slide
        value = toy.gap if airborne else toy.normal_force
        after = rk4(rates, y, step)
        if airborne and t == lifts[-1]:
            # The gap has a triple root at lift-off: leave it before looking for the next.
            t, y = t + step, after
            continue
        if value(after) > 0:
            t, y = t + step, after
            continue
        part = bisect(rates, y, step, value)
        y, t = rk4(rates, y, part), t + part
        if airborne:
            lands.append(t)
            turn = y[2] - phi_then
            # u is fixed in space in flight; resolve it in the frame that has turned meanwhile.
            here = np.array(
                [cos(turn) * u[0] + sin(turn) * u[1], -sin(turn) * u[0] + cos(turn) * u[1]]
            )
            (dth, dph, w), u = toy.hit(y, here, y[6])
            y = np.array([y[0], dth, y[2], dph, w, 0.0, 0.0])
            omega, _ = toy.spin(y)
            y[5:] = u + np.cross(omega, toy.arm(y))[:2]
            airborne = False
        else:
            lifts.append(t)
            u, phi_then = toy.centre_velocity(y), y[2]
            height, sinking = (
                toy.R * (1 - toy.alpha * cos(y[0])),
                toy.R * toy.alpha * sin(y[0]) * y[1],
            )
            y = np.array([*y[:5], height, sinking])
            airborne = True
    return y[:5], lifts, lands
