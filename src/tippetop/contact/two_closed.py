"""What follows where two surfaces touch and have no normal velocities, and slip ends or begins at
them.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tippetop.contact.double import SLOWEST_SLIP, on_two
from tippetop.contact.double_sticking import (
    SlipBeginningOnTwo,
    StickingAndSliding,
    StickingAndSlidingBack,
    StickingOnTwo,
)
from tippetop.contact.mode import Transition
from tippetop.contact.passing import Resting
from tippetop.contact.rules import rests
from tippetop.contact.surfaces import number_of
from tippetop.mechanics.beginning import settling
from tippetop.mechanics.branches import off_branch, on_branch
from tippetop.mechanics.contact_pair import (
    ContactPair,
    Tops,
    apart,
    at_rest,
    slip_apart,
    slips_of,
    turning_along,
    without_tilting,
)
from tippetop.mechanics.contacts.system import free_rates, rates_under
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.pair_resolver import Resolution, resolution, rolling_of_slip
from tippetop.mechanics.rolling import directions_of, is_set_valued, slip_length, spun_up
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import is_rolling, least_slip, size, slip_of
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import scale
from tippetop.mechanics.wrench import Slip

if TYPE_CHECKING:
    from tippetop.contact.several import OnSeveral

TOGETHER = 30.0
"""How many times `SLOWEST_SLIP` the slip of the other contact may be where it ends on one to end
with it.
"""

ABOUT = 1.0 + 1e-3
"""The same of slip that ends on both at once: what is left of it is known to rounding of the
velocities.
"""

FIRST, SECOND, BOTH, NEITHER = "first", "second", "both", "neither"

OPENS, HELD, CLOSES = "opens", "held", "closes"


@dataclass(frozen=True)
class TwoClosed:
    """Two contacts that are closed and have no normal velocities."""

    rules: "OnSeveral"
    """The rules of the body."""
    tops: Tops
    """The top with either surface active; if slip has ended on one, that comes first."""
    state: State
    """The state, in which slip, and rolling, that has ended is zero."""
    ended: tuple[bool, bool]
    """On which contacts it has."""
    rolls: float
    """Sign of omega_e; 0 where rolling has ended, or is not resisted."""
    pair: ContactPair
    """The contact points."""

    @classmethod
    def of(
        cls,
        rules: "OnSeveral",
        state: State,
        tops: Tops,
        rolls: float,
        ended: tuple[bool, bool] | None = None,
    ) -> "TwoClosed":
        """The contacts in a state that has slip, or tilts, by no more than what is taken for
        none.
        """
        tops = off_branch(tops[0]), off_branch(tops[1])
        # What sticks does not slip because tilting has ended: that is held, too.
        ended = ended_slips(state, tops) if ended is None else ended
        state = without_tilting(state, tops[0])
        if ended == (False, True):
            tops, ended = tops[::-1], ended[::-1]
        pair = ContactPair.of(state.axis, state.momentum, tops)
        stopped = tops[0].resists_rolling and not rolls
        if any(ended) or stopped:
            momentum, velocity = at_rest(pair, state.velocity, ended, stopped=stopped)
            state = state._replace(momentum=momentum, velocity=velocity)
            pair = ContactPair.of(state.axis, state.momentum, tops)
        return cls(rules, tops, state, ended, rolls, pair)

    @property
    def stopped(self) -> bool:
        """Whether rolling has ended."""
        return self.tops[0].resists_rolling and not self.rolls

    @property
    def xi(self) -> Slip:
        """How they slip."""
        if self.ended[0]:
            return (0.0, 0.0, 0.0 if self.ended[1] else slip_apart(self.pair))
        slip = slip_of(*along_table(self.state), self.tops[0])
        return (slip[0], slip[1], slip_apart(self.pair))

    def resolved(self) -> Resolution:
        """How both go on while they stay closed."""
        return resolution(self.pair, self.xi, self.ended, self.rolls)

    def consistent(self, found: Resolution) -> list[str]:
        """Which contacts may stay closed: exactly one candidate is expected.

        Where rolling is held, what one contact may do alone both may; else that which is pressed
        the more.
        """
        normal, free = found.motion.normal, free_rates(self.pair).points
        candidates = [BOTH] if normal[0] > 0.0 and normal[1] > 0.0 else []
        if self.stopped and candidates and not found.rolls:
            return candidates
        ways = [self._alone(number) for number in (0, 1)]
        held = [number for number in (0, 1) if ways[number] == HELD]
        if held and not candidates:
            return [(FIRST, SECOND)[max(held, key=lambda number: normal[number])]]
        candidates += [
            name for way, name in zip(ways, (FIRST, SECOND), strict=True) if way == OPENS
        ]
        return candidates + ([NEITHER] if min(free[0][2], free[1][2]) >= 0.0 else [])

    def _alone(self, number: int) -> str:
        """What the other contact does where one alone is pressed: opens, or is held as it is."""
        point = self.pair[number]
        if point.free.point[2] >= 0.0:
            return CLOSES
        slip = None if self.ended[number] else slip_of(*along_table(self.state), self.tops[number])
        found, _ = settling(point, slip, None if self.stopped else point.turning[:2])
        if found.wrench.force[2] <= 0.0:
            return CLOSES
        if found.rolling is None:
            return HELD
        rates = rates_under(self.pair, [(number, found.wrench)], free_rates(self.pair))
        opens = rates.points[1 - number][2] >= 0.0
        return OPENS if opens else CLOSES

    def going_on(self, found: Resolution) -> Transition:
        """The mode in which both go on."""
        if found.rolls != self.rolls:
            return self._rolling(found.rolls).going_on(found)
        if found.begins is not None:
            return self.letting_go(found)
        if not any(found.sticks):
            rules = self.rules.on(number_of(self.tops[0]))
            return Transition((), on_two(self.state, rules, self.tops[1], self.rolls), self.state)
        if all(found.sticks):
            patches = self.rolls and slip_length(self.tops[0].friction) is not None
            least = rolling_of_slip(self.pair, self.rolls) if patches else -1.0
            mode = StickingOnTwo(self.tops[0], self.rules, self.tops[1], self.rolls, least)
            still = rests(self.state, *found.motion.rates.turning)
            return Transition(
                (), Resting(self.tops[0], self.rules, mode) if still else mode, self.state
            )
        return Transition((), self._turning(self.tops, self.xi[2]), self.state)

    def _turning(self, tops: Tops, zeta: float) -> StickingAndSliding:
        """The mode in which the first of these contacts sticks, and the second slips so."""
        return (StickingAndSliding if zeta >= 0.0 else StickingAndSlidingBack)(
            tops[0], self.rules, tops[1], self.rolls
        )

    def _rolling(self, rolls: float) -> "TwoClosed":
        """The same where rolling has begun."""
        least = 2.0 * least_slip(*along_table(self.state), self.tops[0])
        change = scale(rolls * least, directions_of(self.state.axis)[0])
        state = self.state._replace(
            momentum=spun_up(self.state.axis, self.state.momentum, change, self.tops[0])
        )
        pair = ContactPair.of(state.axis, state.momentum, self.tops)
        return replace(self, state=state, rolls=rolls, pair=pair)

    def letting_go(self, found: Resolution, growing: int = 1) -> Transition:
        """The mode in which slip begins, with some power of time."""
        assert found.begins is not None
        if any(found.sticks):
            least = 2.0 * least_slip(*along_table(self.state), self.tops[0])
            tops = self.tops if found.sticks[0] else self.tops[::-1]
            sign = found.begins[2] if found.sticks[0] else -found.begins[2]
            change = (0.0, 0.0, found.begins[2] * least / apart(self.pair))
            momentum = spun_up(self.state.axis, self.state.momentum, change, self.tops[0])
            turning = self._turning(tops, sign)
            return Transition((), turning, turning.state((*self.state.axis, *momentum)))
        begin = (*self.state.axis, *self.state.momentum, 0.0, 0.0, self.xi[2])
        slips = slips_of(self.pair, found.begins)
        one, other = (on_branch(top, slip) for top, slip in zip(self.tops, slips, strict=True))
        way = found.begins if all(self.ended) else found.begins[:2]
        mode = SlipBeginningOnTwo(one, self.rules, other, self.rolls, begin, way, growing)
        return Transition((), mode, mode.state(begin))


def rolling_of(state: State, top: Top) -> float:
    """Sign of omega_e where rolling is resisted and goes on; else 0."""
    if not top.resists_rolling or not is_rolling(state.axis, state.momentum, top):
        return 0.0
    return (
        1.0 if turning_along(ContactPair.of(state.axis, state.momentum, (top, top))) > 0.0 else -1.0
    )


def ended_slips(state: State, tops: Tops) -> tuple[bool, bool]:
    """On which contacts slip has ended: on both at once where drilling is resisted too."""
    if not is_set_valued(tops[0].friction):
        return False, False
    one, other = (size(slip_of(*along_table(state), top)) for top in tops)
    least, limit = min(one, other), ABOUT * SLOWEST_SLIP
    if slip_length(tops[0].friction) is not None:
        return (True, True) if one * one + other * other <= limit * limit else (False, False)
    if least > limit:
        return False, False
    return one <= TOGETHER * limit, other <= TOGETHER * limit
