"""What the engine says of a refused value is said in other languages as a whole, or not at all."""

import ast
import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from bundled import found_in_the_page
from tippetop.page_engine import HERE
from tippetop.page_engine.generate import sources

TEXTS = Path(__file__).parents[2] / "web" / "texts"

NOT_ON_THE_PAGE = (
    "tippetop.support.files",
    "tippetop.support.parsing",
    "tippetop.support.errors",
    "tippetop.support.validation",
    "tippetop.integrators.base",
)
"""Modules whose refusals are of files, of Python's arguments, or read from their parts."""

CODE = {"{}", "{} {}", "{}, which {} {}", " numbers"}
"""Texts that are made of other texts alone."""

NUMBER = r"(?<![A-Za-z_])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?|\bpi\b"


def templates(node: ast.expr | None, constants: dict[str, ast.expr]) -> Iterator[str]:
    """Yield the texts that an argument may be, with {} where something is filled in."""
    match node:
        case ast.Constant(value=str(text)):
            yield text
        case ast.JoinedStr(values=values):
            yield "".join(
                str(part.value) if isinstance(part, ast.Constant) else "{}" for part in values
            )
        case ast.IfExp(body=one, orelse=other):
            yield from templates(one, constants)
            yield from templates(other, constants)
        case ast.Name(id=name) if name in constants:
            yield from templates(constants[name], constants)


def texts_of_refusals() -> set[str]:
    """Return the texts of `InvalidInput` and `Described` in the modules that are translated."""
    found: set[str] = set()
    for module, source in sources()[0].items():
        if module in NOT_ON_THE_PAGE:
            continue
        tree = ast.parse(source)
        constants = {
            node.targets[0].id: node.value
            for node in ast.walk(tree)
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
        }
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Name):
                continue
            arguments: list[ast.expr] = []
            if node.func.id == "InvalidInput":
                named = [
                    one.value for one in node.keywords if one.arg in ("accepted", "fault", "hint")
                ]
                arguments = [*node.args[2:5], *named]
            elif node.func.id == "Described":
                arguments = node.args[:1]
            for argument in arguments:
                found |= set(templates(argument, constants))
    return found - {""}


def accepted_values() -> set[str]:
    """Return the texts of what the fields accept, with {} for their numbers."""
    text = (HERE / "tables.js").read_text(encoding="utf-8")
    listed = re.search(r"export const SCHEMA = (\{.*?\n\});", text, re.DOTALL)
    assert listed
    fields = [one for part in json.loads(listed[1]).values() for one in part["fields"].values()]
    return {re.sub(NUMBER, "{}", one["accepted"]) for one in fields if one.get("accepted")}


@pytest.mark.parametrize("language", ["de"])
def test_every_text_of_a_refusal_is_translated(language: str) -> None:
    catalogue = json.loads((TEXTS / f"{language}.json").read_text(encoding="utf-8"))["refusals"]
    asked = (texts_of_refusals() | accepted_values()) - CODE
    assert len(asked) > 80
    assert sorted(asked - set(catalogue)) == []
    for template, text in catalogue.items():
        assert text.count("{}") <= template.count("{}"), template


SAID = """
import { speak, translated } from "./i18n.js";
import { refusal } from "./refusal.js";
import { FIRST } from "./setup.js";
import { FIRST as UNITS } from "./units.js";
import { InvalidInput, simulate } from "engine";
speak("de");
const launches = [
  { launch: { ...FIRST.problem.launch, tilt: 9 } },
  { launch: { ...FIRST.problem.launch, spin: "abc" } },
  { launch: { ...FIRST.problem.launch, spin: "20 Hz" } },
  { launch: { ...FIRST.problem.launch, spinn: 3 } },
  { body: { ...FIRST.problem.body, I3: 1 } },
  { body: { ...FIRST.problem.body, mass: -1 } },
  { friction: { kind: "sticky", mu: 1 } },
  { friction: { kind: "contensou", mu: 1, patch_radius: 1, pressure: "hertz" } },
  { rolling_resistance: 1 },
  { gravity: "much" },
];
const sentences = launches.map((change) => {
  try {
    simulate({ ...FIRST.problem, ...change }, { duration: 1 });
  } catch (error) {
    if (!(error instanceof InvalidInput)) throw error;
    return refusal(error, { units: UNITS, setup: FIRST }).sentence;
  }
  return "";
});
export const found = {
  sentences,
  half: translated("a number at least 3 that nobody has translated yet and so on"),
  whole: translated("a number at least 0.5 and at most 2.5"),
};
"""

ENGLISH = r"\b(?:is|not|the|and|write|at|most|least|number|one of|has|greater|with)\b"


def test_no_refusal_is_half_in_english() -> None:
    found = found_in_the_page(SAID)
    for sentence in found["sentences"]:
        assert sentence
        assert not re.search(ENGLISH, re.sub(r"„.*?“", "", sentence)), sentence
    assert found["half"] is None, "rather nothing than a half"
    assert found["whole"] == "eine Zahl ab 0,5 und höchstens 2,5"
