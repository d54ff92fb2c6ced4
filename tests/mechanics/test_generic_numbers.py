"""One set of equations for every kind of number: floats, arrays, compiled expressions and algebraic
symbols.

With symbols the conservation laws are theorems: what is asserted to be zero is zero identically,
whatever the friction force.
"""

import math
from typing import Any, NamedTuple

import numpy as np
import pytest
import sympy as sp

from tippetop.mechanics import euler, invariants, quadratures, view
from tippetop.mechanics.laws.friction import NO_TORQUE, RegularizedCoulombLaw, Traction, ViscousLaw
from tippetop.mechanics.motion import (
    along_table,
    axial_spin,
    on_table,
    sliding_contact,
    sliding_rates,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top, natural_units
from tippetop.mechanics.vectors import cross, dot

SHAPES = {"eccentric sphere": SphereSurface(0.02, 0.006), "spheroid": SpheroidSurface(0.02, 0.031)}
FRICTION_LAWS = {"viscous": ViscousLaw(0.3), "Coulomb": RegularizedCoulombLaw(0.4, 0.01)}
TOPS = [
    pytest.param(Top.of(0.02, 3.0e-6, 3.2e-6, shape, law, 9.8), id=f"{shape_name}, {law_name}")
    for shape_name, shape in SHAPES.items()
    for law_name, law in FRICTION_LAWS.items()
]
PUBLISHED_TOP = Top.of(
    0.02, 3.0e-6, 3.2e-6, SHAPES["eccentric sphere"], FRICTION_LAWS["viscous"], 9.8
)


def mechanics_outputs(y, top):
    """Everything the package computes from the 8 numbers of a sliding state."""
    state = SlidingState.unpack(y)
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    whole = on_table(state, top)
    return (
        *touch.arm,
        *touch.slip,
        *touch.traction.force,
        *touch.traction.torque,
        touch.free_acceleration,
        touch.delassus,
        *touch.force,
        *touch.torque,
        touch.power,
        *sliding_rates(state, top).pack(),
        *whole.pack(),
        *along_table(whole).pack(),
        *quadratures.quadrature_rates(whole, touch.power, 1.0, top),
        quadratures.turn_rate(state.axis, state.momentum, -1.0, top),
        invariants.energy(whole, top),
        invariants.jellett(whole, top),
        axial_spin(state.axis, state.momentum, top),
        view.axis_sine(state.axis),
        view.precession_rate(state.axis, state.momentum, top),
        view.tilt_rate(state.axis, state.momentum, top),
        *view.slip_along_tilt(state.axis, touch.slip),
        *natural_units(top),
        natural_units(top).energy,
        natural_units(top).angular_momentum,
        *top.numbers,
    )


def angle_outputs(y, top, functions):
    """The state that Euler angles y = (theta, theta', phi, phi', omega3, v_x, v_y) describe."""
    tilt, tilt_rate, azimuth, precession, spin, slip_x, slip_y = y
    angles = view.Angles(tilt, tilt_rate, azimuth, precession, spin, (slip_x, slip_y))
    return view.state_from_angles(angles, top, functions).pack()


def published_outputs(y, top, functions):
    """The published equations at y = (theta, theta', phi, phi', omega3, v_x, v_y)."""
    return (
        *euler.published_rates(y, top, functions),
        euler.published_normal_force(y, top, functions),
        euler.published_energy(y, top, functions),
    )


def random_sliding_states(count):
    """Rows of 8 numbers: brisk motions of a small top."""
    random = np.random.default_rng(7)
    axis = random.normal(size=(count, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    momentum = random.uniform(-3e-4, 3e-4, (count, 3))
    velocity = random.uniform(-0.3, 0.3, (count, 2))
    return np.hstack([axis, momentum, velocity])


def random_angles(count):
    """Rows of 7 numbers: brisk motions of a small top in Euler angles."""
    random = np.random.default_rng(8)
    tilt, azimuth = random.uniform(0.1, 3.0, (count, 1)), random.uniform(-3.0, 3.0, (count, 1))
    rates = random.uniform(-50.0, 50.0, (count, 3))
    slip = random.uniform(-0.3, 0.3, (count, 2))
    return np.hstack([tilt, rates[:, :1], azimuth, rates[:, 1:], slip])


STATES = random_sliding_states(8)
ANGLES = random_angles(8)


def as_symbols(function, names, *arguments):
    """The function of floats that the algebraic expression for it stands for."""
    symbols = sp.symbols(names, real=True)
    return sp.lambdify(symbols, function(symbols, *arguments), "math", cse=True)


def as_compiled(heyoka, function, names, *arguments):
    """The function of floats that the compiled expression for it evaluates."""
    variables = heyoka.make_vars(*names.split())
    outputs = [heyoka.expression(output) for output in function(variables, *arguments)]
    compiled = heyoka.cfunc(outputs, variables)
    return lambda *row: compiled(np.array(row))


@pytest.fixture(scope="module")
def heyoka():
    return pytest.importorskip(
        "heyoka", reason="heyoka, which compiles expressions, is not installed here"
    )


def names_of(count):
    return " ".join(f"y{i}" for i in range(count))


def assert_same_numbers(actual, expected):
    """Equal to rounding."""
    assert len(actual) == len(expected)
    np.testing.assert_allclose(
        np.array(actual, dtype=float), np.array(expected, dtype=float), rtol=2e-12, atol=1e-17
    )


@pytest.mark.parametrize("top", TOPS)
def test_arrays_of_states_move_as_each_state_does(top):
    outputs = mechanics_outputs(tuple(STATES.T), top)
    columns = [np.broadcast_to(output, len(STATES)) for output in outputs]
    for i, row in enumerate(STATES.tolist()):
        assert_same_numbers([column[i] for column in columns], mechanics_outputs(row, top))


@pytest.mark.parametrize("top", TOPS)
def test_compiled_expressions_move_as_floats_do(top, heyoka):
    compiled = as_compiled(heyoka, mechanics_outputs, names_of(8), top)
    for row in STATES.tolist():
        assert_same_numbers(compiled(*row), mechanics_outputs(row, top))


@pytest.mark.parametrize("top", TOPS)
def test_a_compiled_top_takes_its_dimensionless_numbers_at_run_time(top, heyoka):
    """One compiled right-hand side serves every top of a kind."""
    numbers, kind = top.numbers, top.kind
    parametric = kind.top(tuple(heyoka.par[i] for i in range(len(numbers))))
    variables = heyoka.make_vars(*names_of(8).split())
    rates = sliding_rates(SlidingState.unpack(variables), parametric).pack()
    compiled = heyoka.cfunc([heyoka.expression(rate) for rate in rates], variables)
    units = natural_units(top)
    scales = [1.0] * 3 + [units.angular_momentum] * 3 + [units.speed] * 2
    for row in STATES.tolist():
        scaled = [number / scale for number, scale in zip(row, scales, strict=True)]
        expected = sliding_rates(SlidingState.unpack(scaled), kind.top(numbers)).pack()
        assert_same_numbers(compiled(np.array(scaled), pars=np.array(numbers)), expected)


@pytest.mark.parametrize("top", TOPS)
def test_algebraic_expressions_move_as_floats_do(top):
    algebraic = as_symbols(mechanics_outputs, names_of(8), top)
    for row in STATES.tolist():
        assert_same_numbers(algebraic(*row), mechanics_outputs(row, top))


def assert_angles_agree(function, top, other):
    """The function gives on floats what `other`, made from it for another kind of number, gives."""
    for row in ANGLES.tolist():
        assert_same_numbers(other(*row), function(row, top, math))


@pytest.mark.parametrize("top", TOPS)
def test_arrays_of_angles_describe_the_states_that_each_does(top):
    columns = [
        np.broadcast_to(output, len(ANGLES)) for output in angle_outputs(tuple(ANGLES.T), top, np)
    ]
    for i, row in enumerate(ANGLES.tolist()):
        assert_same_numbers([column[i] for column in columns], angle_outputs(row, top, math))


def test_arrays_of_angles_obey_the_published_equations_as_each_does():
    columns = published_outputs(tuple(ANGLES.T), PUBLISHED_TOP, np)
    for i, row in enumerate(ANGLES.tolist()):
        assert_same_numbers(
            [column[i] for column in columns], published_outputs(row, PUBLISHED_TOP, math)
        )


@pytest.mark.parametrize("top", TOPS)
def test_compiled_angles_describe_the_states_that_floats_do(top, heyoka):
    assert_angles_agree(
        angle_outputs, top, as_compiled(heyoka, angle_outputs, names_of(7), top, heyoka)
    )


def test_compiled_published_equations_agree_with_floats(heyoka):
    compiled = as_compiled(heyoka, published_outputs, names_of(7), PUBLISHED_TOP, heyoka)
    assert_angles_agree(published_outputs, PUBLISHED_TOP, compiled)


@pytest.mark.parametrize("top", TOPS)
def test_algebraic_angles_describe_the_states_that_floats_do(top):
    assert_angles_agree(angle_outputs, top, as_symbols(angle_outputs, names_of(7), top, sp))


def test_algebraic_published_equations_agree_with_floats():
    algebraic = as_symbols(published_outputs, names_of(7), PUBLISHED_TOP, sp)
    assert_angles_agree(published_outputs, PUBLISHED_TOP, algebraic)


class ArbitraryFriction(NamedTuple):
    """A friction law of any force and any torque."""

    force: Any
    torque: Any = NO_TORQUE

    def traction(self, slip, angular_velocity):
        return Traction(self.force, self.torque)


class ArbitraryShape(NamedTuple):
    """A body of revolution of any shape, through its support function."""

    support: Any
    spherical: bool = False

    def height(self, c):
        return self.support(c)

    def slope(self, c):
        return self.derivative(c, 1)

    def curvature(self, c):
        return self.derivative(c, 2)

    def derivative(self, c, order):
        argument = sp.Dummy()
        return self.support(argument).diff(argument, order).subs(argument, c)


SYMBOLS = SlidingState.unpack(sp.symbols("n_x n_y n_z L_x L_y L_z u_x u_y", real=True))
MASS, I1, I3, RADIUS, ALPHA, GRAVITY = sp.symbols("m I_1 I_3 R alpha g", positive=True)
FORCE = sp.symbols("f_x f_y", real=True)
TORQUE = sp.symbols("t_x t_y t_z", real=True)


def symbolic_top(shape, friction):
    return Top.of(MASS, I1, I3, shape, friction, GRAVITY)


def along_motion(quantity, top):
    """Time derivative of a function of the sliding state, along the equations of motion."""
    rates = sliding_rates(SYMBOLS, top).pack()
    return sum(sp.diff(quantity, y) * rate for y, rate in zip(SYMBOLS.pack(), rates, strict=True))


def vanishes_identically(expression):
    numerator, _ = sp.fraction(sp.together(sp.nsimplify(expression, rational=True)))
    return sp.expand(numerator) == 0


SPHERE = SphereSurface(RADIUS, ALPHA)
ANY_SHAPE = ArbitraryShape(sp.Function("h"))


def test_jelletts_integral_is_constant_under_any_friction_force_without_torque():
    top = symbolic_top(SPHERE, ArbitraryFriction(FORCE))
    assert vanishes_identically(along_motion(invariants.jellett(on_table(SYMBOLS, top), top), top))


def test_a_torque_changes_jelletts_integral_by_its_component_along_the_contact_vector():
    top = symbolic_top(SPHERE, ArbitraryFriction(FORCE, TORQUE))
    touch = sliding_contact(SYMBOLS.axis, SYMBOLS.momentum, SYMBOLS.velocity, top)
    change = along_motion(invariants.jellett(on_table(SYMBOLS, top), top), top)
    assert vanishes_identically(change + touch.normal_force * dot(TORQUE, touch.arm))
    assert not vanishes_identically(change)


def test_jelletts_integral_changes_where_the_surface_is_not_a_sphere():
    """d(-L.a)/dt = h'' c' (L.n - c L_z): zero for h'' = 0 only."""
    top = symbolic_top(ANY_SHAPE, ArbitraryFriction(FORCE))
    c = SYMBOLS.axis[2]
    nodding = cross(SYMBOLS.momentum, SYMBOLS.axis)[2] / I1
    expected = (
        ANY_SHAPE.curvature(c)
        * nodding
        * (dot(SYMBOLS.momentum, SYMBOLS.axis) - c * SYMBOLS.momentum[2])
    )
    change = along_motion(invariants.jellett(on_table(SYMBOLS, top), top), top)
    assert vanishes_identically((change - expected).doit())


def test_jelletts_integral_of_a_spheroid_is_not_constant():
    top = symbolic_top(SpheroidSurface(sp.Integer(1), sp.Rational(3, 2)), ArbitraryFriction(FORCE))
    change = along_motion(invariants.jellett(on_table(SYMBOLS, top), top), top)
    values = {
        MASS: 1,
        I1: sp.Rational(1, 2),
        I3: sp.Rational(1, 3),
        GRAVITY: 1,
        FORCE[0]: 0,
        FORCE[1]: 0,
    }
    values |= dict(zip(SYMBOLS.axis, (sp.Rational(3, 5), 0, sp.Rational(4, 5)), strict=True))
    values |= dict(zip(SYMBOLS.momentum, (1, 2, 3), strict=True))
    values |= dict(zip(SYMBOLS.velocity, (0, 0), strict=True))
    # c' = 2 (L x n)_z = -12/5, L.n - c L_z = 3/5, h = sqrt(9 + 36) / 5 and h'' = (5/4) / h^3
    expected = sp.Rational(5, 4) / (3 / sp.sqrt(5)) ** 3 * sp.Rational(-12, 5) * sp.Rational(3, 5)
    assert float(change.subs(values)) == pytest.approx(float(expected), rel=1e-12)


def test_energy_changes_by_the_power_of_friction_whatever_the_shape_and_the_friction():
    top = symbolic_top(ANY_SHAPE, ArbitraryFriction(FORCE, TORQUE))
    change = along_motion(invariants.energy(on_table(SYMBOLS, top), top), top)
    power = sliding_contact(SYMBOLS.axis, SYMBOLS.momentum, SYMBOLS.velocity, top).power
    assert vanishes_identically((change - power).doit())
    assert not vanishes_identically(power)


@pytest.mark.parametrize("shape", [SPHERE, ANY_SHAPE], ids=["eccentric sphere", "any shape"])
def test_the_axis_keeps_its_length(shape):
    top = symbolic_top(shape, ArbitraryFriction(FORCE, TORQUE))
    assert vanishes_identically(along_motion(dot(SYMBOLS.axis, SYMBOLS.axis), top))


def test_the_contact_point_stays_on_the_table():
    """The vertical velocity of the body's lowest point is zero, because the centre of mass sinks by
    h' c'.
    """
    top = symbolic_top(ANY_SHAPE, ArbitraryFriction(FORCE))
    whole = on_table(SYMBOLS, top)
    touch = sliding_contact(SYMBOLS.axis, SYMBOLS.momentum, SYMBOLS.velocity, top)
    point = cross(angular_velocity_by_definition(), touch.arm)[2] + whole.velocity[2]
    assert vanishes_identically(point.doit())


def angular_velocity_by_definition():
    """The omega whose angular momentum I1 omega + (I3 - I1) omega3 n is L, for a unit axis."""
    spin = dot(SYMBOLS.momentum, SYMBOLS.axis) / I3
    return tuple(
        (momentum - (I3 - I1) * spin * n) / I1
        for momentum, n in zip(SYMBOLS.momentum, SYMBOLS.axis, strict=True)
    )


def test_packed_states_unpack_to_themselves():
    numbers = tuple(range(10))
    assert State.unpack(numbers).pack() == numbers
    assert SlidingState.unpack(numbers[:8]).pack() == numbers[:8]
