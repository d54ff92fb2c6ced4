from urllib.parse import parse_qsl

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tippetop as tt
from tippetop.lab.launches import launches
from tippetop.lab.setup import LONGEST, Setup, first_setup, read_query
from tippetop.theory.groups import classify
from tippetop.theory.prediction import predict
from tippetop.theory.steady import SteadyKind
from tippetop.theory.thresholds import critical_spins


def reread(setup: Setup) -> Setup:
    return read_query(dict(parse_qsl(setup.query)))


@given(
    spin=st.floats(-500, 500),
    tilt=st.floats(0, 3.14),
    mu=st.floats(0, 100),
    eccentricity=st.floats(0.01, 0.9),
    restitution=st.floats(0, 1),
    duration=st.floats(0.01, LONGEST),
)
def test_a_link_holds_every_launch(
    spin: float, tilt: float, mu: float, eccentricity: float, restitution: float, duration: float
) -> None:
    setup = first_setup().changed(
        {
            "launch.spin": spin,
            "launch.tilt": tilt,
            "friction.mu": mu,
            "body.shape.eccentricity": eccentricity,
            "contact.restitution": restitution,
            "duration": duration,
        }
    )
    assert reread(setup) == setup


def test_a_link_holds_other_shapes_laws_and_thrown_tops() -> None:
    egg = tt.Body(mass=0.02, shape=tt.Spheroid(across=0.015, along=0.025), I1=4e-6, I3=2e-6)
    problem = tt.Problem(
        body=egg,
        friction=tt.RegularizedCoulombFriction(mu=0.2, eps=1e-3),
        launch=tt.Launch(tilt=1.5, spin=0.0, precession=150.0, gap=0.01, velocity=(0.1, 0.0, 0.2)),
    )
    assert reread(Setup(problem, 3.5)) == Setup(problem, 3.5)


def test_choosing_another_law_drops_the_numbers_of_the_old_one() -> None:
    coulomb = first_setup().changed(
        {"friction.kind": "regularized_coulomb", "friction.mu": 0.2, "friction.eps": 0.01}
    )
    viscous = coulomb.changed({"friction.kind": "viscous", "friction.mu": 0.4})
    assert viscous.problem.friction == tt.ViscousFriction(mu=0.4)


@pytest.mark.parametrize(
    ("query", "field"),
    [
        ({"launch.tilt": "9"}, "launch.tilt"),
        ({"launch.spn": "9"}, "launch.spn"),
        ({"gravity.deep": "1"}, "gravity"),
        ({"nonsense.deep": "1"}, "nonsense"),
        ({"launch.spin.deep": "1"}, "launch.spin"),
        ({"friction.kind": "glue"}, "friction"),
        ({"launch.spin": "NaN"}, "launch.spin"),
        ({"duration": "1e9"}, "duration"),
        ({"duration": "0"}, "duration"),
        ({"duration": "soon"}, "duration"),
        ({"launch": "5"}, "launch"),
        ({"gravity": "[" * 5000}, "gravity"),
    ],
)
def test_a_link_that_cannot_be_followed_names_its_fault(query: dict[str, str], field: str) -> None:
    with pytest.raises(tt.InvalidInput) as refusal:
        read_query(query)
    assert field in str(refusal.value)


def test_what_others_add_to_a_link_is_passed_over() -> None:
    query = {"launch.spin": "100", "utm_source": "a letter", "fbclid": "x" * 500}
    assert read_query(query) == first_setup().changed({"launch.spin": 100.0})


def test_links_of_whole_seconds_read_as_such() -> None:
    assert first_setup().query.endswith("duration=20")


def test_launches_to_start_from_are_told_apart() -> None:
    offered = launches()
    assert first_setup() in offered.values()
    assert len(set(offered)) == len(offered)
    tippe_tops = {body for body in tt.presets.BODIES.values() if isinstance(body.shape, tt.EccentricSphere)}
    assert {setup.problem.body for setup in offered.values()} == tippe_tops


def test_tops_of_the_literature_turn_over_as_theory_says_of_theirs() -> None:
    (setup,) = [each for name, each in launches().items() if name.startswith("Leine and Glocker 2003")]
    problem = setup.problem
    assert classify(problem.body.I1 / problem.body.I3, problem.body.shape.eccentricity).inverts  # type: ignore[union-attr]
    assert problem.launch.spin > critical_spins(problem).inverted
    run = tt.simulate(problem, setup.duration)
    assert run["theta"][0] < 0.2
    assert run["theta"][-1] > 2.0
    assert predict(problem).reachable[0].kind is SteadyKind.INVERTED


@pytest.mark.parametrize("name", ["gravty", "Duration", "launch.spn"])
def test_a_misspelt_field_of_a_link_is_refused(name: str) -> None:
    with pytest.raises(tt.InvalidInput):
        read_query({name: "9"})
