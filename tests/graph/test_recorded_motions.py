"""What is printed of the mechanics computes what the mechanics does: in JavaScript and in LLVM's
code.
"""

import json
import math
import subprocess

import numpy as np
import pytest

from campaigns import among
from every_motion import CASES, SURFACES, everything, states
from node import NODE
from tippetop.contact.contact_mode import sliding_motion
from tippetop.extend import exp, log, tanh
from tippetop.graph import graph, llvm
from tippetop.graph.graph import NotRecordable
from tippetop.graph.hoisting import evaluated, hoisted
from tippetop.graph.javascript import javascript_source
from tippetop.graph.recording import record
from tippetop.graph.taylor_coefficients import NodeArithmetic
from tippetop.mechanics.euler import published_rates
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.series import Series, horner, solved, unknown
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.problem.presets import report_problem

POINTS = 3
ROUNDING = 5e-13
"""Error that rounding makes, beside the largest number: floats in one order of operations are off
by up to 8.6e-14 of what 40 digits give (a ring whose rolling is held), in another by as much again.
"""
REPORT = report_problem().standing()


def by_floats(function, rows, parameters):
    """What a function makes of floats; None where it makes nothing."""
    found = []
    for row in rows.tolist():
        try:
            found.append([complex(number) for number in function(row, parameters)])
        except ArithmeticError:
            found.append(None)
    return found


def assert_same(found, expected):
    """Equal to rounding of the largest number, where floats have one that is real; and they often
    have.
    """
    compared = 0
    for row, right in zip(found, expected, strict=True):
        if right is None:
            continue
        size = max(abs(number) for number in right)
        for number, exact in zip(row, right, strict=True):
            if exact.imag == 0.0:
                compared += 1
                assert abs(number - exact.real) <= ROUNDING * size
    assert compared > len(expected)


def recorded(case):
    return record(everything(case.motion), case.motion.size, case.motion.parameters)


def operations(recorded):
    """How many operations a function takes."""
    return len([node for node in recorded.nodes if node.operands])


def by_node(lines):
    """What lines of JavaScript that fill `found` leave there."""
    script = "\n".join(
        ["const found = {};", *lines, "process.stdout.write(JSON.stringify(found));"]
    )
    done = subprocess.run(
        [NODE, "-"], input=script, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stderr == ""
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def by_javascript():
    """What the JavaScript of every case makes of its points, by one run of Node."""
    lines = []
    for number, case in enumerate(CASES):
        count = case.motion.size + len(case.motion.guards)
        rows = json.dumps(states(case.motion, POINTS).tolist())
        lines += [
            javascript_source(recorded(case), f"f{number}"),
            f"found[{json.dumps(case.name)}] = {rows}.map((y) => {{",
            f"  const out = new Array({count});",
            f"  f{number}(y, {json.dumps(case.parameters)}, out);",
            "  return out.map(String);",
            "});",
        ]
    return by_node(lines)


@pytest.mark.parametrize("shape", SURFACES)
def test_printed_code_computes_what_the_mechanics_does(shape, by_javascript):
    for case in CASES:
        if not case.name.startswith(shape):
            continue
        rows, function = states(case.motion, POINTS), everything(case.motion)
        expected = by_floats(function, rows, case.parameters)
        assert_same([[float(text) for text in row] for row in by_javascript[case.name]], expected)


def by_llvm(recorded, rows, parameters, abreast=8):
    """What LLVM's code makes of rows of states, each a launch."""
    from tippetop.integrators.machine_code import machine_code  # noqa: PLC0415 - where there is llvmlite

    function = machine_code({"f": recorded}, abreast)["f"]
    y = np.ascontiguousarray(np.resize(rows, (8 * math.ceil(len(rows) / 8), rows.shape[1])).T)
    given = np.repeat(np.array(parameters, dtype=float)[:, None], y.shape[1], axis=1)
    out = np.full((len(recorded.outputs), y.shape[1]), np.nan)
    if abreast > 1:
        function(y, given, out)
    else:
        for column in range(y.shape[1]):
            alone = np.full(len(out), np.nan)
            function(y[:, column].copy(), given[:, column].copy(), alone)
            out[:, column] = alone
    return out[:, : len(rows)].T


@pytest.mark.parametrize(
    ("shape", "abreast"),
    among([(shape, abreast) for abreast in (1, llvm.ABREAST) for shape in SURFACES], check=1),
)
def test_machine_code_computes_what_the_mechanics_does(shape, abreast, monkeypatch):
    monkeypatch.setattr(
        llvm, "ROUNDING", ""
    )  # as Python rounds, so that what cancels is the same too
    for case in CASES:
        if case.name.startswith(shape):
            rows, function = states(case.motion, POINTS), everything(case.motion)
            found = by_llvm(recorded(case), rows, case.parameters, abreast)
            assert_same(found.tolist(), by_floats(function, rows, case.parameters))


def test_every_launch_has_its_own_choice_and_its_own_numbers():
    plain = NodeArithmetic()

    def function(y, p):
        chosen = plain.choose(plain.below(y[0], p[0]), plain.size(y[0]), y[0] ** 0.3)
        return (
            chosen,
            plain.total([y[0] * float(k) for k in range(1, 6)]),
            plain.least(y[0], 1.5),
            1.0,
        )

    places = np.linspace(-2.0, 4.0, 24)
    chosen, total, least, one = by_llvm(record(function, 1, 1), places[:, None], (0.5,)).T
    np.testing.assert_allclose(chosen, [abs(x) if x < 0.5 else x**0.3 for x in places], rtol=1e-15)
    np.testing.assert_allclose(total, 15.0 * places, rtol=1e-15)
    np.testing.assert_array_equal(least, np.minimum(places, 1.5))
    np.testing.assert_array_equal(one, 1.0)
    assert by_llvm(record(function, 1, 1), np.empty((0, 1)), (0.5,)).shape == (0, 4)


def test_what_is_rarely_needed_is_there_for_those_who_need_it():
    plain = NodeArithmetic()

    def function(y, p):
        negative, shared = plain.below(y[0], 0.0), y[0] * p[0]
        cube = plain.rarely(negative, y[0] ** 3.0, 7.0)
        chosen = plain.rarely(negative, (-shared) ** 0.5 + shared, shared)
        return chosen, cube + chosen * chosen, shared

    # Launches eight at a time: none needs it, all do, and some.
    places = np.concatenate(
        (np.linspace(1.0, 2.0, 8), np.linspace(-2.0, -1.0, 8), np.linspace(-1.2, 1.1, 8))
    )
    chosen, cube, shared = by_llvm(record(function, 1, 1), places[:, None], (2.0,)).T
    np.testing.assert_array_equal(shared, 2.0 * places)
    wanted = np.where(places < 0.0, 2.0 * places + np.sqrt(2.0 * np.abs(places)), 2.0 * places)
    np.testing.assert_allclose(chosen, wanted, rtol=1e-15)
    np.testing.assert_allclose(cube, np.where(places < 0.0, places**3, 7.0) + wanted**2, rtol=1e-14)

    def twice(y, p):
        inner = plain.rarely(plain.below(y[0], 0.0), y[0] ** 2.0, 1.0)
        return (plain.rarely(plain.below(y[0], 1.0), inner + 1.0, 0.0),)

    with pytest.raises(NotRecordable, match="rarely"):
        by_llvm(record(twice, 1, 0), places[:, None], ())


def test_series_of_nodes_solve_what_they_are_given():
    def exponential(y, p):
        series = Series(unknown, NodeArithmetic())
        solved([series], y, lambda y: (p[0] * y[0] - y[0] * p[0] + y[0] / p[1],))
        return (horner([series[k] for k in range(20)], 1.0),)

    starts = np.linspace(1.0, 2.0, 8)
    found = by_llvm(record(exponential, 1, 2), starts[:, None], (3.0, 2.0))[:, 0]
    np.testing.assert_allclose(found, starts * math.exp(0.5), rtol=1e-15)


@pytest.mark.parametrize("shape", SURFACES)
def test_what_parameters_alone_make_is_made_apart_from_the_rest(shape):
    apart = 0
    for case in CASES:
        if not case.name.startswith(shape):
            continue
        rows, function, whole = states(case.motion, POINTS), everything(case.motion), recorded(case)
        own, rest = hoisted(whole)
        assert operations(own) + operations(rest) == operations(whole)
        constants = (graph.PARAMETER, graph.CONSTANT)
        assert not [
            node
            for node in rest.nodes
            if node.operands and all(operand.name in constants for operand in node.operands)
        ]
        apart += operations(own)
        given = [*case.parameters, *evaluated(own, (), case.parameters)]
        found = by_floats(lambda y, p, rest=rest: evaluated(rest, y, p), rows, given)
        exact = by_floats(function, rows, case.parameters)
        assert [row is None for row in found] == [row is None for row in exact]
        assert_same(found, exact)
    assert apart > len(CASES) / len(SURFACES)


def test_the_reports_sliding_equations_are_few_operations():
    motion = sliding_motion(REPORT.kind, True)
    assert 50 < operations(record(motion.rates, motion.size, motion.parameters)) <= 110


def test_a_choice_that_depends_on_numbers_is_refused():
    law = HertzLaw(0.3, 0.02)
    kind = Top.of(1.0, 0.45, 0.38, SphereSurface(1.0, 0.3), law, 1.0).kind
    with pytest.raises(NotRecordable, match="select"):
        record(
            lambda y, p: kind.top(tuple(p)).friction.reserve(y[0], (y[1], y[2]), y[3]),
            8,
            kind.numbers,
        )
    assert operations(record(lambda y, p: (1.0 * (y[0] > 0.0),), 1, 0)) == 1


class Elementary:
    """Elementary functions of nodes."""

    @staticmethod
    def sin(x):
        return x.graph.node("sin", (x,))

    @staticmethod
    def cos(x):
        return x.graph.node("cos", (x,))


def test_elementary_functions_and_selections_are_printed():
    def function(y, p):
        rates = published_rates(y, REPORT, Elementary())
        return (
            *rates,
            y[0].graph.select(y[0] < y[1], y[0], abs(-y[1])),
            y[2] ** 1.3,
            y[2] ** -2.25,
            exp(y[0]),
            log(y[1]),
            tanh(y[2]),
        )

    y = [0.3, 1.2, 0.7, 2.0, 90.0, 0.01, -0.02]
    expected = (*published_rates(y, REPORT, math), 0.3, 0.7**1.3, 0.7**-2.25)
    expected += (math.exp(0.3), math.log(1.2), math.tanh(0.7))
    taken = record(function, 7, 0)
    code = [javascript_source(taken, "f"), "found.out = [];", f"f({json.dumps(y)}, [], found.out);"]
    for out in (by_node(code)["out"], by_llvm(taken, np.array([y]), ())[0]):
        np.testing.assert_allclose(out, expected, rtol=1e-13)


@pytest.mark.parametrize(
    ("function", "count"),
    [
        (lambda x: x * 0.0 + 0.0 * x, 0),
        (lambda x: 1.0 * x - 0.0, 0),
        (lambda x: -(x * -1.0), 0),
        (lambda x: (x + 2.0) - (2.0 + x), 0),
        (lambda x: x**2 + x * x, 2),
        (lambda x: x**0.5 * x**-0.5, 3),
        (lambda x: 3.0 * x + -(x * 3.0), 0),
        (lambda x: x**3, 2),
        (lambda x: x / 1.0, 0),
        (lambda x: abs(-x) - abs(x), 0),
    ],
)
def test_nothing_is_computed_twice_or_for_nothing(function, count):
    found = record(lambda y, p: (function(y[0]),), 1, 0)
    assert operations(found) == count
    assert by_llvm(found, np.array([[0.7]]), ())[0, 0] == pytest.approx(function(0.7), abs=1e-15)
