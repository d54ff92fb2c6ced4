"""Drawings in SVG as Inkscape, Illustrator, FreeCAD and OpenSCAD write them, and true curves."""

from drawn import (
    BALL,
    BARREL,
    BORED,
    CUT,
    EGG,
    FACE,
    GOBLET,
    SLIM,
    SPHEROID,
    SPINDLE,
    TIP,
    TOP,
    TORUS,
    R,
    polyline,
)

PX = 96.0 / 25.4
"""Pixels in a millimetre."""

HEAD = '<?xml version="1.0" encoding="UTF-8" standalone="no"?>\n'


def svg(content, size="210mm 297mm", box="0 0 210 297"):
    """A drawing of a size with numbers in a box; without a size, the numbers are pixels."""
    sized = 'width="{}" height="{}" '.format(*size.split()) if size else ""
    return f'{HEAD}<svg xmlns="http://www.w3.org/2000/svg" {sized}viewBox="{box}">{content}</svg>'


def d(command, points, scale=1.0, at=0j, digits=4):
    """A path command of SVG with points, whose y goes down."""
    moved = [at + scale * complex(point).conjugate() for point in points]
    return command + " ".join(f"{p.real:.{digits}f},{p.imag:.{digits}f}" for p in moved)


def mirrored(points):
    """The points of a half outline, and back on the other side of the axis."""
    return [*points, *(-complex(p).conjugate() for p in points[-2:0:-1])]


def whole_top(at, scale=1.0):
    """The top drawn on both sides by arcs and lines, clockwise on the sheet."""
    r, slim = scale * R, scale * SLIM

    def to(*points):
        return [f"{p.real:.5f} {p.imag:.5f}" for p in (at + scale * q.conjugate() for q in points)]

    right, inner, tip = to(CUT + FACE * 1j, SLIM + FACE * 1j, SLIM + TIP * 1j)
    left, outer, other = to(-CUT + FACE * 1j, -SLIM + FACE * 1j, -SLIM + TIP * 1j)
    return (
        f"M {left} L {outer} L {other} A {slim} {slim} 0 0 1 {tip} L {inner} L {right}"
        f" A {r} {r} 0 1 1 {left} Z"
    )


def rounded_ellipse(rx, ry, cx, cy, digits=2):
    """An ellipse of four Bezier curves as Illustrator writes it: relative, few digits."""
    k = 0.5522847
    parts = [
        f"M{cx + rx:.{digits}f},{cy:.{digits}f}",
        *(
            "c" + ",".join(f"{number:.{digits}f}" for number in numbers)
            for numbers in (
                (0, ry * k, -rx * (1 - k), ry, -rx, ry),
                (-rx * k, 0, -rx, -ry * (1 - k), -rx, -ry),
                (0, -ry * k, rx * (1 - k), -ry, rx, -ry),
                (rx * k, 0, rx, ry * (1 - k), rx, ry),
            )
        ),
        "Z",
    ]
    return "".join(parts)


def egg_path(command, at, scale=1.0):
    """The egg as two cubic curves, absolute or relative, of a half outline."""
    first = [-20j, 11.0 - 20j, 15.0 - 9j, 15.0 - 1j, 15.0 + 12j, 8.0 + 24j, 24j]
    if command == "C":
        return d("M", first[:1], scale, at) + " " + d("C", first[1:], scale, at)
    steps = [
        *(point - first[0] for point in first[1:4]),
        *(point - first[3] for point in first[4:]),
    ]
    return d("m", first[:1], scale, at) + " " + d("c", steps, scale)


def csv(points, header="x,y", digits=4):
    return header + "\n" + "".join(f"{p.real:.{digits}f},{p.imag:.{digits}f}\n" for p in points)


SVG = {
    "inkscape-circle": (
        BALL,
        svg('<g id="layer1" transform="translate(12.5,-30)"><circle cx="80" cy="120" r="15"/></g>'),
    ),
    "inkscape-arc-path": (
        BALL,
        svg(
            '<path transform="matrix(1,0,0,-1,3,290)" d="m 95,120 a 15,15 0 0 1 -15,15 15,15 0 0 1'
            ' -15,-15 15,15 0 0 1 15,-15 15,15 0 0 1 15,15 z"/>'
        ),
    ),
    "inkscape-two-arcs": (BALL, svg('<path d="M 65,120 a 15 15 0 1 0 30 0 a 15 15 0 1 0 -30 0"/>')),
    "inkscape-egg-relative": (EGG, svg(f'<path d="{egg_path("c", 60 + 150j)} z"/>')),
    "inkscape-whole-top": (
        TOP,
        svg(f'<g transform="scale(2)"><path d="{whole_top(50 + 60j, 0.5)}"/></g>'),
    ),
    "inkscape-lying-top": (
        TOP,
        svg(f'<path transform="rotate(90,70,80)" d="{whole_top(70 + 80j)}"/>'),
    ),
    "inkscape-bored": (
        BORED,
        svg(
            f'<path style="fill-rule:evenodd" d="{whole_top(70 + 80j)} M 78,82 a 8,8 0 0 0 -16,0 '
            '8,8 0 1 0 16,0 z"/>'
        ),
    ),
    "inkscape-polygon": (
        SPINDLE,
        svg(d('<polygon points="', mirrored(polyline(SPINDLE, 1)), 1.0, 40 + 60j) + '"/>'),
    ),
    "inkscape-center-line": (
        EGG,
        svg(
            f'<path d="{egg_path("C", 60 + 150j)}"/>'
            '<path style="stroke-dasharray:4,1" d="M 60,120 V 180"/>'
        ).replace("z", ""),
    ),
    "inkscape-goblet": (
        GOBLET,
        svg(
            '<path d="m 60,150 c 14,0 18,-8 18,-16 h -3 c 0,6 -3,12 -15,12 -12,0 -15,-6 -15,-12'
            ' h -3 c 0,8 4,16 18,16 z"/>'
        ),
    ),
    "illustrator-circle": (
        BALL,
        svg(
            f'<path class="st0" d="{rounded_ellipse(56.69, 56.69, 120.5, 90.2)}"/>',
            "",
            "0 0 400 300",
        ),
    ),
    "illustrator-ellipse": (
        SPHEROID,
        svg(
            '<style>.a{fill:none}</style><ellipse class="a" cx="200" cy="150" '
            f'rx="{25 * PX:.3f}" ry="{16 * PX:.3f}" transform="rotate(-90 200 150)"/>',
            "400px 300px",
            "0 0 400 300",
        ),
    ),
    "illustrator-rounded-rect": (
        BARREL,
        svg('<rect x="1in" y="20" width="98.268" height="75.591" rx="11.339"/>', "", "0 0 300 300"),
    ),
    "illustrator-top-in-points": (
        TOP,
        svg(f'<path d="{whole_top(100 + 90j, 72 / 25.4)}"/>', "200pt 200pt", "0 0 200 200"),
    ),
    "illustrator-egg-both-sides": (
        EGG,
        svg(
            f'<path d="{egg_path("C", 60 + 50j, 1)} C 52 26 45 38 45 51 C 45 59 49 70 60 70 Z"/>',
            "10cm 10cm",
            "0 0 100 100",
        ),
    ),
    "illustrator-ring-cut": (
        TORUS,
        svg('<circle cx="32" cy="40" r="5"/><circle cx="68" cy="40" r="5"/>'),
    ),
    "freecad-loose-edges": (
        TOP,
        svg(
            '<g transform="translate(50,60) scale(1,-1)">'
            f'<path d="M {CUT} {FACE} L {SLIM} {FACE}"/>'
            f'<path d="M {SLIM} {TIP} A {SLIM} {SLIM} 0 0 1 0 {TIP + SLIM}"/>'
            f'<path d="M {SLIM} {FACE} L {SLIM} {TIP}"/>'
            f'<path d="M {CUT} {FACE} A {R} {R} 0 0 0 0 {-R}"/></g>'
        ),
    ),
    "openscad-top": (
        TOP,
        svg(
            d('<path d="M ', mirrored(polyline(TOP, 48)), 1.0, 0j, 5) + ' z" stroke-width="0.5"/>',
            "40mm 53mm",
            "-20 -33 40 53",
        ),
    ),
    "openscad-spheroid": (
        SPHEROID,
        svg(
            d('<path d="M ', mirrored(polyline(SPHEROID, 60)), 1.0, 0j, 5) + ' z"/>',
            "32mm 50mm",
            "-16 -25 32 50",
        ),
    ),
}
"""True curves, and the drawing."""
