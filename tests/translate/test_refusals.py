"""What would mean something else in JavaScript is refused, with file, line and one sentence.

What is translated is checked in `test_same_meaning.py`.
"""

import re

import pytest

from tippetop.translate.definitions import Definitions
from tippetop.translate.refusal import Untranslatable
from tippetop.translate.symbols import SymbolTable

HEAD = """
import math
import numpy as np
from dataclasses import dataclass, field, replace
from enum import Enum, IntEnum
from typing import Any, NamedTuple

class Kind(Enum):
    ROUND = "round"

class Step(IntEnum):
    ONE = 1

class Pair(NamedTuple):
    first: float
    second: float = 2.0

@dataclass(frozen=True)
class Forward:
    def run(self, left, right=5): return left
    def size(self): return 1

@dataclass(frozen=True)
class Backward:
    size: float
    def run(self, right, left=6): return left

def some(x, rows: list[float], pair: Pair, names: set[str], table: dict[str, float], n: int,
         value: float, word: str, one: Forward,
         shared: tuple[int, ...], either: list[int] | tuple[int, ...]):
"""

LINE = HEAD.count("\n") + 1

STATEMENTS = {
    # What is in place in Python.
    "rows *= 2": "lists are extended in place by += only",
    "either += (1,)": "a list is extended in place, a tuple is not",
    "shared += (1,)": "only lists are changed in place",
    "rows[len(rows) - 1] += 1": "the call in the target would be made twice",
    "names |= {word}": "operators of sets and dicts",
    # Loops.
    "for i in range(0, n, n): pass": "the step of a range must be a constant",
    "for i in range(n):\n        pass\n    else:\n        return 1": "such a statement",
    "while n:\n        n -= 1\n    else:\n        return 1": "such a statement",
    "return [lambda: i for i in rows]": "would all read the last value",
    # What is empty at second use.
    "values = (y for y in rows)\n    return [*values, *values]": "empty at second use",
    "values = map(math.cos, rows)\n    return [sum(values), sum(values)]": "empty at second use",
    "values = iter(rows)": "has 'iter'",
    "return next(x)": "a second value of an iterator",
    # Sets, dicts and tuples.
    "return names | names": "operators of sets and dicts",
    "return table | table": "operators of sets and dicts",
    "return names == {1}": "equality of sets and dicts",
    "return names < names": "the order of a set",
    "return (1, 2) < (1, 2, 3)": "the order of a tuple",
    "return rows < [1.0]": "the order of a list",
    "return pair < (1.0, 2.0)": "the order of",
    "return pair >= pair": "the order of class Pair",
    "return rows == (1.0, 2.0)": "a list never equals a tuple",
    "return [1] == (1,)": "a list never equals a tuple",
    "return pair[1:]": "parts of tuples with names",
    # Numbers.
    "return word % n": "formatting with %",
    "return 2**60": "exact up to 2**53",
    "return 9007199254740993": "exact up to 2**53",
    "return +x": "such an expression",
    "return ~n": "such an expression",
    "return n << 1": "such an operator",
    "return 1j": "such a constant",
    "return round(x)": "has 'round'",
    # Text.
    "return f'{value}'": "a float as text needs a format",
    "return str(value)": "a float as text needs a format",
    "return repr(pair.first)": "a float as text needs a format",
    "return f'{rows}'": "only strings and integers are written as text",
    "return f'{x:.3f}'": "format '.3f'",
    "return f'{x:>10}'": "format '>10'",
    "return f'{x!a}'": "such a format",
    # Identity, and what is told apart.
    "return word is word": "identity of numbers, strings",
    "return n is 3": "identity of constants",
    "return isinstance(x, int)": "does not tell int from float",
    "return isinstance(x, float)": "does not tell int from float",
    "return isinstance(x, list)": "does not tell lists from tuples",
    "return isinstance(x, int | float)": "takes a class or a tuple",
    "return Kind('round')": "Kind is looked up by value",
    "return Step(1)": "Step is looked up by value",
    "return Step.ONE.name": "an int has no 'name'",
    # Comparisons and calls.
    "return 0 < one.run(1) < 2": "would be made twice",
    "return sorted(rows, reverse=True)": "sorted takes key only",
    "return max(rows, of=3)": "max takes default and key only",
    "return one.run(1, **x)": "arguments by **",
    "return one.run(1, middle=2)": "nothing that is called takes middle",
    "return x.run(1, left=2)": "parameters in different orders",
    "return some(x, z=1)": "nothing that is called takes z",
    "return pair._replace(third=1)": "class Pair has no 'third'",
    "return replace(one, third=1)": "class Forward has no 'third'",
    # Functions.
    "def inner(a=[]): return a": "a default must be",
    "def inner(a=list(range(3))): return a": "a default must be",
    "return lambda a=n: a": "a default that reads a name of a function",
    "def inner(**more): return more": "parameters by **",
    "def inner():\n        yield 1": "inner, in a function, cannot yield",
    "def inner():\n        nonlocal x\n        x = 2": "such a statement",
    # Targets.
    "first, *more, last = rows": "only the last of several targets",
    "rows[0], n = 1.0, 2": "such a target",
    "rows[0] = rows[1] = some(1)": "one of several targets of a value must be a name",
    "del rows[0]": "such a statement",
    # Names that exist nowhere.
    "return nothing": "has 'nothing'",
    "return undefined(x)": "has 'undefined'",
    "return math.cbrt(x)": "no math.cbrt",
    "return np.einsum('i,i', x, x)": "no np.einsum",
    "return one.colour": "class Forward has no 'colour'",
    "return one.jump()": "class Forward has no 'jump'",
    "return x.nobody_has_this": "no class has no 'nobody_has_this'",
    "return x.nobody_does_this()": "no class has no 'nobody_does_this'",
    "return rows.extend(rows)": "a list has no 'extend'",
    "return rows.sort()": "a list has no 'sort'",
    "return word.replace('a', 'b')": "a str has no 'replace'",
    "return word.title()": "a str has no 'title'",
    "return names.union(names)": "a set has no 'union'",
    "return table.setdefault('a', 1)": "a dict has no 'setdefault'",
    "return Kind.SQUARE": "class Kind has no 'SQUARE'",
    "try:\n        return x\n    except KeyError:\n        return 1": "has 'KeyError'",
    "with open(x) as f: pass": "such a statement",
    "import json": "such a statement",
    "return (y := n)": "such an expression",
}


def refusal_of(text):
    """Return the sentence by which a module is refused."""
    with pytest.raises(Untranslatable) as refusal:
        list(
            Definitions(
                SymbolTable({"sample": text}, {"sample": "src/sample.py"}), "sample"
            ).module_lines()
        )
    return str(refusal.value)


@pytest.mark.parametrize("statement", STATEMENTS)
def test_a_statement_is_refused_with_file_and_line(statement):
    sentence = refusal_of(f"{HEAD}    {statement}\n")
    assert re.match(r"src/sample\.py:\d+: ", sentence), sentence
    assert STATEMENTS[statement] in sentence
    line = int(sentence.split(":")[1])
    assert LINE <= line <= LINE + statement.count("\n")


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("class A:\n    b: int = 3\n", 2, "annotated ClassVar"),
        ("class A:\n    def __len__(self): return 1\n", 2, "__len__ is not called by the runtime"),
        ("class A: pass\nclass B: pass\nclass C(A, B): pass\n", 3, "class C has several bases"),
        ("@total\nclass A: pass\n", 2, "decorator total"),
        ("@slow\ndef f(): return 1\n", 2, "decorator slow"),
        ("for i in range(3): pass\n", 1, "such a statement of a module"),
        ("A = B = 3\n", 1, "a constant has one name"),
        ("from math import cbrt\n", 1, "no math.cbrt"),
        ("X = Y\n", 1, "has 'Y'"),
        (
            "from dataclasses import dataclass, field\n@dataclass\nclass A:\n"
            "    b: list = field(default_factory=list)\n",
            4,
            "a default must be",
        ),
    ],
)
def test_a_definition_is_refused(text, line, words):
    sentence = refusal_of(text)
    assert sentence.startswith(f"src/sample.py:{line}: ")
    assert words in sentence


NUMBERS = "# translate module: numbers\nclass A:\n    def __add__(self, b): return b\n"


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("# translate module: integers\n", 1, "a module cannot declare 'integers'"),
        ("# translate: leave\ndef f(): pass\n", 1, "a definition cannot be 'leave'"),
        ("# translate: skip\n\ndef f(): pass\n", 1, "no definition begins below"),
        ("def f():\n    # translate: skip\n    x = 1\n", 2, "no definition begins below"),
        ("# translate: skip\ndef f(): pass\nx = f()\n", 3, "has 'f'"),
        (
            "class A:\n    # translate: skip\n    def f(self): pass\ndef g(a: A): return a.f()\n",
            4,
            "class A has no 'f'",
        ),
        (f"{NUMBERS}def f(a: A): return a + 1\n", 4, "declares its operands numbers, but class A"),
        ("# translate module: arrays\ndef f(x): return x[-1]\n", 2, "negative places"),
        (
            "# translate module: arrays\ndef f(x):\n    y = x[1:]\n    y[0] = 1.0\n",
            4,
            "a part of an array shares its numbers",
        ),
    ],
)
def test_a_declaration_that_does_not_hold_is_refused(text, line, words):
    sentence = refusal_of(text)
    assert sentence.startswith(f"src/sample.py:{line}: ")
    assert words in sentence


def test_names_of_skipped_modules_are_refused_where_they_are_used():
    skipped = "# translate module: skip\ndef f(): pass\n"
    user = "from other import f\ndef g(): return f()\n"
    program = SymbolTable({"other": skipped, "user": user})
    with pytest.raises(Untranslatable, match=r"user:2: .*'f'"):
        list(Definitions(program, "user").module_lines())
