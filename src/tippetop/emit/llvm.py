"""Recorded functions as LLVM's code for eight launches an instruction."""

from struct import pack

from tippetop.emit.graph import (
    CONSTANT,
    DIFFERENCE,
    LESS,
    NEGATIVE,
    PARAMETER,
    POWER,
    PRODUCT,
    QUOTIENT,
    ROOT,
    SELECT,
    SIZE,
    STATE,
    SUM,
    Node,
    NotRecordable,
)
from tippetop.emit.recording import Recorded

ABREAST = 8
"""Launches an instruction; where a processor has not as many, several instructions."""

VECTOR, FLAGS = f"<{ABREAST} x double>", f"<{ABREAST} x i1>"

ROUNDING = "contract"
"""What a sum and a product may do beyond the letter: be rounded together, which is faster."""

SPELLINGS = {
    SUM: "fadd {r} {v} {0}, {1}",
    DIFFERENCE: "fsub {r} {v} {0}, {1}",
    PRODUCT: "fmul {r} {v} {0}, {1}",
    QUOTIENT: "fdiv {v} {0}, {1}",
    NEGATIVE: "fneg {v} {0}",
    ROOT: "call {v} @llvm.sqrt.v{n}f64({v} {0})",
    SIZE: "call {v} @llvm.fabs.v{n}f64({v} {0})",
    POWER: "call {v} @llvm.pow.v{n}f64({v} {0}, {v} {1})",
}
"""Operations by name."""

FRAME = """\
declare {v} @llvm.sqrt.v{n}f64({v})
declare {v} @llvm.fabs.v{n}f64({v})
declare {v} @llvm.pow.v{n}f64({v}, {v})
define void @{name}(ptr noalias %y, ptr noalias %p, ptr noalias %out, i64 %count) {{
entry:
  %any = icmp ult i64 0, %count
  br i1 %any, label %launches, label %done
launches:
  %first = phi i64 [ 0, %entry ], [ %next, %launches ]
{body}
  %next = add i64 %first, {n}
  %more = icmp ult i64 %next, %count
  br i1 %more, label %launches, label %done
done:
  ret void
}}
"""


def llvm_source(recorded: Recorded, name: str) -> str:
    """A function `name(y, p, out, count)` of arrays whose rows have a number for each of `count` launches.

    The count is a multiple of `ABREAST`.

    Raises
    ------
    NotRecordable
        If there is an operation for which LLVM has no name.
    """
    lines = _Instructions()
    for node in recorded.nodes:
        lines.take(node)
    for row, node in enumerate(recorded.outputs):
        place = lines.place("out", row)
        lines.put(f"store {VECTOR} {lines.names[node.place]}, ptr {place}, align 8")
    return FRAME.format(name=name, body="\n".join(lines.lines), v=VECTOR, n=ABREAST)


class _Instructions:
    """Lines of code, and the names of the nodes that are there so far."""

    def __init__(self) -> None:
        self.lines, self.names, self.flags = list[str](), dict[int, str](), dict[int, str]()

    def put(self, line: str) -> None:
        """Add a line."""
        self.lines.append("  " + line)

    def new(self, made: str) -> str:
        """Give a name to what a line makes."""
        name = f"%v{len(self.lines)}"
        self.put(f"{name} = {made}")
        return name

    def place(self, array: str, row: int) -> str:
        """Where the numbers of a row are."""
        begin = self.new(f"mul i64 %count, {row}")
        where = self.new(f"add i64 {begin}, %first")
        return self.new(f"getelementptr double, ptr %{array}, i64 {where}")

    def take(self, node: Node) -> None:
        """Write a node."""
        if node.name == CONSTANT:
            self.names[node.place] = _number(node.value)
        elif node.name in (STATE, PARAMETER):
            place = self.place("y" if node.name == STATE else "p", int(node.value))
            self.names[node.place] = self.new(f"load {VECTOR}, ptr {place}, align 8")
        else:
            self.names[node.place] = self._compute(node)

    def _compute(self, node: Node) -> str:
        operands = [self.names[operand.place] for operand in node.operands]
        if node.name == LESS:
            flags = self.new(f"fcmp ogt {VECTOR} {operands[1]}, {operands[0]}")
            self.flags[node.place] = flags
            return self.new(f"uitofp {FLAGS} {flags} to {VECTOR}")
        if node.name == SELECT:
            flags = self.flags.get(node.operands[0].place, "")
            flags = flags or self.new(f"fcmp une {VECTOR} {operands[0]}, zeroinitializer")
            return self.new(f"select {FLAGS} {flags}, {VECTOR} {operands[1]}, {VECTOR} {operands[2]}")
        if node.name not in SPELLINGS:
            raise NotRecordable(f"there is no spelling of {node.name}")
        return self.new(SPELLINGS[node.name].format(*operands, r=ROUNDING, v=VECTOR, n=ABREAST))


def _number(value: float) -> str:
    """A constant, to the bit."""
    return "<" + ", ".join([f"double 0x{pack('>d', value).hex().upper()}"] * ABREAST) + ">"
