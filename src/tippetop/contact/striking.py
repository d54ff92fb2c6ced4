"""An impact without restitution as a motion, in which the normal impulse plays the part of time.

It ends where the contact point stops sinking (see `tippetop.mechanics.impacts.impact`). The
executors of motions, of one launch and of many, follow it too, unless slip ends within the impact.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache

from tippetop.contact.guards import BRANCH, SLIP_SMALL
from tippetop.integrators.base import Guard, Integrator, Motion
from tippetop.integrators.dense import as_array
from tippetop.mechanics.contacts.branches import is_branched, on_branch, on_other_branch
from tippetop.mechanics.contacts.forces import is_set_valued, slip_length
from tippetop.mechanics.contacts.slip_variables import branch_guard, is_near, nearing_guard, slip_of
from tippetop.mechanics.impacts.impact import Impact
from tippetop.mechanics.impacts.struck_body import StruckBody, contact_velocity
from tippetop.mechanics.motion import along_table, angular_velocity, moment_per_normal_force
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar, add, cross, scale

SINKING = "sinking"

MOST_IMPULSE = 1e3
"""Normal impulse at most, in units of that which stops a point mass."""

MOST_PIECES = 50
"""Pieces that an impact may have, on one branch of the law each."""


def impact_of_patch(state: State, top: Top, integrator: Integrator | None) -> Impact | None:
    """Return the impact without restitution of a body that touches the table.

    None where this is no way to find it: there is no integrator, drilling is not resisted or
    rolling is, the contact point does not sink, or slip is about to end.
    """
    law = top.friction
    if top.resists_rolling or not is_set_valued(law) or slip_length(law) is None:
        return None
    body = StruckBody.of(state, top)
    if integrator is None or body.before[2] >= 0.0:
        return None
    if is_near(along_table(state), top):
        return None
    top = on_branch(top, slip_of(*along_table(state), top))
    impulse, moving, steps = 0.0, as_array((*state.momentum, *state.velocity)), 0
    longest = MOST_IMPULSE * top.mass * body.striking
    for _ in range(MOST_PIECES):
        motion = impact_motion(top.kind, ending=True)
        parameters = (*top.numbers, *state.axis)
        arc = next(integrator.integrate(motion, parameters, (impulse, moving), longest), None)
        if arc is None:
            return None
        impulse, moving, steps = arc.solution.end, arc.end_state, steps + arc.steps
        if arc.guard == SINKING:
            return impact_between(state, after(state, moving.tolist()), impulse, body)._replace(
                steps=steps
            )
        if arc.guard != BRANCH:
            return None
        top = on_other_branch(top)
    return None


def after(state: State, y: Sequence[float]) -> State:
    """Return a state with other momenta and velocities."""
    return state._replace(momentum=(y[0], y[1], y[2]), velocity=(y[3], y[4], y[5]))


def impact_between(before: State, later: State, normal: float, body: StruckBody) -> Impact:
    """Return the impact that leads from one state to another."""
    x, y, _ = scale(body.contact.top.mass, add(later.velocity, scale(-1.0, before.velocity)))
    moment = add(later.momentum, scale(-1.0, before.momentum))
    torque = add(moment, cross((x, y, normal), body.contact.arm))
    return Impact(later, normal, max(0.0, -body.work((x, y, normal, *torque, 0.0))), normal)


@lru_cache
def impact_motion(kind: Kind, *, ending: bool = False) -> Motion:
    """Return the equations of motion of a struck top, with the normal impulse as time.

    The parameters are its numbers and its axis, which does not move. If `ending`, slip that is
    about to end ends the motion.
    """

    def read(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[State, Top]:
        first, second, third = numbers[kind.numbers :]
        state = State((first, second, third), (y[0], y[1], y[2]), (y[3], y[4], y[5]), 0.0)
        return state, kind.top(tuple(numbers[: kind.numbers]))

    def guard(name: str, value: Callable[[State, Top], Scalar]) -> Guard:
        return Guard(name, lambda y, numbers: value(*read(y, numbers)))

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        state, top = read(y, numbers)
        arm = contact_vector(state.axis, top.surface)
        point = contact_velocity(state, arm, top)
        turning = angular_velocity(state.axis, state.momentum, top)
        traction = top.traction((point[0], point[1]), turning)
        return (
            *moment_per_normal_force(arm, traction),
            *scale(1.0 / top.mass, (*traction.force, 1.0)),
        )

    def sinking(state: State, top: Top) -> Scalar:
        return -contact_velocity(state, contact_vector(state.axis, top.surface), top)[2]

    def branch(state: State, top: Top) -> Scalar:
        return branch_guard(slip_of(*along_table(state), top), top)

    guards = [guard(SINKING, sinking)]
    if is_branched(kind.example.friction):
        guards.append(guard(BRANCH, branch))
    if ending:
        guards.append(guard(SLIP_SMALL, lambda state, top: nearing_guard(along_table(state), top)))
    return Motion(rates, size=6, parameters=kind.numbers + 3, guards=tuple(guards))
