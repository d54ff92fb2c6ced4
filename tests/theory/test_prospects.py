"""What a body alone says: groups, critical spins, and what it takes to stand on a stem."""

import math

import pytest

import tippetop as tt
from tippetop.problem.presets import LEINE_GLOCKER, REPORT
from tippetop.theory.groups import Group
from tippetop.theory.prospects import prospects

STEMS = [
    (LEINE_GLOCKER, tt.Sphere(radius=5e-3, center=1.6e-2), 9.81),
    (REPORT, tt.Sphere(radius=4e-3, center=2.6e-2), 9.8),
]


@pytest.mark.parametrize(("body", "tip", "gravity"), STEMS, ids=["leine-glocker", "report"])
def test_what_it_takes_to_stand_on_a_stem(body, tip, gravity):
    """The least Jellett's integral about the tip, in closed form."""
    stem = prospects(body, [body.shape, tip], gravity).stem
    r, zeta = tip.radius, tip.center
    share = body.mass * gravity * body.I3 * zeta / (r * (zeta + r * (1 - body.I1 / body.I3)))
    assert stem.jellett == pytest.approx(math.sqrt(share) * (r + zeta) ** 2, rel=1e-12)
    assert stem.spin == pytest.approx(stem.jellett / (body.I3 * (r + zeta)), rel=1e-12)


def test_a_body_too_slender_never_stands_on_its_tip():
    slender = REPORT.model_copy(update={"I1": 10 * REPORT.I3})
    tip = tt.Sphere(radius=4e-3, center=2.6e-2)
    assert prospects(slender, [REPORT.shape, tip]).stem.spin == math.inf


def test_the_sphere_decides_whether_it_turns_over():
    shape = REPORT.shape
    sphere = tt.Sphere(radius=shape.radius, center=shape.radius * shape.eccentricity)
    found, other = prospects(REPORT, [shape]), prospects(REPORT, [sphere])
    assert found.group is other.group is Group.IIA
    assert found.stem is other.stem is None
    assert found.critical_spins.upright == pytest.approx(other.critical_spins.upright, rel=1e-12)
    launch = tt.Launch(tilt=0.1, spin=0.0)
    problem = tt.Problem(body=REPORT, friction=tt.ViscousFriction(mu=0.3), launch=launch)
    assert found.critical_spins == tt.critical_spins(problem)


def test_who_lies_on_no_sphere_has_no_group():
    assert prospects(REPORT, [tt.Ring(radius=0.02)]) is None
    assert prospects(REPORT, [tt.Sphere(radius=0.02, center=-0.001)]) is None


def end_of(problem, spin, duration):
    return float(
        tt.simulate(problem.replace({"launch.spin": spin}), duration, samples=11)["tilt"][-1]
    )


def test_a_stem_touches_and_is_stood_upon_from_the_spins_foreseen():
    """Runs of a whole top: below one spin its stem stays up, above it touches; so for standing on
    it.
    """
    body = tt.presets.BODIES["report-stem"]
    found = prospects(body, list(body.shapes))
    launch = tt.Launch(tilt=found.tilt, spin=0.0)
    problem = tt.Problem(body=body, friction=tt.ViscousFriction(mu=0.3), launch=launch)
    gap = [shape.surface.height(math.cos(found.touch.tilt)) for shape in body.shapes]
    assert gap[0] == pytest.approx(gap[1], rel=1e-12)
    for factor, touches in ((0.97, False), (1.05, True)):
        run = tt.simulate(
            problem.replace({"launch.spin": factor * found.touch.spin}), 9.0, samples=11
        )
        assert (run.sizes["event"] > 0) is touches
    assert found.touch.spin < 0.9 * found.stem.launch
    assert end_of(problem, 0.9 * found.stem.launch, 9.0) < found.touch.tilt + 0.2
    assert end_of(problem, 1.1 * found.stem.launch, 9.0) == pytest.approx(math.pi, abs=1e-3)


def test_what_never_leaves_upright_brings_no_stem_to_the_table():
    never = REPORT.model_copy(update={"I1": 0.6 * REPORT.I3})
    found = prospects(never, [REPORT.shape, STEMS[1][1]])
    assert found.group in (Group.IA, Group.IB)
    assert found.touch.spin == found.stem.launch == math.inf
