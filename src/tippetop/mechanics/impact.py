"""Impact of the body on the table, with the friction impulse that follows from the friction law.

An impact is too short for the body to move, so that its configuration, and the arm a from the centre of mass
to the contact point, stay fixed while its velocities jump. The normal impulse p plays the part of time (Routh
1905, Dynamics of a System of Rigid Bodies, Advanced Part, chapter 5; Stronge 2018, Impact Mechanics, chapter
4): where the sliding body feels the force N (z + f) and the torque N t, the struck one gains

    dP = (z + f) dp,        dL = (a x (z + f) + t) dp,        f, t = law(slip, angular velocity),

and the velocity w of its contact point changes by dw = M dP, with M the inverse inertia that the contact
feels, symmetric and positive definite. For viscous friction this is a linear equation, solved exactly; for
another law it is integrated (Glocker 2014, Meccanica 49, and Leine and Glocker 2003, Eur. J. Mech. A 22,
treat set-valued laws in the same setting).

*Compression* lasts until the normal velocity v_n returns to zero from below. It may sink first: where
friction presses the contact together more than p pushes it apart (Painleve's paradox), an impact starts even
at v_n = 0 and ends only when the slip has changed. It always ends, since M is positive definite and slip
that friction has stopped leaves dv_n/dp = M_nn - M_nt M_tt^-1 M_tn > 0.

*Restitution* is Poisson's: it lasts while p grows from the impulse of compression p_c to (1 + e) p_c, with
friction going on. With friction, that hypothesis may create energy: the slope dv_n/dp can be larger in
restitution than in compression, and then the normal impulse gives back more work than it took, even for
e < 1 (Stronge 1990). The work of the normal impulse, the integral of v_n dp, is therefore watched, and
restitution ends at once should it reach zero, which is the most that Stronge's energetic hypothesis allows.
As friction only takes (f.v + t.omega <= 0), no impact gains energy. Should v_n be negative at the end, which
friction that turns during restitution might do, the impact goes on until it is zero.

Jellett's integral is conserved: P acts at the fixed arm, and a.(a x P) = 0.
"""

import math
from collections.abc import Callable, Sequence
from operator import mul
from typing import NamedTuple, Protocol, TypeAlias

from tippetop.mechanics.flight import crossing
from tippetop.mechanics.friction import NO_TORQUE, Traction, ViscousFriction
from tippetop.mechanics.motion import angular_velocity, point_velocity
from tippetop.mechanics.shape import contact_vector
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, cross, dot, length, scale

TOLERANCE = 1e-9
"""Error of the slip in a step of the integration, relative to the slip."""

STUCK = 1e-8
"""How near the traction must be to the one that holds the slip constant to count as equal to it."""

SHORTEST = 1e-12
"""Step, relative to the longest, that is taken whatever its error: at a jump of the law."""

FUZZ = 1e-14
"""Round-off in the velocity of the contact point, relative to what it is made of."""


class Impact(NamedTuple):
    """What an impact did.

    Attributes
    ----------
    state
        The state after: same configuration, other velocities, with the work of the impact added to `work`.
    impulse
        Normal impulse p, N s.
    energy_lost
        Energy that the impact took, J: never negative.
    compression
        Normal impulse of compression p_c, N s.
    """

    state: State
    impulse: Scalar
    energy_lost: Scalar
    compression: Scalar


class Blow(NamedTuple):
    """What the table has done to the body so far.

    Attributes
    ----------
    push
        Normal impulse p, N s.
    rub
        Impulse of friction, N s.
    twist
        Impulse of the torque, N m s.
    normal_work
        Work of the normal impulse, J.
    """

    push: float
    rub: Horizontal
    twist: Vector
    normal_work: float


NO_BLOW = Blow(0.0, (0.0, 0.0), NO_TORQUE, 0.0)

Goal: TypeAlias = Callable[[Blow], float]
"""Negative as long as a phase of the impact lasts."""


class Striking(NamedTuple):
    """A body at the start of an impact, and how its contact point answers to an impulse.

    Attributes
    ----------
    state, top
        The body.
    arm
        Contact vector a, m.
    point
        Velocity of the contact point, m/s; a normal part that is but round-off is zero.
    answer
        Columns of M: velocity of the contact point per unit impulse along x, y and z, 1/kg.
    """

    state: State
    top: Top
    arm: Vector
    point: Vector
    answer: tuple[Vector, Vector, Vector]

    @classmethod
    def of(cls, state: State, top: Top) -> "Striking":
        """The body in this state."""
        arm = contact_vector(state.axis, top.shape)
        at_rest = state._replace(momentum=NO_TORQUE, velocity=NO_TORQUE)
        point = contact_velocity(state, arm, top)
        omega = angular_velocity(state.axis, state.momentum, top)
        if abs(point[2]) <= FUZZ * (length(state.velocity) + length(omega) * length(arm)):
            point = (point[0], point[1], 0.0)
        here = cls(state, top, arm, point, (NO_TORQUE, NO_TORQUE, NO_TORQUE))
        nudged = [
            contact_velocity(struck(at_rest, arm, unit, NO_TORQUE, top), arm, top)
            for unit in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        ]
        return here._replace(answer=(nudged[0], nudged[1], nudged[2]))

    def after(self, blow: Blow) -> State:
        """The state after a blow, its work left out."""
        return struck(self.state, self.arm, (*blow.rub, blow.push), blow.twist, self.top)

    def response(self, blow: Blow) -> Vector:
        """Change of the velocity of the contact point by a blow, m/s."""
        (x, y), p, (east, north, up) = blow.rub, blow.push, self.answer
        change = (
            x * east[0] + y * north[0] + p * up[0],
            x * east[1] + y * north[1] + p * up[1],
            x * east[2] + y * north[2] + p * up[2],
        )
        if blow.twist == NO_TORQUE:
            return change
        return add(change, cross(angular_velocity(self.state.axis, blow.twist, self.top), self.arm))

    def approach(self, blow: Blow) -> float:
        """Normal velocity of the contact point after a blow, m/s."""
        return float(self.point[2] + self.response(blow)[2])

    def friction(self, blow: Blow) -> tuple[Vector, Vector, Traction]:
        """Velocity of the contact point, angular velocity and traction after a blow."""
        omega = angular_velocity(self.state.axis, self.after(blow).momentum, self.top)
        point = add(self.point, self.response(blow))
        return point, omega, self.top.friction.traction((point[0], point[1]), omega)


class Course(Protocol):
    """How an impact runs under some friction law."""

    def until(self, blow: Blow, goal: Goal) -> Blow:
        """The first blow from a given one on at which the goal is not negative."""


def impact(state: State, restitution: float, top: Top) -> Impact:
    """What an impact does to a body that touches the table.

    Parameters
    ----------
    state
        The state before, floats.
    restitution
        Poisson's coefficient e between 0 and 1: normal impulse of restitution over that of compression.
    top
        The body and the friction law, floats.

    Raises
    ------
    ValueError
        If the coefficient of restitution is not between 0 and 1.
    """
    if not 0.0 <= restitution <= 1.0:
        raise ValueError(f"the coefficient of restitution must lie between 0 and 1, but is {restitution}")
    body = Striking.of(state, top)
    if not is_struck(body):
        return Impact(state, 0.0, 0.0, 0.0)
    law = top.friction
    course: Course = ViscousCourse.of(body, law) if isinstance(law, ViscousFriction) else LawfulCourse(body)

    compressed = course.until(NO_BLOW, body.approach)
    blow = compressed
    if restitution > 0.0:
        blow = course.until(compressed, restitution_goal(body, compressed, restitution))
    after = body.after(blow)
    lost = max(0.0, -work_of(blow, state, after, body))
    return Impact(after._replace(work=state.work - lost), blow.push, lost, compressed.push)


def restitution_goal(body: Striking, compressed: Blow, restitution: float) -> Goal:
    """Poisson's end of restitution, or that of the energy stored, but not before the body has stopped."""
    full = (1.0 + restitution) * compressed.push

    def goal(blow: Blow) -> float:
        spent = (blow.push - full) / compressed.push
        returned = -blow.normal_work / compressed.normal_work
        return float(min(max(spent, returned), body.approach(blow) / length(body.point)))

    return goal


def is_struck(body: Striking) -> bool:
    """Whether the contact point sinks into the table, or would, if the impact did not begin."""
    if body.point[2] != 0.0:
        return bool(body.point[2] < 0.0)
    traction = body.friction(NO_BLOW)[2]
    return body.approach(Blow(1.0, traction.force, traction.torque, 0.0)) < 0.0


def struck(state: State, arm: Vector, impulse: Vector, twist: Vector, top: Top) -> State:
    """The state after an impulse at the contact and an impulse of torque."""
    return state._replace(
        momentum=add(state.momentum, add(cross(arm, impulse), twist)),
        velocity=add(state.velocity, scale(1.0 / top.mass, impulse)),
    )


def contact_velocity(state: State, arm: Vector, top: Top) -> Vector:
    """Velocity of the body's contact point, m/s."""
    return point_velocity(state.velocity, angular_velocity(state.axis, state.momentum, top), arm)


def work_of(blow: Blow, before: State, after: State, body: Striking) -> float:
    """Work of a blow, J: impulse times mean velocity (Thomson and Tait), as velocities are linear in it."""
    omega = add(*(angular_velocity(state.axis, state.momentum, body.top) for state in (before, after)))
    point = add(body.point, contact_velocity(after, body.arm, body.top))
    return float(0.5 * (dot((*blow.rub, blow.push), point) + dot(blow.twist, omega)))


def first_reach(along: Callable[[float], Blow], goal: Goal, guess: float) -> Blow:
    """The blow at which the goal stops being negative, on a course where it does so once.

    Where the goal is zero at the start, it is about to become negative: that start is passed over.
    """
    high = guess
    while goal(along(high)) < 0.0:
        high *= 2.0
    low = 0.0 if goal(along(0.0)) < 0.0 else 0.5 * high
    while goal(along(low)) >= 0.0:
        low, high = 0.5 * low, low
    return along(crossing(lambda q: goal(along(q)), low, high))


class Mode(NamedTuple):
    """A direction in which slip, v' = coupling - mu stiffness v, answers to friction along itself only.

    Attributes
    ----------
    direction
        A unit vector, horizontal.
    stiffness, coupling
        Slip along it per unit impulse along it, and per unit normal impulse, 1/kg.
    slip
        Slip along it at the start, m/s.
    """

    direction: Horizontal
    stiffness: float
    coupling: float
    slip: float


class ViscousCourse(NamedTuple):
    """An impact with viscous friction, in closed form.

    With phi_1(x) = (1 - exp(-x)) / x and phi_(k+1) = (1/k! - phi_k) / x at x = mu stiffness p, the slip of a
    mode is exp(-x) slip + coupling p phi_1, its impulse of friction -mu (slip p phi_1 + coupling p^2 phi_2),
    and the integral of that over p is -mu (slip p^2 phi_2 + coupling p^3 phi_3).

    One mode lies across the plane of n and z and has no coupling, so that the slope of the normal velocity,
    M_nn - mu (coupling slip), is monotone with a positive limit: compression has one end, and the velocity
    keeps growing after it.
    """

    body: Striking
    mu: float
    modes: tuple[Mode, Mode]

    @classmethod
    def of(cls, body: Striking, law: ViscousFriction) -> "ViscousCourse":
        """The course of this body's impact, from the principal directions of its tangential answer."""
        east, north, up = body.answer
        angle = 0.5 * math.atan2(2.0 * east[1], east[0] - north[1])
        cosine, sine = math.cos(angle), math.sin(angle)

        def mode(x: float, y: float) -> Mode:
            stiffness = x * x * east[0] + 2.0 * x * y * east[1] + y * y * north[1]
            return Mode((x, y), stiffness, x * up[0] + y * up[1], x * body.point[0] + y * body.point[1])

        return cls(body, law.mu, (mode(cosine, sine), mode(-sine, cosine)))

    def until(self, blow: Blow, goal: Goal) -> Blow:
        """The first blow from a given one on at which the goal is not negative."""
        guess = length(self.body.point) / self.body.answer[2][2]
        return first_reach(lambda q: self.blow(blow.push + q), goal, guess)

    def blow(self, p: float) -> Blow:
        """The blow when the normal impulse is p."""
        rub = (0.0, 0.0)
        work = p * (self.body.point[2] + 0.5 * p * self.body.answer[2][2])
        for (x, y), stiffness, coupling, slip in self.modes:
            phi_1, phi_2, phi_3 = phis(self.mu * stiffness * p)
            impulse = -self.mu * p * (slip * phi_1 + coupling * p * phi_2)
            rub = (rub[0] + impulse * x, rub[1] + impulse * y)
            work -= self.mu * p * p * coupling * (slip * phi_2 + coupling * p * phi_3)
        return Blow(p, rub, NO_TORQUE, work)


def phis(x: float) -> tuple[float, float, float]:
    """phi_1, phi_2 and phi_3 of x >= 0, where phi_k = sum of (-x)^j / (j + k)! over j."""
    if x < 1.0:
        phi_3 = term = 1.0 / 6.0
        for j in range(4, 20):
            term *= -x / j
            phi_3 += term
        phi_2 = 0.5 - x * phi_3
        return 1.0 - x * phi_2, phi_2, phi_3
    phi_1 = -math.expm1(-x) / x
    phi_2 = (1.0 - phi_1) / x
    return phi_1, phi_2, (0.5 - phi_2) / x


Point: TypeAlias = tuple[float, ...]
"""The numbers of a blow in a row: p, impulse of friction, impulse of torque, normal work."""

NODES: tuple[tuple[float, ...], ...] = (
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
"""Weights of the stages of Dormand and Prince's method of order 5 (1980)."""

DOUBT = (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)
"""Weights of the stages in the error of a step of that method."""


class LawfulCourse(NamedTuple):
    """An impact under any friction law, integrated with slip as the clock.

    A law that is steep at small slip makes the equations stiff in p, as slip then changes fast. They are
    integrated over s instead, dp = ds / (|f|/|v| + 1/v_0) with v_0 the initial speed of the contact point:
    slip then decays at the rate of M however steep the law, and needs no more than some tens of units of s
    to fall by twenty orders of magnitude. Once friction has come to hold the slip constant, f = -M_tt^-1
    M_tn (less what a torque does), it stays so, and the rest of the course is a straight line; it is checked
    that the law agrees.
    """

    body: Striking

    def until(self, blow: Blow, goal: Goal) -> Blow:
        """The first blow from a given one on at which the goal is not negative."""
        waiting = goal(blow) >= 0.0
        here, slope = pack(blow), self.slope(pack(blow))
        longest = 2.0 / (self.body.answer[0][0] + self.body.answer[1][1])
        step = 0.05 * longest
        while True:
            held = self.held(unpack(here), goal)
            if held is not None:
                return held
            there, new_slope, doubt = self.step(here, slope, step)
            reached = goal(unpack(there)) >= 0.0
            if (doubt > 1.0 and step > SHORTEST * longest) or (reached and waiting):
                step *= min(0.5, max(0.1, 0.9 * doubt**-0.2))
                continue
            if reached:
                return self.landing(here, slope, step, goal)
            here, slope, waiting = there, new_slope, False
            step = min(longest, step * min(5.0, 0.9 * max(doubt, 1e-10) ** -0.2))

    def landing(self, here: Point, slope: Point, step: float, goal: Goal) -> Blow:
        """The blow within a step at which the goal is reached."""

        def along(part: float) -> Blow:
            return unpack(self.step(here, slope, part)[0])

        return along(crossing(lambda part: goal(along(part)), 0.0, step))

    def slope(self, here: Point) -> Point:
        """Rate of the blow's numbers with the clock s."""
        point, omega, (force, torque) = self.body.friction(unpack(here))
        slip, grip = math.hypot(point[0], point[1]), math.hypot(*force)
        if slip == 0.0:
            slip = 1e-12 * length(self.body.point)
            grip = math.hypot(*self.body.top.friction.traction((slip, 0.0), omega).force)
        pace = 1.0 / (grip / slip + 1.0 / length(self.body.point))
        return (pace, pace * force[0], pace * force[1], *scale(pace, torque), pace * point[2])

    def step(self, here: Point, slope: Point, step: float) -> tuple[Point, Point, float]:
        """The numbers and rates after a step, and the error of the step over the one allowed."""
        slopes = [slope]
        there = here
        for weights in NODES:
            there = combined(here, step, weights, slopes)
            slopes.append(self.slope(there))
        error = self.body.response(unpack(combined((0.0,) * len(here), step, DOUBT, slopes)))
        speed = length(self.body.point)
        slip = max(self.slip(here), self.slip(there), 1e-9 * speed)
        doubt = max(math.hypot(error[0], error[1]) / slip, abs(error[2]) / speed)
        return there, slopes[-1], doubt / TOLERANCE

    def slip(self, here: Point) -> float:
        """Slip speed, m/s."""
        change = self.body.response(unpack(here))
        return math.hypot(self.body.point[0] + change[0], self.body.point[1] + change[1])

    def held(self, blow: Blow, goal: Goal) -> Blow | None:
        """The rest of the course if friction holds the slip constant, if it does so all along."""
        (a, b, _), (_, d, _), _ = self.body.answer
        point, _, traction = self.body.friction(blow)
        x, y, _ = self.body.response(Blow(1.0, (0.0, 0.0), traction.torque, 0.0))
        holding = ((b * y - d * x) / (a * d - b * b), (b * x - a * y) / (a * d - b * b))
        fuzz = FUZZ * length(self.body.point) * math.hypot(*traction.force) / (math.hypot(*point[:2]) or 1.0)
        if math.dist(traction.force, holding) > STUCK + fuzz:
            return None
        rise = self.body.approach(Blow(1.0, holding, traction.torque, 0.0)) - self.body.point[2]

        def along(q: float) -> Blow:
            return Blow(
                blow.push + q,
                (blow.rub[0] + q * holding[0], blow.rub[1] + q * holding[1]),
                add(blow.twist, scale(q, traction.torque)),
                blow.normal_work + q * (point[2] + 0.5 * q * rise),
            )

        end = first_reach(along, goal, length(self.body.point) / self.body.answer[2][2])
        later = self.body.friction(end)[2]
        drift = math.dist((*later.force, *later.torque), (*traction.force, *traction.torque))
        return end if drift <= 2.0 * (STUCK + fuzz) else None


def combined(here: Point, step: float, weights: Sequence[float], slopes: Sequence[Point]) -> Point:
    """A point plus a step along a mean of slopes."""
    return tuple(
        x + step * sum(map(mul, weights, column))
        for x, column in zip(here, zip(*slopes, strict=True), strict=True)
    )


def pack(blow: Blow) -> Point:
    """The numbers of a blow in a row."""
    return (blow.push, *blow.rub, *blow.twist, blow.normal_work)


def unpack(y: Point) -> Blow:
    """The blow that has these numbers."""
    return Blow(y[0], (y[1], y[2]), (y[3], y[4], y[5]), y[6])
