"""Laws and limit surfaces made of branches, of which one holds: see
`tippetop.mechanics.laws.contensou_hertz`.
"""

from typing import Any

from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.laws.friction import FrictionLaw
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar


def is_branched(law: FrictionLaw) -> bool:
    """Return whether a law has branches, or is one of them."""
    return hasattr(whole_law(law), "branch")


def whole_law(law: FrictionLaw) -> Any:
    """Return the whole law of which a law is a branch, or the law itself if it has no branches."""
    return getattr(law, "whole_law", law)


def on_branch(top: Top, slip: Slip) -> Top:
    """Return a top with the branch of its law that holds where it slips, or in that direction; of
    floats.
    """
    if not is_branched(top.friction):
        return top
    return top._replace(branch_law=whole_law(top.friction).branch(slip))


def on_numbered_branch(top: Top, slip: Slip) -> Top:
    """Return the top with the branch as a number beside the law, for arrays or shared equations."""
    if not is_branched(top.friction):
        return top
    return top._replace(branch_law=whole_law(top.friction).numbered_branch(slip))


def on_other_branch(top: Top) -> Top:
    """Return a top with the branch of its law, or of its limit surface, that takes over where its
    own ends.
    """
    law: Any = top.friction
    return top._replace(branch_law=law.other_branch())


def off_branch(top: Top) -> Top:
    """Return the top with its whole law instead of one branch; itself if the law has none."""
    return top if top.branch_law is None else top._replace(branch_law=None)


def on_limit_branch(top: Top, wrench: Wrench) -> Top:
    """Return a top with the branch of its law's limit surface that belongs to what holds it at
    rest; of floats.
    """
    if not is_branched(top.friction):
        return top
    return top._replace(
        branch_law=whole_law(top.friction).limit_branch(wrench.force[2], wrench.torque[2])
    )


def has_limit_branches(law: FrictionLaw) -> bool:
    """Return whether a law is one of the branches of a limit surface."""
    return hasattr(law, "limit_guard")


def limit_guard(top: Top, wrench: Wrench) -> Scalar:
    """Positive as long as the branch of the limit surface that a body at rest has is the one it is
    on.
    """
    law: Any = top.friction
    return law.limit_guard(wrench.force[2], wrench.torque[2])
