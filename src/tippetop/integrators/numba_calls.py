"""What `dormand_prince` leaves to numba: how it calls what LLVM compiled, and what it may rely on.

The text of this is appended to that of `dormand_prince`, whose functions of the same names it
replaces.
"""

from collections.abc import Sequence
from typing import Any

from llvmlite import ir
from numba import extending
from numba.core import types
from numba.np import arrayobj

from tippetop.integrators.dormand_prince import LOOKS, POWERS, ROWS, Array

WIDTH = 8
"""How long rows of the state are."""

intrinsic: Any = extending.intrinsic
make_array: Any = arrayobj.make_array
populate_array: Any = arrayobj.populate_array
NUMBER, POINTER = ir.IntType(64), ir.IntType(8).as_pointer()


@intrinsic  # type: ignore[untyped-decorator]
def called(typing: Any, address: Any, y: Any, p: Any, out: Any, count: Any) -> Any:
    """Call the code at an address, for so many states."""

    def code(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        kinds = zip(signature.args[1:4], given[1:4], strict=True)
        rows = [make_array(kind)(context, builder, one).data for kind, one in kinds]
        kind = ir.FunctionType(ir.VoidType(), [POINTER] * 3 + [NUMBER]).as_pointer()
        places = [builder.bitcast(row, POINTER) for row in rows]
        builder.call(builder.inttoptr(given[0], kind), [*places, given[4]])
        return context.get_dummy_value()

    return types.void(address, y, p, out, count), code


@intrinsic  # type: ignore[untyped-decorator]
def fixed(typing: Any, array: Any) -> Any:
    """An array of a state's numbers, or of rows of them, whose shape the compiler knows."""

    def code(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        new, old = (make_array(array)(context, builder, *one) for one in ((), given))
        shape, strides = (
            [NUMBER(n) for n in pair[-array.ndim :]] for pair in ((ROWS, WIDTH), (8 * WIDTH, 8))
        )
        populate_array(new, old.data, shape, strides, NUMBER(8), None)
        return new._getvalue()

    return array(array), code


def evaluate(function: Sequence[int], y: Array, p: Array, out: Array) -> None:
    """Call a motion's function."""
    called(function[0], y, p, out, 1)


def look(
    guards: Sequence[int],
    p: Array,
    terms: Array,
    first: int,
    y: Array,
    values: Array,
    room: Array,
    tight: bool,
) -> bool:
    """Put the guards' values at the looks of a step into the rows of values after the first, all at
    once.

    It never says that none falls: to find out whether they vary takes as long.
    """
    for i in range(WIDTH):
        at = first + i * POWERS
        a, b, c, d = terms[at], terms[at + 1], terms[at + 2], terms[at + 3]
        e, f, g, h = terms[at + 4], terms[at + 5], terms[at + 6], terms[at + 7]
        for number in range(LOOKS):
            part = (number + 1) / LOOKS
            high = e + part * (f + part * (g + part * h))
            room[i * LOOKS + number] = a + part * (b + part * (c + part * (d + part * high)))
    called(guards[1], room, p[len(p) // (LOOKS + 1) :], room[WIDTH * LOOKS :], LOOKS)
    for guard in range(values.shape[1]):
        for number in range(LOOKS):
            values[number + 1, guard] = room[(WIDTH + guard) * LOOKS + number]
    return True
