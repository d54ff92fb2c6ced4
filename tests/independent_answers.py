"""Consistent answers of two contacts by brute force: an enumeration that shares no code with the
package.

The body is of mass 1, under gravity 1, on two spheres of radii r_i whose centres lie zeta_i along
the axis n from its centre of mass: the contact points are at zeta_i n - r_i z. Velocities are (u,
omega), six numbers. For every set of closed contacts, and every status of slip and rolling that
have ended, the equations are linear for given directions, and the directions are searched from a
grid.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
from mpmath import asin, mpf, sqrt, workdps
from scipy.optimize import minimize, root

Z = np.array([0.0, 0.0, 1.0])
Array = np.ndarray


def cross_matrix(a: Array) -> Array:
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def unit(a: Array) -> Array:
    return a / np.linalg.norm(a)


def hertz(k: float) -> tuple[float, float]:
    """Force and torque over mu N, and mu N R, at v = k R |w|."""
    if k <= 1.0:
        return (
            3.0 * np.pi / 32.0 * k * (4.0 - k * k),
            3.0 * np.pi / 16.0 * (1.0 - k * k + 0.375 * k**4),
        )
    if k > 1e8:
        return 1.0, 0.2 / k
    with workdps(60):  # The terms cancel.
        x = mpf(k)
        s, q = asin(1 / x), sqrt(x * x - 1)
        force = 3 * (x * (4 - x * x) * s + q * (x * x + 2) / x) / 16
        torque = 3 * ((1 - x * x + 3 * x**4 / 8) * s + 3 * q * (2 - x * x) / 8) / 8
        return float(force), float(torque)


@dataclass(frozen=True)
class Law:
    """Dry friction: "coulomb", "ellipsoidal" or "hertz"."""

    kind: str
    mu: float
    radius: float = 0.0

    @property
    def drills(self) -> bool:
        return self.kind != "coulomb"

    def traction(self, v: Array, w: float) -> tuple[Array, float]:
        """Force and torque per unit normal force."""
        speed = float(np.hypot(*v))
        if self.kind == "coulomb":
            return -self.mu * v / speed, 0.0
        if self.kind == "ellipsoidal":
            rho = 3.0 * np.pi / 16.0 * self.radius
            size = np.hypot(speed, rho * w)
            return -self.mu * v / size, float(-self.mu * rho * rho * w / size)
        if speed == 0.0:
            return 0.0 * v, float(-self.mu * self.radius * 3.0 * np.pi / 16.0 * np.sign(w))
        force, torque = hertz(speed / (self.radius * abs(w))) if w else (1.0, 0.0)
        return -self.mu * force * v / speed, float(-self.mu * self.radius * torque * np.sign(w))


@dataclass(frozen=True)
class Case:
    """Two contacts without normal velocities; what has ended is zero in u and omega."""

    across: float
    along: float
    r: Array
    zeta: Array
    law: Law
    eps: float | None
    n: Array
    u: Array
    omega: Array
    ended: tuple[bool, bool]
    stopped: bool

    @property
    def e(self) -> Array:
        return unit(np.array([self.n[0], self.n[1], 0.0]))

    @property
    def arms(self) -> Array:
        return np.array([z * self.n - r * Z for z, r in zip(self.zeta, self.r, strict=True)])

    @property
    def inertia(self) -> Array:
        return self.across * np.eye(3) + (self.along - self.across) * np.outer(self.n, self.n)

    @property
    def mobility(self) -> Array:
        result = np.eye(6)
        result[3:, 3:] = np.linalg.inv(self.inertia)
        return result

    @property
    def free(self) -> Array:
        """Rates of (u, omega) without contact forces."""
        spin = -np.cross(self.omega, self.inertia @ self.omega)
        return np.array([*-Z, *np.linalg.solve(self.inertia, spin)])

    def jacobian(self, i: int) -> Array:
        return np.hstack([np.eye(3), -cross_matrix(self.arms[i])])

    def bias(self, i: int) -> Array:
        return np.cross(self.omega, self.zeta[i] * np.cross(self.omega, self.n))

    def accelerations(self, i: int, q: Array) -> Array:
        return self.jacobian(i) @ q + self.bias(i)

    def slip(self, i: int) -> Array:
        return (self.u + np.cross(self.omega, self.arms[i]))[:2]

    def lever(self) -> Array:
        """z x (a_2 - a_1): what unit drilling adds to the slip of the second contact."""
        return np.cross(Z, self.arms[1] - self.arms[0])[:2]

    def contact_wrench(self, i: int, force: Array, torque: Array) -> Array:
        """Wrench on (u, omega)."""
        return self.jacobian(i).T @ force + np.array([0.0, 0.0, 0.0, *torque])


@dataclass(frozen=True)
class Found:
    """An answer: closed contacts, which stick, whether rolling is held, and the normal forces."""

    closed: tuple[int, ...]
    sticks: tuple[bool, ...]
    held: bool
    normal: tuple[float, ...]


def enumerate_answers(case: Case) -> list[Found]:
    """All answers."""
    both = answers_on(case, (0, 1))
    found = [*both]
    for number in (0, 1):
        for answer, q in answers_on(case, (number,)):
            gap = case.accelerations(1 - number, q)[2]
            if answer.held:
                if not both:  # The other gap keeps still, but for rounding.
                    found.append((answer, q))
            elif gap >= 0.0:
                found.append((answer, q))
    result = [answer for answer, _ in found]
    if min(case.accelerations(i, case.free)[2] for i in (0, 1)) >= 0.0:
        result.append(Found((), (), False, ()))
    return result


def answers_on(case: Case, closed: tuple[int, ...]) -> list[tuple[Found, Array]]:
    """All answers that keep these contacts closed, with the rates of (u, omega)."""
    found = []
    can_stick = [(True, False) if case.ended[i] else (False,) for i in closed]
    patches = case.law.drills and len(closed) == 2
    for sticks in product(*can_stick):
        if patches and any(sticks) and not all(sticks):
            continue
        for rolling in (True, False) if case.stopped else (False,):
            for answer, q in with_status(case, closed, sticks, rolling):
                if not any(same(answer, other) for other, _ in found):
                    found.append((answer, q))
    return found


def same(a: Found, b: Found) -> bool:
    return (a.closed, a.sticks, a.held) == (b.closed, b.sticks, b.held) and bool(
        np.allclose(a.normal, b.normal, rtol=1e-6, atol=1e-9)
    )


def with_status(
    case: Case, closed: tuple[int, ...], sticks: tuple[bool, ...], held: bool
) -> list[tuple[Found, Array]]:
    """Answers in which these stick, and rolling is held or not."""
    single = len(closed) == 1
    begins = [case.ended[i] and not s for i, s in zip(closed, sticks, strict=True)]
    scale = case.law.radius if case.law.drills else 1.0
    # Directions: of slip that begins, then of rolling that begins on one contact.
    if not any(begins):
        slips = 0
    elif single:
        slips = 3 if case.law.drills else 2
    elif all(begins):
        slips = 3
    else:
        slips = 1 if all(case.ended) else 2
    rolls = 0
    if case.stopped and not held:
        rolls = 2 if single else 1

    def motion(ways: Sequence[Array]) -> tuple[Array, Array, Array, list[Array], Array]:
        """Normal forces, multipliers of what is held, q', friction columns, held rows."""
        slip, turn = ways[0] if slips else None, ways[-1] if rolls else None
        columns = []
        for k, i in enumerate(closed):
            force, torque = Z.copy(), np.zeros(3)
            if not sticks[k]:
                if not case.ended[i]:
                    v, w = case.slip(i), case.omega[2]
                else:
                    assert slip is not None
                    v, w = direction(k, slip)
                pull, moment = case.law.traction(v, w)
                force[:2] += pull
                torque[2] += moment
            if case.eps is not None and not held:
                if not case.stopped:
                    way = case.omega[:2] if single else case.e[:2] * (case.omega @ case.e)
                else:
                    assert turn is not None
                    way = turn if single else turn[0] * case.e[:2]
                torque[:2] -= case.eps * unit(way)
            columns.append(case.contact_wrench(i, force, torque))
        rows, biases = [], []
        for k, i in enumerate(closed):
            if sticks[k]:
                rows += [*case.jacobian(i)[:2]]
                biases += [*case.bias(i)[:2]]
        if case.law.drills and any(sticks):
            rows.append(np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
            biases.append(0.0)
        if held:
            axes = np.eye(3)[:2] if single else [case.e]
            rows += [np.array([0.0, 0.0, 0.0, *axis]) for axis in axes]
            biases += [0.0 for _ in axes]
        count = len(rows)
        wrenches = np.array([*rows, *columns]).T
        rows += [case.jacobian(i)[2] for i in closed]
        biases += [case.bias(i)[2] for i in closed]
        matrix = np.array(rows)
        p = np.linalg.lstsq(
            matrix @ case.mobility @ wrenches, -matrix @ case.free - biases, rcond=1e-11
        )[0]
        q = case.free + case.mobility @ wrenches @ p
        return p[count:], p[:count], q, columns, np.array(rows[:count])

    def direction(k: int, slip: Array) -> tuple[Array, float]:
        """Slip and drilling of the k-th closed contact for a direction."""
        if single:
            return slip[:2], (slip[2] / scale if case.law.drills else 0.0)
        if slips == 3:
            w = slip[2] / scale
            return slip[:2] + k * w * case.lever(), w
        if slips == 2:  # The first begins, the second slips on.
            return slip[:2], 0.0
        sign = slip[0] * (1.0 if k == 1 else -1.0)
        return sign * case.lever(), 0.0

    def rates(q: Array) -> list[Array]:
        """Rates of the velocities that begin."""
        result = []
        if slips:
            if single or slips == 2:
                at = case.accelerations(closed[0], q)[:2]
                result.append(np.array([*at, scale * q[5]]) if slips == 3 else at)
            elif slips == 3:
                result.append(np.array([*case.accelerations(0, q)[:2], scale * q[5]]))
            else:
                result.append(np.array([q[5]]))
        if rolls:
            result.append(q[3:5] if single else np.array([q[3:] @ case.e]))
        return result

    found = []
    dims = [d for d in (slips, rolls) if d]
    for ways in solutions(dims, lambda ways: rates(motion(ways)[2])):
        normal, p, q, _, _ = motion(ways)
        if normal.min() <= 0.0:
            continue
        if any(rate @ way < 0.0 for rate, way in zip(rates(q), ways, strict=True)):
            continue
        if any(sticks) and not can_hold_slip(case, closed, sticks, normal, p):
            continue
        if held and not can_hold_rolling(case, normal, p[-2 if single else -1 :]):
            continue
        found.append((Found(closed, sticks, held, tuple(normal)), q))
    return found


def can_hold_rolling(case: Case, normal: Array, couple: Array) -> bool:
    assert case.eps is not None
    return bool(np.linalg.norm(couple) <= case.eps * normal.sum())


def can_hold_slip(
    case: Case, closed: tuple[int, ...], sticks: tuple[bool, ...], normal: Array, p: Array
) -> bool:
    """By virtual power: friction can take at least that of what holds, in every direction."""
    law, both = case.law, all(sticks) and len(sticks) == 2
    if not law.drills and not both:
        at = normal[sticks.index(True)]
        return bool(np.hypot(*p[:2]) <= law.mu * at)
    scale = law.radius if law.drills else 1.0
    lever = case.lever() if both else np.zeros(2)

    def spare(x: Array) -> float:
        v, w = x[:2], x[2] / scale
        total = 0.0
        for k in range(len(closed)):
            slip = v + k * w * lever
            if law.drills or np.hypot(*slip) > 0.0:
                force, torque = law.traction(slip, w)
                total -= normal[k] * float(force @ slip + torque * w)
            total -= float(p[2 * k : 2 * k + 2] @ slip)
        if law.drills:
            total -= float(p[2 * len(closed)] * w)
        return total / float(np.linalg.norm(x))

    starts = sphere(300)
    values = [spare(x) for x in starts]
    if min(values) < 0.0:
        return False
    for k in np.argsort(values)[:3]:
        best = minimize(spare, starts[k], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 0})
        if best.fun < 0.0:
            return False
    return True


def sphere(count: int) -> Array:
    """Points all over the unit sphere, in a spiral."""
    k = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * k / count, np.pi * (1.0 + 5.0**0.5) * k
    s = np.sqrt(1.0 - z * z)
    return np.array([s * np.cos(turn), s * np.sin(turn), z]).T


def starts_of(dims: Sequence[int]) -> list[list[Array]]:
    lone = len(dims) == 1
    each = []
    for dim in dims:
        angles = 2.0 * np.pi * (np.arange(48 if lone else 12) + 0.13) / (48 if lone else 12)
        circle = np.array([np.cos(angles), np.sin(angles)]).T
        each.append(circle if dim == 2 else sphere(200 if lone else 50))
    return [list(ways) for ways in product(*each)]


Rates = Callable[[Sequence[Array]], list[Array]]


def solutions(dims: Sequence[int], rates: Rates) -> list[list[Array]]:
    """Directions e with A(e) parallel to e, of all velocities that begin; on a line both ways."""
    lines = [k for k, dim in enumerate(dims) if dim == 1]
    result = []
    for signs in product((1.0, -1.0), repeat=len(lines)):
        fixed = {k: np.array([sign]) for k, sign in zip(lines, signs, strict=True)}

        def joined(ways: Sequence[Array], fixed: dict[int, Array] = fixed) -> list[Array]:
            free = iter(ways)
            return [fixed[k] if k in fixed else next(free) for k in range(len(dims))]

        def turning(ways: Sequence[Array], fixed: dict[int, Array] = fixed) -> list[Array]:
            return [rate for k, rate in enumerate(rates(joined(ways))) if k not in fixed]

        result += [joined(ways) for ways in turned([d for d in dims if d > 1], turning)]
    return result


def turned(dims: Sequence[int], rates: Rates) -> list[list[Array]]:
    """The same for directions in a plane or in space."""
    if not dims:
        return [[]]
    bounds = np.cumsum([0, *dims])

    def parts_of(x: Array) -> list[Array]:
        return [x[a:b] for a, b in pairwise(bounds)]

    def residual(x: Array) -> Array:
        """None across e, and length 1 of x along it."""
        parts = parts_of(x)
        ways = [unit(part) for part in parts]
        off = [
            (rate - (rate @ e) * e) / np.linalg.norm(rate) + (raw @ raw - 1.0) * e
            for raw, e, rate in zip(parts, ways, rates(ways), strict=True)
        ]
        return np.concatenate(off)

    starts = [np.concatenate(ways) for ways in starts_of(dims)]
    sizes = np.array([np.linalg.norm(residual(x)) for x in starts])
    result: list[list[Array]] = []
    for k in np.argsort(sizes)[:24]:
        solved = root(residual, starts[k], options={"xtol": 1e-14, "maxfev": 150})
        if np.linalg.norm(residual(solved.x)) > 1e-10:
            continue
        ways = [unit(part) for part in parts_of(solved.x)]
        if not any(
            all(np.linalg.norm(a - b) < 1e-6 for a, b in zip(ways, other, strict=True))
            for other in result
        ):
            result.append(ways)
    return result
