"""What happens where contact begins or ends, as users state it, validated."""

from typing import Annotated, Any, Literal

from pydantic import Field

from tippetop.mechanics.top import Top
from tippetop.mechanics.units import Units
from tippetop.support.validation import NO_WORD, Quantity, Variant

Fraction = Annotated[float, Field(ge=0, le=1), NO_WORD]


class Contact(Variant):
    """What happens when the table would have to pull.

    A subclass with a field `kind` is a contact of its own, if it has rules.

    Attributes
    ----------
    liftoff
        "fly": the top leaves the table; "stop": the run ends there; "ignore": the table pulls
        (bilateral contact).
    restitution
        Ratio of the normal impulses of restitution and compression in an impact (Poisson), in [0,
        1].
    indeterminate
        What the table does where strong friction leaves the contact force indeterminate (Painleve's
        paradox), so that both an impact and a lift-off agree with the laws of mechanics and
        friction: "impact" or "lift_off".

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.Contact()  # it may leave the table, and does not bounce
    Contact(liftoff='fly', restitution=0.0, indeterminate='impact')
    """

    liftoff: Literal["fly", "stop", "ignore"] = "fly"
    restitution: Annotated[Fraction, Quantity("1", "coefficient of restitution")] = 0.0
    indeterminate: Literal["impact", "lift_off"] = "impact"

    # translate: skip
    def rules(self, top: Top, units: Units) -> Any:
        """What follows where contact begins or ends, in natural units, where that is not as
        described here.

        Parameters
        ----------
        top
            The top in natural units.
        units
            Those units.

        Returns
        -------
        tippetop.contact.automaton.Automaton or None
            None, unless a subclass has rules of its own.
        """
        return None
