"""Reading of meshes of bodies of revolution with trimesh: axis, meridian and deviation from it.

The meridian is the section of the mesh by a half-plane from the axis, with edges straight in
cylindrical coordinates, so that facets around the axis do not matter. Vertices lie on the body: the
meridian goes through them, and the section only gives their order.
"""

import math
from importlib.util import find_spec
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tippetop.lathe.sheet import Reading, nested
from tippetop.support.errors import Described, InvalidInput, Unavailable
from tippetop.support.installation import install_command

NOT_ROUND = 0.01
"""Largest distance of a surface from one of revolution, in sizes of the body."""

LARGEST_FILE = 2**28
"""Largest file that is read, bytes."""

SLIVER = 1e-7
"""Angle by which half-planes miss vertices, rad."""

SAME = 1e-5
"""Distance of vertices that are one point of the meridian, in sizes of the body: ten times the
rounding of single precision.
"""

ALIKE = 1e-6
"""Angle, rad, between axes that are not compared with one another, and their distance, in sizes of
the body: a tenth of `SAME`, so that neither is rounder by more than rounding.
"""

HALF_PLANES = 5
"""Number of half-planes whose sections are compared with all vertices."""

WIDEST = math.radians(30.0)
"""Largest angle around the axis of an edge that approximates an arc around it, rad."""

FACETED = 0.02
"""Largest distance of facets from the round surface through their vertices, in sizes of the body: a
ball of 12 sides is read as a ball, a prism of 8 sides is refused.
"""

WORTH_SAYING = 1e-4
"""Depth of facets, in sizes of the body, from which it is said: the tolerance of a profile."""

MOST_FACETS = 20_000
"""Largest number of edges of facets that are compared with the round surface."""

DENSE = 3.0
"""Ratio of distinct vertices to points of the meridian above which the vertices are scattered."""

Vectors = NDArray[np.float64]
Line = NDArray[np.complex128]
"""Distance from the axis and, times i, height along it."""


def read_mesh(path: Path, axis: str | None, tolerance: float, name: str) -> Reading:
    """Return the profile of a body of revolution from its surface, in the numbers of the file.

    The axis is as stated, x, y or z through the middle of the body, or by default the one about
    which the surface is roundest.

    Closed surfaces that overlap are united. Raises `InvalidInput` if the surface is not closed, or
    if its vertices differ from one of revolution by more than `NOT_ROUND`, its facets by more than
    `FACETED`, or both by more than the tolerance; `Unavailable` if trimesh is not installed.
    """
    mesh = _mesh(path, name)
    size = float(np.ptp(mesh.vertices, axis=0).max())
    if axis is not None and axis not in ("x", "y", "z"):
        raise InvalidInput("axis", axis, "x, y or z, the direction of the axis of a mesh")
    surfaces = [
        _Surface(mesh, origin, direction, size)
        for direction in _directions(mesh, axis)
        for origin in _origins(mesh, direction, size)
    ]
    # Of axes that differ by rounding the first is a coordinate axis.
    surface = min(
        surfaces,
        key=lambda one: (
            round(max(one.out_of_round, one.facet_depth) / (SAME * size))
            if one.meridian
            else math.inf
        ),
    )
    share, depth = surface.out_of_round / size, surface.facet_depth / size
    for differing, most in ((share, NOT_ROUND), (depth, FACETED)):
        if not differing <= max(most, tolerance):
            raise InvalidInput(
                _format(path),
                Described(f"a surface out of round by {100.0 * differing:.3g} % of its size"),
                f"one of revolution, to {100.0 * most:g} %: without parts that are not round;"
                " --axis x, y or z says which axis is meant, and --tolerance 0.05 accepts 5 %",
                file=name,
            )
    lines = sorted((surface.through_vertices(line) for line in surface.meridian), key=_area)
    along = ", ".join(f"{round(number, 9) + 0.0:.4g}" for number in surface.direction)
    round_volume = sum(map(_volume, lines))
    lost = (1.0 - abs(float(mesh.volume)) / round_volume) if round_volume else 0.0
    remark = (
        f"The axis is along ({along}); the vertices differ from a round surface by"
        f" {100.0 * share:.2g} % of its size at most."
    )
    if depth > WORTH_SAYING and len(lines) == 1:
        remark += (
            f" The body is round: facets of the mesh lie up to {100.0 * depth:.2g} % of the size"
            f" inside it, and the mesh has {100.0 * lost:.2g} % less volume."
        )
    shells = [(f"shell {number}", line) for number, line in enumerate(reversed(lines), 1)]
    return Reading(*nested(shells, tolerance, _format(path)), [remark])


def _format(path: Path) -> str:
    """Return the name of a mesh's format."""
    return path.suffix[1:].upper()


def _mesh(path: Path, name: str) -> Any:
    kind = _format(path)
    if not all(find_spec(one) for one in ("trimesh", "networkx")):
        raise Unavailable(
            f"{kind} files are read with trimesh, which is not installed:"
            f" {install_command('lathe')}"
        )
    import trimesh  # noqa: PLC0415 - optional

    if path.stat().st_size > LARGEST_FILE:
        raise InvalidInput(kind, name, f"a file of at most {LARGEST_FILE:,} bytes")
    try:
        mesh = trimesh.load_mesh(path, file_type=path.suffix[1:].lower())
    except Exception:  # noqa: BLE001 - trimesh raises what its parsers do
        raise InvalidInput(kind, name, f"a mesh in the format {kind}") from None
    if not isinstance(mesh, trimesh.Trimesh) or len(mesh.faces) < 8:
        raise InvalidInput(kind, name, f"a mesh in the format {kind}, of a closed surface")
    size = float(np.ptp(mesh.vertices, axis=0).max())
    if not (math.isfinite(size) and size > 0.0):
        raise InvalidInput(kind, name, "a mesh of finite size")
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    mesh.update_faces(mesh.nondegenerate_faces())
    mesh.update_faces(_unpaired(np.asarray(mesh.faces)))
    mesh.remove_unreferenced_vertices()
    if not (mesh.is_watertight or _is_balanced(np.asarray(mesh.faces))):
        raise InvalidInput(kind, Described("a surface with holes"), "a closed surface", file=name)
    return mesh


def _unpaired(faces: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which faces remain without pairs that face each other, where two parts touch flush."""
    corners = np.sort(faces, axis=1)
    _, numbers, counts = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    return np.asarray(counts[numbers.ravel()] % 2 == 1)


def _is_balanced(faces: NDArray[np.int64]) -> bool:
    """Return whether every edge of faces has as many on one side as on the other: then they are
    closed surfaces, which may touch along edges.
    """
    starts = faces.ravel()
    ends = np.roll(faces, -1, axis=1).ravel()
    sense = np.where(starts < ends, 1, -1)
    edges = np.stack([np.minimum(starts, ends), np.maximum(starts, ends)], axis=1)
    _, numbers = np.unique(edges, axis=0, return_inverse=True)
    return not np.bincount(numbers.ravel(), sense).any()


def _directions(mesh: Any, axis: str | None) -> list[Vectors]:
    """Return possible directions of the axis: the stated one, or coordinate and principal axes."""
    unit = np.eye(3)
    if axis is not None:
        return [unit["xyz".index(axis)]]
    principal = np.linalg.eigh(mesh.moment_inertia)[1].T
    upwards = [
        vector * np.sign(vector[np.abs(vector).argmax()])
        for vector in principal
        if np.sort(np.abs(vector))[1] > ALIKE  # no coordinate axis
    ]
    return [unit[2], unit[1], unit[0], *upwards]


def _origins(mesh: Any, direction: Vectors, size: float) -> list[Vectors]:
    """Return possible points of the axis: the origin if it is near, and the centre of mass."""
    center = np.asarray(mesh.center_mass)
    from_axis = center - (center @ direction) * direction
    offset = np.linalg.norm(from_axis) / size
    return [np.zeros(3)] * bool(offset <= NOT_ROUND) + [from_axis] * bool(offset > ALIKE)


class _Surface:
    """Closed surface in cylindrical coordinates about an axis."""

    def __init__(self, mesh: Any, origin: Vectors, direction: Vectors, size: float) -> None:
        self.direction, self.size = direction, size
        helper = np.eye(3)[np.abs(direction).argmin()]
        first = np.cross(direction, helper)
        first /= np.linalg.norm(first)
        second = np.cross(direction, first)
        arms = np.asarray(mesh.vertices) - origin
        self.x, self.y, self.z = arms @ first, arms @ second, arms @ direction
        self.r, self.angle = np.hypot(self.x, self.y), np.arctan2(self.y, self.x)
        self.is_on_axis = self.r <= SAME * size
        self.faces = np.asarray(mesh.faces)
        self.parts = _parts(mesh)
        self.vertices = self.r + 1j * self.z
        self.vertices[self.is_on_axis] = 1j * self.z[self.is_on_axis]
        self.out_of_round, self.meridian = self._best_section()
        self.facet_depth = self._facet_depth(np.asarray(mesh.edges_unique))

    def _best_section(self) -> tuple[float, list[Line]]:
        """Return the least deviation of the vertices from a section, and the lines of that
        section.
        """
        angles = np.sort(self.angle[~self.is_on_axis])
        chosen = angles[np.linspace(0, len(angles) - 1, HALF_PLANES).astype(int)] + SLIVER
        sections = [lines for lines in map(self._section, chosen.tolist()) if lines]
        # One vertex of a ring is enough.
        places = self._distinct(self.vertices)

        def apart(lines: list[Line]) -> float:
            return float(np.min([_distances(places, line)[0] for line in lines], axis=0).max())

        deviations = [(apart(lines), k) for k, lines in enumerate(sections)]
        least, best = min(deviations, default=(math.inf, 0))
        return (least, sections[best]) if deviations else (math.inf, [])

    def _distinct(self, places: Line) -> Line:
        """Return places without those that are close to others."""
        _, numbers = np.unique(np.round(places / (SAME * self.size)), return_index=True)
        return places[numbers]

    def _facet_depth(self, edges: NDArray[np.int64]) -> float:
        """Return the largest distance of the middles of edges from the meridian."""
        if not self.meridian:
            return math.inf
        some = edges[:: max(1, len(edges) // MOST_FACETS)]
        x, y, z = (0.5 * (of[some[:, 0]] + of[some[:, 1]]) for of in (self.x, self.y, self.z))
        middles = self._distinct(np.hypot(x, y) + 1j * z)
        return float(np.min([_distances(middles, line)[0] for line in self.meridian], axis=0).max())

    def _section(self, angle: float) -> list[Line]:
        """Return the lines in which the half-plane at an angle cuts the surface."""
        aside = np.mod(self.angle - angle + math.pi, math.tau) - math.pi
        is_left = aside > 0.0
        corners = is_left[self.faces]
        is_crossed = corners.any(axis=1) & ~corners.all(axis=1)
        is_crossed |= self.is_on_axis[self.faces].any(axis=1)
        graph: dict[Any, list[Any]] = {}
        places: dict[Any, complex] = {}
        crossed = zip(self.faces[is_crossed].tolist(), self.parts[is_crossed].tolist(), strict=True)
        for face, part in crossed:
            nodes: list[Any] = []
            for first, second in combinations(sorted(face), 2):
                place = self._crossing(first, second, aside)
                if place is not None:
                    nodes.append((part, first, second))
                    places[part, first, second] = place
            tips = [vertex for vertex in face if self.is_on_axis[vertex]]
            if len(nodes) == 1 and len(tips) <= 1:
                end = (part, *tips) if tips else (part, *face)
                places[end] = complex(self.vertices[tips[0]]) if tips else self._on_axis(face)
                nodes.append(end)
            if len(nodes) == 2:
                graph.setdefault(nodes[0], []).append(nodes[1])
                graph.setdefault(nodes[1], []).append(nodes[0])
        return [
            _without_repeats(np.array([places[n] for n in chain]), SAME * self.size)
            for chain in _chains(graph)
        ]

    def _crossing(self, first: int, second: int, aside: Vectors) -> complex | None:
        """Return the intersection of an edge with the half-plane; None if there is none."""
        if self.is_on_axis[first] or self.is_on_axis[second]:
            return None
        before, after = float(aside[first]), float(aside[second])
        if (before > 0.0) == (after > 0.0) or abs(before - after) >= math.pi:
            return None
        start, end = complex(self.vertices[first]), complex(self.vertices[second])
        if abs(before - after) <= WIDEST:
            return start + before / (before - after) * (end - start)
        # A long edge, such as one across a flat end, is a chord.
        y, y_end = start.real * math.sin(before), end.real * math.sin(after)
        x, x_end = start.real * math.cos(before), end.real * math.cos(after)
        share = y / (y - y_end)
        return complex(x + share * (x_end - x), start.imag + share * (end.imag - start.imag))

    def _on_axis(self, face: list[int]) -> complex:
        """Return the intersection of the axis with a triangle around it."""
        matrix = np.stack([self.x[face], self.y[face], np.ones(3)])
        shares = np.linalg.lstsq(matrix, np.array([0.0, 0.0, 1.0]), rcond=None)[0]
        return complex(0.0, float(shares @ self.z[face]))

    def through_vertices(self, line: Line) -> list[tuple[float, ...]]:
        """Return the points of a line of the meridian, moved onto the vertices along it."""
        distances, places = _distances(self.vertices, line)
        others = [
            _distances(self.vertices, second)[0] for second in self.meridian if second is not line
        ]
        is_nearest = np.all([distances <= second for second in others], axis=0) if others else True
        is_nearest &= distances <= self.out_of_round + SAME * self.size
        order = np.argsort(places[is_nearest], kind="stable")
        along, points = places[is_nearest][order], self.vertices[is_nearest][order]
        is_new = np.append(True, np.diff(along) > SAME * self.size)
        groups = np.cumsum(is_new) - 1
        if groups[-1] > DENSE * len(line):
            # Vertices are scattered over the surface: take means of neighbours.
            length = float(np.abs(np.diff(line)).sum())
            bins = np.floor(along / length * 2.0 * len(line)).astype(int)
            groups = np.unique(bins, return_inverse=True)[1]
        counts = np.bincount(groups)
        means = (np.bincount(groups, points.real) + 1j * np.bincount(groups, points.imag)) / counts
        is_loop = line[0] == line[-1]
        ends = [] if is_loop else [complex(line[0]), complex(line[-1])]
        if ends:
            inner = means[
                (np.abs(means - ends[0]) > SAME * self.size)
                & (np.abs(means - ends[1]) > SAME * self.size)
            ]
            means = np.array([ends[0], *inner, ends[1]])
        else:
            means = np.append(means, means[:1])
        return [(float(point.real), float(point.imag)) for point in means]


def _parts(mesh: Any) -> NDArray[np.int64]:
    """Return for every face which closed surface it belongs to."""
    import trimesh  # noqa: PLC0415 - optional

    adjacent = mesh.face_adjacency
    label: Any = trimesh.graph.connected_component_labels
    labels = label(adjacent, node_count=len(mesh.faces))
    return np.asarray(labels)


def _distances(points: Line, line: Line) -> tuple[Vectors, Vectors]:
    """Return the distances of points from a line, and their places along it."""
    chords = np.diff(line)
    lengths = np.abs(chords)
    begins = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    best = np.full(len(points), np.inf)
    along = np.zeros(len(points))
    for start, chord, length, begin in zip(line, chords, lengths, begins, strict=False):
        gone = (points - start) / chord
        share = np.clip(gone.real, 0.0, 1.0)
        apart = np.abs(gone - share) * length
        is_closer = apart < best
        best[is_closer] = apart[is_closer]
        along[is_closer] = begin + length * share[is_closer]
    return best, along


def _chains(graph: dict[Any, list[Any]]) -> list[list[Any]]:
    """Return the paths of a graph whose nodes have one or two neighbours.

    A loop repeats its first node.
    """
    unvisited = dict(graph)
    chains = []
    while unvisited:
        start = next(
            (node for node, beside in unvisited.items() if len(beside) == 1), next(iter(unvisited))
        )
        chain, node = [start], start
        while True:
            beside = unvisited.pop(node)
            following = next((neighbour for neighbour in beside if neighbour in unvisited), None)
            if following is None:
                break
            chain.append(following)
            node = following
        if len(chain) > 2 and len(graph[start]) == 2:
            chain.append(start)
        chains.append(chain)
    return [chain for chain in chains if len(chain) > 2]


def _without_repeats(line: Line, within: float) -> Line:
    """Return the line without points close to their predecessors."""
    remaining = [line[0]]
    for point in line[1:-1]:
        if abs(point - remaining[-1]) > within and abs(point - line[-1]) > within:
            remaining.append(point)
    return np.array([*remaining, line[-1]])


def _volume(points: list[tuple[float, ...]]) -> float:
    """Return the volume that a line of straight edges encloses with the axis, or around it."""
    r, z = np.array(points).T
    return abs(float(np.diff(z) @ (r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2))) * math.pi / 3.0


def _area(points: list[tuple[float, ...]]) -> float:
    """Return the area between a line and the axis."""
    line = np.array(points)
    means = 0.5 * (line[1:, 0] + line[:-1, 0])
    return abs(float(means @ np.diff(line[:, 1])))
