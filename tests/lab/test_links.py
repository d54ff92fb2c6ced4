"""Every state of the page is in its link: what is reopened is what was shown."""

import json
import re
from pathlib import Path

import tippetop as tt
from bundled import found_in_the_page

REOPENED = """
import { readLink, writeLink } from "./link.js";
import { PRESETS } from "./presets.js";
import { sortedPushes } from "./pushes.js";
import { changed, withPushes } from "./setup.js";
import { bodyOf, FIRST } from "./turning.js";
import { SPEEDS } from "../player/speeds.js";

let seed = 50;
const random = () => {
  seed = (seed * 48271) % 2147483647;
  return seed / 2147483647;
};
const one = (choices) => choices[Math.floor(random() * choices.length)];
const some = (choices) => choices.filter(() => random() < 0.5);
const number = (low, high) => Number((low + random() * (high - low)).toPrecision(6));

const CHANGES = [
  () => ({ "launch.spin": number(-200, 250) }),
  () => ({ "launch.tilt": number(0, 3.1), "launch.precession": number(-9, 9) }),
  () => ({ "launch.tilt_rate": number(-9, 9), "launch.gap": number(0, 1e-4) }),
  () => ({ "launch.velocity": [number(-1, 1), number(-1, 1), 0] }),
  () => ({ "friction.mu": number(0.01, 3) }),
  () => ({ "friction.kind": one(
    ["viscous", "coulomb", "static_coulomb", "contensou", "regularized_coulomb"]) }),
  () => ({ "air.axial_linear": number(0, 2e-6), "air.transverse_linear": number(0, 2e-6) }),
  () => ({ "contact.liftoff": one(["fly", "stop", "ignore"]) }),
  () => ({ "contact.restitution": number(0, 1) }),
  () => ({ gravity: number(1, 20), rolling_resistance: number(0, 1e-4) }),
  () => ({ duration: number(1, 60) }),
  () => ({ body: bodyOf({ ...FIRST, hollow: number(0.2, 0.8), stem: number(0.025, 0.05) }) }),
];
const push = () => ({
  time: number(0.1, 9),
  impulse: number(0, 0.01),
  direction: number(-3, 3),
  mu: one([null, number(0, 1)]),
  slope: one([null, number(0, 0.3)]),
});
const launch = () => withPushes(
  some(CHANGES).reduce((setup, change) => changed(setup, change()), one(PRESETS).setup),
  random() < 0.7 ? [] : sortedPushes([push(), push()].slice(0, one([1, 2]))));

const state = () => ({
  setup: random() < 0.3 ? PRESETS[0].setup : launch(),
  pins: random() < 0.7 ? [] : [launch(), launch()].slice(0, one([1, 2])),
  units: { spin: one(["rad/s", "turns/s", "rpm"]), angle: one(["rad", "deg"]) },
  view: {
    time: random() < 0.5 ? 0 : Math.round(1e5 * random()) / 1e4,
    camera: random() < 0.7 ? null : [number(0.3, 1), number(0.3, 1), number(2, 5)].map(
      (v) => Number(v.toFixed(3))),
    speed: random() < 0.5 ? null : one(SPEEDS),
    shown: random() < 0.5 ? null : some(
      ["axis", "momentum", "slip", "friction", "torque", "trace", "glass"]),
  },
  tab: one(["story", "story", "launch", "own", "compare", "map", "keep"]),
  step: one([0, 0, 1, 4, 9]),
  plots: random() < 0.5 ? null : some(["tilt", "spin", "slip", "energy"]),
  own: random() < 0.6 ? null : { ...FIRST, hollow: number(0.2, 0.8), material: "cork" },
  classroom: random() < 0.6 ? null : {
    groups: one([2, 8, 30]), low: 20, high: number(100, 200), results: "155 179.9\\n50 86,1" },
  free: random() < 0.6 ? null : [one(["time", "tilt", "slip"]), one(["spin", "energy"])],
  lang: one([null, "en", "de"]),
  theme: one(["auto", "light", "dark"]),
});

const sorted = (value) => {
  if (value === null || typeof value !== "object") return value;
  if (Array.isArray(value)) return value.map(sorted);
  return Object.fromEntries(Object.keys(value).sort().map((key) => [key, sorted(value[key])]));
};
export const found = Array.from({ length: 200 }, () => {
  const asked = state();
  const { timed, flaw, unread, ...reopened } = readLink(writeLink(asked));
  return [JSON.stringify(sorted(asked)), JSON.stringify(sorted(reopened)), writeLink(asked)];
});
"""


def test_two_hundred_states_are_reopened_as_they_were() -> None:
    found = found_in_the_page(REOPENED)
    assert len(found) == 200
    assert len({asked for asked, _, _ in found}) == 200
    for asked, reopened, link in found:
        assert reopened == asked, link


READ = """
import { readLink } from "./link.js";
export const found = %s.map((link) => {
  const { unread, flaw } = readLink(link);
  return flaw ? [...unread, flaw.field] : unread;
});
"""


def test_links_of_the_documentation_are_read_whole() -> None:
    docs = Path(__file__).parents[2] / "docs"
    texts = [page.read_text("utf-8") for page in docs.rglob("*.md")]
    links = [link for text in texts for link in re.findall(r"^:link: (.+)$", text, re.M)]
    assert len(links) > 6
    found = found_in_the_page(READ % json.dumps(links))
    assert [link for link, unread in zip(links, found, strict=True) if unread] == []


DIALS = """
import { ALL } from "./dials.js";
import { part } from "./i18n.js";
import { changed, FIRST, fieldValue } from "./setup.js";
const laws = ["viscous", "coulomb", "static_coulomb", "contensou", "regularized_coulomb"].map(
  (kind) => changed(FIRST, { "friction.kind": kind }));
const named = ALL.filter(({ field }) => {
  const { name, symbol, help } = part(`quantities.${field}`);
  return name && symbol && help && laws.some((setup) => fieldValue(setup, field) !== undefined);
});
export const found = [
  ALL.map(({ field }) => field),
  named.map(({ field }) => field),
  laws.map(({ problem }) => problem.friction),
];
"""


def test_every_law_and_the_air_have_dials_with_names() -> None:
    every, named, laws = found_in_the_page(DIALS)
    assert {"friction.static_mu", "air.axial_linear", "air.transverse_linear"} <= set(every)
    assert named == every
    for friction in laws:
        assert tt.presets.report_problem().replace({"friction": friction}).friction.law
