"""Exceptions of the package, each with one sentence that says what to do.

    TippetopError
    |-- InvalidInput (ValueError)      names the field, the value and what is accepted
    |-- FileTrouble (OSError)          a file that cannot be read, or may not be overwritten
    |-- NotConverged (RuntimeError)    a fit that did not reach a minimum
    `-- Unavailable (RuntimeError)     an optional library or program that is not installed

How a run ends is not an error: see `tippetop.contact.mode.Status`.
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
"""Stands in refusals for a value that is missing."""


class Described(NamedTuple):
    """Refused value that sentences show by a description."""

    description: str


OVERWRITE, RESUME, OTHER_OUT = "overwrite=True", "resume=True", "another out"
"""Names of arguments in Python in messages; the command line names its options instead."""

OR_NONE = "; or None for enough"
"""What Python accepts beside a number; at the command line an option is left out instead."""


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


LONGEST_FIELD = 100
"""Letters of a field's name that a sentence shows at most."""


class InvalidInput(TippetopError, ValueError):
    """Refusal of a value, in a sentence with its field and what to write instead.

    The sentence is "<field>: <value> is not <accepted> (<hint>)" or, if a fault is stated,
    "<field>: <value> <fault> (write <accepted>)".

    Parameters
    ----------
    field
        Where the value stands, dotted: ``launch.tilt``.
    value
        The refused value; a `Described` one is shown by its description.
    accepted
        What is accepted, as the end of "is not ..." or "write ...".
    fault
        What is wrong with the value, as the end of "<field>: <value> ..."; "" if "is not
        <accepted>" says it.
    hint
        What to write instead, if that is more than `accepted` says.
    others
        How many further values of the same input are refused.
    file
        The file that the value is in; "" if it is in none.

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
            statement = f"{head} is missing"
        elif fault:
            statement = f"{head}: {short(value)} {fault}"
        else:
            statement = f"{head}: {short(value)} is not {accepted}"
        if not hint and accepted and (fault or value is MISSING):
            note = f"write {accepted}"
        noted = f" ({note})" if note else ""
        counted = f" (and {others} more)" if others else ""
        super().__init__(f"{statement}{noted}{counted}")
        self.field = field
        self.value = value
        self.accepted = accepted
        self.fault = fault
        self.hint = hint
        self.others = others
        self.file = file

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


def within_part(error: InvalidInput, part: str, further: int = 0) -> InvalidInput:
    """Return a refusal with the name of a part put before that of the field.

    `further` is how many further values of the same input are refused.
    """
    return renamed(error, ".".join([name for name in (part, error.field) if name]), further)


def renamed(error: InvalidInput, field: str, further: int = 0) -> InvalidInput:
    """Return a refusal with another name of the field.

    `further` is how many further values of the same input are refused.
    """
    return InvalidInput(
        field,
        error.value,
        error.accepted,
        error.fault,
        error.hint,
        error.others + further,
        error.file,
    )


# translate: skip
def in_file(error: InvalidInput, file: str) -> InvalidInput:
    """Return a refusal with the name of the file that the value is in."""
    return InvalidInput(
        error.field, error.value, error.accepted, error.fault, error.hint, error.others, file
    )


# translate: skip
def reworded(error: TippetopError, words: Mapping[str, str]) -> str:
    """Return the sentence of an error with names of arguments in Python replaced by `words`."""
    sentence = str(error)
    for python, option in words.items():
        sentence = option.join(sentence.rsplit(python, 1))
    return sentence


# translate: skip
class FileTrouble(TippetopError, OSError):
    """Error of a file that cannot be read or written, or may not be overwritten.

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
    """Error of a fit or search that did not reach a minimum: there is no result.

    Examples
    --------
    >>> import tippetop as tt
    >>> issubclass(tt.NotConverged, RuntimeError)
    True
    """


# translate: skip
class Unavailable(TippetopError, RuntimeError):
    """Error of an optional library or program that is needed and not installed.

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
    """Return whether a value is a finite real number that a float can hold."""
    try:
        return isinstance(value, Real) and not isinstance(value, bool) and isfinite(value)
    except OverflowError:
        return False


# translate: runtime
def is_whole(value: object) -> TypeGuard[int]:
    """Return whether a value is a whole number, of Python or NumPy, and no truth value."""
    return isinstance(value, Integral) and not isinstance(value, bool)


# translate: runtime
def short(value: object, limit: int = 60) -> str:
    """Return a value as it would be typed, cut to at most `limit` characters."""
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
"""Characters that numbers begin with."""


# translate: skip
def _typed(value: object) -> str:
    if isinstance(value, Described):
        return value.description
    if isinstance(value, list | tuple) and not hasattr(value, "_fields"):
        inner = ", ".join(map(_typed, value))
        return f"[{inner}]" if isinstance(value, list) else f"({inner})"
    if isinstance(value, str) and value[:1] in BEGINS_A_NUMBER and value.isprintable() and value:
        return value
    # Validation may have turned a whole number into a float: it is shown without ".0".
    return repr(float(value) + 0.0).removesuffix(".0") if isinstance(value, float) else repr(value)
