"""Rules for the begin and the end of contact, as users state them, validated."""

from typing import Annotated, Any, Literal

from pydantic import Field

from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.top import Top
from tippetop.support.validation import NO_WORD, Quantity, Variant

Fraction = Annotated[float, Field(ge=0, le=1), NO_WORD]


class Contact(Variant):
    """Rules for lift-off and impacts.

    A subclass with a field `kind` and a method `rules` is a contact with modes of its own.

    Attributes
    ----------
    liftoff
        What happens when the table would have to pull. "fly": the top leaves the table; "stop": the
        run ends; "ignore": the table pulls (bilateral contact).
    restitution
        Ratio of the normal impulses of restitution and compression in an impact (Poisson), in [0,
        1].
    indeterminate
        What happens where strong friction makes the contact force indeterminate (Painleve's
        paradox), so that both an impact and a lift-off satisfy the laws of mechanics and friction:
        "impact" or "liftoff". Where friction jams nothing, "impact" begins none: what is closed
        stays closed, and what friction can hold is held.
    face_pressure
        Pressure of a flat face on the table, on which its dry friction depends. "uniform": the same
        all over the face; "rim": at its outer radius alone; "ellipsoidal": uniform, with the limit
        surface approximated by an ellipsoid with the same drilling torque.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.Contact()  # the top may leave the table, and does not bounce
    Contact(liftoff='fly', restitution=0.0, indeterminate='impact', face_pressure='uniform')
    """

    liftoff: Literal["fly", "stop", "ignore"] = "fly"
    restitution: Annotated[Fraction, Quantity("1", "coefficient of restitution")] = 0.0
    indeterminate: Literal["impact", "liftoff"] = "impact"
    face_pressure: Literal["uniform", "rim", "ellipsoidal"] = "uniform"

    # translate: skip
    def rules(self, top: Top, units: Units) -> Any:
        """Return an automaton of contact modes that replaces the package's own, or None.

        Parameters
        ----------
        top
            The top in natural units.
        units
            The natural units, in SI.

        Returns
        -------
        tippetop.extend.Automaton or None
            Always None, unless a subclass has modes of its own.
        """
        return None
