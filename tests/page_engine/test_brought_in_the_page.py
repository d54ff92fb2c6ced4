"""Workpieces and points are the same body in the page as in Python."""

import itertools
import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

import tippetop as tt
from node import printed
from tippetop.lathe.files import read_with_remarks
from tippetop.page_engine import HERE
from tippetop.support.errors import InvalidInput

READ = """
import { fromPoints, InvalidInput, pointsOf, turned, weighed } from %s;
const tried = (compute) => {
  try { return compute(); } catch (error) {
    if (!(error instanceof InvalidInput)) throw error;
    return { field: error.field, sentence: error.message };
  }
};
const read = ({ text, table, fields, whole }) => tried(() => {
  const found = text === undefined ? { table, remarks: [] } : fromPoints(pointsOf(text), fields);
  const { remarks } = found;
  return { remarks, weight: weighed(found.table), body: tried(() => turned(found.table, whole)) };
});
console.log(JSON.stringify(%s.map(read)));
"""

WORKPIECES = {
    "rounded": """unit = "mm"
density = "7 g/cm^3"
profile = [[0, -20], [14.142, 14.142, 20], [12.021, 12.021], [2, -16.882, -17], [2, 22], [0, 24, 2]]
""",
    "inserts": """density = 700
unit = "cm"
profile = [[0, -2], [0, 2, 2]]
[[inserts]]
profile = [[0, -1.5], [0, -0.5, 0.5]]
density = 7800
[[inserts]]
profile = [[0, 0.2], [0, 1.2, 0.5]]
density = 0
""",
    "crossing": """density = 700
profile = [[0, -0.02], [0.02, 0.01], [0.02, -0.01], [0, 0.02]]
""",
    "open cavity": """density = 700
profile = [[0, -0.02], [0, 0.02, 0.02]]
inserts = [{ profile = [[0, -0.02], [0.005, 0], [0, 0.01]], density = 0 }]
""",
    "no density": "profile = [[0, -0.02], [0, 0.02, 0.02]]",
}


def arc(center: float, radius: float, begin: float, end: float, count: int) -> list[complex]:
    angles = np.linspace(math.radians(begin), math.radians(end), count)
    return [1j * center + radius * complex(math.cos(a), math.sin(a)) for a in angles]


def outlines() -> dict[str, list[complex]]:
    """Half outlines of points, mm."""
    egg = [
        complex(15 * math.cos(a), (20 + 4 * math.sin(a)) * math.sin(a))
        for a in np.linspace(-math.pi / 2, math.pi / 2, 61)
    ]
    ellipse = [
        complex(16 * math.cos(a), 25 * math.sin(a))
        for a in np.linspace(-math.pi / 2, math.pi / 2, 91)
    ]
    stem = [3 + 26j, *arc(26, 3, 0, 90, 12)[1:]]
    pear = [complex(p.real * (1 - 0.01 * p.imag), p.imag) for p in egg]
    return {
        "pear": pear,
        "egg with a stem": [*egg[:50], 3 + 21j, 3 + 28j, 30j],
        "ball": arc(0, 15, -90, 90, 61),
        "coarse ball": arc(0, 15, -90, 90, 31),
        "polygon": arc(0, 15, -90, 90, 7),
        "top": [*arc(0, 20, -90, 40, 50), 3 + 13j, *stem],
        "spindle": [-12j, 9 + 2j, 2 + 4j, 2 + 16j, 20j],
        "ellipse": ellipse,
        "egg": egg,
        "ring": [18 + 5 * np.exp(1j * a) for a in np.linspace(0, 2 * math.pi, 73)],
    }  # fmt: skip


def points_text(points: list[complex], between: str, digits: int) -> str:
    rows = [f"{p.real:.{digits}f}{between}{p.imag:.{digits}f}" for p in points]
    return "\n".join([f"r{between}z", *rows]) + "\n"


def random_profiles(count: int) -> list[list[list[float]]]:
    """Profiles of lines and arcs, some of which are no bodies."""
    rng = np.random.default_rng(45)
    found = []
    for _ in range(count):
        angles = [-math.pi / 2, *np.sort(rng.uniform(-1.4, 1.4, rng.integers(1, 6))), math.pi / 2]
        places = [rng.uniform(0.01, 0.03) * np.exp(1j * a) for a in angles]
        places[0], places[-1] = 1j * places[0].imag, 1j * places[-1].imag
        profile = [[float(places[0].real), float(places[0].imag)]]
        for start, end in itertools.pairwise(places):
            bend = rng.uniform(-1.0, 1.0)
            arc_radius = [abs(end - start) / 2.0 / bend] if rng.random() < 0.6 else []
            profile.append([float(end.real), float(end.imag), *map(float, arc_radius)])
        found.append(profile)
    return found


def cases() -> list[dict[str, object]]:
    tables = [tomllib.loads(text) for text in WORKPIECES.values()]
    asked: list[dict[str, object]] = [{"table": table} for table in tables]
    for number, profile in enumerate(random_profiles(24)):
        table = {"profile": profile, "density": 700}
        asked.append({"table": table, "whole": number % 2 == 0})
    for number, points in enumerate(outlines().values()):
        whole = [*points, *(-p.conjugate() for p in points[-2:0:-1])]
        line, between, digits = (points, "\t", 4) if number % 2 else (whole, ",", 2)
        fields = {"unit": "mm", "density": 700}
        asked.append({"text": points_text(line, between, digits), "fields": fields})
    asked.append({"text": "1;2\n3;x\n", "fields": {"density": 700}})
    return asked


def in_python(case: dict[str, object], folder: Path) -> dict[str, object]:
    try:
        if "table" in case:
            piece, remarks = tt.Workpiece(**case["table"]), []  # type: ignore[arg-type]
        else:
            (folder / "points.csv").write_text(str(case["text"]))
            fields = case["fields"]
            piece, remarks = read_with_remarks(folder / "points.csv", **fields)  # type: ignore
    except InvalidInput as error:
        return {"field": error.field}
    weight = {**piece.mass_properties._asdict(), "edges": piece.fit.edges}
    try:
        body = tt.Body.turned(piece, whole=bool(case.get("whole"))).model_dump()
    except InvalidInput as error:
        return {"remarks": remarks, "weight": weight, "body": {"sentence": str(error)}}
    return {"remarks": remarks, "weight": weight, "body": body, "size": piece.outline.size}


def test_what_is_brought_is_the_same_body_in_the_page(tmp_path: Path) -> None:
    asked = cases()
    engine = json.dumps((HERE / "index.js").as_uri())
    found = json.loads(printed(READ % (engine, json.dumps(asked))))
    bodies = ovals = 0
    for case, ours in zip(asked, found, strict=True):
        theirs = in_python(case, tmp_path)
        if "weight" not in theirs:
            assert ours["field"] == theirs["field"], case
            continue
        assert ours["remarks"] == theirs["remarks"]
        weight = theirs["weight"]
        assert ours["weight"]["edges"] == weight["edges"], case
        for name in ("mass", "I1", "I3"):
            assert ours["weight"][name] == pytest.approx(weight[name], rel=1e-9), case
        body = theirs["body"]
        if "sentence" in body:
            assert ours["body"]["sentence"] == body["sentence"], case
        else:
            assert flat(ours["body"]) == pytest.approx(flat(body), rel=1e-8, abs=1e-10), case
            bodies += 1
            ovals += "oval" in json.dumps(body)
    assert bodies >= 9
    assert ovals == 3


def flat(value: object, name: str = "") -> dict[str, float]:
    """The numbers in a table by their names with dots."""
    if isinstance(value, dict):
        items = list(value.items())
    elif isinstance(value, list | tuple):
        items = [(str(k), one) for k, one in enumerate(value)]
    else:
        return {name: float(value)} if isinstance(value, float | int) else {}
    return {k: v for key, one in items for k, v in flat(one, f"{name}.{key}").items()}
