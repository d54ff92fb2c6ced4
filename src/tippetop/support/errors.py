"""What can go wrong, each with one sentence that says what to do.

    TippetopError
    |-- InvalidInput (ValueError)      names the field, the value and what is accepted
    |-- FileTrouble (OSError)          a file that cannot be read, or may not be overwritten
    |-- NotConverged (RuntimeError)    a fit that did not reach a minimum
    `-- Unavailable (RuntimeError)     something optional that is not installed here

How a run ends is not an error: see `tippetop.contact.mode.Outcome`.
"""

from collections.abc import Mapping
from math import isfinite
from numbers import Integral, Real
from typing import NamedTuple, TypeGuard


class _Missing:
    # translate: skip
    def __repr__(self) -> str:
        return "(nothing)"


MISSING = _Missing()
"""Stands for a value that was not given."""


class Described(NamedTuple):
    """A refused value that sentences describe instead of writing it out."""

    description: str


OVERWRITE, RESUME, OTHER_OUT = "overwrite=True", "resume=True", "another out"
"""How sentences name what is asked for in Python; a command has its own words for these."""


# translate: skip
class TippetopError(Exception):
    """Base of every error this package raises on purpose.

    Examples
    --------
    >>> import tippetop as tt
    >>> try:
    ...     tt.ViscousFriction(mu=-1.0)
    ... except tt.TippetopError as error:
    ...     print(error)
    mu: -1 is not a number at least 0
    """

    def told(self, words: Mapping[str, str]) -> str:
        """The sentence with other words for what is asked for, where it ends with such."""
        sentence = str(self)
        for python, other in words.items():
            sentence = other.join(sentence.rsplit(python, 1))
        return sentence


LONGEST_FIELD = 100
"""How much of a field's name a sentence shows, letters."""


class InvalidInput(TippetopError, ValueError):
    """A value that is refused, in a sentence with its field and what to write instead.

    The sentence is "field: value is not what is accepted (hint)" or, with a fault of its own,
    "field: value has this fault (write what is accepted)".

    Parameters
    ----------
    field
        Where the value stands, dotted: ``launch.tilt``.
    value
        The value given; a `Described` one is shown in its words.
    accepted
        What is accepted, as the end of "is not ..." or "write ...".
    fault
        What is wrong with the value, as the end of "<field>: <value> ...", where "is not
        <accepted>" does not say it.
    hint
        What to write instead, where that is more than what is accepted.
    others
        How many more values of the same input are refused.
    file
        The file that the value is in; "" where it is in none.

    Examples
    --------
    >>> import tippetop as tt
    >>> try:
    ...     tt.Launch(tilt=4.0, spin=100.0)
    ... except tt.InvalidInput as error:
    ...     print(error)
    ...     error.field, error.value, error.accepted
    tilt: 4 is not a number at least 0 and at most pi (for 4 degrees write 0.06981, or "4 deg")
    ('tilt', 4.0, 'a number at least 0 and at most pi')
    """

    def __init__(
        self,
        field: str,
        value: object,
        accepted: str,
        fault: str = "",
        hint: str = "",
        others: int = 0,
        file: str = "",
    ) -> None:
        name = field if field and field.isprintable() else repr(field)
        if len(name) > LONGEST_FIELD:
            name = f"{name[:LONGEST_FIELD]}..."
        head = f"{name} in {file}" if file else name
        note = hint
        if value is MISSING:
            said = f"{head} is missing"
        elif fault:
            said = f"{head}: {short(value)} {fault}"
        else:
            said = f"{head}: {short(value)} is not {accepted}"
        if not hint and accepted and (fault or value is MISSING):
            note = f"write {accepted}"
        noted = f" ({note})" if note else ""
        more = f" (and {others} more)" if others else ""
        super().__init__(f"{said}{noted}{more}")
        self.field = field
        self.value = value
        self.accepted = accepted
        self.fault = fault
        self.hint = hint
        self.others = others
        self.file = file

    def within(self, part: str, more: int = 0) -> "InvalidInput":
        """The same of a field of a part, or of the part itself if it names none; more are refused
        besides.
        """
        field = ".".join([name for name in (part, self.field) if name])
        return InvalidInput(
            field,
            self.value,
            self.accepted,
            self.fault,
            self.hint,
            self.others + more,
            self.file,
        )

    # translate: skip
    def in_file(self, file: str) -> "InvalidInput":
        """The same of a value in a file."""
        return InvalidInput(
            self.field, self.value, self.accepted, self.fault, self.hint, self.others, file
        )

    # translate: skip
    def __reduce__(self) -> tuple[type["InvalidInput"], tuple[object, ...]]:
        return type(self), (
            self.field,
            self.value,
            self.accepted,
            self.fault,
            self.hint,
            self.others,
            self.file,
        )


# translate: skip
class FileTrouble(TippetopError, OSError):
    """A file that cannot be read or written, or that exists and may not be overwritten.

    Examples
    --------
    >>> import tippetop as tt
    >>> try:
    ...     tt.Problem.read("none.toml")
    ... except tt.FileTrouble as error:
    ...     print(error)
    none.toml cannot be read: No such file or directory
    """


# translate: skip
class NotConverged(TippetopError, RuntimeError):
    """A search for the best numbers that did not reach a minimum: there is no result.

    Examples
    --------
    >>> import tippetop as tt
    >>> issubclass(tt.NotConverged, RuntimeError)
    True
    """


# translate: skip
class Unavailable(TippetopError, RuntimeError):
    """Something optional that is asked for and not installed.

    Examples
    --------
    >>> import tippetop as tt
    >>> issubclass(tt.Unavailable, RuntimeError)
    True
    """


# translate: drop
def require(field: str, value: object, kind: type, accepted: str) -> None:
    """Raise `InvalidInput` unless a value is of a kind."""
    if not isinstance(value, kind):
        raise InvalidInput(field, value, accepted)


# translate: runtime
def is_number(value: object) -> bool:
    """Whether a value is a finite real number, as a float too."""
    try:
        return isinstance(value, Real) and not isinstance(value, bool) and isfinite(value)
    except OverflowError:
        return False


# translate: runtime
def is_whole(value: object) -> TypeGuard[int]:
    """Whether a value is a whole number, also of numpy, and no truth value."""
    return isinstance(value, Integral) and not isinstance(value, bool)


# translate: runtime
def short(value: object, limit: int = 60) -> str:
    """A value as it would be typed, numbers as briefly as can be, cut to at most `limit`
    characters.
    """
    try:
        text = _typed(value)
    except RecursionError:
        text = f"({type(value).__name__}, nested too deep to be shown)"
    except ValueError:  # Python refuses to write down whole numbers of thousands of digits.
        text = f"({type(value).__name__}, too long to be shown)"
    except Exception:  # noqa: BLE001 - an object's own repr may raise anything
        text = f"({type(value).__name__}, which cannot be shown)"
    text = " ".join(text.split()) if "\n" in text else text
    return text if len(text) <= limit else text[: limit - 3] + "..."


BEGINS_A_NUMBER = "0123456789+-.,"
"""What numbers begin with."""


# translate: skip
def _typed(value: object) -> str:
    if isinstance(value, Described):
        return value.description
    if isinstance(value, list | tuple) and not hasattr(value, "_fields"):
        inner = ", ".join(map(_typed, value))
        return f"[{inner}]" if isinstance(value, list) else f"({inner})"
    if isinstance(value, str) and value[:1] in BEGINS_A_NUMBER and value.isprintable() and value:
        return value
    # What was refused may have been made a fraction on its way: a whole number is told as one.
    return repr(float(value) + 0.0).removesuffix(".0") if isinstance(value, float) else repr(value)
