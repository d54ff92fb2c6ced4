"""What the report says that is not judged here, and why not."""

from typing import NamedTuple


class Unchecked(NamedTuple):
    """A statement of the report, its place, and why it has no verdict."""

    place: str
    statement: str
    reason: str


_OTHERS = "a statement about other people's work, which no computation here can judge"

UNCHECKED = (
    Unchecked("Abstract", "Critical behaviour is missing in preceding works.", _OTHERS),
    Unchecked(
        "Abstract",
        "The system has a high level of non-linear performance.",
        "a manner of speaking: the equations are nonlinear, as (2.8) to (2.15) show, and there is no measure "
        "of how much",
    ),
    Unchecked("section 1", "That the top may fly was neglected in the literature.", _OTHERS),
    Unchecked(
        "section 1",
        "The toy is a half sphere with a small leg.",
        "a description of the toy; what the report computes, and what is judged, is a whole sphere",
    ),
    Unchecked(
        "section 1",
        "The top has 5 degrees of freedom: two of translation on the surface and three angles.",
        "a count, and right: six of a rigid body less one for the contact, while it lasts",
    ),
    Unchecked(
        "section 1",
        "In the end the top loses its balance and falls.",
        "nothing in the report's model, viscous friction at a point, slows an inverted top down; it takes "
        "friction against drilling, as the fall in the section Real tops does",
    ),
    Unchecked(
        "section 1",
        "To get the exact friction term is impossible.",
        "a statement about materials, not about the model",
    ),
    Unchecked(
        "section 2.2",
        "The contact force can be found by Lagrange multipliers, which is much work.",
        "a way to derive it; its result, (2.15), is judged",
    ),
    Unchecked(
        "section 3",
        "To solve (2.8) to (2.15) analytically is impossible.",
        "no solution in closed form is known, and no computation can show that there is none",
    ),
    Unchecked("section 3, Table 1", "The parameters are those of reference [3].", _OTHERS),
    Unchecked(
        "section 3.1",
        "Too slow a launch does not turn over completely.",
        "the report says it again, with numbers, in section 3.3, and there it is judged",
    ),
    Unchecked(
        "section 3.3",
        "The top spins on its stem.",
        "the model is a whole sphere and has none; what is judged is that it turns over, and in the section "
        "Real tops on which stems it stands",
    ),
    Unchecked(
        "section 5", "Tricks of programming make the listing faster.", "a statement about its author's time"
    ),
    Unchecked(
        "Appendix B",
        "Runge-Kutta methods are among the most popular ones, and the one with 4 steps is the most popular.",
        "a statement about habits; which formula ode45 uses is judged",
    ),
    Unchecked(
        "Appendix B",
        "Their accuracy and speed are both satisfactory in most situations.",
        "a statement about most problems; that it holds for this one is judged in sections 3 and 5",
    ),
)
"""The statements without a verdict, in the order of the report."""
