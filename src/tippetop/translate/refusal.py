"""Error by which the translator refuses code."""


class Untranslatable(SyntaxError):
    """Python code that has no translation that is known to mean the same.

    Parameters
    ----------
    path
        File of the code.
    line
        Line of the code, from 1.
    reason
        What is refused, and what to write instead, without a full stop.
    code
        The code.
    """

    def __init__(self, path: str, line: int, reason: str, code: str = "") -> None:
        super().__init__(f"{path}:{line}: {reason}" + (f": {code}" if code else ""))
