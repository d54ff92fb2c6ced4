"""Taylor coefficients of a recorded motion as LLVM's code: one loop over the orders.

Coefficient k of every node follows from coefficients up to k of its operands (Jorba and Zou 2005,
Experimental Mathematics 14, section 2.1). The convolutions in products, quotients, roots, powers
and elementary functions run over vectors of `WIDTH` coefficients. The code grows with the number
of nodes and not with the square of the order, so that it compiles in a fraction of a second.
"""

from collections.abc import Iterable
from itertools import count
from math import ceil
from struct import pack
from typing import TypeAlias

from tippetop.graph import graph
from tippetop.graph.recording import Recorded, needed

WIDTH = 8
"""Coefficients a vector."""

PLAIN, DERIVATIVE, SLOPE = "plain", "derivative", "slope"
"""Which coefficients a row has: a node's, those times their orders, or those of the derivative of
the operation, 1 - node^2 of a hyperbolic tangent.
"""

Row: TypeAlias = tuple[str, int]
"""Which coefficients, and the place of the node."""

LINEAR = (graph.SUM, graph.DIFFERENCE, graph.NEGATIVE)

ZERO = "0.0"

SCALARS = {
    graph.SUM: "fadd contract double {0}, {1}",
    graph.DIFFERENCE: "fsub contract double {0}, {1}",
    graph.PRODUCT: "fmul contract double {0}, {1}",
    graph.QUOTIENT: "fdiv double {0}, {1}",
    graph.NEGATIVE: "fneg double {0}",
    graph.SIZE: "call double @llvm.fabs.f64(double {0})",
    graph.ROOT: "call double @llvm.sqrt.f64(double {0})",
    graph.POWER: "call double @llvm.pow.f64(double {0}, double {1})",
    graph.SINE: "call double @llvm.sin.f64(double {0})",
    graph.COSINE: "call double @llvm.cos.f64(double {0})",
    graph.EXPONENTIAL: "call double @llvm.exp.f64(double {0})",
    graph.LOGARITHM: "call double @llvm.log.f64(double {0})",
    graph.HYPERBOLIC_TANGENT: "call double @llvm.tanh.f64(double {0})",
}
"""Operations on single numbers."""

DECLARATIONS = """\
declare double @llvm.fabs.f64(double)
declare double @llvm.sqrt.f64(double)
declare double @llvm.sin.f64(double)
declare double @llvm.cos.f64(double)
declare double @llvm.exp.f64(double)
declare double @llvm.log.f64(double)
declare double @llvm.tanh.f64(double)
declare double @llvm.pow.f64(double, double)
declare double @llvm.vector.reduce.fadd.v{n}f64(double, <{n} x double>)
"""


def series_source(recorded: Recorded, order: int) -> str:
    """Return LLVM's code of a function `jet(y, p, room, out)` of a recorded motion.

    The first outputs of the recorded function are the rates of its state, the others are guards.
    The function writes the coefficients of the state, size x (order + 1), and of the guards,
    guards x order, to `out`. In `room`, of `room_size` numbers, it keeps coefficients between
    orders; the numbers in it are zero before the first call and stay finite while the coefficients
    do.

    Raises
    ------
    NotRecordable
        If a node depends on the state by an operation that has no rule for coefficients.
    """
    return DECLARATIONS.format(n=WIDTH) + "\n".join(_SeriesPrinter(recorded, order).lines()) + "\n"


def with_choices(recorded: Recorded) -> Recorded:
    """Return a recorded function with one more output for every `<` and `abs` in it: its margin.

    The margin is positive while the choice stays the one made where the coefficients begin; beyond
    its zero the coefficients are invalid.
    """
    moving = _moving(recorded)
    margins = dict[int, graph.Node]()
    for node in recorded.nodes:
        a, b = _two_of(node)
        margin = None
        if node.name == graph.SIZE and a.place in moving:
            margin = node
        elif node.name == graph.LESS and not moving.isdisjoint([a.place, b.place]):
            margin = node.graph.select(node, b - a, a - b)
        if margin is not None:
            margins[margin.place] = margin
    if not margins:
        return recorded
    outputs = (*recorded.outputs, *margins.values())
    nodes = needed(outputs[0].graph, outputs)
    return Recorded(nodes, outputs, recorded.size, recorded.parameters)


def room_size(recorded: Recorded, order: int) -> int:
    """Return how many numbers the function of `series_source` needs room for."""
    printer = _SeriesPrinter(recorded, order)
    return len(printer.rows) * printer.row_length


class _SeriesPrinter:
    """Prints the function `jet` of one motion.

    A row of `room` has the coefficients of one node that is convolved, after as many zeros.
    Coefficient 0 is zero there, and what it adds is added apart: so the sum of all products, of one
    row forwards and another backwards from k, is that of those of the orders 1 to k - 1. What is
    beyond k is left there from the last call, and multiplied by the zeros.
    """

    def __init__(self, recorded: Recorded, order: int) -> None:
        self.recorded, self.order = recorded, order
        self.guards = len(recorded.outputs) - recorded.size
        self.vectors = ceil((order - 1) / WIDTH)
        self.zeros = WIDTH * self.vectors
        self.row_length = 2 * self.zeros
        self.text = list[str]()
        self._names = count()
        self.moving = _moving(recorded)
        self.uses = dict[int, int]()
        for node in recorded.nodes:
            for operand in node.operands:
                self.uses[operand.place] = self.uses.get(operand.place, 0) + 1
        for output in recorded.outputs:
            self.uses[output.place] = self.uses.get(output.place, 0) + 2
        self.deferred = self._deferred()
        self.rows = dict[Row, int]()
        for node in recorded.nodes:
            for row in self._convolved(node):
                self.rows.setdefault(row, len(self.rows))
        # What is printed of a node so far: its value, and its coefficient in the current order.
        self.first = dict[int, str]()
        self.term = dict[int, str]()
        self.first_slope = dict[int, str]()
        self.inverse = dict[tuple[str, int], str]()
        self.chunks = dict[tuple[str, Row, int], str]()

    def _deferred(self) -> set[int]:
        """Return the sums and products that are added up where they are used, and nowhere else."""
        deferred = set[int]()
        for node in self.recorded.nodes:
            if node.place not in self.moving or node.name not in (
                *LINEAR,
                graph.QUOTIENT,
                graph.ROOT,
            ):
                continue
            for operand in node.operands[: 1 if node.name == graph.QUOTIENT else None]:
                product = operand.name == graph.PRODUCT and self._both_move(operand)
                if (
                    operand.place in self.moving
                    and (product or operand.name in LINEAR)
                    and self.uses[operand.place] == 1
                ):
                    deferred.add(operand.place)
        return deferred

    def _both_move(self, node: graph.Node) -> bool:
        return all(operand.place in self.moving for operand in node.operands)

    def _convolved(self, node: graph.Node) -> list[Row]:
        """Return the rows of which a node's coefficient is a convolution."""
        if node.place not in self.moving:
            return []
        match node.name:
            case graph.PRODUCT if self._both_move(node):
                return [(PLAIN, operand.place) for operand in node.operands]
            case graph.QUOTIENT if node.operands[1].place in self.moving:
                return [(PLAIN, node.operands[1].place), (PLAIN, node.place)]
            case graph.ROOT:
                return [(PLAIN, node.place)]
            case graph.POWER:
                base = node.operands[0].place
                return [(PLAIN, base), (DERIVATIVE, base), (PLAIN, node.place)]
            case graph.EXPONENTIAL:
                return [(DERIVATIVE, node.operands[0].place), (PLAIN, node.place)]
            case graph.LOGARITHM:
                return [(PLAIN, node.operands[0].place), (DERIVATIVE, node.place)]
            case graph.HYPERBOLIC_TANGENT:
                operand = node.operands[0].place
                return [(DERIVATIVE, operand), (PLAIN, node.place), (SLOPE, node.place)]
        return []

    def lines(self) -> list[str]:
        """Return the lines of the function."""
        self.text = [
            "define void @jet(ptr noalias %y, ptr noalias %p, ptr noalias %room, ptr noalias %out)"
            " alignstack(64) {",
            "entry:",
        ]
        self._print_values()
        self._print_orders()
        self.text += ["ret void", "}"]
        return self.text

    # --- pieces of text

    def _new(self, text: str) -> str:
        name = f"%v{next(self._names)}"
        self.text.append(f"  {name} = {text}")
        return name

    def _place(self, base: str, index: int | str) -> str:
        return self._new(f"getelementptr double, ptr {base}, i64 {index}")

    def _load(self, base: str, index: int | str) -> str:
        return self._new(f"load double, ptr {self._place(base, index)}, align 8")

    def _store(self, value: str, base: str, index: int | str) -> None:
        place = self._place(base, index)
        self.text.append(f"  store double {value}, ptr {place}, align 8")

    def _sum(self, terms: Iterable[tuple[float, str]]) -> str | None:
        """Return the sum of numbers with signs; None of none."""
        total = None
        for sign, term in sorted(terms, key=lambda pair: -pair[0]):
            if total is None:
                total = term if sign > 0.0 else self._new(f"fneg double {term}")
            else:
                operation = "fadd" if sign > 0.0 else "fsub"
                total = self._new(f"{operation} contract double {total}, {term}")
        return total

    def _product(self, a: str, b: str) -> str:
        return self._new(f"fmul contract double {a}, {b}")

    # --- values: order 0

    def _print_values(self) -> None:
        """Print the value of every node, and the first two coefficients of the state."""
        for node in self.recorded.nodes:
            self.first[node.place] = self._value(node)
        for node in self.recorded.nodes:
            if node.place in self.moving:
                self._print_inverse(node)
            if node.place in self.moving and node.name == graph.HYPERBOLIC_TANGENT:
                self.first_slope[node.place] = self._slope(node)
        for i in range(self.recorded.size):
            self._store(self._load("%y", i), "%out", i * (self.order + 1))
            self._store(
                self.first[self.recorded.outputs[i].place], "%out", i * (self.order + 1) + 1
            )
        for i in range(self.guards):
            guard = self.recorded.outputs[self.recorded.size + i]
            self._store(self.first[guard.place], "%out", self._guard_place(i))

    def _value(self, node: graph.Node) -> str:
        operands = [self.first[operand.place] for operand in node.operands]
        match node.name:
            case graph.CONSTANT:
                return _written(node.value)
            case graph.STATE:
                return self._load("%y", int(node.value))
            case graph.PARAMETER:
                return self._load("%p", int(node.value))
            case graph.LESS:
                flag = self._new(f"fcmp ogt double {operands[1]}, {operands[0]}")
                return self._new(f"uitofp i1 {flag} to double")
            case graph.SELECT:
                flag = self._new(f"fcmp une double {operands[0]}, {ZERO}")
                return self._new(f"select i1 {flag}, double {operands[1]}, double {operands[2]}")
            case name if name in SCALARS:
                return self._new(SCALARS[name].format(*operands))
        raise graph.NotRecordable(f"{node.name} of single numbers")

    def _print_inverse(self, node: graph.Node) -> None:
        """Print what the coefficients of a node are divided by."""
        match node.name:
            case graph.QUOTIENT:
                operand, factor = node.operands[1].place, "1.0"
            case graph.ROOT:
                operand, factor = node.place, "0.5"
            case graph.POWER | graph.LOGARITHM:
                operand, factor = node.operands[0].place, "1.0"
            case _:
                return
        if (factor, operand) not in self.inverse:
            divided = self._new(f"fdiv double {factor}, {self.first[operand]}")
            self.inverse[factor, operand] = divided

    def _guard_place(self, guard: int) -> int:
        return self.recorded.size * (self.order + 1) + guard * self.order

    # --- coefficients of the orders from 1 on

    def _print_orders(self) -> None:
        """Print the loop over the orders."""
        recorded = self.recorded
        self.text += [
            "  br label %orders",
            "orders:",
            "  %k = phi i64 [ 1, %entry ], [ %next, %orders ]",
        ]
        self.order_number = self._new("uitofp i64 %k to double")
        for node in recorded.nodes:
            if node.place in self.moving and node.place not in self.deferred:
                self.term[node.place] = self._coefficient(node)
        for (name, place), row in self.rows.items():
            term = self.term[place]
            if name == DERIVATIVE:
                term = self._product(self.order_number, term)
            elif name == SLOPE:
                term = self._slope_coefficient(place)
            self._store(
                term, "%room", self._new(f"add i64 %k, {row * self.row_length + self.zeros}")
            )
        self.text.append("  %next = add i64 %k, 1")
        part = self._new(f"fdiv double 1.0, {self._new('uitofp i64 %next to double')}")
        for i, output in enumerate(recorded.outputs):
            term = self.term.get(output.place, ZERO)
            if i < recorded.size:
                index = self._new(f"add i64 %next, {i * (self.order + 1)}")
                self._store(self._product(part, term), "%out", index)
            else:
                index = self._new(f"add i64 %k, {self._guard_place(i - recorded.size)}")
                self._store(term, "%out", index)
        self.text += [
            f"  %go_on = icmp ult i64 %next, {self.order}",
            "  br i1 %go_on, label %orders, label %done",
            "done:",
        ]

    def _coefficient(self, node: graph.Node) -> str:
        a, b = _two_of(node)
        match node.name:
            case graph.STATE:
                index = self._new(f"add i64 %k, {int(node.value) * (self.order + 1)}")
                return self._load("%out", index)
            case graph.SUM | graph.DIFFERENCE | graph.NEGATIVE:
                return self._combined(self._leaves(node))
            case graph.PRODUCT if self._both_move(node):
                return self._combined([(1.0, node)])
            case graph.PRODUCT:
                moved, fixed = (a, b) if a.place in self.moving else (b, a)
                return self._product(self.first[fixed.place], self.term[moved.place])
            case graph.QUOTIENT:
                convolved = (
                    [(-1.0, (PLAIN, b.place), (PLAIN, node.place))]
                    if b.place in self.moving
                    else []
                )
                ends = [(-1.0, self.term[b.place], self.first[node.place])] if convolved else []
                above = self._combined(self._leaves_of(a), convolved, ends)
                return self._product(above, self.inverse["1.0", b.place])
            case graph.ROOT:
                above = self._combined(
                    self._leaves_of(a), [(-1.0, (PLAIN, node.place), (PLAIN, node.place))]
                )
                return self._product(above, self.inverse["0.5", node.place])
            case graph.POWER if b.place not in self.moving:
                return self._power(node, a, b)
            case graph.EXPONENTIAL:
                slope = (PLAIN, node.place), self.first[node.place]
                return self._integral(a, *slope)
            case graph.HYPERBOLIC_TANGENT:
                slope = (SLOPE, node.place), self.first_slope[node.place]
                return self._integral(a, *slope)
            case graph.LOGARITHM:
                return self._logarithm(node, a)
            case graph.SELECT:
                flag = self._new(f"fcmp une double {self.first[node.operands[0].place]}, {ZERO}")
                yes, no = (self.term.get(operand.place, ZERO) for operand in node.operands[1:])
                return self._new(f"select i1 {flag}, double {yes}, double {no}")
            case graph.SIZE:
                flag = self._new(f"fcmp ult double {self.first[a.place]}, {ZERO}")
                negative = self._new(f"fneg double {self.term[a.place]}")
                return self._new(
                    f"select i1 {flag}, double {negative}, double {self.term[a.place]}"
                )
        raise graph.NotRecordable(f"{node.name} has no rule for Taylor coefficients")

    def _power(self, node: graph.Node, base: graph.Node, exponent: graph.Node) -> str:
        """Return the coefficient of a power: k a_0 p_k = sum of ((e + 1) j - k) a_j p_(k-j)."""
        term, first = self.term[base.place], self.first[node.place]
        power = (PLAIN, node.place)
        plain = self._combined([], [(1.0, (PLAIN, base.place), power)], [(1.0, term, first)])
        scaled = self._product(self.order_number, term)
        derivative = (DERIVATIVE, base.place)
        weighted = self._combined([], [(1.0, derivative, power)], [(1.0, scaled, first)])
        factor = self._new(f"fadd double {self.first[exponent.place]}, 1.0")
        total = self._sum(
            [
                (1.0, self._product(factor, weighted)),
                (-1.0, self._product(self.order_number, plain)),
            ]
        )
        inverse = self._new(f"fdiv double {self.inverse['1.0', base.place]}, {self.order_number}")
        assert total is not None
        return self._product(total, inverse)

    def _integral(self, operand: graph.Node, slope: Row, first_slope: str) -> str:
        """Return the coefficient of a function whose derivative, its slope, is a row: k f_k = sum
        of j a_j slope_(k-j).
        """
        scaled = self._product(self.order_number, self.term[operand.place])
        derivative = (DERIVATIVE, operand.place)
        total = self._combined([], [(1.0, derivative, slope)], [(1.0, scaled, first_slope)])
        return self._new(f"fdiv double {total}, {self.order_number}")

    def _slope(self, node: graph.Node) -> str:
        """Return the value of the derivative of a hyperbolic tangent, 1 - node^2."""
        value = self.first[node.place]
        return self._new(f"fsub contract double 1.0, {self._product(value, value)}")

    def _slope_coefficient(self, place: int) -> str:
        """Return the coefficient of the derivative of a hyperbolic tangent."""
        row, first, term = (PLAIN, place), self.first[place], self.term[place]
        ends = [(-1.0, first, term), (-1.0, term, first)]
        return self._combined([], [(-1.0, row, row)], ends)

    def _logarithm(self, node: graph.Node, operand: graph.Node) -> str:
        """Return the coefficient of a logarithm: k a_0 l_k = k a_k - sum of j l_j a_(k-j)."""
        below = self._combined([], [(1.0, (DERIVATIVE, node.place), (PLAIN, operand.place))])
        mean = self._new(f"fdiv double {below}, {self.order_number}")
        above = self._sum([(1.0, self.term[operand.place]), (-1.0, mean)])
        assert above is not None
        return self._product(above, self.inverse["1.0", operand.place])

    def _leaves(self, node: graph.Node) -> list[tuple[float, graph.Node]]:
        """Return the moving nodes, with signs, of which a sum consists."""
        signs = {graph.SUM: (1.0, 1.0), graph.DIFFERENCE: (1.0, -1.0), graph.NEGATIVE: (-1.0,)}
        return [
            (sign * inner, leaf)
            for sign, operand in zip(signs[node.name], node.operands, strict=True)
            for inner, leaf in self._leaves_of(operand)
        ]

    def _leaves_of(self, node: graph.Node) -> list[tuple[float, graph.Node]]:
        if node.place not in self.moving:
            return []
        if node.place in self.deferred and node.name in LINEAR:
            return self._leaves(node)
        return [(1.0, node)]

    def _combined(
        self,
        leaves: Iterable[tuple[float, graph.Node]],
        convolved: Iterable[tuple[float, Row, Row]] = (),
        ends: Iterable[tuple[float, str, str]] = (),
    ) -> str:
        """Return the sum of nodes, deferred products among them, of convolutions, and of products
        of two numbers.
        """
        convolved, ends, terms = list(convolved), list(ends), list[tuple[float, str]]()
        for sign, leaf in leaves:
            if leaf.name == graph.PRODUCT and leaf.place not in self.term and self._both_move(leaf):
                x, y = (operand.place for operand in leaf.operands)
                convolved.append((sign, (PLAIN, x), (PLAIN, y)))
                ends.append((sign, self.first[x], self.term[y]))
                ends.append((sign, self.term[x], self.first[y]))
            else:
                terms.append((sign, self.term[leaf.place]))
        terms += [(sign, self._product(first, second)) for sign, first, second in ends]
        vector = None
        for sign, a, b in sorted(convolved, key=lambda term: -term[0]):
            for chunk in range(self.vectors):
                vector = self._accumulated(vector, sign, a, b, chunk)
        if vector is not None:
            total = self._new(
                f"call reassoc double @llvm.vector.reduce.fadd.v{WIDTH}f64(double 0.0,"
                f" <{WIDTH} x double> {vector})"
            )
            terms.append((1.0, total))
        total_name = self._sum(terms)
        return ZERO if total_name is None else total_name

    def _accumulated(self, vector: str | None, sign: float, a: Row, b: Row, chunk: int) -> str:
        """Return a vector plus, or minus, products of a part of two rows, one of them backwards."""
        forwards, backwards = self._chunk("forwards", a, chunk), self._chunk("backwards", b, chunk)
        product = self._new(f"fmul contract <{WIDTH} x double> {forwards}, {backwards}")
        if vector is None:
            return product if sign > 0.0 else self._new(f"fneg <{WIDTH} x double> {product}")
        operation = "fadd" if sign > 0.0 else "fsub"
        return self._new(f"{operation} contract <{WIDTH} x double> {vector}, {product}")

    def _chunk(self, direction: str, row: Row, chunk: int) -> str:
        """Return a vector of coefficients j, or k - j, of a node for the j of a chunk."""
        key = direction, row, chunk
        if key not in self.chunks:
            begin = self.rows[row] * self.row_length + self.zeros
            if direction == "forwards":
                where = self._place("%room", begin + WIDTH * chunk)
                self.chunks[key] = self._new(f"load <{WIDTH} x double>, ptr {where}, align 8")
            else:
                index = self._new(f"add i64 %k, {begin - WIDTH * chunk - (WIDTH - 1)}")
                where = self._place("%room", index)
                loaded = self._new(f"load <{WIDTH} x double>, ptr {where}, align 8")
                order = ", ".join(f"i32 {lane}" for lane in reversed(range(WIDTH)))
                self.chunks[key] = self._new(
                    f"shufflevector <{WIDTH} x double> {loaded}, <{WIDTH} x double> poison,"
                    f" <{WIDTH} x i32> <{order}>"
                )
        return self.chunks[key]


def _two_of(node: graph.Node) -> tuple[graph.Node, graph.Node]:
    """Return the first two operands of a node, which stands for those that it has not."""
    first, second, *_ = (*node.operands, node, node)
    return first, second


def _moving(recorded: Recorded) -> set[int]:
    """Return the places of the nodes that depend on the state and have no constant coefficients."""
    moving = set[int]()
    for node in recorded.nodes:
        if node.name == graph.STATE or (
            node.name != graph.LESS
            and not moving.isdisjoint([operand.place for operand in node.operands])
        ):
            moving.add(node.place)
    return moving


def _written(number: float) -> str:
    return f"0x{pack('>d', number).hex().upper()}"
