"""The arrows of slip, friction and its torque are what changes the angular momentum."""

from collections.abc import Callable

import numpy as np

from browsing import Visit
from bundled import found_in_the_page

CODE = """
import { simulate } from "engine";
import { PRESETS } from "engine-tables";
import { pack } from "../run/pack.js";
const problem = PRESETS.problems.report;
const run = simulate(problem, { duration: 5.5 });
const { time, columns } = pack(problem, run, 40001);
const of = (name, width) =>
  Array.from({ length: 3 }, (_, k) => 39000 + k).map((i) =>
    Array.from(columns[name].subarray(i * width, (i + 1) * width)));
export const found = {
  time: Array.from(time.subarray(39000, 39003)),
  momentum: of("momentum", 3),
  slip: of("slipping", 2),
  friction: of("friction", 2),
  torque: of("torque", 3),
  point: of("point", 2),
  position: of("position", 3),
  normal: of("normal_force", 1),
  mu: problem.friction.mu,
};
"""


def test_friction_opposes_slip_and_its_torque_turns_the_angular_momentum() -> None:
    found = found_in_the_page(CODE)
    number = {name: np.array(values) for name, values in found.items()}
    slip, friction, normal = number["slip"][1], number["friction"][1], number["normal"][1, 0]
    np.testing.assert_allclose(friction, -found["mu"] * normal * slip, rtol=1e-5)
    assert np.hypot(*slip) > 0.1
    arm = number["point"][1] - number["position"][1, :2]
    of_weight = np.array([arm[1] * normal, -arm[0] * normal, 0.0])
    before, now, after = number["time"]
    assert now - before > 0.0
    rate = (number["momentum"][2] - number["momentum"][0]) / (after - before)
    size = np.linalg.norm(number["torque"][1])
    np.testing.assert_allclose(rate, number["torque"][1] + of_weight, atol=0.01 * size)
    assert np.linalg.norm(of_weight) > 0.1 * size


def test_an_answer_shows_what_it_speaks_of(lab: Callable[..., Visit]) -> None:
    visitor = lab("step=0")
    visitor.page.get_by_role("button", name="Just show me").click()
    visitor.page.get_by_role("button", name="Tell me now").click()
    visitor.page.get_by_role("button", name="Watch it turn over with arrows").click()
    shown = visitor.ask("() => Object.entries(tippetopLab.player.scene.shown)")
    assert {name for name, on in shown if on} >= {"slip", "friction", "torque"}
    visitor.wait("() => tippetopLab.player.playing && tippetopLab.player.time > 5")
    arrows = visitor.ask(
        "() => Object.entries(tippetopLab.player.scene.arrows)"
        ".filter(([, arrow]) => arrow.visible).map(([name]) => name)"
    )
    assert {"slip", "friction", "torque"} <= set(arrows)
