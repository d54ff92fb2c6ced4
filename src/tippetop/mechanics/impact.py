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
e < 1 (Stronge 1990). The work of the normal impulse, the integral of v_n dp, is therefore followed, and
restitution ends at once should it reach zero, which is the most that Stronge's energetic hypothesis allows.
As friction only takes (f.v + t.omega <= 0), no impact gains energy. Should v_n be negative at the end, which
friction that turns during restitution might do, the impact goes on until it is zero.

Jellett's integral is conserved: P acts at the fixed arm, and a.(a x P) = 0.
"""

from typing import NamedTuple

from tippetop.mechanics.dry_impact import DryContact, is_dry
from tippetop.mechanics.friction import ViscousLaw
from tippetop.mechanics.impulse import NO_IMPULSE, Goal, Impulse, Process, Striking, contact_velocity
from tippetop.mechanics.integrated_impact import IntegratedProcess
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, add, dot, length
from tippetop.mechanics.viscous_impact import ViscousProcess


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
    law = top.friction
    dry = DryContact.of(body) if is_dry(law) else None
    if not is_struck(body, dry):
        return Impact(state, 0.0, 0.0, 0.0)
    process: Process = (
        ViscousProcess.of(body, law) if isinstance(law, ViscousLaw) else IntegratedProcess(body, dry)
    )

    frictionless = (-2.0 * body.point[2] or length(body.point)) / body.inverse_mass[2][2]
    compressed = process.until(NO_IMPULSE, body.approach, frictionless)
    impulse, steps = compressed, compressed.steps
    if restitution > 0.0:
        goal = restitution_goal(body, compressed, restitution)
        impulse = process.until(compressed, goal, restitution * compressed.normal)
        steps += impulse.steps
    after = body.after(impulse)
    if dry is not None:
        after = dry.at_rest(impulse, after)
    lost = max(0.0, -work_of(impulse, state, after, body))
    return Impact(after, impulse.normal, lost, compressed.normal, steps)


def restitution_goal(body: Striking, compressed: Impulse, restitution: float) -> Goal:
    """Poisson's end of restitution, or that of the energy stored, but not before the body has stopped."""
    full = compressed.normal + restitution * compressed.normal

    def goal(impulse: Impulse) -> float:
        spent = (impulse.normal - full) / compressed.normal
        returned = -impulse.normal_work / compressed.normal_work
        return float(min(max(spent, returned), body.approach(impulse) / length(body.point)))

    return goal


def is_struck(body: Striking, dry: DryContact | None) -> bool:
    """Whether the contact point sinks into the table, or would, if the impact did not begin."""
    if body.point[2] != 0.0:
        return bool(body.point[2] < 0.0)
    if dry is not None:
        now = dry.settled(NO_IMPULSE)
        return bool(now.change(now.friction(*now.velocities(NO_IMPULSE)))[2] < 0.0)
    traction = body.friction(NO_IMPULSE)[2]
    return body.approach(Impulse(1.0, traction.force, traction.torque, 0.0)) < 0.0


def work_of(impulse: Impulse, before: State, after: State, body: Striking) -> float:
    """Work of an impulse, J: times the mean velocity, as velocities are linear in it (Thomson and Tait)."""
    omega = add(*(angular_velocity(state.axis, state.momentum, body.top) for state in (before, after)))
    point = add(body.point, contact_velocity(after, body.arm, body.top))
    return float(0.5 * (dot((*impulse.tangential, impulse.normal), point) + dot(impulse.angular, omega)))
