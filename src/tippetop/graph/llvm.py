"""Recorded functions as LLVM's code, for one launch or for several an instruction."""

from collections.abc import Mapping, Sequence

from tippetop.graph import graph
from tippetop.graph.llvm_powers import is_small_power, power_function, spread
from tippetop.graph.recording import Recorded

ABREAST = 8
"""Launches an instruction; where a processor has not as many, several instructions."""

ROUNDING = "contract"
"""What a sum and a product may do beyond the letter: be rounded together, which is faster."""

PLACE = """\
{t}_begin = mul i64 {count}, {row}
  {t}_where = add i64 {t}_begin, %first
  {t}_place = getelementptr double, ptr %{name}, i64 {t}_where
"""
"""Where the numbers of a row are."""

LOAD = PLACE + "  {t} = load {v}, ptr {t}_place, align 8"
STORE = PLACE + "  store {v} {0}, ptr {t}_place, align 8"
CALL = "{t} = call {v} @llvm.{name}.v{n}f64({v} {0})"
SMALL_POWER = "{t} = call {v} @small_power({v} {0}, {v} {1})"
CHOICE = "{t} = select <{n} x i1> {0}_flag, {v} {1}, {v} {2}"
"""One of two numbers, by flags that are there already."""

SPREAD_FIRST = """\
  {t}_first = insertelement {v} poison, double {t}_one, i64 0
  {t} = shufflevector {v} {t}_first, {v} poison, <{n} x i32> zeroinitializer"""
"""One number for all."""

SPELLINGS = {
    graph.STATE: LOAD,
    graph.PARAMETER: LOAD,
    graph.SUM: "{t} = fadd {r} {v} {0}, {1}",
    graph.DIFFERENCE: "{t} = fsub {r} {v} {0}, {1}",
    graph.PRODUCT: "{t} = fmul {r} {v} {0}, {1}",
    graph.QUOTIENT: "{t} = fdiv {v} {0}, {1}",
    graph.NEGATIVE: "{t} = fneg {v} {0}",
    graph.SIZE: CALL.replace("{name}", "fabs"),
    graph.ROOT: CALL,
    graph.SINE: CALL,
    graph.COSINE: CALL,
    graph.EXPONENTIAL: CALL,
    graph.LOGARITHM: CALL,
    graph.HYPERBOLIC_TANGENT: CALL,
    graph.POWER: "{t} = call {v} @llvm.pow.v{n}f64({v} {0}, {v} {1})",
    graph.LESS: "{t}_flag = fcmp ogt {v} {1}, {0}\n  {t} = uitofp <{n} x i1> {t}_flag to {v}",
    graph.SELECT: "{t}_flag = fcmp une {v} {0}, zeroinitializer\n  " + CHOICE.replace("{0}", "{t}"),
    graph.SPREAD: "{t}_one = extractelement {v} {0}, i64 {row}\n" + SPREAD_FIRST,
    graph.TOTAL: (
        "{t}_one = call reassoc double @llvm.vector.reduce.fadd.v{n}f64(double 0.0, {v} {0})\n"
        + SPREAD_FIRST
    ),
}
"""What makes {t} of {0}, {1}, ..."""

NEED = """\
%need = fcmp une {v} {0}, zeroinitializer
  %somewhere = call i1 @llvm.vector.reduce.or.v{n}i1(<{n} x i1> %need)
  br i1 %somewhere, label %rare, label %rest
rare:"""
RARE = "{t}_rare = select <{n} x i1> %need, {v} {1}, {v} {2}"
PHI = "{t} = phi {v} [ {2}, %ready ], [ {t}_rare, %rare ]"
"""What is computed only where one of the launches has need of it: how that begins, and what it
makes.
"""

PART = 200
"""Operations a block: for thousands in one, LLVM takes twice as long to find registers."""

BLOCK = """\
br i1 %any, label %{name}, label %none
{name}:"""

# What does not fit into registers lies on the stack in whole cache lines: two lines a number cost
# twice.
FRAME = """\
define void @{name}(ptr noalias %y, ptr noalias %p, ptr noalias %out, i64 %count{more})
alignstack(64) {{
entry:
  %any = icmp ult i64 0, {count}
  br i1 %any, label %launches, label %none
launches:
  %first = phi i64 [ 0, %entry ], [ %next, %last ]
  {body}
  br label %last
last:
  %next = add i64 %first, {n}
  %left = icmp ult i64 %next, {count}
  br i1 %left, label %launches, label %none
none:
  ret void
}}
"""

OPTIONAL_OUTPUTS = """\
%asked = icmp ne ptr %more, null
  br i1 %asked, label %give, label %last
give:"""
"""What is before that which is only given where it is asked for."""

ITERATION_FRAME = """\
define i64 @{name}(ptr noalias %y, ptr noalias %p, ptr noalias %out, double %enough, i64 %most)
alignstack(64) {{
entry:
  %any = icmp ult i64 0, %most
  br i1 %any, label %turn, label %none
turn:
  %first = phi i64 [ 0, %entry ], [ 0, %last ]
  %turns = phi i64 [ 0, %entry ], [ %next, %last ]
  {body}
  br label %last
last:
  %changed = extractelement {v} {last}, i64 0
  %next = add i64 %turns, 1
  %left = icmp ult i64 %next, %most
  %moves = fcmp oge double %changed, %enough
  %more = and i1 %left, %moves
  br i1 %more, label %turn, label %done
done:
  ret i64 %next
none:
  ret i64 0
}}
"""


def llvm_source(functions: Mapping[str, Recorded], abreast: int, *, again: bool = False) -> str:
    """Functions `name(y, p, out, count, more)` of arrays whose rows have a number for each launch.

    Their count is a multiple of the launches `abreast`, and 1 if that is. What is computed besides
    goes to `more`, unless that is null.

    If they are made again and again, they are functions `name(y, p, out, enough, most)` of as many
    numbers abreast: what is made of y is put into its place, and only what is made besides goes to
    `out`, until the last of that is less than enough, or no number, or as many times as may be;
    they return how many.
    """
    frame, vector = ITERATION_FRAME if again else FRAME, f"<{abreast} x double>"
    count = abreast if again else "%count" if abreast > 1 else 1
    words = {"v": vector, "n": abreast, "r": ROUNDING, "count": count}

    def name_of(node: graph.Node) -> str:
        return spread(node.value, abreast) if node.name == graph.CONSTANT else f"%t{node.place}"

    parts = [
        f"declare {vector}"
        f" @llvm.{name}.v{abreast}f64({vector}{', ' + vector if name == 'pow' else ''})\n"
        for name in ("fabs", "sqrt", "sin", "cos", "exp", "log", "tanh", "pow")
    ]
    parts.append(f"declare double @llvm.vector.reduce.fadd.v{abreast}f64(double, {vector})\n")
    parts.append(f"declare i1 @llvm.vector.reduce.or.v{abreast}i1(<{abreast} x i1>)\n")
    if abreast > 1 and any(
        is_small_power(node) for made in functions.values() for node in made.nodes
    ):
        parts.append(power_function(abreast))
    for name, recorded in functions.items():
        names = {node.place: name_of(node) for node in recorded.nodes}
        lines = spelt(recorded, names, words)
        replaced = recorded.size if again else 0
        destinations = {
            "y": recorded.outputs[:replaced],
            "out": recorded.outputs[replaced:],
            "more": recorded.optional,
        }
        for place, nodes in destinations.items():
            lines += [OPTIONAL_OUTPUTS] if place == "more" and nodes else []
            lines += [
                STORE.format(names[node.place], t=f"%{place}{row}", name=place, row=row, **words)
                for row, node in enumerate(nodes)
            ]
        last = names[recorded.outputs[-1].place] if again else ""
        argument = ", ptr noalias %more" if recorded.optional else ""
        parts.append(
            frame.format(name=name, body="\n  ".join(lines), last=last, more=argument, **words)
        )
    return "".join(parts)


def spelt(recorded: Recorded, names: Mapping[int, str], words: Mapping[str, object]) -> list[str]:
    """Return the lines that compute nodes, whose names are known."""

    def line(node: graph.Node, spelling: str | None = None) -> str:
        operands = [names[operand.place] for operand in node.operands]
        gaps = {"t": names[node.place], "name": node.name, "row": node.value}
        text = spelling or spelling_of(node, words["n"] != 1)
        return text.format(*operands, **gaps, **words)

    always, seldom, either, later = parted(recorded)
    lines = in_blocks(list(map(line, always)), "part")
    if either:
        lines += ["br label %ready", "ready:", line(either[0], NEED), *map(line, seldom)]
        lines += [*(line(node, RARE) for node in either), "br label %rest", "rest:"]
        lines += [
            *(line(node, PHI) for node in either),
            *in_blocks(list(map(line, later)), "later"),
        ]
    return lines


def spelling_of(node: graph.Node, several: bool) -> str:
    """Return the template of the line that computes a node, of one launch or of several."""
    if node.name == graph.SELECT and node.operands[0].name == graph.LESS:
        return CHOICE
    return SMALL_POWER if several and is_small_power(node) else SPELLINGS[node.name]


def in_blocks(lines: Sequence[str], name: str) -> list[str]:
    """Lines with ends of blocks between them."""
    separated = list(lines[:PART])
    for first in range(PART, len(lines), PART):
        separated += [BLOCK.format(name=f"{name}{first}"), *lines[first : first + PART]]
    return separated


def parted(recorded: Recorded) -> tuple[Sequence[graph.Node], ...]:
    """Return the nodes that are computed always, those computed rarely, those that choose between
    both, and those that depend on a choice.
    """
    needed = {node.place for node in (*recorded.outputs, *recorded.optional)}
    for node in reversed(recorded.nodes):
        if node.place in needed:
            operands = node.operands[::2] if node.name == graph.RARELY else node.operands
            needed.update([operand.place for operand in operands])
    later = set[int]()
    for node in recorded.nodes:
        if node.name == graph.RARELY or not later.isdisjoint(
            [operand.place for operand in node.operands]
        ):
            later.add(node.place)
    made = [node for node in recorded.nodes if node.name != graph.CONSTANT]
    either = [node for node in made if node.name == graph.RARELY]
    if len({node.operands[0].place for node in either}) > 1 or any(
        node.place in later and node.place not in needed for node in made
    ):
        raise graph.NotRecordable(
            "what is computed rarely is so on one condition, and needs nothing of it"
        )
    return (
        [node for node in made if node.place in needed and node.place not in later],
        [node for node in made if node.place not in needed],
        either,
        [node for node in made if node.place in later and node.name != graph.RARELY],
    )
