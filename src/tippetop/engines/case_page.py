"""A page for people about a case of the suite: figure, equations, parameters and results."""

import html
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import tippetop as tt
from tippetop.engines.cases import Case
from tippetop.support.field_paths import numbers_of as fields_of

WIDTH, HEIGHT, MARGIN = 640.0, 190.0, 34.0
"""Size of the figure and of the margin around its axes, in its own units."""

CURVE = 600
"""Number of points of the curve."""

EVENTS = 6
"""Number of events that a page lists."""

LAWS = {
    "viscous": "f = −μ v, no couple",
    "coulomb": "f = −μ v/|v| in slip; |f| ≤ μ at v = 0; no couple",
    "ellipsoidal": "S² = |v|² + (ρ w)², ρ = (3π/16) R: f = −μ v/S, couple −μ ρ² w/S along z",
    "hertz": "Coulomb's law on every part of a patch of radius R under Hertz's pressure",
}
"""Force and couple per unit normal force, by friction law."""

STYLE = """
@page { size: A4; margin: 14mm }
body { font: 10pt/1.35 system-ui, sans-serif; max-width: 46em; margin: 1em auto; padding: 0 1em }
h1 { font-size: 15pt; margin: 0 0 .2em } h2 { font-size: 11pt; margin: .8em 0 .2em }
table { border-collapse: collapse; font-size: 8.5pt; width: 100% }
td, th { text-align: left; padding: .1em .6em .1em 0; border-bottom: 1px solid #ddd }
td, th { white-space: nowrap } td:last-child { white-space: normal }
td.n { font-family: ui-monospace, monospace }
@media print { body { font-size: 8pt; margin: 0; max-width: none; padding: 0 }
  h1 { font-size: 12pt } h2 { font-size: 9pt; margin: .5em 0 .1em } table { font-size: 7pt } }
svg { width: 100%; height: auto } p { margin: .3em 0 }
"""


def page_of(case: Case, record: Mapping[str, Any]) -> str:
    """Return the page of a case from its record in the suite, as HTML of one side."""
    parts = [
        f"<h1>{html.escape(case.title)}</h1>",
        f"<p>Case <code>{case.name}</code>, suite {record['suite']}, {record['program']}. Tests"
        f" {html.escape(case.tests)}. Frames, signs and units: README.md.</p>",
        _figure(case, record),
        "<h2>Equations</h2>",
        *(f"<p>{html.escape(line)}</p>" for line in _equations(case, record)),
        "<h2>Parameters and state at launch</h2>",
        _table(("field", "value", "unit", "meaning"), _parameters(case)),
        f"<h2>Results at {case.duration:g} s</h2>",
        _table(("number", "value", "uncertainty", "unit"), _results(record)),
        f"<h2>Events{_count(record)}</h2>",
        _table(("time (s)", "uncertainty (s)", "kind", "surface"), _events(record))
        if record["events"]
        else "",
        "<p>Uncertainty: the difference of two methods that share no code. All numbers, and"
        f" derivatives by all parameters: {case.name}.json.</p>",
    ]
    body = "\n".join(parts)
    return (
        f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n'
        f"<title>{html.escape(case.title)}</title>\n<style>{STYLE}</style>\n{body}\n</html>\n"
    )


def _equations(case: Case, record: Mapping[str, Any]) -> Iterator[str]:
    """Yield what holds in a case, in lines."""
    problem = case.problem
    weight = "− m g z" if problem.table.is_level else "+ m g (sin b cos d, sin b sin d, −cos b)"
    yield (
        f"m u′ = F {weight},  L′ = a × F + M,  n′ = ω × n,  L = I1 ω + (I3 − I1)(n·ω) n;"
        "  N = F·z ≥ 0, gap ≥ 0, N gap = 0."
    )
    yield "a = −h′(c)(n − c z) − h(c) z, c = n·z; v = u + ω × a; w = ω·z; F = N (z + f)."
    friction = problem.friction
    kind = getattr(friction, "pressure", friction.kind)
    yield f"Friction, {friction.kind}: {LAWS[kind]}."
    if _lies_flat(case, record):
        yield "On its face: the law on every part of it, under uniform pressure (README.md)."
    if problem.rolling_resistance:
        yield "Rolling resistance: couple −N e w_t/|w_t|, at most N e where w_t = 0."
    if problem.contact.restitution:
        yield "Impacts: friction along the normal impulse (Routh), Poisson's restitution."


def _lies_flat(case: Case, record: Mapping[str, Any]) -> bool:
    """Return whether a body with a flat face is upright at one of the instants of a case."""
    has_face = any(isinstance(shape, tt.Ring) for shape in case.problem.body.shapes)
    upright = [record["start"]["tilt"], *record["states"]["tilt"]["values"]]
    return has_face and min(upright) == 0.0


def _parameters(case: Case) -> Iterator[Sequence[str]]:
    """Yield the fields of a problem that are numbers, but for those of pictures and zeros."""
    fields = case.problem.model_dump()
    for name, value in fields_of(fields):
        if value and not name.startswith("body.profile"):
            about = case.problem.quantity(name)
            yield name, f"{value:.10g}", about.units, about.long_name
    for name in ("body", "friction"):
        part = fields[name]
        kinds = [part["kind"]] if "kind" in part else [_kind(part["shape"])]
        yield f"{name}", ", ".join(kinds), "", "kind"


def _kind(shape: Any) -> str:
    shapes = shape if isinstance(shape, (list, tuple)) else [shape]
    return ", ".join(one["kind"] for one in shapes)


def _results(record: Mapping[str, Any]) -> Iterator[Sequence[str]]:
    """Yield the last state with its uncertainty."""
    for name, column in record["states"].items():
        value, apart = column["values"][-1], column["agreement"][-1]
        yield name, f"{value + 0.0:.12g}", f"{apart:.0e}", column["unit"]


def _events(record: Mapping[str, Any]) -> Iterator[Sequence[str]]:
    """Yield the first events with their uncertainty."""
    for event in record["events"][:EVENTS]:
        apart = event["agreement"]
        shown = "" if apart is None else f"{apart:.0e}"
        yield f"{event['time']:.13g}", shown, event["kind"], str(event["surface"])


def _count(record: Mapping[str, Any]) -> str:
    count = len(record["events"])
    return f": the first {EVENTS} of {count}" if count > EVENTS else "" if count else ": none"


def _table(headings: Sequence[str], rows: Iterator[Sequence[str]]) -> str:
    """Return a table whose second column is of numbers."""
    head = "".join(f"<th>{html.escape(one)}</th>" for one in headings)
    lines = [
        "<tr>"
        + "".join(
            f"<td{' class=n' if place < 2 else ''}>{html.escape(cell)}</td>"
            for place, cell in enumerate(row)
        )
        + "</tr>"
        for row in rows
    ]
    return f"<table><tr>{head}</tr>{''.join(lines)}</table>"


def _figure(case: Case, record: Mapping[str, Any]) -> str:
    """Return the tilt over time as SVG, with the instants and the events of the suite."""
    run = tt.simulate(case.problem, case.duration, samples=CURVE)
    times, tilts = run["time"].values.tolist(), run["tilt"].values.tolist()
    top = math.pi / 2 if max(tilts) < math.pi / 2 else math.pi

    def place(time: float, tilt: float) -> tuple[float, float]:
        x = MARGIN + (WIDTH - 2 * MARGIN) * time / case.duration
        return x, HEIGHT - MARGIN - (HEIGHT - 1.5 * MARGIN) * tilt / top

    curve = " ".join(f"{x:.2f},{y:.2f}" for x, y in map(place, times, tilts))
    dots = [
        place(t, a) for t, a in zip(record["time"], record["states"]["tilt"]["values"], strict=True)
    ]
    ticks = "".join(
        f'<line x1="{place(event["time"], 0)[0]:.2f}" x2="{place(event["time"], 0)[0]:.2f}"'
        f' y1="{HEIGHT - MARGIN}" y2="{HEIGHT - MARGIN + 6}" stroke="#b00"/>'
        for event in record["events"]
    )
    low, right = HEIGHT - MARGIN, WIDTH - MARGIN
    return (
        f'<svg viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" aria-label="Tilt over time">'
        f'<path d="M{MARGIN} {MARGIN / 2}V{low}H{right}" fill="none" stroke="#444"/>'
        f'<polyline points="{curve}" fill="none" stroke="#06c" stroke-width="1.2"/>'
        + "".join(f'<circle cx="{x:.2f}" cy="{y:.2f}" r="2.2"/>' for x, y in dots)
        + ticks
        + f'<g font-size="10"><text x="2" y="{MARGIN / 2 + 4}">{top:.2f} rad</text>'
        f'<text x="{MARGIN - 10}" y="{low + 4}">0</text>'
        f'<text x="{right - 60}" y="{low + 22}">time, {case.duration:g} s</text>'
        f'<text x="{MARGIN + 40}" y="{MARGIN / 2 + 4}">tilt; dots: states of the suite; red: events'
        "</text></g></svg>"
    )
