"""Numbers with units are the numbers in SI: in Python, in files, at the command line, in sweeps and
in the page.
"""

import json
import math
import subprocess
import sys
from typing import Any

import numpy as np
import pint
import pytest
import tomli_w
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import tippetop as tt
from mistakes import fields_with
from node import printed
from tippetop.cli.commands import app
from tippetop.page_engine import HERE
from tippetop.support import units
from tippetop.support.errors import InvalidInput
from tippetop.sweeps.draws import RangeColumn
from tippetop.sweeps.grid import Product

PINT: Any = pint.UnitRegistry()
TURN = 2.0 * math.pi

WRITTEN = [
    ("launch.spin", "2200 rpm", 2200.0 * TURN / 60.0),
    ("launch.spin", "2200rpm", 2200.0 * TURN / 60.0),
    ("launch.spin", "25 rev/s", 25.0 * TURN),
    ("launch.spin", "-25 turns / s", -25.0 * TURN),
    ("launch.spin", "1.5e3 rev/min", 1500.0 * TURN / 60.0),
    ("launch.spin", "155 rad/s", 155.0),
    ("launch.spin", "155 rad s-1", 155.0),
    ("launch.spin", "155 rad·s⁻¹", 155.0),
    ("launch.spin", "9000 deg/s", 9000.0 * TURN / 360.0),
    ("launch.tilt", "90 deg", math.pi / 2.0),
    ("launch.tilt", "180°", math.pi),
    ("launch.tilt", "100 mrad", 0.1),
    ("launch.gap", "1 cm", 0.01),
    ("launch.gap", "12.7 µm", 12.7e-6),
    ("launch.azimuth", "-0.25 turn", -0.25 * TURN),
    ("body.mass", "20 g", 0.02),
    ("body.mass", "20 grams", 0.02),
    ("body.mass", "0.5 oz", 0.5 * 0.028349523125),
    ("body.shape.radius", "2 cm", 0.02),
    ("body.shape.radius", "0.8 in", 0.8 * 0.0254),
    ("body.shape.radius", "14.1 mm", 0.0141),
    ("body.I1", "30 g cm^2", 30e-7),
    ("body.I1", "30 g*cm**2", 30e-7),
    ("body.I1", "3000 g mm²", 30e-7),
    ("friction.mu", "0.3 s/m", 0.3),
    ("friction.mu", "3 ms/cm", 0.3),
    ("gravity", "981 cm/s^2", 9.81),
    ("gravity", "32 ft/s^2", 32.0 * 0.3048),
    ("contact.restitution", "50 %", 0.5),
    ("rolling_resistance", "10 um", 1e-5),
]


def value_of(problem: "tt.Problem", field: str) -> float:
    found: Any = problem
    for name in field.split("."):
        found = getattr(found, name)
    return float(found)


def with_moments(field: str, text: str) -> dict[str, Any]:
    """The fields with a text in one of them; with a moment I3 that each of these I1 may have."""
    fields = fields_with(field, text)
    if field == "body.I1":
        fields["body"]["I3"] = 3e-7
    return fields


@pytest.mark.parametrize(("field", "text", "number"), WRITTEN)
def test_a_number_with_a_unit_is_that_number_in_si(field: str, text: str, number: float) -> None:
    fields = with_moments(field, text)
    problem = tt.Problem(**fields)
    assert value_of(problem, field) == pytest.approx(number, rel=4e-16)
    assert tt.Problem.from_toml(tomli_w.dumps(fields)) == problem
    assert tt.Problem.from_json(json.dumps(fields)) == problem
    assert tt.Problem.from_toml(problem.to_toml()) == problem, "and is stored in SI"
    words = ["problem", "--json", "--set", f"{field}={text}", "--set", "body.I3=3e-7"]
    done = CliRunner().invoke(app, words)
    assert value_of(tt.Problem.from_json(done.stdout), field) == value_of(problem, field)


def test_the_page_reads_the_same_numbers() -> None:
    asked = [with_moments(field, text) for field, text, _ in WRITTEN]
    script = f"""
        import * as m from "{(HERE / "mechanics.js").as_uri()}";
        const read = (fields) => new m.Problem(fields);
        console.log(JSON.stringify({json.dumps(asked)}.map(read)));
    """
    for fields, (field, text, _), found in zip(
        asked, WRITTEN, json.loads(printed(script)), strict=True
    ):
        there: Any = found
        for name in field.split("."):
            there = there[name]
        assert there == value_of(tt.Problem(**fields), field), text


def test_the_page_has_the_units_of_pint() -> None:
    """Every name in its table, against pint itself."""
    script = f"""
        import {{ UNITS }} from "{(HERE / "tables.js").as_uri()}";
        console.log(JSON.stringify(UNITS));
    """
    table = json.loads(printed(script))
    assert {"m", "kg", "s", "rad", "rad s-1"} <= set(table)
    names = 0
    for si, named in table.items():
        wanted = PINT.Unit(" * ".join(f"{name}**{power}" for name, power in factors(si)))
        for name, (over, under) in named.items():
            if name in OURS:
                continue
            found = PINT.Quantity(1.0, PINT.parse_units(name)).to(wanted).magnitude
            assert over / under == pytest.approx(found, rel=1e-12), name
            names += 1
    assert names > 300


OURS = ("rev", "revs", "rotation", "rotations", "RPM", "RPMs", "Kg", "Kgs", "KG", "KGs", "degs")
"""Names that pint does not have."""


def factors(si: str) -> list[tuple[str, int]]:
    return units.factors_of(si) or [("dimensionless", 1)]


@pytest.mark.parametrize(
    ("field", "quantity", "number"),
    [
        ("launch.spin", PINT.Quantity(2200.0, "rpm"), 2200.0 * TURN / 60.0),
        ("launch.spin", PINT.Quantity(25, "turn/s"), 25.0 * TURN),
        ("launch.tilt", PINT.Quantity(90.0, "degree"), math.pi / 2.0),
        ("launch.tilt", PINT.Quantity(0.1), 0.1),
        ("body.mass", PINT.Quantity(np.float64(20.0), "g"), 0.02),
        ("body.I1", PINT.Quantity(30.0, "g*cm**2"), 30e-7),
        ("gravity", PINT.Quantity(32.0, "ft/s**2"), 32.0 * 0.3048),
    ],
    ids=str,
)
def test_quantities_of_pint_are_numbers(field: str, quantity: Any, number: float) -> None:
    changes = {"body.I3": 3e-7, field: quantity}
    problem = tt.presets.report_problem().replace(changes)
    assert value_of(problem, field) == pytest.approx(number, rel=1e-15)


class Inches:
    """A quantity of a library that pint does not know."""

    magnitude, units = 0.8, "zoll"

    def to(self, unit: str) -> "Inches":
        if unit != "m":
            raise ValueError(unit)
        found = Inches()
        found.magnitude = self.magnitude * 0.0254
        return found


def test_quantities_of_another_library_convert_themselves() -> None:
    problem = tt.presets.report_problem().replace({"body.shape.radius": Inches()})
    assert problem.body.shapes[0].radius == 0.8 * 0.0254
    with pytest.raises(InvalidInput, match=r"launch\.spin: 0\.8 zoll has an unknown unit"):
        problem.replace({"launch.spin": Inches()})
    with pytest.raises(InvalidInput, match=r"launch\.spin: 25 hertz is a frequency"):
        problem.replace({"launch.spin": PINT.Quantity(25, "Hz")})


def test_lists_and_arrays_have_units() -> None:
    slip = PINT.Quantity(np.array([10.0, -5.0]), "cm/s")
    launch = tt.Launch(tilt=0.1, spin=1.0, slip=slip)
    assert launch.slip == (0.1, -0.05)
    assert tt.Launch(tilt=0.1, spin=1.0, slip=["10 cm/s", -0.05]).slip == (0.1, -0.05)


def test_axes_of_sweeps_have_units() -> None:
    wanted = Product.of({"launch.spin": [10.0 * TURN, 20.0 * TURN]})
    spins = PINT.Quantity(np.array([10.0, 20.0]), "turn/s")
    for spoken in (["10 rev/s", "20 rev/s"], [10.0 * TURN, "1200 rpm"], spins):
        found = Product.of({"launch.spin": spoken}).axes[0].values
        assert found == pytest.approx(wanted.axes[0].values, rel=1e-15)
    spaced = Product.of({"launch.tilt": {"from": "0 deg", "to": "90 deg", "count": 3}})
    assert spaced.axes[0].values.tolist() == [0.0, math.pi / 4.0, math.pi / 2.0]
    drawn = RangeColumn("body.shape.radius", "1 cm", "2 cm")
    assert (drawn.low, drawn.high) == (0.01, 0.02)


@pytest.mark.parametrize(
    ("axis", "values"),
    [
        ("launch.spin=0:600rpm:3", [0.0, 10.0 * TURN / 2.0, 10.0 * TURN]),
        pytest.param(
            "launch.spin=300:600 rpm:2", [5.0 * TURN, 10.0 * TURN], marks=pytest.mark.slow
        ),
        ("launch.tilt=0,90,180 deg", [0.0, math.pi / 2.0, math.pi]),
        ("body.mass=10 g,0.02 kg", [0.01, 0.02]),
    ],
)
def test_axes_of_the_command_line_have_units(tmp_path: Any, axis: str, values: list[float]) -> None:
    out = str(tmp_path / "a.zarr")
    words = ["sweep", "--over", axis, "--duration", "1 ms", "--workers", "1", "--no-maps"]
    done = CliRunner().invoke(app, [*words, "--out", out])
    assert done.exit_code == 0, done.output
    found = tt.read_sweep(out)
    assert found[axis.partition("=")[0].rpartition(".")[2]].values == pytest.approx(
        values, rel=1e-15
    )


def test_options_have_units() -> None:
    words = ["simulate", "--json", "--spin", "2200rpm", "--tilt", "5 deg", "--duration", "100ms"]
    done = CliRunner().invoke(app, [*words, "--samples", "3"])
    told = json.loads(done.stdout)
    assert told["end_time"] == 0.1
    assert told["problem"]["launch"]["spin"] == pytest.approx(2200.0 * TURN / 60.0, rel=1e-15)
    assert told["problem"]["launch"]["tilt"] == pytest.approx(math.radians(5.0), rel=1e-15)


def test_step_and_sample_times_of_a_run_have_units() -> None:
    """In Python as at the command line, which has `--step "1 ms"`."""
    problem = tt.presets.report_problem()
    steps = [tt.simulate(problem, 0.1, integrator="rk4", step=step) for step in STEPS]
    assert [run.attrs["step"] for run in steps] == [pytest.approx(0.001, rel=1e-15)] * len(STEPS)
    assert np.ptp([float(run["tilt"][-1]) for run in steps]) == 0.0
    for times in SAMPLE_TIMES:
        run = tt.simulate(problem, "100 ms", times=times)
        assert run["time"].values.tolist() == [0.05, 0.1]


STEPS = (0.001, "1 ms", PINT.Quantity(1.0, "ms"))
SAMPLE_TIMES: list[Any] = [
    [0.05, 0.1],
    ["0.05 s", 0.1],
    ("50 ms", PINT.Quantity(100, "ms")),
    np.array(["0.05 s", "100 ms"]),
    PINT.Quantity(np.array([50.0, 100.0]), "ms"),
]


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"integrator": "rk4", "step": "1 mm"}, "step: 1 mm is a length, not a time"),
        ({"integrator": "rk4", "step": "0.001"}, "step: 0.001 is not a number"),
        ({"times": [0.0, "1 rad"]}, "times.1: 1 rad is an angle, not a time"),
        ({"times": ["0.05", 0.1]}, "times.0: 0.05 is not a number"),
        ({"times": "50 ms"}, "times: 50 ms is not a list of increasing finite numbers"),
        ({"times": ["60 ms", 0.05]}, "is not a list of increasing finite numbers"),
    ],
)
def test_steps_and_times_in_other_units_are_refused(
    settings: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InvalidInput) as caught:
        tt.simulate(tt.presets.report_problem(), 0.1, **settings)
    assert sentence in str(caught.value)


NAMES = ("m", "cm", "kg", "g", "s", "min", "rad", "deg", "rev", "rpm")


@given(
    st.floats(min_value=1e-3, max_value=1e3),
    st.lists(st.tuples(st.sampled_from(NAMES), st.integers(-3, 3)), min_size=1, max_size=4),
)
def test_products_of_units_are_those_of_pint(number: float, names: list[tuple[str, int]]) -> None:
    """Any product, however its powers are written, against pint's own arithmetic."""
    registry = units.registry()
    text = " ".join(f"{name}^{power}" for name, power in names)
    parsed = units.factors_of(text) or []
    found = units.product(
        [(units.named_unit(name) or units.PLAIN, power) for name, power in parsed]
    )
    quantity = registry.Quantity(number, "")
    for name, power in names:
        quantity = quantity * registry.Quantity(1.0, name) ** power
    exact = quantity.to_base_units()
    assert units.converted(number, found) == pytest.approx(exact.magnitude, rel=1e-12)
    powers = dict(exact.unit_items())
    assert [powers.get(base, 0) for base in units.BASES] == list(found.exponents)


def test_no_unit_needs_no_pint() -> None:
    """Neither the import, nor a problem, nor a refusal of a number in SI."""
    code = """
import sys
import tippetop as tt
tt.simulate(tt.presets.report_problem(), 0.01, samples=2)
try:
    tt.Launch(tilt=6, spin="1,55")
except tt.InvalidInput:
    pass
assert "pint" not in sys.modules
tt.Launch(tilt=0.1, spin="2200 rpm")
assert "pint" in sys.modules
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
