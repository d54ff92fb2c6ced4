"""Laws and limit surfaces made of branches, of which one holds: see
`tippetop.mechanics.laws.contensou_hertz`.
"""

from typing import Any

from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.laws.friction import FrictionLaw
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar


def is_branched(law: FrictionLaw) -> bool:
    """Whether a law is made of branches, and knows itself which holds, or is one of them."""
    return hasattr(whole_law(law), "branch")


def whole_law(law: FrictionLaw) -> Any:
    """A law, the whole of it where there is but a branch."""
    return getattr(law, "whole", law)


def on_branch(top: Top, slip: Slip) -> Top:
    """A top with the branch of its law that holds where it slips, or in that direction; of
    floats.
    """
    if not is_branched(top.friction):
        return top
    return top._replace(friction=whole_law(top.friction).branch(slip))


def on_numbered_branch(top: Top, slip: Slip) -> Top:
    """The same where a number tells the branch, for arrays, or for floats that share equations."""
    if not is_branched(top.friction):
        return top
    return top._replace(friction=whole_law(top.friction).numbered_branch(slip))


def on_other_branch(top: Top) -> Top:
    """A top with the branch of its law, or of its limit surface, that takes over where its own
    ends.
    """
    law: Any = top.friction
    return top._replace(friction=law.other_branch())


def off_branch(top: Top) -> Top:
    """A top with the whole of its law, if it has but a branch of it."""
    return top._replace(friction=whole_law(top.friction))


def on_limit_branch(top: Top, wrench: Wrench) -> Top:
    """A top with the branch of its law's limit surface that belongs to what holds it at rest; of
    floats.
    """
    if not is_branched(top.friction):
        return top
    return top._replace(
        friction=whole_law(top.friction).limit_branch(wrench.force[2], wrench.torque[2])
    )


def has_limit_branches(law: FrictionLaw) -> bool:
    """Whether a law is one of the branches of a limit surface."""
    return hasattr(law, "limit_guard")


def limit_guard(top: Top, wrench: Wrench) -> Scalar:
    """Positive as long as the branch of the limit surface that a body at rest has is the one it is
    on.
    """
    law: Any = top.friction
    return law.limit_guard(wrench.force[2], wrench.torque[2])
