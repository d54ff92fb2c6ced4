"""Random drawings, tables and meshes as people make them are read right, or asked about.

Masses and moments are compared with sums over thin slices of the outline, which is made of points
here and of arcs there.
"""

import math
from pathlib import Path

import numpy as np
import pytest

import tippetop as tt
from campaigns import seeds
from tippetop.lathe.files import read_with_remarks

DENSITY = 700.0
ASKED = ("may be", "--axis", "--frame")


def outline(random):
    """Half an outline from the axis up to it: (r, z) or (r, z, radius), mm."""
    size = float(random.uniform(8.0, 30.0))
    stem, end = size * float(random.uniform(0.1, 0.25)), size * float(random.uniform(1.1, 2.0))
    kind = random.choice(["cut ball", "ball with stem", "foot", "cone", "hemisphere", "fillet"])
    if kind == "cut ball":
        cut = size * float(random.uniform(-0.3, 0.7))
        return [(0, -size), *ball(size, math.sqrt(size**2 - cut**2), cut), (stem, cut),
                (stem, max(end, cut + 2.0)), (0, max(end, cut + 2.0))]  # fmt: skip
    if kind == "ball with stem":
        top = math.sqrt(size**2 - stem**2)
        return [(0, -size), *ball(size, stem, top), (stem, end), (0, end + stem, stem)]
    if kind == "foot":
        foot = 0.6 * size
        return [(0, 0), (foot, 0), (size, 0.3 * size), (stem, 0.8 * size), (stem, end), (0, end)]
    if kind == "cone":
        return [(0, 0), (size, 0.5 * size), (size, 0.7 * size), (stem, size), (stem, end), (0, end)]
    if kind == "hemisphere":
        return [(0, -size), (size, 0, size), (0, 0)]
    fillet = 0.1 * size
    return [(0, 0), (size - fillet, 0), (size, fillet, fillet), (size, 0.4 * size),
            (stem, 0.4 * size), (stem, end), (0, end)]  # fmt: skip


def ball(radius, r, z):
    """Points of a ball from its pole to (r, z), none of whose arcs is more than a quarter."""
    return [(radius, 0.0, radius), (r, z, radius)] if z > 0.0 else [(r, z, radius)]


def fine(profile, count=400):
    """The outline as many points."""
    points = [complex(*profile[0][:2])]
    for point in profile[1:]:
        start, end = points[-1], complex(*point[:2])
        if len(point) == 2:
            points.append(end)
            continue
        chord, radius = end - start, point[2]
        height = math.sqrt(max(0.0, radius**2 - abs(chord) ** 2 / 4.0))
        center = (start + end) / 2.0 + 1j * chord / abs(chord) * height
        first = np.angle(start - center)
        turn = np.angle((end - center) / (start - center))
        points += [center + radius * np.exp(1j * (first + turn * k / count))
                   for k in range(1, count + 1)]  # fmt: skip
    return np.array(points)


def moments(profile, bore=None):
    """Mass, kg, and moment about the axis, kg m^2, by frustums."""
    points = fine(profile)
    r, z = points.real, points.imag
    low, high, rise = r[:-1], r[1:], np.diff(z)
    volume = math.pi / 3.0 * (rise * (low**2 + low * high + high**2)).sum()
    fourth = (rise * sum(low**k * high ** (4 - k) for k in range(5))).sum()
    axial = math.pi / 10.0 * fourth
    if bore:
        width, length = bore
        volume -= math.pi * width**2 * length
        axial -= math.pi / 2.0 * width**4 * length
    return DENSITY * 1e-9 * volume, DENSITY * 1e-15 * axial


def path_of(profile, turn, at, sides):
    """A path of SVG; one or both sides, turned by a factor, with the axis through `at`."""

    def place(point):
        moved = at + turn * point
        return f"{moved.real:.6f} {-moved.imag:.6f}"

    def arcs(points, sweep):
        parts = []
        for point in points[1:]:
            end = place(complex(*point[:2]))
            radius = point[2] if len(point) == 3 else 0.0
            parts.append(f"A {radius:.6f} {radius:.6f} 0 0 {sweep} {end}" if radius else f"L {end}")
        return parts

    parts = [f"M {place(complex(*profile[0][:2]))}", *arcs(profile, 0)]
    if sides == 2:
        radii = [point[2] if len(point) == 3 else 0.0 for point in profile]
        back = [(-profile[-1][0], profile[-1][1])]
        for k in range(len(profile) - 2, -1, -1):
            r, z = profile[k][:2]
            back.append((-r, z, radii[k + 1]) if radii[k + 1] else (-r, z))
        parts += arcs(back, 0)
    return f'<path d="{" ".join(parts)} Z"/>'


def drawn(random, folder):
    """A file, options to read it, and the mass and moment that it should have."""
    profile = outline(random)
    points = fine(profile, 60)
    width, tall = points.real.max(), np.ptp(points.imag)
    way = random.choice(["svg", "svg", "svg", "svg", "csv", "points"])
    if way == "csv":
        unit = str(random.choice(["mm", "cm", "in", "m"]))
        factor = {"mm": 1.0, "cm": 0.1, "in": 1.0 / 25.4, "m": 1e-3}[unit]
        rows = [",".join(f"{factor * x:.9g}" for x in point) for point in profile]
        (folder / "a.csv").write_text("\n".join([f"r ({unit}),z ({unit}),radius ({unit})", *rows]))
        return folder / "a.csv", {}, moments(profile)
    if way == "points":
        rows = [f"{p.real:.6f};{p.imag:.6f}".replace(".", ",") for p in points]
        (folder / "a.csv").write_text("\n".join(["r [mm];z [mm]", *rows]))
        return folder / "a.csv", {}, moments(profile)
    sides, turn = int(random.integers(1, 3)), complex(random.choice([1, -1, 1j, -1j, 1, 1]))
    if len(profile) == 3 and turn.imag:
        sides = 1  # half a ball that lies is, drawn in full, half the outline of a ball
    page = 6.0 * max(width, tall)
    middle = complex(random.uniform(0.4, 0.6), -random.uniform(0.4, 0.6)) * page
    at = middle - turn * 1j * (points.imag.max() + points.imag.min()) / 2.0
    bore = None
    content = path_of(profile, turn, at, sides)
    if sides == 2 and random.uniform() < 0.3:
        heights = points.imag.max() - points.imag.min()
        place = points.imag.min() + 0.25 * heights
        room = min(abs(p.real) for p in points if abs(p.imag - place) < 0.15 * heights and p.real)
        bore = (0.3 * room, 0.1 * heights)
        box = [(0, place), (bore[0], place), (bore[0], place + bore[1]), (0, place + bore[1])]
        content += path_of(box, turn, at, 2)
    around = random.choice(["none", "page", "frame", "both", "title", "layer"])
    if around in ("page", "both"):
        content = f'<rect width="{page}" height="{page}" fill="#fff"/>' + content
    if around in ("frame", "both", "title"):
        edge, long = 0.03 * page, 0.94 * page
        content += f'<rect x="{edge}" y="{edge}" width="{long}" height="{long}" fill="none"/>'
    if around == "title":
        content += f'<path d="M {0.7 * page} {0.97 * page} V {0.9 * page} H {0.97 * page}"/>'
    if around == "layer":
        content += '<g style="display:none"><circle cx="9" cy="9" r="40"/></g>'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{page}mm" height="{page}mm"'
    (folder / "a.svg").write_text(f'{head} viewBox="0 0 {page} {page}">{content}</svg>')
    return folder / "a.svg", {}, moments(profile, bore)


@pytest.mark.parametrize("seed", seeds(12, 40, 300))
def test_it_is_read_right_or_asked_about(tmp_path: Path, seed: int) -> None:
    path, options, (mass, axial) = drawn(np.random.default_rng(seed), tmp_path)
    question = ""
    try:
        piece, _ = read_with_remarks(path, density=DENSITY, **options)
    except tt.InvalidInput as refusal:
        question = str(refusal)
    if question:
        assert any(word in question for word in ASKED)
        return
    assert piece.mass_properties.mass == pytest.approx(mass, rel=1e-4)
    assert pytest.approx(axial, rel=2e-4) == piece.mass_properties.I3
