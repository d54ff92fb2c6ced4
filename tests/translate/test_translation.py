"""What is translated of Python into JavaScript means there what it meant."""

import json
import subprocess

import pytest

from node import NODE
from tippetop.page_engine import HERE
from tippetop.translate.definitions import Definitions
from tippetop.translate.layout import WIDTH, laid_out
from tippetop.translate.refusal import Untranslatable
from tippetop.translate.symbols import SymbolTable

MODULE = """
import math
from dataclasses import dataclass, replace
from enum import Enum, IntEnum
from functools import lru_cache
from math import hypot as distance
from math import inf
from typing import Any, ClassVar, NamedTuple

class Colour(Enum):
    RED = "a colour"
    BLUE = "another"

class Step(IntEnum):
    NONE = 0
    TWO = 2

class Point(NamedTuple):
    x: Any
    y: Any = 2.0

    @property
    def size(self):
        return math.hypot(*self)

    @classmethod
    def of(cls, numbers):
        return cls(*numbers)

class Maker(NamedTuple):
    made: type[Any]
    number: Any

    def two(self):
        return [self.made(*one) for one in ((self.number,), (1.0, self.number))]

@dataclass(frozen=True)
class Base:
    name: str
    place: Point

    loud: ClassVar[bool] = False

    def told(self, *, twice=False):
        return self.name * (2 if twice else 1)

    def parts(self, count):
        for number in range(count):
            yield number, self.told()

@dataclass(frozen=True)
class Louder(Base):
    volume: float = 3.0

    loud: ClassVar[bool] = True

    def told(self, *, twice=False):
        return super().told(twice=twice) + "!"

class Ring:
    def __init__(self, number):
        self.number = number % 7

    def __add__(self, other):
        if isinstance(other, Knot):
            return NotImplemented
        return Ring(self.number + (other.number if isinstance(other, Ring) else other))

    def __radd__(self, other):
        return self + other

    def __mul__(self, other):
        return Ring(self.number * other.number)

class Gold(Ring):
    def __radd__(self, other):
        return Gold(self.number + other.number + 3)

class Knot:
    def __radd__(self, other):
        return Ring(other.number + 4)

class Wrong(ValueError):
    def __init__(self, field):
        name = field if field.isprintable() else "it"
        super().__init__(f"{name} is wrong")
        self.field = field

CALLS = []

@lru_cache
def remembered(point, word):
    CALLS.append(word)
    return point.x

def tuples():
    a, *rest = (1.0, 2.0, 3.0, 4.0)
    (b, _), c = (5.0, 6.0), 7.0
    point = Point(y=1.0, x=a)
    x, y = point._replace(x=8.0)
    return [a, rest, b, c, x, y, point == (1.0, 1.0), point == Point.of([1.0, 1.0]),
            Point(3.0, 4.0).size,
            Maker(Point, 0.75).two()[1].size, Maker(Point, 0.0).two()[0].y,
            rest[-1], rest[::-1], rest[1:], rest[:-1], [*rest, *point], (0.0,) * 3,
            point != (1.0, 2.0)]

def records():
    here = Louder("a", Point(1.0), volume=4.0)
    there = replace(here, name="b")
    told = {"first": Base.told, "second": lambda one: one.name}
    return [there.told(), there.told(twice=True), told["first"](there), there.loud,
            there == replace(here, name="b"),
            there == here,
            list(there.parts(2)), there.place.y, isinstance(there, Base), here.volume]

def arithmetic():
    found = []
    for work in (lambda: 1.0 / (2.0 - 2.0), lambda: (1.0 - 1.0) ** -0.5, lambda: 1e200 ** 2):
        try:
            found.append(work())
        except ArithmeticError as error:
            found.append(isinstance(error, ZeroDivisionError))
    for word in ("a field", "two\\nlines"):
        try:
            raise Wrong(word)
        except ValueError as error:
            found += [str(error), error.field, repr(word[:3])]
    three, none = Ring(5) + 4, inf - inf
    gold = Ring(1) + Gold(2)
    rings = [(Ring(5) + Knot()).number, gold.number, isinstance(gold, Gold)]
    return [*found, *rings, (2 + three).number, (three * three).number, 7 // 2, -7 // 2, -7 % 3,
            2.0**0.5,
            True + 1, -inf < 0.0, distance(3.0, 4.0), sum([1, 2], 10), max(3, 1, 2),
            min([4.0, 2.0]),
            max([], default=-1.0), 1 if not () else 0, max(2.0, 5.0, 3.0), min(2.0, 2),
            max(*[1.0, 4.0]),
            max(none, 1.0) != max(none, 1.0), max(1.0, none), min(1.0, none), max(False, 0),
            max(0, False),
            min(True, 3), list(range(2, 9, 3)), list(range(5, 0, -2)), list(range(3, 3)),
            list(map(lambda a: a + 1, (1, 2))), list(map(lambda a, b: a * b, (1, 2, 3), [4, 5])),
            list(map(lambda a, b, c: a + b - c, (1, 2), range(2), (5, 6, 7)))]

def choices():
    found = []
    for number, word in enumerate(["red", "blue", "grey", ""]):
        if word == "red":
            found.append(Colour.RED.value)
        elif word == "blue":
            found.append(Colour.BLUE.name)
        if number > 1:
            found.append(word or number)
    if 1.0 <= len(found) < 5.0 and "red" not in found:
        found.append(f"{len(found)} {Step.TWO + 1}")
    best = max([Point(1.0, 5.0), Point(2.0, 4.0)], key=lambda one: one.y)
    table = {word: place for place, word in enumerate("ab")}
    table["c"] = 5
    square = next((n for n in range(9) if n * n > 20), None)
    return [*found, best.x, square, table.get("d", -1), sorted([2, 1]),
            [a + b for a in (1, 2) for b in (10, 20) if b > 10], table["a"], any([]), all([]),
            len(table), 1 if table else 0, 1 if dict([]) else 0]

def closures():
    total = 0.0
    count = 3
    while count > 0:
        left = count
        def more(by, times=2.0):
            return by * times + left
        total += more(1.0, 4.0)
        count -= 1
    values = [1.0, 2.0, 3.0, 4.0]
    values = values[:2]
    values[0] = values[1]
    numbers = (0.0, 2.6, -293456.0, 1e6, 9.9996, 9.96e-5, 1e-4, inf)
    words = [f"{number:g} {number:.3g} {number:.1g}" for number in numbers]
    calls = [remembered(Point(1.0), "a"), remembered(Point(1.0), "a"), len(CALLS)]
    return [*words, total, count, values, *calls]
"""

TESTS = ("tuples", "records", "arithmetic", "choices", "closures")


def plain(value):
    """A value as JSON has it."""
    return json.loads(json.dumps(value))


def run(lines, folder):
    """What JavaScript with these lines prints, and what goes wrong in it."""
    script = folder / "sample.mjs"
    runtime = f'import * as py from "{(HERE / "python.js").as_uri()}";'
    script.write_text("\n".join([runtime, *lines]), encoding="utf-8")
    ran = subprocess.run([NODE, str(script)], capture_output=True, text=True, check=False)
    return ran.stdout, ran.stderr


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    """What the functions return in Python, and in JavaScript."""
    space = {"__name__": "sample"}
    exec(compile(MODULE, "sample", "exec"), space)
    program = SymbolTable({"sample": MODULE})
    lines = list(Definitions(program, "sample").module_lines())
    lines.append(f"console.log(JSON.stringify([{', '.join(f'{name}()' for name in TESTS)}]));")
    found, wrong = run(lines, tmp_path_factory.mktemp("translated"))
    assert not wrong, wrong
    return {name: plain(space[name]()) for name in TESTS}, dict(
        zip(TESTS, json.loads(found), strict=True)
    )


@pytest.mark.parametrize("name", TESTS)
def test_translated_functions_return_the_same(both, name):
    assert both[1][name] == both[0][name]


PLAIN = """
# translate module: numbers

def numbers(x=3.0):
    row = [x - 1.0, -x] + [abs(x - 5.0)]
    row += [0.0] * 2
    try:
        row.append(x / (x - 3.0))
    except ZeroDivisionError:
        row.append(x * 2.0 / 4.0 - (x - (1.0 - x)))
    return row
"""


def test_arithmetic_of_numbers_alone_is_that_of_javascript_and_means_the_same(tmp_path):
    program, space = SymbolTable({"sample": PLAIN}), {}
    exec(PLAIN, space)
    lines = list(Definitions(program, "sample").module_lines())
    assert "2.0 / 4.0 - (x - (1.0 - x))" in "".join(lines)
    found, wrong = run([*lines, "console.log(JSON.stringify(numbers()))"], tmp_path)
    assert not wrong
    assert json.loads(found) == space["numbers"]()
    _, wrong = run([*lines, "numbers(new py.Thing());"], tmp_path)
    assert "TypeError: what is compared, or added to something, is no number" in wrong


def test_the_runtimes_functions_are_called_where_a_module_declares_so():
    size = "def size(x):\n    return x\n"
    two = "from one import size\ndef f(x):\n    return size(x)\n"
    lines = Definitions(SymbolTable({"one": size, "two": two}), "two").module_lines()
    assert "return size(x);" in "".join(lines)
    program = SymbolTable({"one": f"# translate: runtime\n{size}", "two": two})
    assert "return py.size(x);" in "".join(Definitions(program, "two").module_lines())


def test_a_name_written_by_hand_is_not_confused_with_another_modules():
    sources = {
        "by_hand": "# translate module: by hand in hand.js\n",
        "one": "def size(x):\n    return x\n",
        "two": "from by_hand import size\n",
    }
    with pytest.raises(Untranslatable, match="two:1: size of by_hand"):
        SymbolTable(sources)
    program = SymbolTable({name: sources[name] for name in ("by_hand", "two", "one")})
    assert program.names["one", "size"] != program.names["two", "size"]


def test_long_lines_are_broken_into_the_same_code():
    args = ", ".join(f"f({number}, [1.0, x{number}])" for number in range(12))
    text = f'say("of (many, things", `and ${{name}}, too`, {args})'
    for line in (
        f"  return {text};",
        f"  if (a) {{ {text}; }}",
        f"  const total = h * ({args.replace(', f', ' + f')});",
    ):
        lines = list(laid_out(line))
        assert len(lines) > 10
        assert max(map(len, lines)) <= WIDTH
        assert "".join("".join(lines).split()) == "".join(line.split())
    assert list(laid_out(f"/** {args}, {args} */")) == [f"/** {args}, {args} */"]
    assert list(laid_out("f(1, 2);")) == ["f(1, 2);"]
