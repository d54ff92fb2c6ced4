"""Problems: what they refuse and how they say so, that they are values, and that writing loses
nothing.
"""

import copy
import inspect
import json
import math
import pickle
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel

from strategies import problems
from tippetop import presets
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.motion import angular_velocity, point_velocity, sliding_contact
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface, contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import length
from tippetop.problem import bodies, contact_rules, frictions, launch, problem, shapes
from tippetop.problem.bodies import Body
from tippetop.problem.contact_rules import Contact
from tippetop.problem.frictions import (
    ContensouFriction,
    CoulombFriction,
    RegularizedCoulombFriction,
    StaticCoulombFriction,
    ViscousFriction,
)
from tippetop.problem.launch import Launch
from tippetop.problem.problem import Problem, top_of
from tippetop.problem.shapes import EccentricSphere, Meridian, Oval, Ring, Sphere, Spheroid
from tippetop.support.errors import FileTrouble, InvalidInput, TippetopError
from tippetop.support.field_paths import dotted_names, part_at
from tippetop.support.validation import Quantity

EGG = {
    "mass": 0.05,
    "shape": {"kind": "spheroid", "across": 0.02, "along": 0.03},
    "I1": 1.3e-5,
    "I3": 8e-6,
}
COULOMB = {"kind": "regularized_coulomb", "mu": 0.3, "eps": 1e-3}
ENTRIES = re.MULTILINE | re.DOTALL
WRITTEN = {
    "1": "",
    "kg": "kg",
    "kg m2": "kg m^2",
    "m": "m",
    "m s-1": "m/s",
    "m s-2": "m/s^2",
    "rad": "rad",
    "rad s-1": "rad/s",
    "s m-1": "s/m",
}
"""Units as docstrings write them."""
PARTS = [
    Body,
    Contact,
    ContensouFriction,
    CoulombFriction,
    EccentricSphere,
    Launch,
    Problem,
    RegularizedCoulombFriction,
    Ring,
    Sphere,
    Meridian,
    Oval,
    Spheroid,
    StaticCoulombFriction,
    ViscousFriction,
]


def top_problem(**changes):
    """The tippe top on a rough table; names with two underscores for dots are changed."""
    return presets.report_problem().replace(
        {name.replace("__", "."): value for name, value in changes.items()}
    )


def fields_with(name, value):
    """The fields of a problem as nested dictionaries, with one set (or removed, for ...)."""
    fields = json.loads(presets.report_problem().to_json())
    *parents, last = name.split(".")
    table = fields
    for parent in parents:
        table = table[parent]
    if value is ...:
        del table[last]
    else:
        table[last] = value
    return fields


def typed(value):
    """A value as one would type it: whole numbers without a fraction."""
    return re.sub(r"\.0(?=[,)]|$)", "", repr(value))


def the_one_line_of(refusal):
    """The message of an error, which is one line for people."""
    message = str(refusal)
    assert message == message.strip()
    assert len(message.splitlines()) == 1
    return message


class TestRefusals:
    """Every value that cannot be is refused with one line that names its field and the value."""

    @pytest.mark.parametrize(
        ("name", "value"),
        [
            ("body.mass", 0.0),
            ("body.mass", -0.02),
            ("body.mass", math.nan),
            ("body.mass", math.inf),
            ("body.mass", "heavy"),
            ("body.mass", None),
            ("body.mass", [0.02]),
            ("body.I1", 0.0),
            ("body.I1", math.nan),
            ("body.I3", -1e-6),
            ("body.I3", math.inf),
            ("body.shape.radius", 0.0),
            ("body.shape.radius", math.nan),
            ("body.shape.eccentricity", 0.0),
            ("body.shape.eccentricity", 1.0),
            ("body.shape.eccentricity", 1.3),
            ("body.shape.eccentricity", -0.3),
            ("friction.mu", -0.1),
            ("friction.mu", math.nan),
            ("friction.mu", math.inf),
            ("launch.tilt", -0.1),
            ("launch.tilt", 3.2),
            ("launch.tilt", math.nan),
            ("launch.spin", math.inf),
            ("launch.spin", -math.inf),
            ("launch.azimuth", math.nan),
            ("launch.gap", -1e-9),
            ("launch.gap", math.inf),
            ("launch.velocity", 1.0),
            ("launch.tilt_rate", math.nan),
            ("launch.precession", math.inf),
            ("contact.liftoff", "jump"),
            ("contact.restitution", -0.1),
            ("contact.restitution", 1.1),
            ("contact.restitution", math.nan),
            ("gravity", 0.0),
            ("gravity", -9.8),
            ("gravity", math.nan),
            ("body", 3),
            ("launch", "fast"),
        ],
    )
    def test_a_value_that_cannot_be(self, name, value):
        for attempt in (
            lambda: Problem(**fields_with(name, value)),
            lambda: presets.report_problem().replace({name: value}),
        ):
            with pytest.raises(InvalidInput) as caught:
                attempt()
            message = the_one_line_of(caught.value)
            assert message.startswith(f"{name}: {typed(value)} ")
            assert caught.value.field == name
            assert caught.value.others == 0

    @pytest.mark.parametrize(
        ("name", "value"),
        [("body.mass", True), ("gravity", "9.8"), ("launch.spin", "155"), ("launch.tilt", False)],
    )
    def test_what_is_not_a_number_is_not_taken_for_one(self, name, value):
        with pytest.raises(InvalidInput, match="is not a number"):
            Problem(**fields_with(name, value))

    @pytest.mark.parametrize("index", [0, 1])
    def test_a_slip_that_is_not_finite(self, index):
        slip = [0.0, 0.0]
        slip[index] = math.nan
        with pytest.raises(InvalidInput) as caught:
            top_problem(launch__slip=tuple(slip))
        assert the_one_line_of(caught.value).startswith(
            f"launch.slip.{index}: nan is not a finite number"
        )

    def test_a_velocity_leaves_no_slip_to_choose(self):
        with pytest.raises(InvalidInput) as caught:
            top_problem(launch__slip=(0.1, 0.0), launch__velocity=(0.0, 0.0, 0.0))
        assert the_one_line_of(caught.value).startswith(
            "launch.slip: (0.1, 0) stands beside a velocity"
        )

    @pytest.mark.parametrize("liftoff", ["stop", "ignore"])
    @pytest.mark.parametrize(
        ("name", "value"), [("launch.gap", 0.1), ("launch.velocity", (0.0, 0.0, 1.0))]
    )
    def test_a_top_that_may_not_fly_starts_on_the_table(self, liftoff, name, value):
        with pytest.raises(InvalidInput) as caught:
            presets.report_problem().replace({"contact.liftoff": liftoff, name: value})
        assert the_one_line_of(caught.value).startswith(
            f"{name}: {typed(value)} lets the body leave the table"
        )

    @pytest.mark.parametrize("radius", [1e-12, 0.03])
    def test_a_patch_that_is_a_point_or_larger_than_the_body(self, radius):
        patch = ContensouFriction(mu=0.3, patch_radius=radius)
        with pytest.raises(InvalidInput) as caught:
            presets.report_problem().replace({"friction": patch})
        told = the_one_line_of(caught.value)
        assert told.startswith(
            f"friction.patch_radius: {typed(radius)} does not fit this body (write a"
            " radius from 2.01e-11 to 0.02 m;"
        )

    @pytest.mark.parametrize("size", [0.01, 0.0123456, 0.0199999, 0.0999951, 1 / 7])
    def test_what_a_sentence_says_is_accepted_is(self, size):
        def fitted(patch, arm=0.0):
            changes = {
                "body.shape.radius": size,
                "friction.kind": "contensou",
                "friction.patch_radius": patch,
            }
            return presets.report_problem(mu=0.3).replace(changes | {"rolling_resistance": arm})

        def bounds(*numbers):
            with pytest.raises(InvalidInput) as caught:
                fitted(*numbers)
            told = re.search("from (.*) to (.*) m[;,]", str(caught.value))
            return [float(number) for number in told.groups()]

        least, most = bounds(0.5)
        assert [least, most] == pytest.approx([1e-9 * size, size], rel=0.01)
        assert bounds(most, 0.5) == [0.0, most]
        for patch in (least, most):
            assert fitted(patch, most).friction.patch_radius == patch

    def test_a_patch_and_an_arm_fit_the_largest_surface_whichever_comes_first(self):
        ball, tip = Sphere(radius=0.02, center=-0.006), Sphere(radius=0.004, center=0.02)
        for two in ([ball, tip], [tip, ball]):
            patch = {
                "friction.kind": "contensou",
                "friction.patch_radius": 0.01,
                "rolling_resistance": 0.01,
            }
            problem = presets.report_problem(mu=0.3).replace({"body.shape": two} | patch)
            for name, value in (("friction.patch_radius", 1e-11), ("rolling_resistance", 0.021)):
                with pytest.raises(InvalidInput) as caught:
                    problem.replace({name: value})
                assert the_one_line_of(caught.value).startswith(f"{name}: {typed(value)} ")

    @pytest.mark.parametrize("slip", [(0.0, 0.0, 0.0), "no", 1.0])
    def test_a_slip_that_is_not_two_numbers(self, slip):
        with pytest.raises(InvalidInput) as caught:
            top_problem(launch__slip=slip)
        assert the_one_line_of(caught.value).startswith(f"launch.slip: {typed(slip)} is ")

    @pytest.mark.parametrize(
        ("name", "value"), [("across", 0.0), ("along", -0.03), ("along", math.nan)]
    )
    def test_a_spheroid_that_cannot_be(self, name, value):
        with pytest.raises(InvalidInput) as caught:
            top_problem(body={**EGG, "shape": {**EGG["shape"], name: value}})
        assert the_one_line_of(caught.value).startswith(f"body.shape.{name}: {typed(value)} is ")

    @pytest.mark.parametrize(
        ("name", "value"), [("mu", -0.1), ("eps", 0.0), ("eps", 5e-324), ("eps", math.inf)]
    )
    def test_a_coulomb_friction_that_cannot_be(self, name, value):
        with pytest.raises(InvalidInput) as caught:
            top_problem(friction={**COULOMB, name: value})
        assert the_one_line_of(caught.value).startswith(f"friction.{name}: {typed(value)} is ")

    @pytest.mark.parametrize(
        ("part", "name", "value"),
        [
            (lambda: Launch(tilt=-1.0, spin=1.0), "tilt", -1.0),
            (lambda: ViscousFriction(mu=-1.0), "mu", -1.0),
            (lambda: EccentricSphere(radius=0.02, eccentricity=1.3), "eccentricity", 1.3),
            (lambda: Contact(restitution=2.0), "restitution", 2.0),
            (lambda: Body(**{**EGG, "I3": 3e-5}), "I3", 3e-5),
        ],
    )
    def test_a_part_names_its_own_field(self, part, name, value):
        with pytest.raises(InvalidInput) as caught:
            part()
        assert the_one_line_of(caught.value).startswith(f"{name}: {typed(value)} is ")

    def test_no_body_has_an_axial_inertia_above_twice_its_transverse_one(self):
        """I3 = 2 I1 is a flat disc; more would need mass off every axis at once."""
        assert Body(**{**EGG, "I1": 1e-5, "I3": 2e-5}).I3 == 2e-5
        too_much = math.nextafter(2e-5, 1.0)
        with pytest.raises(InvalidInput) as caught:
            top_problem(body={**EGG, "I1": 1e-5, "I3": too_much})
        assert the_one_line_of(caught.value).startswith(
            f"body.I3: {typed(too_much)} is more than any body with this I1 has (write at most 2 I1"
        )

    @pytest.mark.parametrize(
        "name",
        [
            "body",
            "friction",
            "launch",
            "body.mass",
            "body.I3",
            "body.shape",
            "launch.tilt",
            "friction.mu",
        ],
    )
    def test_a_missing_key(self, name):
        with pytest.raises(InvalidInput) as caught:
            Problem(**fields_with(name, ...))
        assert the_one_line_of(caught.value).startswith(f"{name} is missing (write ")
        assert caught.value.field == name

    @pytest.mark.parametrize("name", ["body.shape.kind", "friction.kind"])
    def test_a_missing_kind(self, name):
        with pytest.raises(InvalidInput) as caught:
            Problem(**fields_with(name, ...))
        assert the_one_line_of(caught.value).startswith(f"{name} is missing (write ")

    @pytest.mark.parametrize(
        ("name", "kinds"),
        [
            ("body.shape.kind", "eccentric_sphere, sphere, ring, meridian, oval, spheroid"),
            ("friction.kind", "viscous, regularized_coulomb"),
        ],
    )
    def test_an_unknown_kind_is_answered_with_the_known_ones(self, name, kinds):
        with pytest.raises(InvalidInput) as caught:
            Problem(**fields_with(name, "cubic"))
        message = the_one_line_of(caught.value)
        assert "'cubic'" in message
        # Those that others define come after them.
        assert f"is not one of {kinds}" in message

    @pytest.mark.parametrize("name", ["body.shape.kind", "friction.kind"])
    def test_an_unknown_kind_is_named_by_its_field(self, name):
        with pytest.raises(InvalidInput) as caught:
            Problem(**fields_with(name, "cubic"))
        assert the_one_line_of(caught.value).startswith(f"{name}: 'cubic' is not one of ")

    @pytest.mark.parametrize(
        ("name", "hint"),
        [
            ("gravty", "gravity"),
            ("body.mas", "mass"),
            ("body.shape.radus", "radius"),
            ("friction.mue", "mu"),
            ("launch.tlt", "tilt"),
            ("contact.restitutoin", "restitution"),
        ],
    )
    def test_an_unknown_key_is_answered_with_the_one_meant(self, name, hint):
        with pytest.raises(InvalidInput) as caught:
            Problem(**fields_with(name, 1.0))
        message = the_one_line_of(caught.value)
        assert message.startswith(f"{name}: 1 is given for an unknown field ")
        assert message.endswith(f"(did you mean {hint}?)")

    def test_values_without_their_names_are_answered_with_the_names(self):
        with pytest.raises(InvalidInput) as caught:
            Launch(0.1, 155.0)
        told = (
            "Launch: (0.1, 155) are values without names (write its fields by name: tilt, spin,"
            " azimuth, "
        )
        assert the_one_line_of(caught.value).startswith(told)
        assert next(iter(inspect.signature(Launch).parameters)) == "tilt", (
            "and help tells of no others"
        )

    def test_a_misspelt_key_is_told_before_the_key_that_is_missing_for_it(self):
        fields = fields_with("launch.tilt", ...)
        fields["launch"]["tlit"] = 0.1
        with pytest.raises(InvalidInput) as caught:
            Problem(**fields)
        message = the_one_line_of(caught.value)
        assert message.startswith("launch.tlit: 0.1 ")
        assert message.endswith("(did you mean tilt?) (and 1 more)")
        assert caught.value.others == 1

    def test_how_many_more_values_cannot_be_is_told(self):
        with pytest.raises(InvalidInput) as caught:
            Launch(tilt=-1.0, spin=math.nan, azimuth=math.inf)
        assert caught.value.others == 2
        assert the_one_line_of(caught.value).endswith("(and 2 more)")

    def test_a_long_value_is_cut(self):
        with pytest.raises(InvalidInput) as caught:
            Launch(tilt="x" * 1000, spin=1.0)
        assert len(the_one_line_of(caught.value)) < 150
        assert caught.value.value == "x" * 1000

    def test_a_key_with_a_line_break_does_not_break_the_line(self):
        with pytest.raises(InvalidInput) as caught:
            Problem(**{**fields_with("gravity", 9.8), "gra\nvity": 9.8})
        the_one_line_of(caught.value)

    @pytest.mark.parametrize(
        ("changes", "field", "others"),
        [
            ({"launch.spin": -1e200}, "launch.spin", 0),
            ({"launch.precession": 1e308, "launch.spin": 1e200}, "launch.precession", 1),
            ({"body.shape.radius": 1e200}, "body.shape.radius", 0),
            ({"launch.slip": (0.0, 1e308), "launch.spin": 1e200}, "launch.slip.1", 1),
            ({"body.I1": 1e-310, "body.I3": 1e-310}, "body.I1", 1),
        ],
    )
    def test_numbers_that_cannot_be_reckoned_with_are_named(self, changes, field, others):
        with pytest.raises(InvalidInput) as caught:
            presets.report_problem().replace(changes)
        assert (caught.value.field, caught.value.others) == (field, others)
        assert str(caught.value).startswith(f"{field}: {caught.value.value} is too ")

    def test_an_unknown_preset(self):
        with pytest.raises(InvalidInput) as caught:
            presets.body("reprot")
        message = the_one_line_of(caught.value)
        assert "'reprot'" in message
        assert message.endswith("(did you mean report?)")

    def test_refusals_survive_pickling(self):
        """Workers send them home."""
        with pytest.raises(InvalidInput) as caught:
            Launch(tilt=-1.0, spin=math.nan)
        there = pickle.loads(pickle.dumps(caught.value))
        assert (there.field, there.value, there.accepted, there.hint, there.others) == (
            caught.value.field,
            caught.value.value,
            caught.value.accepted,
            caught.value.hint,
            caught.value.others,
        )
        assert str(there) == str(caught.value)

    def test_refusals_are_errors_of_the_package_and_value_errors(self):
        assert issubclass(InvalidInput, TippetopError)
        assert issubclass(InvalidInput, ValueError)
        assert issubclass(FileTrouble, OSError)


class TestPainlevesParadox:
    """A launch in which the table's push would drag the body further into it has no motion to
    compute.
    """

    @staticmethod
    def critical_slip(tilt):
        """Slip at which I1 + m R^2 alpha^2 s^2 = m R^2 alpha s (1 - alpha c) mu v_x, for the tippe
        top.
        """
        m, R, alpha, mu, I1 = 0.02, 0.02, 0.3, 0.3, 131 / 350 * 0.02 * 0.02**2
        s, c = math.sin(tilt), math.cos(tilt)
        return (I1 + m * R**2 * alpha**2 * s**2) / (m * R**2 * alpha * s * (1.0 - alpha * c) * mu)

    @pytest.mark.parametrize("tilt", [0.1, 1.0, 3.0])
    @pytest.mark.parametrize("liftoff", ["stop", "ignore"])
    def test_a_launch_in_the_paradox_is_refused(self, tilt, liftoff):
        slip = (1.001 * self.critical_slip(tilt), 0.0)
        with pytest.raises(InvalidInput) as caught:
            top_problem(launch__tilt=tilt, launch__slip=slip, contact__liftoff=liftoff)
        message = the_one_line_of(caught.value)
        assert message.startswith(f"launch.slip: {typed(slip)} is ")
        assert "Painleve" in message

    @pytest.mark.parametrize("tilt", [0.1, 1.0, 3.0])
    @pytest.mark.parametrize("factor", [0.999, -10.0])
    def test_a_launch_short_of_the_paradox_is_accepted(self, tilt, factor):
        slip = (factor * self.critical_slip(tilt), 0.0)
        accepted = top_problem(launch__tilt=tilt, launch__slip=slip, contact__liftoff="stop")
        assert accepted.launch.slip == slip

    @pytest.mark.parametrize("tilt", [0.1, 1.0, 3.0])
    def test_a_top_that_may_leave_the_table_has_a_way_out_of_the_paradox(self, tilt):
        slip = (1.001 * self.critical_slip(tilt), 0.0)
        accepted = top_problem(launch__tilt=tilt, launch__slip=slip, contact__liftoff="fly")
        assert accepted.launch.slip == slip

    def test_an_unbounded_slip_is_in_the_paradox_of_viscous_friction(self):
        with pytest.raises(InvalidInput, match=r"launch\.slip"):
            top_problem(launch__slip=(1e300, 0.0), contact__liftoff="stop")


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param(
            {"friction": COULOMB, "launch.slip": (1e200, 0.0)}, id="Coulomb friction at 1e200 m/s"
        ),
        pytest.param({"friction": {**COULOMB, "eps": 1e-100}}, id="eps of 1e-100 m/s"),
        pytest.param(
            {"body.shape": {"kind": "spheroid", "across": 1e-200, "along": 1e-200}}, id="a tiny egg"
        ),
        pytest.param(
            {"body.shape": {"kind": "spheroid", "across": 1e200, "along": 1e200}}, id="a huge egg"
        ),
    ],
)
def test_absurd_sizes_are_accepted_or_refused_but_do_not_break_the_arithmetic(changes):
    try:
        presets.report_problem().replace({"contact.liftoff": "stop", **changes})
    except InvalidInput as refusal:
        the_one_line_of(refusal)


@pytest.mark.parametrize("along", [1e-9, 1e9])
def test_a_spheroid_so_thin_that_rounding_decides_its_curvature_is_refused(along):
    with pytest.raises(InvalidInput, match=r"along: .* is not within a factor of"):
        Spheroid(across=0.02, along=along)


class TestFiles:
    def write(self, path, content):
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    @pytest.mark.parametrize("suffix", ["toml", "json"])
    def test_a_problem_is_read_as_it_was_written(self, tmp_path, suffix):
        original = top_problem(launch__azimuth=1 / 3, friction=COULOMB)
        text = original.to_json() if suffix == "json" else original.to_toml()
        path = self.write(tmp_path / f"problem.{suffix}", text)
        assert Problem.read(path) == original
        assert Problem.read(str(path)) == original

    def test_a_file_written_by_hand_may_leave_out_what_has_a_default(self, tmp_path):
        text = """
            [body]
            mass = 0.05
            I1 = 1.3e-5
            I3 = 8e-6
            [body.shape]
            kind = "spheroid"
            across = 0.02
            along = 0.03
            [friction]
            kind = "regularized_coulomb"
            mu = 0.3
            [launch]
            tilt = 0
            spin = 200
        """
        read = Problem.read(self.write(tmp_path / "egg.toml", text))
        expected = Problem(
            body=EGG,
            friction=RegularizedCoulombFriction(mu=0.3),
            launch=Launch(tilt=0.0, spin=200.0),
        )
        assert read == expected
        assert read.friction.eps == 1e-3
        assert read.contact == Contact(liftoff="fly", restitution=0.0)
        assert read.gravity == 9.8

    @pytest.mark.parametrize("name", ["problem.toml", "problem.json"])
    def test_a_file_that_is_not_there(self, tmp_path, name):
        with pytest.raises(FileTrouble) as caught:
            Problem.read(tmp_path / name)
        assert the_one_line_of(caught.value).startswith(f"{tmp_path / name} cannot be read: ")

    def test_a_directory(self, tmp_path):
        with pytest.raises(FileTrouble) as caught:
            Problem.read(tmp_path)
        assert the_one_line_of(caught.value).startswith(f"{tmp_path} cannot be read: ")

    @pytest.mark.parametrize("name", ["problem.toml", "problem.json"])
    def test_a_binary_file(self, tmp_path, name):
        path = self.write(tmp_path / name, b"\x89PNG\r\n\x1a\n\x00\xff")
        with pytest.raises(FileTrouble) as caught:
            Problem.read(path)
        assert the_one_line_of(caught.value).startswith(f"{path} is not a text file")

    @pytest.mark.parametrize("text", ["[1, 2]", '"x"', "null"])
    def test_json_that_is_no_object(self, tmp_path, text):
        with pytest.raises(InvalidInput) as caught:
            Problem.read(self.write(tmp_path / "a.json", text))
        assert the_one_line_of(caught.value).endswith(" is not a JSON object")

    def test_every_truncated_toml_is_refused_or_lacks_only_defaults(self, tmp_path):
        """A file cut short anywhere is refused in one line, unless what is left is a problem by
        itself.
        """
        text = top_problem(launch__azimuth=0.5).to_toml()
        refused = 0
        for end in range(len(text) - 1):
            try:
                left = Problem.from_toml(text[:end])
            except InvalidInput as refusal:
                the_one_line_of(refusal)
                refused += 1
            else:
                assert left.body == presets.REPORT
        assert refused > 0.5 * len(text)

    def test_every_truncated_json_is_refused(self):
        text = top_problem().to_json()
        for end in range(len(text)):
            with pytest.raises(InvalidInput) as caught:
                Problem.from_json(text[:end])
            assert the_one_line_of(caught.value).startswith("problem: ")

    @pytest.mark.parametrize("text", ["", "\n", "[1, 2]", "3", "null", '"problem"', "{", "{}"])
    def test_json_that_is_not_a_problem(self, tmp_path, text):
        path = self.write(tmp_path / "problem.json", text)
        with pytest.raises(InvalidInput) as caught:
            Problem.read(path)
        the_one_line_of(caught.value)

    @pytest.mark.parametrize(
        "text", ["", "tilt", "tilt = ", "[body", "[body]\n[body]", "\x00", "a = 'b\n'"]
    )
    def test_toml_that_is_not_a_problem(self, tmp_path, text):
        path = self.write(tmp_path / "problem.toml", text)
        with pytest.raises(InvalidInput) as caught:
            Problem.read(path)
        the_one_line_of(caught.value)

    @pytest.mark.parametrize(("name", "language"), [("mine.toml", "TOML"), ("mine.json", "JSON")])
    def test_a_file_that_cannot_be_read_is_named(self, tmp_path, name, language):
        path = self.write(tmp_path / name, "{ gravity")
        with pytest.raises(InvalidInput) as caught:
            Problem.read(path)
        said = the_one_line_of(caught.value)
        assert said.startswith(f"problem: '{name}' is not {language} (")

    def test_of_what_cannot_be_in_a_file_the_file_is_named(self, tmp_path):
        text = top_problem().to_toml()
        for wrong, said in (
            (
                text.replace("gravity = 9.8", "gravity = -9.8"),
                "gravity in mine.toml: -9.8 is not ",
            ),
            (text.replace("[launch]", "[launched]"), "launched in mine.toml: {"),
            (text.replace("mass = ", "weight = "), "body.weight in mine.toml: "),
        ):
            assert wrong != text
            with pytest.raises(InvalidInput) as caught:
                Problem.read(self.write(tmp_path / "mine.toml", wrong))
            assert the_one_line_of(caught.value).startswith(said)
            assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)

    @pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999"])
    def test_json_with_a_number_that_is_not_finite(self, number):
        text = top_problem().to_json().replace("9.8", number)
        with pytest.raises(InvalidInput) as caught:
            Problem.from_json(text)
        assert the_one_line_of(caught.value).startswith("gravity: ")

    @pytest.mark.parametrize("number", ["nan", "inf", "-inf", "1e999"])
    def test_toml_with_a_number_that_is_not_finite(self, number):
        text = top_problem().to_toml().replace("gravity = 9.8", f"gravity = {number}")
        with pytest.raises(InvalidInput) as caught:
            Problem.from_toml(text)
        assert the_one_line_of(caught.value).startswith("gravity: ")

    @pytest.mark.parametrize(
        ("read", "text"),
        [
            pytest.param(
                Problem.from_json, '{"gravity": ' + "1" * 5000 + "}", id="JSON, 5000 digits"
            ),
            pytest.param(Problem.from_toml, "gravity = " + "1" * 5000, id="TOML, 5000 digits"),
            pytest.param(Problem.from_json, "[" * 100_000, id="JSON, 100000 brackets"),
            pytest.param(
                Problem.from_toml, "gravity = " + "[" * 100_000, id="TOML, 100000 brackets"
            ),
        ],
    )
    def test_digits_or_brackets_without_end_are_refused_in_one_line(self, read, text):
        with pytest.raises(InvalidInput) as caught:
            read(text)
        the_one_line_of(caught.value)


def bits(model):
    """Every number of a model to the last bit, and everything else as it is."""
    if isinstance(model, BaseModel):
        return {name: bits(value) for name, value in model}
    if isinstance(model, tuple):
        return [bits(value) for value in model]
    return model.hex() if isinstance(model, float) else model


class TestRoundTrips:
    @given(problems())
    def test_toml_loses_nothing(self, original):
        assert bits(Problem.from_toml(original.to_toml())) == bits(original)

    @given(problems())
    def test_json_loses_nothing(self, original):
        assert bits(Problem.from_json(original.to_json())) == bits(original)

    @given(problems())
    def test_pickling_loses_nothing(self, original):
        there = pickle.loads(pickle.dumps(original))
        assert bits(there) == bits(original)
        assert there == original
        assert hash(there) == hash(original)

    @given(problems())
    def test_its_own_dump_makes_the_same_problem(self, original):
        assert bits(Problem(**original.model_dump())) == bits(original)

    @given(st.floats(allow_nan=False, allow_infinity=False))
    def test_any_finite_float_is_kept_to_the_last_bit(self, azimuth):
        original = top_problem(launch__azimuth=azimuth)
        for there in (Problem.from_toml(original.to_toml()), Problem.from_json(original.to_json())):
            assert there.launch.azimuth.hex() == azimuth.hex()


class TestValues:
    def test_a_problem_cannot_be_changed(self):
        original = top_problem()
        for part, name in (
            (original, "gravity"),
            (original.launch, "spin"),
            (original.body.shape, "radius"),
        ):
            before = getattr(part, name)
            with pytest.raises(InvalidInput, match="make a changed copy by"):
                setattr(part, name, 1.0)
            assert getattr(part, name) == before

    def test_equal_problems_are_one_key(self):
        seen = {top_problem(): "a", top_problem(launch__spin=100.0): "b"}
        assert seen[presets.report_problem()] == "a"
        assert seen[presets.report_problem(spin=100.0)] == "b"
        assert len(seen) == 2

    def test_a_copy_is_validated(self):
        original = top_problem()
        assert original.model_copy(update={"gravity": 1.62}).gravity == 1.62
        assert original.model_copy() == original
        assert original.model_copy(deep=True) == original
        for part, update, field in (
            (original, {"gravity": -1.0}, "gravity"),
            (original.launch, {"tilt": 4.0}, "tilt"),
            (original.body, {"I3": 1.0}, "I3"),
            (original, {"gravty": 1.0}, "gravty"),
        ):
            with pytest.raises(InvalidInput) as caught:
                part.model_copy(update=update)
            assert caught.value.field == field

    @pytest.mark.parametrize(
        ("name", "value"),
        [
            ("gravity", 1.62),
            ("launch.spin", -100.0),
            ("launch.slip", (0.1, -0.2)),
            ("body.shape.eccentricity", 0.25),
            ("body.I3", 2e-6),
            ("friction.mu", 0.0),
            ("contact.liftoff", "ignore"),
            ("launch.gap", 0.1),
            ("launch.velocity", (0.1, 0.2, -0.3)),
            ("launch.slip.1", 0.3),
            ("body", presets.REPORT_TABLE_1),
            ("friction", RegularizedCoulombFriction(mu=0.2)),
        ],
    )
    def test_replacing_a_field_changes_it_and_nothing_else(self, name, value):
        original = top_problem()
        before = copy.deepcopy(original)
        changed = original.replace({name: value})
        at, at_original = part_at(changed, name), part_at(original, name)
        assert at == value
        assert original == before
        assert changed != original
        assert changed.replace({name: at_original}) == original

    def test_replacing_several_fields_is_one_step(self):
        """Neither of the first of these inertias is possible without the second."""
        heavier = presets.report_problem().replace({"body.I3": 1.9e-4, "body.I1": 1e-4})
        assert (heavier.body.I1, heavier.body.I3) == (1e-4, 1.9e-4)
        lighter = presets.report_problem().replace({"body.I1": 1e-6, "body.I3": 1.9e-6})
        assert (lighter.body.I1, lighter.body.I3) == (1e-6, 1.9e-6)

    @pytest.mark.parametrize(
        "name", ["launch.tlt", "gravty", "launch.tilt.x", "body.shape.along", "", "."]
    )
    def test_replacing_a_field_that_is_not_there(self, name):
        with pytest.raises(InvalidInput) as caught:
            top_problem().replace({name: 1.0})
        message = the_one_line_of(caught.value)
        assert message.startswith(name or repr(name))
        assert "launch.tilt" in message or "gravity" in message or "spheroid" in message

    @given(problems())
    def test_what_is_got_at_a_path_is_what_replace_puts_there(self, original):
        for name in dotted_names(original.model_dump()):
            value = original.get(name)
            assert original.replace({name: value}) == original, name
            where, _, last = name.rpartition(".")
            if where and not last.isdecimal() and not isinstance(original.get(where), tuple):
                assert getattr(original.get(where), last) == value

    def test_items_of_lists_are_got_by_their_places(self):
        problem = top_problem(launch__slip=(0.1, 0.2))
        assert problem.get("launch.slip.1") == 0.2
        assert problem.get("launch.slip") == (0.1, 0.2)

    @pytest.mark.parametrize(
        ("path", "meant"),
        [
            ("spin", "launch.spin"),
            ("launch.spn", "launch.spin"),
            ("mu", "friction.mu"),
            ("body.radius", "body.shape.radius"),
            ("launch.slip.2", "launch.slip"),
            ("body.surface", None),
            ("launch.__class__", None),
            ("", None),
        ],
    )
    def test_a_path_without_a_field_is_refused_with_what_may_be_meant(self, path, meant):
        problem = top_problem()
        calls = {
            f"field: {path!r} is not the name of a field": lambda: problem.get(path),
            f"{path or repr(path)}: 1 is given for an unknown field": lambda: problem.replace(
                {path: 1.0}
            ),
        }
        for head, call in calls.items():
            with pytest.raises(InvalidInput) as caught:
                call()
            message = the_one_line_of(caught.value)
            assert message.startswith(head)
            assert meant is None or message.endswith(f"(did you mean {meant}?)")

    def test_a_problem_is_the_numbers_of_its_parts(self):
        sphere = top_problem(launch__tilt=0.5)
        assert top_of(sphere) == Top.of(
            0.02, sphere.body.I1, sphere.body.I3, SphereSurface(0.02, 0.006), ViscousLaw(0.3), 9.8
        )
        egg = top_problem(body=EGG, friction=COULOMB, gravity=1.62)
        assert top_of(egg) == Top.of(
            0.05, 1.3e-5, 8e-6, SpheroidSurface(0.02, 0.03), RegularizedCoulombLaw(0.3, 1e-3), 1.62
        )

    @given(problems())
    def test_the_start_leans_spins_and_slips_as_the_launch_says(self, original):
        launch, start, body = original.launch, original.start(), original.body
        assert start.axis[2] == pytest.approx(math.cos(launch.tilt), abs=1e-15)
        spin = sum(a * b for a, b in zip(start.momentum, start.axis, strict=True)) / body.I3
        swing = abs(launch.precession) + abs(launch.tilt_rate)
        assert spin == pytest.approx(
            launch.spin, abs=1e-12 * (abs(launch.spin) + swing * body.I1 / body.I3)
        )
        if launch.velocity is not None:
            assert start.velocity == launch.velocity
            return
        touch = sliding_contact(start.axis, start.momentum, start.velocity[:2], top_of(original))
        leaning = complex(math.cos(launch.azimuth), math.sin(launch.azimuth))
        size = 10.0 * body.shape.surface.size
        error = abs(complex(*touch.slip) - complex(*launch.slip) * leaning)
        assert error <= 1e-12 * (math.hypot(*launch.slip) + size * (abs(launch.spin) + swing))

    @given(problems())
    def test_the_start_is_as_far_above_the_table_as_the_launch_says(self, original):
        """Without a velocity of its own the lowest point moves sideways only."""
        launch, start, top = original.launch, original.start(), top_of(original)
        arm = contact_vector(start.axis, top.surface)
        size = 10.0 * top.surface.size
        assert start.height + arm[2] == pytest.approx(launch.gap, abs=1e-14 * (size + launch.gap))
        if launch.velocity is None:
            omega = angular_velocity(start.axis, start.momentum, top)
            point = point_velocity(start.velocity, omega, arm)
            assert point[2] == pytest.approx(
                0.0, abs=1e-13 * (size * length(omega) + length(start.velocity))
            )

    @pytest.mark.parametrize(("tilt", "pole"), [(0.0, 1.0), (math.pi, -1.0)])
    def test_a_launch_at_a_pole_is_exactly_vertical(self, tilt, pole):
        start = top_problem(launch__tilt=tilt).start()
        assert start.axis == (0.0, 0.0, pole)
        assert start.momentum[:2] == (0.0, 0.0)
        assert start.velocity == (0.0, 0.0, 0.0)


class TestPresets:
    def test_the_reports_top_has_the_inertias_of_its_listing(self):
        """I1 = 131/350 m R^2 and I3 = 2/5 m R^2, with m = 0.02 kg, R = 0.02 m and alpha = 0.3."""
        unit = 0.02 * 0.02**2
        assert presets.REPORT.mass == 0.02
        assert presets.REPORT.shape == EccentricSphere(radius=0.02, eccentricity=0.3)
        assert pytest.approx(131 / 350 * unit, rel=1e-15) == presets.REPORT.I1
        assert pytest.approx(2 / 5 * unit, rel=1e-15) == presets.REPORT.I3

    def test_the_reports_table_exchanges_them(self):
        listing, table = presets.REPORT, presets.REPORT_TABLE_1
        assert (table.I1, table.I3) == (listing.I3, listing.I1)
        assert table.I1 != table.I3
        assert (table.mass, table.shape) == (listing.mass, listing.shape)

    def test_presets_are_found_by_their_names(self):
        assert presets.body("report") == presets.REPORT
        assert presets.body("report-table-1") == presets.REPORT_TABLE_1
        assert (
            presets.body("leine-glocker")
            == presets.LEINE_GLOCKER
            == presets.leine_glocker_problem().body
        )

    def test_leine_and_glockers_centre_of_mass_is_3_mm_from_the_middle(self):
        shape = presets.LEINE_GLOCKER.shape
        assert shape.radius * shape.eccentricity == pytest.approx(3e-3, rel=1e-15)

    def test_the_reports_problem_is_launched_at_rest_in_tilt(self):
        """theta = 0.1 rad and omega3 = 155 rad/s with everything else zero, mu = 0.3 s/m, g = 9.8
        m/s^2.
        """
        assert presets.report_problem() == Problem(
            body=presets.REPORT,
            friction=ViscousFriction(mu=0.3),
            launch=Launch(
                tilt=0.1, spin=155.0, azimuth=0.0, tilt_rate=0.0, precession=0.0, slip=(0.0, 0.0)
            ),
            gravity=9.8,
        )
        other = presets.report_problem(spin=50.0, tilt=0.2, mu=1.0)
        assert (other.launch.spin, other.launch.tilt, other.friction.mu) == (50.0, 0.2, 1.0)


def conforms(value, schema, root):
    """Whether a JSON value conforms to a JSON Schema, as far as the schemas of problems go."""
    if "$ref" in schema:
        return conforms(value, root["$defs"][schema["$ref"].removeprefix("#/$defs/")], root)
    if "oneOf" in schema:
        return sum(conforms(value, choice, root) for choice in schema["oneOf"]) == 1
    if "anyOf" in schema:
        return any(conforms(value, choice, root) for choice in schema["anyOf"])
    if "const" in schema or "enum" in schema:
        return value in schema.get("enum", [schema.get("const")])
    match schema["type"]:
        case "number":
            return (
                isinstance(value, float)
                and value > schema.get("exclusiveMinimum", -math.inf)
                and value >= schema.get("minimum", -math.inf)
                and value < schema.get("exclusiveMaximum", math.inf)
                and value <= schema.get("maximum", math.inf)
            )
        case "array" if "items" in schema:
            several = isinstance(value, list) and len(value) >= schema["minItems"]
            return several and all(conforms(inner, schema["items"], root) for inner in value)
        case "array":
            items = schema["prefixItems"]
            return (
                isinstance(value, list)
                and schema["minItems"] == schema["maxItems"] == len(items) == len(value)
                and all(conforms(v, item, root) for v, item in zip(value, items, strict=True))
            )
        case "null":
            return value is None
        case "string":
            return isinstance(value, str) and re.search(schema["pattern"], value) is not None
        case "object":
            known = schema["properties"]
            return (
                isinstance(value, dict)
                and set(schema.get("required", [])) <= set(value)
                and not schema["additionalProperties"]
                and all(
                    name in known and conforms(v, known[name], root) for name, v in value.items()
                )
            )
    raise AssertionError(f"unknown schema: {schema}")


def objects_in(schema):
    """The schemas of objects in a JSON Schema, with their titles."""
    if isinstance(schema, dict):
        if schema.get("type") == "object":
            yield schema["title"], schema
        schema = list(schema.values())
    if isinstance(schema, list):
        for part in schema:
            yield from objects_in(part)


class TestSchema:
    SCHEMA = Problem.model_json_schema()

    def test_it_has_every_field_of_every_part(self):
        definitions = dict(objects_in(self.SCHEMA))
        assert {part.__name__ for part in PARTS} <= set(definitions)
        for part in PARTS:
            assert set(definitions[part.__name__]["properties"]) == set(part.model_fields)

    def test_the_parts_are_all_the_models_there_are(self):
        defined = {
            model
            for module in (bodies, contact_rules, frictions, launch, problem, shapes)
            for model in vars(module).values()
            if isinstance(model, type)
            and issubclass(model, BaseModel)
            and model.__module__ == module.__name__
            and not inspect.isabstract(model)
        }
        assert defined == set(PARTS)

    def test_every_number_says_what_it_is_in_a_docstring_with_units(self):
        for part in PARTS:
            description = dict(objects_in(self.SCHEMA))[part.__name__]["description"]
            for name, field in part.model_fields.items():
                entry = re.search(
                    rf"^ *(\w+, )*{name}(, \w+)*\n(?P<text>.*?)(^ *\w+$|\Z)", description, ENTRIES
                )
                assert entry or name == "kind", (part, name)
                for quantity in [one for one in field.metadata if isinstance(one, Quantity)]:
                    unit = WRITTEN[quantity.units]
                    written = rf"(?<![\w/^]){re.escape(unit)}(?![\w/^])"
                    assert not unit or re.search(written, entry["text"]), (part, name)

    @pytest.mark.parametrize(
        ("name", "value"),
        [
            ("launch.spin", "2200 rpm"),
            ("launch.tilt", "5°"),
            ("body.mass", "20g"),
            ("body.shape.radius", "1e-2 m"),
            ("launch.slip", ["1 cm/s", 0.0]),
            ("gravity", "9.8 m/s^2"),
        ],
    )
    def test_it_accepts_numbers_with_units_as_the_models_do(self, name, value):
        fields = fields_with(name, value)
        assert Problem(**fields)
        assert conforms(fields, self.SCHEMA, self.SCHEMA)

    @given(problems())
    def test_it_accepts_every_problem(self, original):
        assert conforms(json.loads(original.to_json()), self.SCHEMA, self.SCHEMA)

    @pytest.mark.parametrize(
        ("name", "value"),
        [
            ("gravity", 0.0),
            ("gravity", "9.8"),
            ("gravity", "1e5"),
            ("friction.mu", "a little"),
            ("body", ...),
            ("body.mass", -1.0),
            ("body.shape.eccentricity", 1.0),
            ("body.shape.kind", "cube"),
            ("body.shape.along", 0.02),
            ("friction.mu", -0.1),
            ("friction.eps", 0.1),
            ("launch.tilt", 3.2),
            ("launch.slip", [0.0]),
            ("launch.velocity", [0.0, 0.0]),
            ("launch.gap", -0.1),
            ("launch.omega", 1.0),
            ("contact.liftoff", "jump"),
        ],
    )
    def test_it_refuses_what_the_models_refuse(self, name, value):
        fields = fields_with(name, value)
        assert not conforms(fields, self.SCHEMA, self.SCHEMA)
