"""A recorded function as straight-line code, in a language that is a table of spellings."""

from typing import NamedTuple

from tippetop.emit.graph import (
    CONSTANT,
    DIFFERENCE,
    FUNCTIONS,
    NEGATIVE,
    PARAMETER,
    POWER,
    PRODUCT,
    QUOTIENT,
    ROOT,
    STATE,
    SUM,
    Node,
    NotRecordable,
)
from tippetop.emit.recording import Recorded

LONGEST = 72
"""Characters of an expression that is written where it is used, rather than given a name."""

ATOM = 9
"""How tightly names, numbers and calls bind."""


class Spelling(NamedTuple):
    """How an operation is written."""

    parts: tuple[str, ...]
    """What stands before, between and after its operands."""
    binds: int = ATOM
    """How tightly: an operand that binds less is put in parentheses, and the last one if it binds no more."""
    order: tuple[int, ...] = ()
    """In which order its operands stand there, if it is another."""


class Language(NamedTuple):
    """How code is written."""

    spellings: dict[str, Spelling]
    """Operations by name."""
    head: tuple[str, str]
    foot: str
    """What stands before and after the name of a function, and at its end."""
    local: str
    end: str
    """What stands before and after an assignment to a new name."""


def common_spellings(library: str) -> dict[str, Spelling]:
    """What languages write alike, with the elementary functions of a library."""
    return {
        SUM: Spelling(("", " + ", ""), 1),
        DIFFERENCE: Spelling(("", " - ", ""), 1),
        PRODUCT: Spelling(("", " * ", ""), 2),
        QUOTIENT: Spelling(("", " / ", ""), 2),
        NEGATIVE: Spelling(("-", ""), 3),
        POWER: Spelling((f"{library}.pow(", ", ", ")")),
        ROOT: Spelling((f"{library}.sqrt(", ")")),
    } | {
        name: Spelling((f"{library}.{name}(", *[", "] * (count - 1), ")"))
        for name, count in FUNCTIONS.items()
    }


def written(recorded: Recorded, name: str, language: Language) -> str:
    """The code of a function `name(y, p, out)` that puts what was recorded of y and p into out."""
    lines = _Lines(recorded, language)
    for node in recorded.nodes:
        lines.take(node)
    for number, node in enumerate(recorded.outputs):
        lines.put("    out[" + str(number) + "] = " + lines.texts[node.place])
    return "\n".join([language.head[0] + name + language.head[1], *lines.lines, language.foot])


class _Lines:
    """Lines of code, and how the nodes are written that are there so far."""

    def __init__(self, recorded: Recorded, language: Language) -> None:
        self.language, self.lines = language, list[str]()
        self.texts, self.binds = dict[int, str](), dict[int, int]()
        self.uses = dict[int, int]()
        self.named = 0
        for used in [recorded.outputs, *[node.operands for node in recorded.nodes]]:
            for node in used:
                self.uses[node.place] = self.uses.get(node.place, 0) + 1

    def put(self, line: str) -> None:
        """Add a line."""
        self.lines.append(line + self.language.end)

    def take(self, node: Node) -> None:
        """Write a node: under a name of its own if it is used often, or is long."""
        self.binds[node.place] = ATOM
        if node.name == CONSTANT:
            self.texts[node.place] = _number(node.value)
        elif node.name in (STATE, PARAMETER):
            letter, which = ("y" if node.name == STATE else "p"), str(int(node.value))
            self.texts[node.place] = letter + which
            self.put("    " + self.language.local + letter + which + " = " + letter + "[" + which + "]")
        else:
            self._compute(node)

    def _compute(self, node: Node) -> None:
        spelling = self.language.spellings.get(node.name)
        if spelling is None:
            raise NotRecordable("there is no spelling of " + node.name)
        text = spelling.parts[0]
        operands = [node.operands[which] for which in spelling.order] or list(node.operands)
        for number, operand in enumerate(operands):
            here, binds = self.texts[operand.place], self.binds[operand.place]
            if spelling.binds < ATOM and (binds < spelling.binds or (binds == spelling.binds and number > 0)):
                here = "(" + here + ")"
            text = text + here + spelling.parts[number + 1]
        if self.uses[node.place] == 1 and len(text) <= LONGEST:
            self.texts[node.place], self.binds[node.place] = text, spelling.binds
            return
        self.texts[node.place] = "t" + str(self.named)
        self.named += 1
        self.put("    " + self.language.local + self.texts[node.place] + " = " + text)


def _number(value: float) -> str:
    if value in (float("inf"), -float("inf")):
        return "1e999" if value > 0.0 else "-1e999"
    return repr(value)
