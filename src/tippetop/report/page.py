"""The page: every figure and every claim in one file that opens without a network."""

import base64
from collections import Counter
from collections.abc import Mapping, Sequence, Set
from importlib.metadata import version

import jinja2

from tippetop.integrators import default_name
from tippetop.report.claim import RULE, Judgement, Value, Verdict
from tippetop.report.gallery import PLATES, Plate
from tippetop.report.typeset import typeset
from tippetop.report.unchecked import UNCHECKED

_TEMPLATE = "page.html.j2"

_PARTS = (
    ("1", "Introduction"),
    ("2", "The model"),
    ("3", "Results"),
    ("4", "Discussion: flight"),
    ("5", "Critique and summary"),
    ("A", "Appendices"),
    ("F", "Friction"),
)
"""The report's sections by the beginning of their numbers, for the order of the claims."""

_WRONG = (Verdict.CORRECTED, Verdict.EXPLAINED)
"""Verdicts on what is not true."""


def render(
    plates: Sequence[Plate],
    judgements: Sequence[Judgement],
    pictures: Mapping[str, bytes],
    *,
    quick: bool,
    partial: str | None = None,
) -> str:
    """The page as HTML.

    Parameters
    ----------
    plates
        The figures on it.
    judgements
        The claims on it.
    pictures
        The figures' SVG by name; they become part of the page.
    quick
        Whether to say that the computations were coarse.
    partial
        What was asked for, when it was not everything.
    """
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("tippetop.report", "."),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters["typeset"] = typeset
    shown = {plate.id for plate in plates}
    claims = [worded(judgement, shown) for judgement in judgements]
    counts = Counter(claim["verdict"] for claim in claims)
    wrong = [verdict.name.lower() for verdict in _WRONG]
    return environment.get_template(_TEMPLATE).render(
        sections=[
            {
                "title": section,
                "figures": [_shown(plate, pictures, claims) for plate in plates if plate.section == section],
            }
            for section in dict.fromkeys(plate.section for plate in plates)
        ],
        claims=claims,
        errors=[claim for name in wrong for claim in claims if claim["verdict"] == name],
        sound=[claim for claim in claims if claim["verdict"] not in wrong],
        parts=[part for part in (_part(*named, claims) for named in _PARTS) if part["claims"]],
        unchecked=UNCHECKED,
        verdicts=[
            {"name": verdict.name.lower(), "count": counts[verdict.name.lower()], "meaning": verdict.value}
            for verdict in Verdict
        ],
        rule=RULE,
        quick=quick,
        partial=partial,
        version=version("tippetop"),
        integrator=default_name(),
    )


def _shown(
    plate: Plate, pictures: Mapping[str, bytes], claims: Sequence[dict[str, str | None]]
) -> dict[str, object]:
    """A figure for the page."""
    return {
        "id": plate.id,
        "title": plate.title,
        "caption": plate.caption,
        "image": _embedded(pictures[plate.id]),
        "has_data": bool(plate.needs),
        "experiments": ", ".join(plate.needs),
        "claims": [claim for claim in claims if claim["figure"] == plate.id],
    }


def _part(number: str, title: str, claims: Sequence[dict[str, str | None]]) -> dict[str, object]:
    """A section of the report with its claims."""
    inside = [claim for claim in claims if (claim["section"] or "")[0] == number]
    return {"id": f"section-{number}", "number": number, "title": title, "claims": inside}


def worded(judgement: Judgement, shown: Set[str] = frozenset()) -> dict[str, str | None]:
    """A claim in words, for people; `shown` are the figures that it may refer to."""
    claim, finding, tolerance = judgement.claim, judgement.finding, judgement.tolerance
    unit = "" if claim.units == "1" else f" {claim.units}"
    reported = claim.number.replace("pi", "π") or _number(judgement.reported)
    figure = claim.figure
    return {
        "id": claim.id,
        "short": _without_measure(claim.text),
        "place": claim.source.place,
        "section": claim.source.section,
        "experiments": ", ".join(claim.needs),
        "right": claim.right or (_number(finding.converged) + unit),
        "text": claim.text + (" (implied)" if claim.implied else ""),
        "reported": reported + unit,
        "listing": "–" if finding.listing is None else _number(finding.listing) + unit,
        "chosen": None if finding.chosen is None else _number(finding.chosen) + unit,
        "choice": finding.choice,
        "converged": _number(finding.converged) + unit,
        "tolerance": f"± {tolerance.value:g}{unit}" if tolerance else None,
        "tolerance_from": tolerance.reason if claim.tolerance and tolerance else "",
        "verdict": judgement.verdict.name.lower(),
        "note": finding.note,
        "figure": figure if figure in shown else None,
        "figure_title": PLATES[figure].title.partition(":")[0] if figure in shown and figure else None,
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
    """A value for people."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if value == 0:
        return "0"
    return f"{value:.2e}" if abs(value) < 1e-3 else f"{value:.5g}"


def _embedded(svg: bytes) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(svg).decode("ascii")
