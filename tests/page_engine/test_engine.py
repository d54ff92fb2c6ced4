"""The engine in the page computes the same numbers as Python, and what its motions must keep."""

import json
import math
from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import pytest

import tippetop as tt
from campaigns import among, seed_ranges
from launches import (
    TOLERANCE,
    asked,
    compared,
    in_javascript,
    in_python,
    launch_of,
    laws_of,
    nudged,
    parts_of,
    surfaces_of,
)
from lying import lying, resisted
from node import printed
from tippetop.page_engine import HERE

SLIPS_IN_THE_END = 21
STOPS_ON_TWO = 192
LIFTS_OFF_AT_ONCE, SLIPS_TO_ITS_END, TRIES_NO_SHAPE = 327, 374, 1030
"""The last's first trial leads beyond lying flat, where nothing is a number; its step is then
shortened.
"""
CLOSE_CALLS = (62, 104, LIFTS_OFF_AT_ONCE, SLIPS_TO_ITS_END, TRIES_NO_SHAPE)
DURATION = 0.3


def test_all_that_is_generated_asks_for_is_there() -> None:
    script = f"""
      import {{ readFileSync }} from "node:fs";
      import * as py from {json.dumps((HERE / "python.js").as_uri())};
      const text = readFileSync({json.dumps(str(HERE / "mechanics.js"))}, "utf8");
      const uses = text.matchAll(/\\bpy\\.(?:(math|np)\\.)?(\\w+)/g);
      const asked = new Set(Array.from(uses, ([name]) => name));
      const value = (name) => name.split(".").slice(1).reduce((one, part) => one?.[part], py);
      const there = (name) => value(name) !== undefined;
      console.log(JSON.stringify([[...asked].filter((name) => !there(name)), [...asked]]));
    """
    missing, asked = json.loads(printed(script))
    assert {"py.add", "py.math.pi", "py.np.nan"} <= set(asked)
    assert not missing


def test_the_report_s_launch_with_flights_is_the_same() -> None:
    problem = tt.presets.report_problem(spin=175.0)
    duration = 6.5
    run = tt.simulate(problem, duration, samples=41)
    question = asked(0, duration) | {
        "problem": problem.model_dump(mode="json"),
        "tolerance": TOLERANCE,
    }
    (found,) = in_javascript([question])
    assert run.sizes["event"] > 10, "it flies"
    assert not compared(found, run)


def test_a_coin_that_tumbles_through_flat_is_the_same() -> None:
    launch, contact = tt.Launch(tilt=1.2, spin=0.0, gap=0.01), tt.Contact(restitution=0.5)
    for friction in (tt.ViscousFriction(mu=0.3), tt.CoulombFriction(mu=0.3)):
        problem = tt.Problem(
            body=tt.presets.COIN, friction=friction, launch=launch, contact=contact
        )
        fields = problem.model_dump(mode="json")
        (found,) = in_javascript([asked(0, DURATION) | {"problem": fields}])
        run = in_python(fields, DURATION)
        assert "lies down" in run["event_kind"].values
        assert not compared(found, run)


def test_a_coin_that_slips_until_it_lies_flat_is_the_same() -> None:
    launch = tt.Launch(tilt=0.16, spin=0.0, tilt_rate=-20.0)
    law = tt.ContensouFriction(mu=0.3, patch_radius=1e-3, pressure="hertz")
    problem = tt.Problem(body=tt.presets.COIN, friction=law, launch=launch)
    fields = problem.model_dump(mode="json")
    (found,) = in_javascript([asked(0, DURATION) | {"problem": fields}])
    run = in_python(fields, DURATION)
    assert "lies down" in run["event_kind"].values
    assert float(run["tilt"][-1]) < 1e-9
    assert not compared(found, run)


@pytest.mark.parametrize(
    ("friction", "pressure"),
    among(
        list(
            product(
                [tt.CoulombFriction(mu=0.3), tt.ViscousFriction(mu=0.3)],
                ["uniform", "rim", "ellipsoidal"],
            )
        ),
        check=3,
    ),
)
def test_a_disk_that_slides_and_spins_on_its_face_is_the_same(
    friction: tt.Friction, pressure: Any
) -> None:
    disk = tt.Body(
        mass=0.4, shape=tt.Ring(radius=0.04, center=-0.005, inner_radius=0.01), I1=1.6e-4, I3=3.2e-4
    )
    problem = tt.Problem(
        body=disk,
        friction=friction,
        launch=tt.Launch(tilt=0.0, spin=20.0, slip=(0.4, 0.2)),
        contact=tt.Contact(face_pressure=pressure),
    )
    fields = problem.model_dump(mode="json")
    (found,) = in_javascript([asked(0, DURATION) | {"problem": fields}])
    run = in_python(fields, DURATION)
    assert run.attrs["status"] == ("at_rest" if friction.kind == "coulomb" else "completed")
    assert not compared(found, run)


def test_disks_whose_pressure_differs_are_told_apart_one_after_the_other() -> None:
    """What is compiled for a face is not that of another pressure, or of a face with a hole."""
    problems = [
        tt.Problem(
            body=tt.Body(
                mass=0.4,
                shape=tt.Ring(radius=0.04, center=-0.005, inner_radius=hole),
                I1=1.6e-4,
                I3=3.2e-4,
            ),
            friction=tt.CoulombFriction(mu=0.3),
            launch=tt.Launch(tilt=0.0, spin=20.0, slip=(0.4, 0.2)),
            contact=tt.Contact(face_pressure=pressure),
        )
        for hole, pressure in ((0.01, "uniform"), (0.01, "rim"), (0.0, "uniform"))
    ]
    questions = [asked(0, DURATION) | {"problem": json.loads(one.to_json())} for one in problems]
    for found, question in zip(in_javascript(questions), questions, strict=True):
        assert not compared(found, in_python(question["problem"], DURATION))


def test_a_disk_that_sticks_by_static_friction_and_slips_is_the_same() -> None:
    disk = tt.Problem(
        body=tt.Body(mass=0.05, shape=tt.Ring(radius=0.02), I1=5e-6, I3=1e-5),
        friction=tt.StaticCoulombFriction(mu=0.2, static_mu=0.3),
        launch=tt.Launch(tilt=1.7, spin=0.0, precession=2.0),
    )
    fields = disk.model_dump(mode="json")
    (found,) = in_javascript([asked(0, 0.12) | {"problem": fields}])
    run = in_python(fields, 0.12)
    assert run["event_kind"].values.tolist()[:2] == ["stick", "slip"]
    assert not compared(found, run)


@pytest.mark.parametrize("spin", [0.0, 20.0])
def test_a_body_that_tips_over_its_rim_is_the_same(spin: float) -> None:
    tall = tt.Body(mass=0.1, shape=tt.Ring(radius=0.02, center=-0.05), I1=1e-4, I3=2e-5)
    launch = tt.Launch(tilt=0.0, spin=spin, slip=(3.0, 0.0))
    problem = tt.Problem(body=tall, friction=tt.CoulombFriction(mu=0.45), launch=launch)
    fields = problem.model_dump(mode="json")
    (found,) = in_javascript([asked(0, 0.1) | {"problem": fields}])
    run = in_python(fields, 0.1)
    assert run["event_kind"].values[0] == "tips over its rim"
    assert not compared(found, run)


@pytest.mark.parametrize("tilt", [0.0, 0.2])
def test_a_cylinder_that_lands_flat_or_rocks_is_the_same(tilt: float) -> None:
    mass, radius, height = 0.1, 0.01, 0.06
    cylinder = tt.Body(
        mass=mass,
        shape=[tt.Ring(radius=radius, center=side * height / 2) for side in (-1, 1)],
        I1=mass * (3 * radius**2 + height**2) / 12,
        I3=mass * radius**2 / 2,
    )
    fields = (
        {"spin": 30.0, "gap": 0.01, "velocity": (0.2, 0.1, 0.0)} if tilt == 0.0 else {"spin": 0.0}
    )
    problem = tt.Problem(
        body=cylinder,
        friction=tt.CoulombFriction(mu=0.25 if tilt == 0.0 else 0.5),
        launch=tt.Launch(tilt=tilt, **fields),
        contact=tt.Contact(restitution=0.4 if tilt == 0.0 else 0.0),
    )
    written = problem.model_dump(mode="json")
    (found,) = in_javascript([asked(0, 0.3) | {"problem": written}])
    run = in_python(written, 0.3)
    assert list(run["event_kind"].values).count("impact") > 1
    assert not compared(found, run)


def test_a_disk_that_wobbles_down_is_the_same() -> None:
    disk = tt.Body(mass=0.4, shape=tt.Ring(radius=0.04), I1=1.6e-4, I3=3.2e-4)
    problem = tt.Problem(
        body=disk,
        friction=tt.ViscousFriction(mu=10.0),
        launch=tt.Launch(tilt=0.01, spin=0.0, precession=313.0),
        rolling_resistance=0.01,
    )
    fields = problem.model_dump(mode="json")
    (found,) = in_javascript([asked(0, DURATION) | {"problem": fields}])
    run = in_python(fields, DURATION)
    assert "lies down" in run["event_kind"].values
    assert not compared(found, run)


def test_a_top_that_falls_back_is_told_from_one_that_does_not() -> None:
    law = tt.ContensouFriction(mu=0.3, patch_radius=5e-4)
    duration, falls = 15.0, []
    for spin in (10.0, 80.0):
        problem = tt.presets.report_problem(spin=spin).replace({"friction": law})
        fields = problem.model_dump(mode="json")
        (found,) = in_javascript([asked(0, duration) | {"problem": fields}])
        assert not compared(found, in_python(fields, duration))
        falls.append(found["fellBack"])
    assert falls == [False, True]


@pytest.mark.parametrize(
    "seeds",
    [
        CLOSE_CALLS[:2],
        pytest.param(CLOSE_CALLS[2:], marks=pytest.mark.slow),
        *seed_ranges(check=0, sample=40, claim=500, size=46),
    ],
)
def test_random_launches_are_the_same(seeds: Sequence[int]) -> None:
    found = in_javascript([asked(seed, DURATION) for seed in seeds])
    wrong = {}
    for seed, theirs in zip(seeds, found, strict=True):
        run = in_python(launch_of(seed), DURATION)
        if isinstance(run, str):
            off = [] if theirs.get("refused") == run else [f"{theirs} instead of {run}"]
        else:
            off = compared(theirs, run)
            if off:
                off = compared(theirs, run, in_python(nudged(launch_of(seed)), DURATION))
        if off:
            wrong[seed] = off
    assert not wrong


def test_every_law_on_every_surface_keeps_what_motion_keeps() -> None:
    """Energy is what it began with and the work since; of spheres without torque Jellett's integral
    stays.
    """
    random, size = np.random.default_rng(0), 0.02
    launch = {"tilt": 0.4, "spin": 60.0, "tilt_rate": 1.0, "slip": [0.1, -0.05]}
    shapes: list[Any] = [*surfaces_of(random, size), parts_of(random, size)[1:]]
    spheres = shapes[:2]
    problems = [
        {
            "body": {"mass": 0.02, "shape": shape, "I1": 3e-6, "I3": 3.5e-6},
            "friction": law,
            "launch": launch,
        }
        for law in laws_of(random, size)
        for shape in shapes
    ]
    found = in_javascript([asked(0, 0.05) | {"problem": problem} for problem in problems])
    for problem, run in zip(problems, found, strict=True):
        assert run.get("status", run)["name"] == "completed", problem
        energy, work, jellett = (
            np.array(run["track"][name]) for name in ("energy", "work", "jellett")
        )
        assert np.ptp(energy - work) < 1e-12 * energy[0], problem
        assert work[-1] < -1e-3 * energy[0], problem
        if problem["friction"]["kind"] != "contensou" and problem["body"]["shape"] in spheres:
            assert np.ptp(jellett) < 1e-12 * abs(jellett[0]), problem


def test_slip_that_begins_on_two_contacts_is_the_same() -> None:
    """At first its direction follows friction so fast that rates tell of rounding, and of motion no
    more.
    """
    problem, duration = lying(SLIPS_IN_THE_END), 0.5
    question = asked(0, duration) | {
        "problem": problem.model_dump(mode="json"),
        "tolerance": TOLERANCE,
    }
    (found,) = in_javascript([question])
    run = in_python(problem.model_dump(mode="json"), duration)
    assert str(run["event_kind"].values[-1]) == "slip"
    assert not compared(found, run)


def test_rolling_that_stops_and_starts_on_two_contacts_is_the_same() -> None:
    problem, duration = resisted(64), 0.1
    question = asked(0, duration) | {
        "problem": problem.model_dump(mode="json"),
        "tolerance": TOLERANCE,
    }
    (found,) = in_javascript([question])
    run = in_python(problem.model_dump(mode="json"), duration)
    assert {"rolling starts", "rolling stops"} <= set(run["event_kind"].values.tolist())
    assert run.attrs["status"] == "at_rest"
    assert not compared(found, run)


def test_two_patches_stop_whatever_a_step_may_be_wrong_by() -> None:
    """In the end guards are zero but for the error of a step, or for rounding, and no end of
    anything.
    """
    ends = []
    for tolerance in (1e-12, TOLERANCE):
        (found,) = in_javascript([asked(STOPS_ON_TWO, DURATION) | {"tolerance": tolerance}])
        assert found["status"]["name"] == "completed"
        ends.append([(event["kind"], event["surface"]) for event in found["events"]])
    assert ends[0] == ends[1]
    assert [kind for kind, _ in ends[0][-2:]] == ["stick", "stick"]


def test_bodies_of_several_surfaces_may_end_upright() -> None:
    """Where the precession has no value, which is no number there."""
    changes = {"body": tt.presets.LEINE_GLOCKER_STEM, "launch.tilt": 0.0}
    upright = tt.presets.report_problem().replace(changes)
    [found] = in_javascript([asked(0, 0.1) | {"problem": json.loads(upright.to_json())}])
    run = tt.simulate(upright, 0.1, samples=2)
    assert found["status"]["name"] == run.attrs["status"] == "completed"
    assert np.isnan(run["final_precession"])
    assert found["metrics"]["final_precession"] is None
    assert found["metrics"]["final_spin"] == pytest.approx(upright.launch.spin, rel=1e-9)


def test_numbers_that_are_refused_are_told_the_same() -> None:
    question, sentences = asked(0, DURATION), list[str]()
    numbers = (
        0.0,
        -0.0,
        -2.0,
        -3,
        -0.5,
        -1e-4,
        -1.5e-5,
        -3e-7,
        -1e15,
        -2e16,
        -1.25e22,
        -5e-324,
        -1e300,
    )
    for number in numbers:
        fields = question["problem"] | {"gravity": number}
        with pytest.raises(tt.InvalidInput) as refusal:
            tt.Problem(**fields)
        sentences.append(str(refusal.value))
    questions = [
        question | {"problem": question["problem"] | {"gravity": number}} for number in numbers
    ]
    assert [found["refused"] for found in in_javascript(questions)] == sentences
    told = [sentence.removeprefix("gravity: ").split(" is ")[0] for sentence in sentences]
    assert told[:6] == ["0", "0", "-2", "-3", "-0.5", "-0.0001"]
    assert list(map(float, told)) == list(numbers)


def test_where_no_code_may_be_made_the_numbers_are_the_same() -> None:
    """As under a policy of content security without unsafe-eval: every operation is the same."""
    launches = [asked(CLOSE_CALLS[0], 0.02)]
    plain = list(in_javascript(launches))
    assert all("status" in found for found in plain)
    assert list(in_javascript(launches, "--disallow-code-generation-from-strings")) == plain


def test_durations_and_limits_are_refused_the_same() -> None:
    """What is asked of a run beside the problem; neither may a count of steps be a fraction."""
    problem = tt.presets.report_problem()
    changes: list[dict[str, Any]] = [
        {"duration": 0.0},
        {"duration": "1"},
        {"duration": 2e300},
        {"step_limit": -1},
        {"step_limit": 0.5},
        {"mode_limit": "3"},
        {"tolerance": 1.0},
        {"tolerance": "a"},
    ]
    sentences = list[str]()
    for change in changes:
        with pytest.raises(tt.InvalidInput) as refusal:
            tt.simulate(problem, integrator="dop853", **{"duration": DURATION, **change})
        sentences.append(str(refusal.value))
    question = asked(0, DURATION) | {"problem": json.loads(problem.to_json())}
    assert [
        found.get("refused") for found in in_javascript([question | one for one in changes])
    ] == sentences


def test_the_last_of_so_many_samples_is_at_the_end() -> None:
    """Also where the duration times a number, over that number, is rounded to more than the
    duration.
    """
    duration, count = 0.007, 100
    assert duration * (count - 1) / (count - 1) > duration
    problem = json.dumps(tt.presets.report_problem().model_dump(mode="json"))
    script = f"""
      import {{ simulate }} from {json.dumps((HERE / "index.js").as_uri())};
      const run = simulate({problem}, {{ duration: {duration} }});
      console.log(JSON.stringify(Array.from(run.track({count}).time)));
    """
    times = json.loads(printed(script))
    assert times == pytest.approx(np.linspace(0.0, duration, count), rel=1e-15)
    assert times[-1] == duration


def test_no_more_is_kept_than_so_much() -> None:
    """A page may follow launches of ever other tops, each with tables of its own."""
    script = f"""
      import {{ cached }} from {json.dumps((HERE / "python.js").as_uri())};
      let made = 0;
      const square = cached((number) => (made += 1, number ** 2));
      for (let number = 0; number < 5000; number += 1) square(number);
      console.log(JSON.stringify([square(4999), made, square(0), made]));
    """
    assert json.loads(printed(script)) == [4999**2, 5000, 0, 5001]


def test_a_run_keeps_not_much_more_than_its_numbers() -> None:
    """However short its arcs are: a top that sticks and slips has hundreds of a few steps."""
    problem = tt.presets.report_problem(tilt=1.0, spin=50.0).replace(
        {"friction": tt.CoulombFriction(mu=0.2)}
    )
    script = f"""
      import {{ simulate }} from {json.dumps((HERE / "index.js").as_uri())};
      const {{ segments }} = simulate({problem.to_json()}, {{ duration: 3, tolerance: 1e-8 }});
      const sum = (of) => segments.reduce((total, {{ solution }}) => total + of(solution.terms), 0);
      const kept = sum((terms) => terms.buffer.byteLength), used = sum((terms) => terms.byteLength);
      console.log(JSON.stringify([segments.length, kept, used]));
    """
    arcs, kept, used = json.loads(printed(script))
    assert arcs > 50
    assert kept <= 2 * used


def test_slip_that_has_all_but_ended_where_it_jams_sticks_in_the_page() -> None:
    problem = tt.Problem(
        body=tt.Body(
            mass=0.02,
            shape=tt.EccentricSphere(radius=0.013461353875469938, eccentricity=0.11510802842372737),
            I1=1.0932492640476375e-07,
            I3=1.266445725988121e-07,
        ),
        friction=tt.CoulombFriction(mu=0.5355226843422539),
        launch=tt.Launch(
            tilt=2.2788167293165924,
            spin=-9.692539375774324,
            tilt_rate=4.101303263481906,
            slip=(-0.3166715094802961, 0.04264067899626711),
        ),
        contact=tt.Contact(liftoff="fly", restitution=0.0),
        rolling_resistance=9.09935279481451e-05,
    )
    asked = {
        "problem": problem.model_dump(mode="json"),
        "duration": 0.05,
        "tolerance": 1e-8,
        "times": [0.05],
    }
    (found,) = in_javascript([asked | {"mode_limit": 300}])
    assert found["status"]["name"] == "completed"


def test_the_least_force_is_that_before_it_jumps_where_the_curvature_changes() -> None:
    # The body rolls from its edge onto its ball: the force jumps, within a step of the page.
    height, radius = -3.0, math.sqrt(20.0**2 - 3.0**2)
    profile = [(0, -20), (radius, height, 20), (radius - 2, height + 2, 2), (0, height + 7)]
    body = tt.Body.turned(tt.Workpiece(profile=profile, unit="mm", density=700))
    assert body.shapes[0].kind == "meridian"
    launch = tt.Launch(tilt=1.510903011163761, spin=16.5752934464801)
    problem = tt.Problem(body=body, friction=tt.CoulombFriction(mu=0.2), launch=launch)
    question = {
        "problem": problem.model_dump(mode="json"),
        "duration": 0.3,
        "pushes": [],
        "tolerance": TOLERANCE,
        "times": [0.0],
    }
    (found,) = in_javascript([question])
    expected = float(tt.simulate(problem, 0.3)["min_normal_force"])
    assert found["metrics"]["min_normal_force"] == pytest.approx(expected, rel=1e-6)
