"""A problem from MJCF: one free body of revolution on one plane."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.mjcf.document import Document, numbers
from tippetop.engines.mjcf.geoms import Geom
from tippetop.engines.mjcf.model import MjcfModel
from tippetop.engines.mjcf.poses import Pose, Quaternion, inverse, matrix, product
from tippetop.engines.mjcf.surfaces import Turned, friction_of, turned_body
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.files import made_of, path_of, read_text
from tippetop.support.suggestions import not_one_of

Array = NDArray[np.float64]

ROUNDING = 1e-12
"""Part of a body's size, and of its speeds, below which a gap or slip at launch is rounding: an
orientation of 17 digits leaves 1e-15, and no file means less than the bound.
"""


def read_mjcf(path: Path | str, keyframe: str | None = None) -> tt.Problem:
    """Read a problem from MJCF, the XML of MuJoCo: one free body of revolution on a plane.

    Spheres, ellipsoids, cylinders and capsules on one axis are the surface; geoms that touch
    nothing count by their mass. Default classes, all ways to state an orientation, `frame`, bodies
    fixed to the free one, contact pairs and masks are understood; friction, of both geoms the
    larger, acts in as many dimensions as `condim` says. Contact is rigid: `solref`, `solimp`,
    `impratio` and the other numbers of the solver are not read.

    Parameters
    ----------
    path
        The file.
    keyframe
        Name of the keyframe of the launch; by default the first one, and without any the pose of
        the body at rest.

    Raises
    ------
    FileTrouble
        If the file cannot be read.
    InvalidInput
        If it is no MJCF, or has anything that a problem cannot state, which is named.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem = tt.presets.report_problem().replace({"friction.kind": "coulomb"})
    >>> path = tt.write_mjcf(problem, "top_to_read.xml")
    >>> tt.read_mjcf(path).body == problem.body
    True
    """
    place = path_of(path)
    text = read_text(place, "MJCF, the XML of MuJoCo")
    with made_of(place, replaced=("keyframe",)):
        return problem_of_mjcf(text, keyframe)


def problem_of_mjcf(text: str, keyframe: str | None = None) -> tt.Problem:
    """Return the problem of an MJCF text; `read_mjcf` says what is read and raised."""
    document = Document.of(text)
    model = MjcfModel(document)
    top, pose = model.top()
    table, touching = model.table(top)
    turned = turned_body(touching, model.mass(top))
    friction, rolling = friction_of(turned.pair)
    state = _state_in(document, keyframe, pose)
    launch, (gravity, slope) = _launch(turned, state, table), _gravity(document, table)
    try:
        return tt.Problem(
            body=turned.body,
            friction=friction,
            launch=launch,
            gravity=gravity,
            rolling_resistance=rolling,
            table=slope,
        )
    except InvalidInput as error:
        if error.field != "friction.patch_radius":
            raise
        raise InvalidInput(
            "friction",
            Described(f"drilling friction of {turned.pair.friction[1]:g} m"),
            "",
            f"needs a patch of radius {error.value:.3g} m, larger than the body",
            'write a smaller second number of friction, or condim="3"',
        ) from None


def _gravity(document: Document, table: Geom) -> tuple[float, tt.Table]:
    """Return gravity, m/s^2, and the table with the slope that its direction stands for."""
    stated = numbers(document.settings("option"), "gravity", "option", (3,)) or (0.0, 0.0, -9.81)
    x, y, up = map(float, matrix(table.pose.orientation).T @ np.array(stated))
    along = math.hypot(x, y)
    if not up < 0.0:
        shown = " ".join(f"{part:g}" for part in stated)
        raise InvalidInput(
            "option.gravity", Described(shown), "a vector that points into the plane"
        )
    if along <= -ROUNDING * up:
        return -up, tt.Table()
    slope = tt.Table(slope=math.atan2(along, -up), azimuth=math.atan2(y, x))
    return math.hypot(along, up), slope


class _FreeState(NamedTuple):
    """State of a free joint: the pose of the body's frame, and its velocities."""

    pose: Pose
    velocity: Array
    """Of the frame's origin, in the world's frame, m/s."""
    omega: Array
    """In the body's frame, rad/s."""


def _state_in(document: Document, keyframe: str | None, pose: Pose) -> _FreeState:
    """Return the state of a keyframe: that of this name, or the first; at rest without any."""
    keys = [key for key in document.parts("keyframe") if key.tag == "key"]
    if keyframe is not None:
        named = [key for key in keys if key.get("name") == keyframe]
        if not named:
            raise not_one_of("keyframe", keyframe, [key.get("name", "") for key in keys])
        keys = named
    if not keys:
        return _FreeState(pose, np.zeros(3), np.zeros(3))
    field = f"key '{keys[0].get('name', '')}'"
    place = numbers(keys[0].attrib, "qpos", field, (7,))
    if place is not None:
        w, x, y, z = place[3:]
        if not any(place[3:]):
            raise InvalidInput(f"{field}.qpos", keys[0].get("qpos"), "", "states no orientation")
        pose = Pose(np.array(place[:3]), (w, x, y, z))
    rates = np.array(numbers(keys[0].attrib, "qvel", field, (6,)) or 6 * (0.0,))
    return _FreeState(pose, rates[:3], rates[3:])


def _launch(turned: Turned, state: _FreeState, table: Geom) -> tt.Launch:
    """Return the launch of a body in a state of its free joint."""
    centered = state.pose.of(Pose(turned.center, turned.axis))
    to_table = matrix(table.pose.orientation).T
    orientation = product(inverse(table.pose.orientation), centered.orientation)
    tilt, azimuth, rotation = _euler_angles(orientation)
    across, left_of, along = map(float, matrix(inverse(turned.axis)) @ state.omega)
    turn = (
        math.cos(rotation) * across - math.sin(rotation) * left_of,
        math.sin(rotation) * across + math.cos(rotation) * left_of,
        along,
    )
    launch = tt.Launch.from_angular_velocity(turn, tilt=tilt, azimuth=azimuth, frame="body")
    away = matrix(state.pose.orientation) @ turned.center
    omega = matrix(state.pose.orientation) @ state.omega
    velocity = to_table @ (state.velocity + np.cross(omega, away))
    height = float((to_table @ (centered.position - table.pose.position))[2])
    return _standing(turned.body, launch, height, velocity)


def _euler_angles(orientation: Quaternion) -> tuple[float, float, float]:
    """Return tilt, azimuth and rotation about the axis; the azimuth of a vertical axis is 0."""
    w, x, y, z = orientation
    across, upright = math.hypot(x, y), math.hypot(w, z)
    tilt = 2.0 * math.atan2(across, upright)
    if not across:
        return 0.0, 0.0, 2.0 * math.atan2(z, w)
    if not upright:
        return math.pi, 0.0, 2.0 * math.atan2(x, y)
    return tilt, math.atan2(y * z - w * x, x * z + w * y), math.atan2(y * z + w * x, w * y - x * z)


def _standing(body: tt.Body, launch: tt.Launch, height: float, velocity: Array) -> tt.Launch:
    """Return a launch with its gap, and with its slip on the table or its velocity.

    `height` is that of the centre of mass above the table, m.
    """
    touching = tt.Problem(body=body, friction=tt.ViscousFriction(mu=0.0), launch=launch)
    start = touching.start()
    size = float(start.height)
    gap = height - size
    if gap < -ROUNDING * size:
        raise InvalidInput(
            "pos",
            Described(f"the height of the launch, {height:.6g} m,"),
            f"{size:.6g} m for the centre of mass, or more",
            f"is {-gap:.3g} m inside the table",
        )
    if gap > ROUNDING * size:
        return launch.model_copy(update={"gap": gap, "velocity": _plain(velocity)})
    relative = velocity - np.array([float(part) for part in start.velocity])
    speeds = size * math.hypot(*launch.angular_velocity()) + float(np.linalg.norm(velocity))
    relative[np.abs(relative) <= ROUNDING * speeds] = 0.0
    if relative[2]:
        return launch.model_copy(update={"velocity": _plain(velocity)})
    c, s = math.cos(launch.azimuth), math.sin(launch.azimuth)
    slip = (c * relative[0] + s * relative[1], c * relative[1] - s * relative[0])
    return launch.model_copy(update={"slip": (float(slip[0]), float(slip[1]))})


def _plain(vector: Array) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
