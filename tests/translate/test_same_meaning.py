"""Snippets whose meaning differs between Python and JavaScript: their translation means the same.

What is refused instead is in `test_refusals.py`.
"""

import json

import pytest

from node import printed
from tippetop.page_engine import HERE
from tippetop.translate.definitions import Definitions
from tippetop.translate.symbols import SymbolTable

HEAD = """
import math
from dataclasses import dataclass, replace
from enum import Enum, IntEnum, StrEnum
from functools import lru_cache
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple
"""

DEFINITIONS = """
class Kind(Enum):
    ROUND = "round"

class Word(StrEnum):
    LONG = "long"

class Pair(NamedTuple):
    first: float
    second: float = 2.0

@dataclass(frozen=True)
class Forward:
    name: str
    def run(self, left, right=5, *, up=7):
        return [left, right, up]

@dataclass(frozen=True)
class Backward:
    name: str
    def run(self, right=5, left=6, *, up=7):
        return [left, right, up]

@dataclass(frozen=True)
class Level:
    run: float

class Same:
    limit = 3
    def __init__(self, number):
        self.number = number
    def __eq__(self, other):
        return isinstance(other, Same) and self.number == other.number
    def twice(self):
        return 2 * self.number

def first_of(row):
    row += [9]
    return row

@lru_cache
def kind_of(value):
    return isinstance(value, str)
"""

SNIPPETS = {
    "a list extended in place is seen through another name": """
row: list[int] = [1]
other = row
other += [2]
first_of(other)
result = [row, other]
""",
    "a tuple is not": """
row: tuple[int, ...] = (1,)
other = row
other = other + (2,)
result = [list(row), list(other)]
""",
    "one list bound to two names": """
a = b = [1]
b.append(2)
result = [a, b]
""",
    "the end of a range changes in its loop": """
count, turns = 3, 0
for _ in range(count):
    count -= 1
    turns += 1
rows = [1, 2]
for number in range(len(rows)):
    rows.append(number)
result = [turns, count, rows]
""",
    "the variable of a range changes in its loop, and is read after it": """
seen = []
for number in range(4):
    seen.append(number)
    number += 2
for last in range(3):
    pass
result = [seen, number, last]
""",
    "functions made in a loop read its variable later": """
late = []
for number in range(3):
    late.append(lambda: number)
words = []
for word in "ab":
    words.append(lambda: word)
result = [[one() for one in late], [one() for one in words]]
""",
    "enumerate with a start": """
result = [[place, word] for place, word in enumerate("ab", 3)] + list(enumerate([5.5], start=-1))
""",
    "sets: truth and size": """
empty, full = set[int](), {1, 2, 2}
full.add(3)
full.add(3)
result = [1 if empty else 0, 1 if full else 0, len(empty), len(full), not empty, bool(full),
    sorted({n % 3 for n in range(9)}), 2 in full, [1 if empty or full else 0]]
""",
    "tuples of which one is a prefix": """
rows = [(1, 2, 3), (1, 2), (0, 5), (1,), (1, 2)]
result = [sorted(rows), list(max(rows)), list(min(rows)), list(max([(1,), (1, 0)]))]
""",
    "sorted is stable, by keys that are tuples or strings too": """
pairs = [(2, "b"), (1, "b"), (2, "a"), (10, "B")]
result = [sorted(pairs, key=lambda pair: pair[1]), sorted(pairs, key=lambda pair: -pair[0]),
    sorted([10, 9, 1, -3]), sorted(pairs)]
""",
    "modulo and division of integers and floats": """
cases = [(7, 3), (-7, 3), (7, -3), (-7, -3), (1.0, 0.1), (-1.0, 0.1), (5.5, 0.3), (1e17, 3.0),
    (0.3, 0.1), (-1e-20, 3.0), (6.0, 2.0), (2.5, -1.0)]
result = [[a // b, a % b] for a, b in cases]
""",
    "division by zero": """
result = []
for work in (lambda: 1 // 0, lambda: 1 % 0, lambda: 1.0 / 0.0, lambda: 0.0 ** -1):
    try:
        result.append(work())
    except ZeroDivisionError as error:
        result.append("zero")
""",
    "what has no value in the real numbers": """
result = []
for work in (lambda: math.sqrt(-1.0), lambda: math.acos(2.0), lambda: math.log(0.0),
             lambda: int("x"), lambda: float("1x"), lambda: float(""), lambda: [1, 2].index(3)):
    try:
        result.append(work())
    except ValueError as error:
        result.append("no value")
for large in (lambda: math.exp(1e3), lambda: math.sinh(1e3), lambda: 1e300 ** 2):
    try:
        result.append(large())
    except ArithmeticError as error:
        result.append("too large")
""",
    "an error is caught by its class": """
result = []
for work in (lambda: 1 // 0, lambda: int("x")):
    try:
        try:
            result.append(work())
        except ValueError as error:
            result.append("value")
    except ArithmeticError as error:
        result.append("arithmetic")
""",
    "quotes in strings": """
words = ["plain", "it's", 'say "so"', "it's \\"so\\"", "back\\\\slash",
    "tab\\t, line\\n, bell\\x07",
    "\\u00e9 \\u200b \\U0001f600"]
result = [repr(word) for word in words] + [f"{word!r}" for word in words]
""",
    "values as text": """
count, word, flag, none = 3, "a", True, None
result = [f"{count} {word} {flag} {none}", str(count), str(flag), repr(none), f"{{{count}}}",
    f"`${{{word}}} \\\\ \\"", str(Kind.ROUND), f"{Word.LONG}", Kind.ROUND.name, Word.LONG.value]
""",
    "numbers in a format": """
numbers = [0.0, -0.0, 2.5, 3.5, 0.125, 0.375, 1e5, 123456.0, 1234567.0, 1e-4, 1.5e-5, 1e22, 0.1,
    -2.5, 9.995, 2.0**-25, 1.0 / 3.0, 1e100, 5e-324, math.inf, -math.inf, math.nan, 100.0, 1e16]
result = [f"{number:g} {number:.1g} {number:.2g} {number:.3g} {number:.6g} {number:.17g}"
    for number in numbers]
""",
    "comparisons in a row": """
a, b, c = 1.0, 2.0, 3.0
result = [a < b < c, a < c < b, 1 <= a <= 1, a < b > 1.5 != c, not a < b < c]
""",
    "and, or: the operand is the result": """
empty: list[int] = []
result = [empty or [1], [] and 1, 0 or "x", "" or 0.0, [0] and "y", {} or 2, None or (),
    (0, 0) and 3, 0.0 or None, "a" and "" or "b", Pair(0.0) and 1, 1 if math.nan else 0]
""",
    "truth values are numbers": """
flags = [True, False, True]
result = [sum(flags), True + True, True == 1, 1 == True, 0 == False, 2 == True, -True, True * 2.5,
    (1 < 2) | (2 < 1), (1 < 2) & (2 < 1), 1 in [True], max(flags), [True, 2] == [1, 2], abs(-2)]
""",
    "equality": """
result = [(1, 2) == (1, 2), (1, (2,)) == (1, (2,)), [1] == [1, 2], Pair(1.0) == (1.0, 2.0),
    Pair(1.0) != Pair(1.0), None == 0, "" == 0, Same(1) == Same(1), Same(1) != Same(2),
    Forward("a") == Backward("a"), Word.LONG == "long", "long" == Word.LONG, Kind.ROUND == "round",
    math.nan == math.nan, Forward("a") == Forward("a"), "1" == 1, [Same(1)] == [Same(1)]]
""",
    "places from the end, and slices": """
row, text = [1, 2, 3, 4], "abcd"
place = -2
row[-1] = 9
result = [row[-1], row[place], row[-3:-1], row[::-1], row[:-1], row[5:], row[:0], text[-1],
    text[1:3], row[2::-1], (1, 2, 3)[-1], Pair(1.0)[-1]]
""",
    "strings: parts, and what they begin with": """
result = ["ab" in "cabd", "" in "a", "ac" in "abc", "abc".startswith("ab"), "abc".index("c"),
    "x".join(["a", "b"]), "abc".removeprefix("ab"), "a, b".split(", "), "aBc".lower(),
    "ab" * 2, "a" + "b", "a" < "b", "B" < "a", [letter for letter in "hi"]]
""",
    "dicts: keys that are no strings, what lacks, and what is looked up": """
table = {1: "one", 2.5: "more", "1": "text", None: "none", Kind.ROUND: "round"}
table[2] = "two"
result = [table[1], table["1"], table.get(3, "no"), table.get(3), len(table), 2.5 in table,
    list({"b": 1, "a": 2}), [[key, value] for key, value in {"b": 1, "a": 2}.items()],
    {**{"a": 1}, "b": 2}["a"], list({n: n * n for n in range(3)}.values()), table[None],
    table[Kind.ROUND]]
""",
    "what is cached by values": """
result = [kind_of("1"), kind_of(1), kind_of((1, 2)), kind_of("(1,2)"), kind_of("1")]
""",
    "methods of one name with parameters in different orders": """
one, other = Forward("a"), Backward("b")
work = other.run
result = [one.run(1, up=2), other.run(1, up=2), one.run(left=1), other.run(left=1, right=3),
    work(left=4), Level(2.5).run, [which.run(1) for which in (one, other)]]
""",
    "constants of classes, and methods as values": """
one = Same(4)
work = one.twice
result = [Same.limit, one.limit, work(), getattr(one, "twice", None)(), getattr(one, "no", 5),
    hasattr(one, "limit"), hasattr(one, "no")]
""",
    "records with other values": """
one = replace(Forward("a"), name="b")
two = Pair(1.0)._replace(second=5.0)
result = [one.name, list(two), isinstance(two, tuple), isinstance("a", str),
    isinstance(one, Backward),
    isinstance(1.5, (int, float)), isinstance("1", (int, float)), isinstance(True, bool)]
""",
    "arguments by name, and defaults that are made once": """
def made(a, b=(1, 2), *, c=Pair(3.0)):
    return [a, list(b), list(c)]
result = [made(1), made(b=(4,), a=2), made(1, c=Pair(5.0))]
""",
    "rows that are as long as each other": """
result = [list(zip((1, 2), (3, 4), strict=True)), list(zip((1, 2), (3,)))]
result.append(list(zip("ab", range(9))))
try:
    result.append([list(pair) for pair in zip((1, 2), (3,), strict=True)])
except ValueError as error:
    result.append("lengths differ")
""",
    "swaps and nested targets": """
a, b = 1, 2
a, b = b, a
(c, d), *more = (3, 4), 5, 6
result = [a, b, c, d, more, list(pairwise([1, 2, 3])), next((n for n in (0, 3) if n), None)]
""",
    "rounding towards zero and down": """
result = [int(-2.7), int(2.7), int("-12"), int(True), math.floor(-2.5), math.ceil(-2.5), -7 // 2,
    float("1e3"), float("-inf") < 0.0, 2**10, 2**-1, (-8.0) ** 2, 7 / 2, 6 / 2]
""",
}


def as_json(value):
    """Return a value as JSON has it, infinities and what is no number as words."""
    if isinstance(value, dict):
        return {key: as_json(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(one) for one in value]
    return value


@pytest.fixture(scope="module")
def results():
    """The results of all snippets in Python and in JavaScript, by their names."""
    snippets = [
        f"def snippet_{number}():\n"
        + "".join(f"    {line}\n" for line in text.strip().split("\n"))
        + "    return result\n"
        for number, text in enumerate(SNIPPETS.values())
    ]
    source = "\n".join([HEAD, DEFINITIONS, *snippets])
    space = {"__name__": "snippets"}
    exec(compile(source, "snippets", "exec", dont_inherit=True), space)
    lines = [f'import * as py from "{(HERE / "python.js").as_uri()}";']
    lines += Definitions(SymbolTable({"snippets": source}), "snippets").module_lines()
    lines += [
        f"""
        try {{ console.log(JSON.stringify(snippet_{number}())); }}
        catch (error) {{ console.log(JSON.stringify(String(error))); }}
        """
        for number in range(len(SNIPPETS))
    ]
    theirs = printed("\n".join(lines)).splitlines()
    ours = [space[f"snippet_{number}"]() for number in range(len(SNIPPETS))]
    return dict(zip(SNIPPETS, zip(ours, map(json.loads, theirs), strict=True), strict=True))


@pytest.mark.parametrize("name", SNIPPETS)
def test_javascript_returns_what_python_returns(results, name):
    ours, theirs = results[name]
    assert theirs == as_json(ours)
