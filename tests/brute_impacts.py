"""Impacts by small steps in the normal impulse, with matrices and projections: another solver.

Nothing of it is the package's. A body has mass m, moments I1 and I3, an axis n, and two contact
points; its velocities are those of the centre of mass and the angular one, six numbers. With the
normal impulse of the contact that strikes as time, the velocities change by M^-1 J^T lambda, where
lambda are the impulses of both contacts. Slip that is not zero has the friction of its law. What is
held, and a second normal impulse, are found by projections on what friction can exert, again and
again, until nothing changes. Steps of Runge and Kutta's method of order four are so short that slip
changes by a small part of itself, and where something happens they are halved.
"""

import math
from dataclasses import dataclass, field

import numpy as np

HELD = 1e-9
"""Slip that has ended, beside an approach of the order of 1."""

SHORTEST = 1e-12
PART = 0.02


def hertz(kappa):
    """Force along the slip and torque of a patch with Hertz's pressure over mu N and its radius."""
    if kappa <= 1.0:
        square = kappa * kappa
        force = 3.0 * math.pi / 32.0 * kappa * (4.0 - square)
        return force, 3.0 * math.pi / 16.0 * (1.0 - square + 0.375 * square * square)
    if kappa > 30.0:  # There the terms cancel.
        x = 1.0 / kappa
        force = 1.0 - x**2 / 10.0 - 3.0 * x**4 / 280.0 - x**6 / 336.0
        return force, x / 5.0 + x**3 / 70.0 + x**5 / 280.0 + 5.0 * x**7 / 3696.0
    square, sine = kappa * kappa, math.asin(1.0 / kappa)
    root = math.sqrt(square - 1.0)
    force = 3.0 / 16.0 * (kappa * (4.0 - square) * sine + root * (square + 2.0) / kappa)
    torque = (1.0 - square + 0.375 * square**2) * sine + root * (0.75 - 0.375 * square)
    return force, 0.375 * torque


class Unknown(Exception):
    """Small steps do not tell what follows: friction presses the second contact as much as its own
    normal impulse opens it, or holds a patch with Hertz's pressure.
    """


@dataclass
class Law:
    """Friction: its name, coefficient, and its length or speed."""

    name: str
    mu: float
    scale: float = 0.0

    @property
    def parts(self):
        """How many components of slip it resists, the third times `reach`."""
        return 3 if self.name in ("ellipsoidal", "hertz") else 2

    @property
    def reach(self):
        return 3.0 * math.pi / 16.0 * self.scale if self.name == "ellipsoidal" else self.scale

    @property
    def holds(self):
        return self.name in ("coulomb", "ellipsoidal", "hertz")

    def friction(self, slip):
        """Return friction per unit normal impulse, the torque over `reach`."""
        if self.name == "viscous":
            return -self.mu * slip
        if self.name == "regularized":
            return -self.mu * slip / math.hypot(*slip, self.scale)
        if self.name in ("coulomb", "ellipsoidal"):
            return -self.mu * slip / np.linalg.norm(slip)
        speed, drilling = math.hypot(*slip[:2]), abs(slip[2])
        if drilling == 0.0:
            return -self.mu * slip / speed
        force, torque = hertz(speed / drilling)
        along = slip[:2] / speed if speed else 0.0 * slip[:2]
        return -self.mu * np.array([*(force * along), math.copysign(torque, slip[2])])


@dataclass
class Struck:
    """A body and its contacts, of which the first strikes."""

    mass: float
    inertias: tuple
    axis: np.ndarray
    arms: list
    law: Law
    rolling: float = 0.0
    trades: dict = field(default_factory=dict)

    def __post_init__(self):
        first, third = self.inertias
        turning = (np.eye(3) - np.outer(self.axis, self.axis)) / first
        turning += np.outer(self.axis, self.axis) / third
        inverse = np.zeros((6, 6))
        inverse[:3, :3] = np.eye(3) / self.mass
        inverse[3:, 3:] = turning
        rows = []
        for arm in self.arms:
            x, y, z = arm
            lever = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
            point = np.hstack([np.eye(3), lever])
            drill = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, self.law.reach]])
            tangents = np.vstack([point[:2], drill])[: self.law.parts]
            rows.append((point[2], tangents))
        self.rows, self.inverse = rows, inverse
        self.couple = np.eye(6)[3:5]

    def rates(self, velocities, states):
        """Return the rates of the velocities per normal impulse of the first contact, and the
        second normal impulse.

        The states are whether the second contact is closed, whether the slip of each has ended, and
        whether rolling has.
        """
        closed, ended, stopped = states
        normals = [1.0, self.trades.get("normal", 0.0) if closed else 0.0]
        columns, held = [], [False, False]
        omega = velocities[3:5]
        turning = np.linalg.norm(omega)
        for number, (normal, tangents) in enumerate(self.rows):
            wrench = normal.copy()
            if not ended[number]:
                wrench = wrench + tangents.T @ self.law.friction(tangents @ velocities)
            else:
                held[number] = True
            if self.rolling and not stopped:
                wrench = wrench - self.rolling * self.couple.T @ (omega / turning)
            columns.append(self.inverse @ wrench)
        active = [0, 1] if closed else [0]
        if not any(held[number] for number in active) and not stopped:
            if closed:
                here, there = self.rows[1][0] @ columns[0], self.rows[1][0] @ columns[1]
                if there <= 0.0:
                    raise Unknown
                normals[1] = max(0.0, -here / there)
            return columns[0] + normals[1] * columns[1], normals[1]
        return self._projected(columns, held, active, closed, stopped)

    def _projected(self, columns, held, active, closed, stopped):
        """Return the rates with what is held, by projections."""
        if self.law.name == "hertz" and any(held[number] for number in active):
            raise Unknown  # What friction can exert then is no ball.
        trades = self.trades
        second = trades.get("normal", 0.0) if closed else 0.0
        tangential = {
            number: trades.get(number, np.zeros(self.law.parts))
            for number in active
            if held[number]
        }
        couple = trades.get("couple", np.zeros(2)) if stopped else np.zeros(2)
        responses = {number: self.inverse @ self.rows[number][1].T for number in tangential}
        turned = self.inverse @ self.couple.T
        rate = columns[0] + second * columns[1]
        for number, value in tangential.items():
            rate = rate + responses[number] @ value
        rate = rate + turned @ couple
        for _ in range(200_000):
            moved = 0.0
            if closed:
                normal = self.rows[1][0]
                new = max(0.0, second - normal @ rate / abs(normal @ columns[1]))
                rate, moved = rate + (new - second) * columns[1], max(moved, abs(new - second))
                second = new
            for number, value in tangential.items():
                row = self.rows[number][1]
                gain = 1.0 / np.trace(row @ responses[number])
                new = value - gain * (row @ rate)
                limit = self.law.mu * (second if number else 1.0)
                size = np.linalg.norm(new)
                if size > limit:
                    new = new * (limit / size)
                rate = rate + responses[number] @ (new - value)
                moved = max(moved, np.abs(new - value).max())
                tangential[number] = new
            if stopped:
                new = couple - self.couple @ rate / np.trace(self.couple @ turned)
                limit, size = self.rolling * (1.0 + second), np.linalg.norm(new)
                if size > limit:
                    new = new * (limit / size)
                rate, moved = rate + turned @ (new - couple), max(moved, np.abs(new - couple).max())
                couple = new
            if moved < 1e-13:
                break
        trades.update(tangential)
        trades["normal"], trades["couple"] = second, couple
        return rate, second

    def step(self, velocities, states, size):
        """Return the velocities and the second normal impulse after a step of order four."""
        one, a = self.rates(velocities, states)
        two, b = self.rates(velocities + 0.5 * size * one, states)
        three, c = self.rates(velocities + 0.5 * size * two, states)
        four, d = self.rates(velocities + size * three, states)
        return (
            velocities + size / 6.0 * (one + 2.0 * two + 2.0 * three + four),
            size / 6.0 * (a + 2.0 * b + 2.0 * c + d),
        )


def struck(body, velocities, restitution, steps=1500):
    """Return the velocities after an impact, the normal impulse of the first contact, and the least
    normal velocity of the second.
    """
    velocities = np.array(velocities, dtype=float)
    normals = [row for row, _ in body.rows]
    approach = -normals[0] @ velocities
    longest = approach / (normals[0] @ body.inverse @ normals[0]) / steps
    slips = [tangents @ velocities for _, tangents in body.rows]
    ended = [body.law.holds and bool(np.linalg.norm(slip) < HELD) for slip in slips]
    stopped = bool(body.rolling) and bool(np.linalg.norm(velocities[3:5]) < HELD)
    closed, impulse, full, work, least = True, 0.0, math.inf, 0.0, 0.0
    while True:
        states = closed, ended, stopped
        rate, _ = body.rates(velocities, states)
        size = min(longest, full - impulse)
        for number, (_, tangents) in enumerate(body.rows):
            slip, change = tangents @ velocities, tangents @ rate
            if not ended[number] and body.law.holds and (closed or not number):
                size = min(size, PART * np.linalg.norm(slip) / max(np.linalg.norm(change), 1e-30))
        if body.rolling and not stopped:
            speed, change = np.linalg.norm(velocities[3:5]), np.linalg.norm(rate[3:5])
            size = min(size, PART * speed / max(change, 1e-30))
        size = max(size, SHORTEST)
        after, pressed = body.step(velocities, states, size)
        # Halve the step where the first contact stops, or the second comes back to the table.
        ends = full == math.inf and normals[0] @ after >= 0.0
        closes = not closed and normals[1] @ after < 0.0
        if ends or closes:
            low, high = 0.0, size
            for _ in range(60):
                middle = 0.5 * (low + high)
                trial, _ = body.step(velocities, states, middle)
                over = (ends and normals[0] @ trial >= 0.0) or (closes and normals[1] @ trial < 0.0)
                low, high = (low, middle) if over else (middle, high)
            size = high
            after, pressed = body.step(velocities, states, size)
            ends = full == math.inf and normals[0] @ after >= 0.0
        work += 0.5 * size * normals[0] @ (velocities + after)
        velocities, impulse = after, impulse + size
        if closes and normals[1] @ velocities <= 1e-12:
            closed = True
        elif closed and pressed == 0.0 and normals[1] @ velocities > 1e-13:
            closed = False
        least = min(least, normals[1] @ velocities)
        slips = [tangents @ velocities for _, tangents in body.rows]
        for number, slip in enumerate(slips):
            if body.law.holds:
                ended[number] = bool(np.linalg.norm(slip) < HELD)
        stopped = bool(body.rolling) and bool(np.linalg.norm(velocities[3:5]) < HELD)
        if ends:
            if not restitution:
                return velocities, impulse, least
            full = (1.0 + restitution) * impulse
        elif full < math.inf and (impulse >= full * (1.0 - 1e-14) or work >= 0.0):
            return velocities, impulse, least
