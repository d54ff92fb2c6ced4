"""An impact of one surface while another touches the table, and is pressed onto it.

With the normal impulse p of the striking contact as time (see `impact`), the other contact j has

    0 <= dp_j,    0 <= dv_nj,    dp_j dv_nj = 0    while its normal velocity v_nj is zero,

and none of its own while it is open. At both, friction follows the law along the way.
"""

from collections.abc import Callable
from typing import NamedTuple

from tippetop.mechanics.contact_pair import Tops
from tippetop.mechanics.coulomb import RollingResistance
from tippetop.mechanics.impact import Impact
from tippetop.mechanics.impulse import Striking, contact_velocity
from tippetop.mechanics.integrated_impact import MOST, STUCK, TOLERANCE
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import angular_velocity, moment_per_normal_force
from tippetop.mechanics.rolling import is_set_valued
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.runge_kutta import POWER, Point, step_from
from tippetop.mechanics.state import State
from tippetop.mechanics.surface import contact_vector
from tippetop.mechanics.vectors import Vector, add, length, scale

OPEN = 1e-9
"""Normal velocity of a contact that is closed, and slip that has ended, in units of what strikes."""


class SlipEnds(ArithmeticError):
    """Slip, or rolling, ends under a law that then leaves what resists it open."""


class StruckOnTwo(NamedTuple):
    """A body at the start of such an impact, floats.

    The numbers that an impact changes are the impulses that change angular momentum and velocity, the normal
    impulses of both contacts, and the first one's work.
    """

    state: State
    """Its state."""
    tops: Tops
    """The top with the striking surface active, and with the one that touches."""
    arms: tuple[Vector, Vector]
    """Their contact vectors, m."""
    points: tuple[Vector, Vector]
    """Velocities of both contact points, m/s."""

    @property
    def speed(self) -> float:
        """Speed of what strikes, m/s."""
        return -float(self.points[0][2])

    @property
    def longest(self) -> float:
        """Longest step of the clock in which slip that friction takes decays smoothly."""
        struck = (Striking.of(self.state, top).response for top in self.tops)
        return 2.0 / float(sum(response[0][0] + response[1][1] for response in struck))

    def after(self, here: Point) -> State:
        """The state after these impulses."""
        momentum = add(self.state.momentum, (here[0], here[1], here[2]))
        return self.state._replace(
            momentum=momentum, velocity=add(self.state.velocity, (here[3], here[4], here[5]))
        )

    def change(self, here: Point) -> tuple[Vector, Vector]:
        """Change of the velocities of both contact points by these impulses, whose digits it keeps."""
        moved = self.state._replace(
            momentum=(here[0], here[1], here[2]), velocity=(here[3], here[4], here[5])
        )
        one, other = (contact_velocity(moved, arm, self.tops[0]) for arm in self.arms)
        return one, other

    def velocities(self, here: Point) -> tuple[Vector, Vector]:
        """Velocities of both contact points after these impulses."""
        one, other = map(add, self.points, self.change(here))
        return one, other

    def slope(self, here: Point, *, pressed: bool) -> Point:
        """Rate of the numbers in a clock in which slip that ends decays exponentially."""
        state, top = self.after(here), self.tops[0]
        omega = angular_velocity(state.axis, state.momentum, top)
        points = self.velocities(here)
        pace, units, responses = 1.0 / self.speed, [], []
        if isinstance(top.friction, RollingResistance):
            lever = length(self.arms[0])
            rolling = lever * length((*omega[:2], 0.0))
            if rolling < OPEN * self.speed:
                raise SlipEnds("rolling ends in an impact on two surfaces")
            pace += 2.0 * top.friction.length / (lever * rolling)
        touching = list(zip(points, self.arms, strict=True))
        for point, arm in touching if pressed else touching[:1]:
            if is_set_valued(top.friction) and length((*point[:2], 0.0)) < OPEN * self.speed:
                raise SlipEnds("slip ends in an impact on two surfaces")
            traction = top.friction.traction((point[0], point[1]), omega)
            slip, grip = length((*point[:2], 0.0)), length((*traction.force, 0.0))
            pace += grip / slip if slip else 0.0
            moment, force = moment_per_normal_force(arm, traction), (*traction.force, 1.0)
            units.append((*moment, *scale(1.0 / top.mass, force)))
            responses.append(self.change(units[-1]))
        share = max(0.0, -responses[0][1][2] / responses[1][1][2]) if pressed else 0.0
        rates = (*(a + share * b for a, b in zip(units[0], units[-1], strict=True)), 1.0, share, points[0][2])
        return tuple(rate / pace for rate in rates)

    def step(self, here: Point, step: float, *, pressed: bool) -> tuple[Point, float]:
        """The numbers after a step, and its error over the one allowed."""

        def slope(point: Point) -> Point:
            return self.slope(point, pressed=pressed)

        taken = step_from(here, slope(here), step, slope)
        doubt = taken.doubt(lambda error: max(map(length, self.change(error))))
        return taken.there, float(doubt / (TOLERANCE * self.speed))

    def until(self, here: Point, goal: Callable[[Point], float]) -> tuple[Point, int]:
        """The first numbers from given ones on at which the goal is not negative, and the steps to there.

        Raises
        ------
        ArithmeticError
            If it takes too many steps.
        """
        step, longest = 0.05 * self.tops[0].mass, self.longest
        for taken in range(MOST):
            lifted = self.velocities(here)[1][2]
            pressed = bool(lifted <= OPEN * self.speed)
            held = self.held(here, goal) if pressed else None
            if held is not None:
                return held, taken
            there, doubt = self.step(here, step, pressed=pressed)
            if doubt > 1.0:
                step *= max(0.1, 0.9 * doubt**POWER)
                continue
            ends = [goal]
            if not pressed:
                ends.append(lambda y: -self.velocities(y)[1][2])
            reached = [end for end in ends if end(there) >= 0.0]
            for end in reached:
                there = self._landing(here, step, end, there, pressed=pressed)
            if goal in reached and goal(there) >= -1e-12:
                return there, taken + 1
            here, step = there, min(longest, step * min(5.0, 0.9 * max(doubt, 1e-10) ** POWER))
        raise ArithmeticError("an impact on two surfaces does not come to its end")

    def held(self, here: Point, goal: Callable[[Point], float]) -> Point | None:
        """The rest if friction has come to hold both slips constant: a straight line.

        Where they change less along it than a step may err, a steep law would take many steps, and no other
        way.
        """
        rates = self.slope(here, pressed=True)
        unit = tuple(rate / rates[6] for rate in rates)
        (x, y, rise), (other_x, other_y, _) = self.change(unit)
        approach, shift = self.velocities(here)[0][2], length((x, y, 0.0)) + length((other_x, other_y, 0.0))
        if not shift < STUCK * rise:
            return None

        def along(q: float) -> Point:
            work = q * (approach + 0.5 * q * rise)
            return (*(a + q * b for a, b in zip(here[:8], unit[:8], strict=True)), here[8] + work)

        guess = self.speed / rise
        while goal(along(guess)) < 0.0:
            guess *= 2.0
        return along(crossing(lambda q: goal(along(q)), 0.0, guess))

    def _landing(
        self, here: Point, step: float, end: Callable[[Point], float], there: Point, *, pressed: bool
    ) -> Point:
        """Where within a step an end is reached, unless another one was before."""
        if end(there) < 0.0:
            return there
        part = crossing(lambda part: end(self.step(here, part, pressed=pressed)[0]), 0.0, step)
        return self.step(here, part, pressed=pressed)[0]


def impact_on_two(state: State, restitution: float, tops: Tops) -> Impact:
    """What an impact does to a body whose other surface touches the table, with no normal velocity.

    Parameters
    ----------
    state
        The state before, floats.
    restitution
        Poisson's coefficient e of the striking contact, between 0 and 1.
    tops
        The top with the striking surface active, and with the one that touches.

    Raises
    ------
    SlipEnds
        If slip ends under a law that then leaves the force open.
    ArithmeticError
        If it takes too many steps.
    """
    arms = tuple(contact_vector(state.axis, top.surface) for top in tops)
    points = tuple(contact_velocity(state, arm, tops[0]) for arm in arms)
    body = StruckOnTwo(state, tops, (arms[0], arms[1]), (points[0], points[1]))
    compressed, steps = body.until((0.0,) * 9, lambda y: float(body.velocities(y)[0][2]) / body.speed)
    end = compressed
    if restitution > 0.0:
        full, stored = (1.0 + restitution) * compressed[6], -compressed[8]

        def goal(here: Point) -> float:
            spent, left = here[6] / full - 1.0, here[8] / stored
            return float(max(spent, left))

        end, more = body.until(compressed, goal)
        steps += more
    after = body.after(end)
    lost = max(0.0, float(energy(state, tops[0]) - energy(after, tops[0])))
    return Impact(after, end[6] + end[7], lost, compressed[6], steps)
