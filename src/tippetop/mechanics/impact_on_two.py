"""An impact of one surface while another touches the table, and is pressed onto it.

With the normal impulse p of the striking contact as time (see `impact`), the other contact j has

    0 <= dp_j,    0 <= dv_nj,    dp_j dv_nj = 0    while its normal velocity v_nj is zero,

and none of its own while it is open. At both, friction follows the law along the way.
"""

from typing import NamedTuple, Self

from tippetop.mechanics.contact_pair import Tops
from tippetop.mechanics.impact import Impact
from tippetop.mechanics.impulse import Goal, Striking, contact_velocity, first_reach
from tippetop.mechanics.integrated_impact import STUCK, TOLERANCE, integrated
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import angular_velocity, moment_per_normal_force
from tippetop.mechanics.rolling import is_set_valued
from tippetop.mechanics.runge_kutta import Point, RungeKuttaStep
from tippetop.mechanics.state import State
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

    bodies: tuple[Striking, Striking]
    """The body, struck at what strikes, and at what touches."""
    pressed: bool = True
    """Whether the other contact is closed."""

    @property
    def speed(self) -> float:
        """Speed of what strikes, m/s."""
        return -float(self.bodies[0].before[2])

    @property
    def longest(self) -> float:
        """Longest step of the clock in which slip that friction takes decays smoothly."""
        return 2.0 / float(sum(body.response[0][0] + body.response[1][1] for body in self.bodies))

    def after(self, here: Point) -> State:
        """The state after these impulses."""
        state = self.bodies[0].state
        momentum = add(state.momentum, (here[0], here[1], here[2]))
        return state._replace(momentum=momentum, velocity=add(state.velocity, (here[3], here[4], here[5])))

    def change(self, here: Point) -> tuple[Vector, Vector]:
        """Change of the velocities of both contact points by these impulses, whose digits it keeps."""
        moved = self.bodies[0].state._replace(
            momentum=(here[0], here[1], here[2]), velocity=(here[3], here[4], here[5])
        )
        one, other = (contact_velocity(moved, body.contact.arm, body.contact.top) for body in self.bodies)
        return one, other

    def velocities(self, here: Point) -> tuple[Vector, Vector]:
        """Velocities of both contact points after these impulses."""
        one, other = (
            add((body.before[0], body.before[1], body.before[2]), change)
            for body, change in zip(self.bodies, self.change(here), strict=True)
        )
        return one, other

    def settled(self, here: Point) -> Self:
        """The impact from some impulses on, whether or not the other contact is closed then."""
        pressed = bool(self.velocities(here)[1][2] <= OPEN * self.speed)
        return self if pressed == self.pressed else self._replace(pressed=pressed)

    def ends(self, goal: Goal) -> list[Goal]:
        """The goal, and that the other contact closes."""
        return [goal] if self.pressed else [goal, lambda here: -float(self.velocities(here)[1][2])]

    def slope(self, here: Point) -> Point:
        """Rate of the numbers in a clock in which slip that ends decays exponentially."""
        state, top = self.after(here), self.bodies[0].contact.top
        omega = angular_velocity(state.axis, state.momentum, top)
        points = self.velocities(here)
        pace, units, responses = 1.0 / self.speed, [], []
        if top.rolling_resistance is not None:
            lever = self.bodies[0].lever
            rolling = lever * length((*omega[:2], 0.0))
            if rolling < OPEN * self.speed:
                raise SlipEnds("rolling ends in an impact on two surfaces")
            pace += 2.0 * top.rolling_resistance.length / (lever * rolling)
        touching = list(zip(points, self.bodies, strict=True))
        for point, body in touching if self.pressed else touching[:1]:
            slip = length((*point[:2], 0.0))
            if is_set_valued(top.friction) and slip < OPEN * self.speed:
                raise SlipEnds("slip ends in an impact on two surfaces")
            traction = top.traction((point[0], point[1]), omega)
            pace += length((*traction.force, 0.0)) / slip if slip else 0.0
            moment = moment_per_normal_force(body.contact.arm, traction)
            units.append((*moment, *scale(1.0 / top.mass, (*traction.force, 1.0))))
            responses.append(self.change(units[-1]))
        share = max(0.0, -responses[0][1][2] / responses[1][1][2]) if self.pressed else 0.0
        rates = (*(a + share * b for a, b in zip(units[0], units[-1], strict=True)), 1.0, share, points[0][2])
        return tuple(rate / pace for rate in rates)

    def doubt(self, taken: RungeKuttaStep) -> float:
        """The error of a step over the one allowed."""
        return taken.doubt(lambda off: max(map(length, self.change(off)))) / (TOLERANCE * self.speed)

    def straight(self, here: Point, goal: Goal, guess: float, taken: int) -> tuple[Point, bool] | None:
        """The rest if friction has come to hold both slips constant.

        Where they change less along it than a step may err, a steep law would take many steps, and no other
        way.
        """
        if not self.pressed:
            return None
        rates = self.slope(here)
        unit = tuple(rate / rates[6] for rate in rates)
        (x, y, rise), (other_x, other_y, _) = self.change(unit)
        approach, shift = self.velocities(here)[0][2], length((x, y, 0.0)) + length((other_x, other_y, 0.0))
        if not shift < STUCK * rise:
            return None

        def along(q: float) -> Point:
            work = q * (approach + 0.5 * q * rise)
            return (*(a + q * b for a, b in zip(here[:8], unit[:8], strict=True)), here[8] + work)

        return first_reach(along, goal, self.speed / rise), True


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
    body = StruckOnTwo((Striking.of(state, tops[0]), Striking.of(state, tops[1])))
    begin, guess = (0.0,) * 9, 1.0
    compressed, steps = integrated(body, begin, lambda y: body.velocities(y)[0][2] / body.speed, guess)
    end = compressed
    if restitution > 0.0:
        full, stored = (1.0 + restitution) * compressed[6], -compressed[8]
        end, more = integrated(body, compressed, lambda y: max(y[6] / full - 1.0, y[8] / stored), guess)
        steps += more
    then = body.after(end)
    lost = max(0.0, float(energy(state, tops[0]) - energy(then, tops[0])))
    return Impact(then, end[6] + end[7], lost, compressed[6], steps)
