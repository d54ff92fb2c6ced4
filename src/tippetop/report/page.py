"""Page of the report redone: findings, figures and claims in one file that opens without a network.

The page opens with the story in five figures. Everything else is in sections that unfold.
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
from tippetop.report import printed_numbers
from tippetop.report.claim import RULE, Judgement, Value, Verdict, count_verdicts, in_words
from tippetop.report.gallery import PLATES, Plate
from tippetop.report.outline import (
    ADDED_SECTIONS,
    REPORT_TITLE,
    SECTIONS,
    STORY,
    UNCHECKED,
    section_of,
)
from tippetop.report.selection import Selection
from tippetop.report.typeset import formula, typeset

_THUMBNAIL = (640, 420)
"""Largest size of the opening pictures, pixels."""

_ROUNDED = 1e-12
"""Absolute value below which a value is shown as 0.

Zeros are computed with rounding errors below it, and the smallest value with a meaning, a
difference of two computations, is about 1e-9.
"""

_VERDICTS = [verdict.name.lower() for verdict in Verdict]

Worded = dict[str, Any]
"""Texts and fields of a claim as the page shows them."""


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

    Parameters
    ----------
    plates, judgements
        Figures and judged claims to be shown.
    figures
        Folder with an SVG and a PNG of each figure, by name; they become part of the page.
    player
        A run and its player, packed by `tippetop.report.playable`; None for a page without.
    quick
        Whether the computations were coarse; the page then says so.
    partial
        Name of the one figure or claim that was selected, or None.
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
    errors = [verdict.name.lower() for verdict in (Verdict.CORRECTED, Verdict.EXPLAINED)]
    of_report = [claim for claim in claims if claim["is_of_report"]]
    counts = count_verdicts(one for one in judgements if one.claim.is_of_report)
    counts_of_others = count_verdicts(one for one in judgements if not one.claim.is_of_report)
    shown_counts = count_verdicts(judgements)
    parts: dict[str, Any] = {
        "errors": [claim for name in errors for claim in of_report if claim["verdict"] == name],
        "sound": [claim for claim in of_report if claim["verdict"] not in errors],
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
        statements=len(of_report),
        of_others=in_words(counts_of_others) if sum(counts_of_others.values()) else "",
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
    """Return the table of contents: names of the page's parts for links, and their titles."""
    return [
        ("summary", "What was found"),
        *((name, title) for name, title in _OPENING.items() if parts[name]),
        *((section["id"], section["title"]) for section in parts["sections"]),
        *((name, title) for name, title in _CLOSING.items() if parts[name]),
    ]


def _is_new(plate: Plate) -> bool:
    """Return whether a figure shows a result that the report does not have."""
    return plate.section in ADDED_SECTIONS or (
        bool(plate.finding) and not plate.id.startswith("fig")
    )


def _sections(
    plates: Sequence[Plate], claims: Sequence[Worded], figures: Path
) -> list[dict[str, Any]]:
    """Return the sections of the page that have content, each with its figures and claims.

    A claim stands beside its figure if both are in the same section, otherwise after all figures.
    """
    sections = []
    for key, (title, words) in SECTIONS.items():
        inside = [claim for claim in claims if claim["section"] == key]
        drawn = [plate for plate in plates if section_of(plate.section) == key]
        names = {plate.id for plate in drawn}
        without_figure = [claim for claim in inside if claim["figure"] not in names]
        if drawn or without_figure:
            shown = [_shown(plate, figures, claims, key) for plate in drawn]
            counts = Counter(claim["verdict"] for claim in inside)
            named = {
                "id": "section-" + key.replace(" ", "-").lower(),
                "title": title,
                "words": words,
                "verdicts": [(name, counts[name]) for name in _VERDICTS if counts[name]],
            }
            sections.append({**named, "figures": shown, "claims": without_figure})
    return sections


def _shown(plate: Plate, figures: Path, claims: Sequence[Worded], section: str) -> dict[str, Any]:
    """Return the fields of a figure on the page, with its claims in this and in other sections."""
    svg = (figures / f"{plate.id}.svg").read_bytes()
    of_figure = [claim for claim in claims if claim["figure"] == plate.id]
    return {
        "id": plate.id,
        "title": plate.title,
        "caption": plate.caption,
        "image": _embedded(svg, "svg+xml"),
        "needs": plate.needs,
        "claims": [claim for claim in of_figure if claim["section"] == section],
        "elsewhere": [claim for claim in of_figure if claim["section"] != section],
    }


def _story(claims: Sequence[Worded], shown: Set[str], figures: Path) -> list[dict[str, str]]:
    """Return the parts of the story whose figures are shown, each with its picture."""
    fields = {
        "claims": {claim["id"]: claim for claim in claims},
        "printed_numbers": printed_numbers,
    }
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
    """Return a small picture of a figure as a data URL."""
    with Image.open(figures / f"{name}.png") as full_size:
        small = full_size.convert("RGB")
    small.thumbnail(_THUMBNAIL, Image.Resampling.LANCZOS)
    file = io.BytesIO()
    small.save(file, "webp", quality=82)
    return _embedded(file.getvalue(), "webp")


def _experiments(chosen: Selection) -> list[dict[str, Any]]:
    """Return the experiments in the order of the page, each with the figures and claims that need
    it.
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
    """Return the texts and fields of a claim as the page shows them.

    `shown` are the figures on the page, to which the claim can refer.
    """
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
    """Return the text of a claim without its last parenthesis, which states how it is measured."""
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
    """Return a value as text for people."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if abs(value) < _ROUNDED:
        return "0"
    return f"{value:.2e}" if abs(value) < 1e-3 else f"{value:.4g}"


def _embedded(content: bytes, kind: str) -> str:
    """Return an image as a data URL."""
    return f"data:image/{kind};base64," + base64.b64encode(content).decode("ascii")
