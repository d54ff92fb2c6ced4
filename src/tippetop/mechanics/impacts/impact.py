"""Impact of the body on the table, with the friction impulse that follows from the friction law.

An impact is too short for the body to move, so that its configuration, and the arm a from the
centre of mass to the contact point, stay fixed while its velocities jump. The normal impulse p
plays the part of time (Routh 1905, Dynamics of a System of Rigid Bodies, Advanced Part, chapter 5;
Stronge 2018, Impact Mechanics, chapter 4): where the sliding body feels the force N (z + f) and the
torque N t, the struck one gains

    dP = (z + f) dp,        dL = (a x (z + f) + t) dp,        f, t = law(slip, angular velocity),

and the velocity v of its contact point changes by dv = M dP + (J t dp) x a, with J the inverse
inertia of the body and M that of the contact (Delassus matrix), symmetric and positive definite.
For viscous friction alone this is a linear equation, solved exactly; for another law it is
integrated (Glocker 2014, Meccanica 49, and Leine and Glocker 2003, Eur. J. Mech. A 22, treat
set-valued laws in the same setting).

*Compression* lasts until the normal velocity v_n returns to zero from below. It may sink first:
where friction presses the contact together more than p opens it (Painleve's paradox), an impact
starts even at v_n = 0 and ends only when the slip has changed. It always ends: while v_n < 0 the
kinetic energy falls, dT/dp = v_n + f.v + t.omega < 0, but the impulse would make it grow with p^2.

*Restitution* is Poisson's: it lasts while p grows from the impulse of compression p_c to (1 + e)
p_c, with friction going on. With friction, that hypothesis may create energy: the slope dv_n/dp can
be larger in restitution than in compression, and then the normal impulse gives back more work than
it took, even for e < 1 (Stronge 1990). The work of the normal impulse, the integral of v_n dp, is
therefore followed, and restitution ends at once should it reach zero, which is the most that
Stronge's energetic hypothesis allows. As friction only takes (f.v + t.omega <= 0), no impact gains
energy. Should v_n be negative at the end, which friction that turns during restitution might do,
the impact goes on until it is zero.

Jellett's integral is conserved: P acts at the fixed arm, and a.(a x P) = 0.
"""

# translate module: numbers

from typing import NamedTuple

from tippetop.mechanics.impacts.dry_impact import DryProcess, is_dry
from tippetop.mechanics.impacts.impact_on_two import ProcessOnTwo, SlipEndsInImpact
from tippetop.mechanics.impacts.process import ImpactProcess, SteppedProcess
from tippetop.mechanics.impacts.struck_body import NORMAL, WORK, Goal, Impulse, StruckBody
from tippetop.mechanics.impacts.viscous_impact import ViscousProcess
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar


class Impact(NamedTuple):
    """What an impact did."""

    state: State
    """The state after: same configuration, other velocities."""
    impulse: Scalar
    """Normal impulse of the table, N s: on all surfaces that touch."""
    energy_lost: Scalar
    """Energy that the impact took, J: never negative."""
    compression: Scalar
    """Normal impulse of compression p_c, N s: of what strikes."""
    steps: int = 0
    """How many steps it took to find them, where they are integrated."""


def impact(state: State, restitution: float, top: Top, beside: Top | None = None) -> Impact:
    """Return the impact of a body that touches the table.

    Parameters
    ----------
    state
        The state before, floats.
    restitution
        Poisson's coefficient e between 0 and 1: normal impulse of restitution over that of
        compression.
    top
        The body and the friction law, floats.
    beside
        The same with another surface active that touches too, with no normal velocity, and is
        pressed onto the table; None if none is.

    Raises
    ------
    ValueError
        If the coefficient of restitution is not between 0 and 1.
    SlipEndsInImpact
        If slip ends on one of two surfaces under a law that then leaves the force open.
    ArithmeticError
        If it takes too many steps.
    """
    if not 0.0 <= restitution <= 1.0:
        raise ValueError(
            f"the coefficient of restitution must lie between 0 and 1, but is {restitution:g}"
        )
    body = StruckBody.of(state, top)
    process = process_of(body, beside)
    if not process.is_struck:
        return Impact(state, 0.0, 0.0, 0.0)
    frictionless = (-2.0 * body.before[2] or body.striking) / body.response[2][2]
    impulse, steps = process.until(process.begin, body.approach, frictionless)
    compression = process.normal(impulse)
    if restitution > 0.0 and compression > 0.0:
        goal = restitution_goal(process, impulse, restitution)
        impulse, further_steps = process.until(impulse, goal, restitution * compression)
        steps += further_steps
    lost = max(0.0, -body.work(impulse))
    return Impact(process.after(impulse), impulse[NORMAL], lost, compression, steps)


def begins_without_approach(state: State, top: Top, beside: Top) -> bool:
    """Return whether an impact begins at a contact without normal velocity that slips, while
    another contact responds as `ProcessOnTwo` says.

    Where slip, or rolling, has ended, the other contact's response is left out.
    """
    body = StruckBody.of(state, top)
    try:
        return process_of(body, beside).is_struck
    except SlipEndsInImpact:
        return process_of(body, None).is_struck


def process_of(body: StruckBody, beside: Top | None) -> ImpactProcess:
    """Return the process of an impact for the law of a body, on one surface or two."""
    law = body.contact.top.friction
    if beside is not None:
        return ProcessOnTwo.of(body, StruckBody.of(body.state, beside))
    if is_dry(body.contact.top):
        return DryProcess(body)
    return ViscousProcess.of(body, law) if isinstance(law, ViscousLaw) else SteppedProcess(body)


def restitution_goal(process: ImpactProcess, compressed: Impulse, restitution: float) -> Goal:
    """Poisson's end of restitution, or that of the energy stored, but not before the body has
    stopped.
    """
    body, compression = process.body, process.normal(compressed)
    full = compression + restitution * compression

    def goal(impulse: Impulse) -> float:
        spent = (process.normal(impulse) - full) / compression
        returned = -impulse[WORK] / compressed[WORK]
        return float(min(max(spent, returned), body.approach(impulse) / body.striking))

    return goal
