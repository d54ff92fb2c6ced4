"""Moreau's time-stepping, the textbook method for unilateral contact with set-valued friction.

A step moves the body freely for its first half, gives all impulses of contact at once, and moves
it freely for the second half (J. J. Moreau, 1988). Impulses come by projections onto the ball of
friction: the ellipsoidal limit surface, or the disc of Coulomb's law.
"""

import math

import numpy as np

import tippetop as tt
from tippetop.engines.adapters.base import Array, EngineState, Setting, no_rolling
from tippetop.engines.bodies import primitives
from tippetop.engines.cases import Case
from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS

CLOSE = 1e-10
"""Change of the impulses between two rounds at which they are taken, relative to the normal one."""

ROUNDS = 500
"""Rounds at most."""


class Moreau:
    """Moreau's time-stepping as textbooks have it, here."""

    name = "Moreau"
    package = None
    module = None
    settings = (
        Setting(
            "textbook",
            "midpoint, plastic or Newton's impact law, Gauss-Seidel by projections",
            "J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988",
            {},
        ),
    )

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""
        if isinstance(case.problem.friction, tt.ViscousFriction):
            return "only set-valued friction"
        shapes = primitives(case.problem.body, ellipsoids=False)
        if shapes is None or any(shape.kind != "sphere" for shape in shapes):
            return "only spheres"
        return no_rolling(case)

    def start(self, case: Case, step: float, setting: Setting) -> "MoreauStepper":
        """Return a case at its launch, with steps of this length, s."""
        return MoreauStepper(case.problem, step)


class MoreauStepper:
    """A body of spheres under way; plain numbers in lists, which are fast for three components."""

    def __init__(self, problem: tt.Problem, step: float) -> None:
        body, friction, start = problem.body, problem.friction, problem.start()
        self.step = step
        self.mass, self.I1, self.I3 = body.mass, body.I1, body.I3
        self.gravity = np.array(problem.gravity_vector)
        self.rebound = problem.contact.restitution
        shapes = primitives(body, ellipsoids=False) or ()
        self.balls = [(shape.sizes[0], shape.center) for shape in shapes]
        self.mu = float(getattr(friction, "mu", 0.0))
        self.patch = ELLIPSOIDAL_RADIUS * float(getattr(friction, "patch_radius", 0.0))
        self.n = np.array([float(x) for x in start.axis])
        self.L = np.array([float(x) for x in start.momentum])
        self.u = np.array([float(x) for x in start.velocity])
        self.z = float(start.height)
        self.held = [np.zeros(4) for _ in self.balls]

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        for _ in range(steps):
            self._move(0.5 * self.step)
            self.u += self.step * self.gravity
            self._impulses()
            self._move(0.5 * self.step)

    def read(self) -> EngineState:
        """Return the state."""
        omega = self.L / self.I1 + (1.0 / self.I3 - 1.0 / self.I1) * (self.L @ self.n) * self.n
        return EngineState(self.n.copy(), omega, self.u.copy(), self.z)

    def close(self) -> None:
        """Hold nothing."""

    def _move(self, time: float) -> None:
        """Move freely: the axis goes round the angular momentum evenly."""
        self.z += time * float(self.u[2])
        size = math.sqrt(float(self.L @ self.L))
        if size == 0.0:
            return
        about, angle = self.L / size, size * time / self.I1
        c, s = math.cos(angle), math.sin(angle)
        n = c * self.n + s * np.cross(about, self.n) + (1.0 - c) * (about @ self.n) * about
        self.n = n / math.sqrt(float(n @ n))

    def _impulses(self) -> None:
        """Give the impulses of all contacts that are closed in the middle of the step."""
        contacts = []
        across, along = 1.0 / self.I1, 1.0 / self.I3 - 1.0 / self.I1
        for number, (radius, center) in enumerate(self.balls):
            if self.z + center * self.n[2] > radius:
                self.held[number] = np.zeros(4)
                continue
            x, y, z = center * self.n[0], center * self.n[1], center * self.n[2] - radius
            turns = np.array([[0.0, z, -y], [-z, 0.0, x], [0.0, 0.0, self.patch], [y, -x, 0.0]])
            contacts.append((number, turns))
        if not contacts:
            return
        forces = np.array([[1.0, 0, 0], [0, 1.0, 0], [0, 0, 0], [0, 0, 1.0]])
        linear = np.vstack([forces] * len(contacts))
        angular = np.vstack([turns for _, turns in contacts])
        spun = across * angular + along * np.outer(angular @ self.n, self.n)
        D = linear @ linear.T / self.mass + angular @ spun.T
        omega = across * self.L + along * (self.L @ self.n) * self.n
        free = linear @ self.u + angular @ omega
        if self.rebound:
            before = free[3::4] - self.step * self.gravity[2]
            free[3::4] += self.rebound * np.minimum(before, 0.0)
        impulse = np.concatenate([self.held[number] for number, _ in contacts])
        impulse = self._solved(D, free, impulse)
        for k, (number, _) in enumerate(contacts):
            self.held[number] = impulse[4 * k : 4 * k + 4]
        self.u = self.u + linear.T @ impulse / self.mass
        self.L = self.L + angular.T @ impulse

    def _solved(self, D: Array, free: Array, impulse: Array) -> Array:
        """Return the impulses, by rounds between normal ones and the ball of friction."""
        rows, start, p = D.tolist(), free.tolist(), impulse.tolist()
        size, count = len(p), 3 if self.patch else 2
        indices = range(size)
        weights = [
            1.0 / float(np.linalg.eigvalsh(D[k : k + count, k : k + count])[-1])
            for k in range(0, size, 4)
        ]
        for _ in range(ROUNDS):
            worst = 0.0
            for k in range(0, size, 4):
                row = rows[k + 3]
                up = p[k + 3] - (start[k + 3] + sum([row[j] * p[j] for j in indices])) / row[k + 3]
                up = max(0.0, up)
                worst = max(worst, abs(up - p[k + 3]) - CLOSE * up)
                p[k + 3] = up
                trial = [
                    p[i] - weights[k // 4] * (start[i] + sum([rows[i][j] * p[j] for j in indices]))
                    for i in range(k, k + count)
                ]
                length = math.sqrt(sum([t * t for t in trial]))
                share = min(1.0, self.mu * up / length) if length else 0.0
                for i, t in enumerate(trial, k):
                    worst = max(worst, abs(share * t - p[i]) - CLOSE * up)
                    p[i] = share * t
            if worst <= 0.0:
                break
        return np.array(p)
