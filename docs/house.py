"""Draw the map of the rooms from the package's imports: `make map`, or `python docs/house.py`.

The picture is text in SVG, so that the same imports give the same file.
"""

from collections.abc import Callable, Iterable
from html import escape
from itertools import pairwise
from pathlib import Path
from textwrap import wrap

import grimp

PICTURE = Path(__file__).parent / "_static" / "house.svg"

ROOMS = {
    "cli": "one file per command",
    "lab": "the page's server; the player in notebooks",
    "report": "its claims and figures, computed again and judged",
    "export": "runs as pages, films, models and tables",
    "figures": "draws results, solves nothing",
    "page_engine": "the engine in the page, JavaScript",
    "translate": "Python modules to JavaScript",
    "fit": "data, fits with errors, plans of measurements",
    "engines": "reference suite; other programs' formats and runs",
    "sweeps": "many launches: grid, lanes, store, schedulers",
    "extend": "what users' laws, surfaces and events need",
    "run": "simulate: one launch from mode to mode",
    "stepper": "one launch, in steps of one's own",
    "results": "variables, metrics, monitors, files of a run",
    "theory": "steady states, stability, critical spins",
    "contact": "contact modes: motion, guards, what follows",
    "integrators": "methods, search for guards, dense solutions",
    "graph": "expression graphs, as LLVM and JavaScript",
    "problem": "the physics of a run, checked; presets",
    "lathe": "bodies from profiles: mass, inertia, surfaces",
    "support": "errors, files, processes, checked fields",
    "mechanics": "equations in plain operators; no library",
}
"""Every room of the package and what it holds."""

MODULES = ("extend", "run", "stepper")
"""Rooms that are one module."""

WIDTH, HEIGHT, GAP_X, GAP_Y, MARGIN = 176, 60, 26, 48, 16
PASSAGE = 14
"""Width of the space between two rooms through which a long arrow passes."""

PASSES = 12
"""Passes over the rows that move each room toward those it has arrows with; more change nothing."""

Imports = dict[str, set[str]]


def imports_of_rooms() -> Imports:
    """Return the rooms that each room imports; what only type checkers import does not count."""
    graph = grimp.build_graph("tippetop", exclude_type_checking_imports=True, cache_dir=None)
    imports: Imports = {room: set() for room in sorted(set(map(_room, graph.modules)) - {""})}
    for module in graph.modules:
        for imported in graph.find_modules_directly_imported_by(module):
            if _room(module) and _room(imported):
                imports[_room(module)].add(_room(imported))
    return {room: direct - {room} for room, direct in imports.items()}


def _room(module: str) -> str:
    """Return the room of a module; "" for the package itself and its `__main__`."""
    name = f"{module}.".split(".")[1]
    return "" if name == "__main__" else name


def reduced(imports: Imports) -> Imports:
    """Leave out the arrows to rooms that are also reached through another room."""

    def below(room: str) -> set[str]:
        return imports[room].union(*map(below, imports[room]))

    return {
        room: direct - set().union(*map(below, direct)) for room, direct in sorted(imports.items())
    }


def ranks(imports: Imports) -> dict[str, int]:
    """Return the row of each room, counted from the lowest: above all rooms that it imports."""
    rows: dict[str, int] = {}

    def rank(room: str) -> int:
        if room not in rows:
            rows[room] = 1 + max(map(rank, imports[room]), default=-1)
        return rows[room]

    for room in imports:
        rank(room)
    return rows


def placed(arrows: Imports, rank: dict[str, int]) -> tuple[list[list[str]], list[list[str]]]:
    """Return the rows of rooms and passages, the lowest row first, and the path of each arrow.

    An arrow that passes a row has a place of its own there: a passage, named for both its ends.
    """
    rows: list[list[str]] = [[] for _ in range(1 + max(rank.values()))]
    for room in arrows:
        rows[rank[room]].append(room)
    paths = []
    for room, directs in arrows.items():
        for direct in sorted(directs):
            passages = [f"{room}>{direct}>{row}" for row in range(rank[room] - 1, rank[direct], -1)]
            for row, passage in zip(range(rank[room] - 1, 0, -1), passages, strict=False):
                rows[row].append(passage)
            paths.append([room, *passages, direct])
    near: dict[str, list[str]] = {place: [] for row in rows for place in row}
    for path in paths:
        for upper, lower in pairwise(path):
            near[upper].append(lower)
            near[lower].append(upper)
    for number in range(PASSES):
        at = positions(rows)
        for places in rows if number % 2 else reversed(rows):
            places.sort(key=lambda place: _mean([at[one] for one in near[place]] or [at[place]]))
            at = positions(rows)
    return rows, paths


def positions(rows: list[list[str]]) -> dict[str, float]:
    """Return the middle of each place, from the middle of its row."""
    at = {}
    for row in rows:
        left = -0.5 * (sum(map(_width, row)) + GAP_X * (len(row) - 1))
        for place in row:
            at[place] = left + 0.5 * _width(place)
            left += _width(place) + GAP_X
    return at


def _width(place: str) -> int:
    return PASSAGE if ">" in place else WIDTH


def _mean(numbers: list[float]) -> float:
    return sum(numbers) / len(numbers)


def picture() -> str:
    """Return the map as the text of an SVG file."""
    imports = imports_of_rooms()
    arrows, rank = reduced(imports), ranks(imports)
    rows, paths = placed(arrows, rank)
    at = positions(rows)
    left, right = min(at.values()) - WIDTH / 2, max(at.values()) + WIDTH / 2
    across, high = right - left + 2 * MARGIN, len(rows) * (HEIGHT + GAP_Y) - GAP_Y + 2 * MARGIN
    level = {place: row for row, places in enumerate(rows) for place in places}

    def top(place: str) -> tuple[float, float]:
        x = at[place] - left + MARGIN
        return x, MARGIN + (len(rows) - 1 - level[place]) * (HEIGHT + GAP_Y)

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {across:g} {high:g}"'
        ' font-family="sans-serif" text-anchor="middle" role="img">',
        "<title>The rooms of tippetop and the imports between them</title>",
        "<!-- Drawn by docs/house.py; not to be edited. -->",
        '<defs><marker id="head" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8"'
        ' markerHeight="8" orient="auto"><path d="M0 0 8 4 0 8z" fill="#555"/></marker></defs>',
        f'<rect width="{across:g}" height="{high:g}" fill="#fff"/>',
        '<g fill="none" stroke="#555" stroke-width="1.3">',
    ]
    outgoing, incoming = _ends(paths, at, 0), _ends(paths, at, -1)
    lines += [
        f'<path marker-end="url(#head)" d="{_curve(path, top, outgoing, incoming)}">'
        f"<title>{path[0]} imports {path[-1]}</title></path>"
        for path in paths
    ]
    lines += ["</g>", '<g fill="#222">']
    for room in sorted(arrows, key=lambda one: (-rank[one], at[one])):
        lines += _box(room, *top(room), imports[room])
    return "\n".join([*lines, "</g>", "</svg>", ""])


def _ends(paths: list[list[str]], at: dict[str, float], end: int) -> dict[tuple[str, ...], float]:
    """Return where arrows meet their boxes, from the middle: side by side in order of what is next.

    `end` is 0 for where arrows begin and -1 for where they end.
    """
    shift = {}
    for room in {path[end] for path in paths}:
        meeting = [path for path in paths if path[end] == room]
        meeting.sort(key=lambda path: at[path[1 if end == 0 else -2]])
        for number, path in enumerate(meeting, 1):
            shift[tuple(path)] = WIDTH * (number / (len(meeting) + 1) - 0.5)
    return shift


def _curve(
    path: list[str],
    top: Callable[[str], tuple[float, float]],
    outgoing: dict[tuple[str, ...], float],
    incoming: dict[tuple[str, ...], float],
) -> str:
    """Return an arrow from the bottom of its first place through passages to the top of its last.

    `top` gives the middle of a place's upper side.
    """
    x, y = top(path[0])
    x, y = x + outgoing[tuple(path)], y + HEIGHT
    text = [f"M{x:.1f} {y:.1f}"]
    for place in path[1:]:
        u, v = top(place)
        if place == path[-1]:
            u += incoming[tuple(path)]
        half = GAP_Y / 2
        text.append(f"C{x:.1f} {y + half:.1f} {u:.1f} {v - half:.1f} {u:.1f} {v:.1f}")
        x, y = u, v
        if place != path[-1]:
            y += HEIGHT
            text.append(f"V{y:.1f}")
    return " ".join(text)


def _box(room: str, x: float, y: float, imported: Iterable[str]) -> list[str]:
    """Return a room as a box with its name and what it holds."""
    name = f"{room}.py" if room in MODULES else f"{room}/"
    names = ", ".join(sorted(imported)) or "no other room"
    lines = [
        f"<g><title>{name} imports {names}</title>",
        f'<rect x="{x - WIDTH / 2:.1f}" y="{y:.1f}" width="{WIDTH}" height="{HEIGHT}" rx="6"'
        ' fill="#eef3f8" stroke="#34618e"/>',
        f'<text x="{x:.1f}" y="{y + 20:.1f}" font-size="15" font-weight="bold">{name}</text>',
    ]
    for number, line in enumerate(wrap(ROOMS[room], 26)):
        below = y + 37 + 14 * number
        lines.append(f'<text x="{x:.1f}" y="{below:.1f}" font-size="11.5">{escape(line)}</text>')
    return [*lines, "</g>"]


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
