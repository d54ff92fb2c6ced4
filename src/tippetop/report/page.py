"""The page: what was found, every figure and every claim, in one file that opens without a network.

It opens with the story, in five figures; all else is folded, a part each.
"""

import base64
import io
from collections import Counter
from collections.abc import Mapping, Sequence, Set
from importlib.metadata import version
from pathlib import Path
from typing import Any

import jinja2
from PIL import Image

from tippetop.integrators import DEFAULT
from tippetop.report import quoted
from tippetop.report.claim import RULE, Judgement, Value, Verdict, count_verdicts, in_words
from tippetop.report.gallery import PLATES, Plate
from tippetop.report.outline import OWN, REPORT_TITLE, SECTIONS, STORY, UNCHECKED, section_of
from tippetop.report.selection import Selection
from tippetop.report.typeset import formula, typeset

_THUMBNAIL = (640, 420)
"""Largest size of the pictures that the page opens with, pixels."""

_ROUNDED = 1e-12
"""Values below this are shown as 0: they are what rounding leaves of zero. The least value that
means anything, a difference of two computations, is about 1e-9.
"""

_VERDICTS = [verdict.name.lower() for verdict in Verdict]

Worded = dict[str, Any]
"""A claim in words."""


def render(
    plates: Sequence[Plate],
    judgements: Sequence[Judgement],
    figures: Path,
    *,
    player: Mapping[str, str] | None = None,
    quick: bool,
    partial: str | None = None,
) -> str:
    """Return the page of some figures and claims as HTML.

    The folder `figures` has SVG and PNG of these by name, which become part of the page. The
    `player` is a run and what plays it, as `tippetop.report.playable` packs them; None for a page
    without. `quick` has it say that the computations were coarse, `partial` what was asked for,
    when it was not everything.
    """
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("tippetop.report", "."),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters |= {"typeset": typeset, "formula": formula}
    shown = {plate.id for plate in plates}
    claims = [worded(judgement, shown) for judgement in judgements]
    wrong = [verdict.name.lower() for verdict in (Verdict.CORRECTED, Verdict.EXPLAINED)]
    theirs = [claim for claim in claims if claim["is_of_report"]]
    counts = count_verdicts(one for one in judgements if one.claim.is_of_report)
    others = count_verdicts(one for one in judgements if not one.claim.is_of_report)
    shown_counts = count_verdicts(judgements)
    parts: dict[str, Any] = {
        "errors": [claim for name in wrong for claim in theirs if claim["verdict"] == name],
        "sound": [claim for claim in theirs if claim["verdict"] not in wrong],
        "unknown": [] if partial else [plate for plate in plates if _is_new(plate)],
        "news": [claim for claim in claims if claim["news"]],
        "player": player,
        "sections": _sections(plates, claims, figures),
        "experiments_done": _experiments(
            Selection(tuple(plates), tuple(one.claim for one in judgements))
        ),
        "unchecked": [] if partial else UNCHECKED,
    }
    return environment.get_template("page.html.j2").render(
        **parts,
        contents=_contents(parts),
        claims=claims,
        report_title=REPORT_TITLE,
        statements=len(theirs),
        of_others=in_words(others) if sum(others.values()) else "",
        story=[] if partial else _story(claims, shown, figures),
        verdicts=[
            {
                "name": name,
                "count": counts[name],
                "shown": shown_counts[name],
                "meaning": verdict.value,
            }
            for verdict in Verdict
            for name in (verdict.name.lower(),)
        ],
        rule=RULE,
        quick=quick,
        partial=partial,
        version=version("tippetop"),
        integrator=DEFAULT,
    )


_OPENING = {
    "errors": "What the report has wrong",
    "sound": "What it has right",
    "unknown": "What it could not know",
    "player": "A run to play",
}
_CLOSING = {"experiments_done": "The experiments behind it", "unchecked": "What is not judged"}


def _contents(parts: Mapping[str, Any]) -> list[tuple[str, str]]:
    """What there is on the page, in its order: the names to link at, and the titles."""
    return [
        ("summary", "What was found"),
        *((name, title) for name, title in _OPENING.items() if parts[name]),
        *((section["id"], section["title"]) for section in parts["sections"]),
        *((name, title) for name, title in _CLOSING.items() if parts[name]),
    ]


def _is_new(plate: Plate) -> bool:
    """Return whether a figure shows what the report could not know."""
    return plate.section in OWN or (bool(plate.finding) and not plate.id.startswith("fig"))


def _sections(
    plates: Sequence[Plate], claims: Sequence[Worded], figures: Path
) -> list[dict[str, Any]]:
    """Return the report's sections and ours that there is something in, each with its figures and
    claims.

    A claim stands beside its figure if that is in the same section, else after all figures.
    """
    found = []
    for key, (title, words) in SECTIONS.items():
        inside = [claim for claim in claims if claim["section"] == key]
        drawn = [plate for plate in plates if section_of(plate.section) == key]
        names = {plate.id for plate in drawn}
        rest = [claim for claim in inside if claim["figure"] not in names]
        if drawn or rest:
            shown = [_shown(plate, figures, claims, key) for plate in drawn]
            counts = Counter(claim["verdict"] for claim in inside)
            named = {
                "id": "section-" + key.replace(" ", "-").lower(),
                "title": title,
                "words": words,
                "verdicts": [(name, counts[name]) for name in _VERDICTS if counts[name]],
            }
            found.append({**named, "figures": shown, "claims": rest})
    return found


def _shown(plate: Plate, figures: Path, claims: Sequence[Worded], section: str) -> dict[str, Any]:
    """Return a figure for the page, with the claims beside it and those elsewhere that it shows,
    too.
    """
    svg = (figures / f"{plate.id}.svg").read_bytes()
    own = [claim for claim in claims if claim["figure"] == plate.id]
    return {
        "id": plate.id,
        "title": plate.title,
        "caption": plate.caption,
        "image": _embedded(svg, "svg+xml"),
        "needs": plate.needs,
        "claims": [claim for claim in own if claim["section"] == section],
        "elsewhere": [claim for claim in own if claim["section"] != section],
    }


def _story(claims: Sequence[Worded], shown: Set[str], figures: Path) -> list[dict[str, str]]:
    """Return the parts of the story whose figures are shown, each with its picture."""
    fields = {"claims": {claim["id"]: claim for claim in claims}, "quoted": quoted}
    return [
        {
            "id": part["figure"],
            "title": part["title"],
            "text": part["text"].format(**fields),
            "image": _thumbnail(part["figure"], figures),
            "alternative": PLATES[part["figure"]].title,
        }
        for part in STORY
        if part["figure"] in shown
    ]


def _thumbnail(name: str, figures: Path) -> str:
    """Return the picture of a figure, small, as the address of an image."""
    with Image.open(figures / f"{name}.png") as whole:
        small = whole.convert("RGB")
    small.thumbnail(_THUMBNAIL, Image.Resampling.LANCZOS)
    file = io.BytesIO()
    small.save(file, "webp", quality=82)
    return _embedded(file.getvalue(), "webp")


def _experiments(chosen: Selection) -> list[dict[str, Any]]:
    """Return the experiments, as the page comes to them, with the figures drawn from each and the
    claims decided.
    """
    return [
        {
            "id": one.id,
            "title": one.title,
            "figures": [plate.id for plate in chosen.plates if one.id in plate.needs],
            "claims": [claim.id for claim in chosen.claims if one.id in claim.needs],
        }
        for one in chosen.experiments
    ]


def worded(judgement: Judgement, shown: Set[str] = frozenset()) -> Worded:
    """Return a claim in words, for people; `shown` are the figures that it may refer to."""
    claim, finding, tolerance = judgement.claim, judgement.finding, judgement.tolerance
    unit = "" if claim.units == "1" else f" {claim.units}"
    reported = claim.number.replace("pi", "π") or _number(judgement.reported)
    figure = claim.figure
    return {
        "id": claim.id,
        "short": _without_measure(claim.text),
        "implied": claim.implied,
        "quote": claim.quote,
        "is_code": claim.id.startswith("listing"),
        "formula": {"printed": claim.formula, "right": claim.formula_right}
        if claim.formula
        else None,
        "place": claim.source.place,
        "section": section_of(claim.source.section),
        "is_of_report": claim.is_of_report,
        "needs": claim.needs,
        "right": finding.right or claim.right or (_number(finding.converged) + unit),
        "text": claim.text + (" (implied)" if claim.implied else ""),
        "reported": reported + unit,
        "listing": "–" if finding.listing is None else _number(finding.listing) + unit,
        "chosen": None if finding.chosen is None else _number(finding.chosen) + unit,
        "choice": finding.choice,
        "converged": _number(finding.converged) + unit,
        "value": finding.converged,
        "tolerance": tolerance
        and f"a difference of at most {tolerance.value:g}{unit}: {tolerance.reason}",
        "verdict": judgement.verdict.name.lower(),
        "note": finding.note,
        "news": finding.news,
        "figure": figure if figure in shown else None,
        "figure_title": PLATES[figure].title.partition(":")[0]
        if figure in shown and figure
        else None,
    }


def _without_measure(text: str) -> str:
    """What is claimed, without the last parenthesis, which says what the value is."""
    if not text.endswith(")."):
        return text
    depth, start = 0, len(text) - 1
    while start > 0:
        start -= 1
        depth += {")": 1, "(": -1}.get(text[start], 0)
        if depth == 0:
            break
    return text[:start].rstrip() + "."


def _number(value: Value) -> str:
    """Return a value for people."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if abs(value) < _ROUNDED:
        return "0"
    return f"{value:.2e}" if abs(value) < 1e-3 else f"{value:.4g}"


def _embedded(content: bytes, kind: str) -> str:
    return f"data:image/{kind};base64," + base64.b64encode(content).decode("ascii")
