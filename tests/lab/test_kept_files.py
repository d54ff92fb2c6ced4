"""Launches that are kept as TOML are read by Python as they were shown."""

import math

import pytest

import tippetop as tt
from bundled import found_in_the_page

KEPT = """
import { PRESETS } from "./presets.js";
import { toml } from "./toml.js";
import { bodyOf, FIRST, MATERIALS, possible } from "./turning.js";

const own = Array.from({ length: 10 }, (_, k) => {
  const share = (n) => ((k + 1) * n) % 1;
  const top = possible({
    ...FIRST,
    radius: 0.008 + 0.03 * share(0.618),
    face: 0.2 + 0.7 * share(0.414),
    hollow: 0.95 * share(0.732),
    stem: 0.02 + 0.05 * share(0.236),
    knob: 0.0015 + 0.01 * share(0.449),
    material: Object.keys(MATERIALS)[k % 4],
  });
  return { ...PRESETS[0].setup.problem, body: bodyOf(top) };
});
const problems = [...PRESETS.map(({ setup }) => setup.problem), ...own];
export const found = problems.map((problem) => ({ problem, text: toml(problem) }));
"""


def test_every_kept_launch_is_read_as_it_was(tmp_path):
    kept = found_in_the_page(KEPT)
    assert len(kept) >= 20
    path = tmp_path / "tippetop.toml"
    profiles = 0
    for one in kept:
        path.write_text(one["text"])
        problem = tt.Problem.read(path)
        assert problem == tt.Problem(**one["problem"])
        profiles += problem.body.profile is not None
    assert profiles >= 11


def test_own_tops_are_as_uniform_as_their_solid():
    for one in found_in_the_page(KEPT)[-10:]:
        body = tt.Body(**one["problem"]["body"])
        piece = tt.Workpiece(profile=body.profile, density=1.0)
        mass, center, across, along = piece.mass_properties
        density = body.mass / mass
        assert abs(center) < 1e-8
        assert [density * across, density * along] == pytest.approx([body.I1, body.I3], rel=1e-5)
        assert math.isfinite(density)
