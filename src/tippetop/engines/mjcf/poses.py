"""Positions and orientations of elements of MJCF."""

import math
from collections.abc import Mapping
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from tippetop.engines.mjcf.document import numbers
from tippetop.support.errors import InvalidInput

Array = NDArray[np.float64]

Quaternion = tuple[float, float, float, float]
"""Orientation, scalar first, of any length."""

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)

ORIENTATIONS = {"quat": 4, "axisangle": 4, "euler": 3, "xyaxes": 6, "zaxis": 3}
"""Attributes that state an orientation, and how many numbers they have."""


class AngleUnits(NamedTuple):
    """How a file states angles: the compiler's `angle` and `eulerseq`."""

    unit: float
    """Radians of the file's unit."""
    sequence: str
    """Axes of the three rotations of `euler`: small letters turn with the body."""

    @classmethod
    def of(cls, compiler: Mapping[str, str]) -> Self:
        """Return the angles of a compiler's attributes."""
        unit, sequence = compiler.get("angle", "degree"), compiler.get("eulerseq", "xyz")
        if unit not in ("degree", "radian"):
            raise InvalidInput("compiler.angle", unit, "degree or radian")
        if len(sequence) != 3 or not set(sequence) <= set("xyzXYZ"):
            raise InvalidInput("compiler.eulerseq", sequence, "three of the letters x, y, z")
        return cls(1.0 if unit == "radian" else math.pi / 180.0, sequence)


def product(p: Quaternion, q: Quaternion) -> Quaternion:
    """Return the rotation q followed by p."""
    a, b, c, d = p
    w, x, y, z = q
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


def inverse(q: Quaternion) -> Quaternion:
    """Return the inverse rotation."""
    w, x, y, z = q
    return (w, -x, -y, -z)


def matrix(q: Quaternion) -> Array:
    """Return the matrix of a rotation."""
    w, x, y, z = q
    rows = [
        [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    return np.array(rows) / (w * w + x * x + y * y + z * z)


def about(axis: Array, angle: float) -> Quaternion:
    """Return the rotation about an axis of any length."""
    x, y, z = math.sin(0.5 * angle) * np.asarray(axis) / float(np.linalg.norm(axis))
    return (math.cos(0.5 * angle), float(x), float(y), float(z))


def onto(direction: Array) -> Quaternion:
    """Return the shortest rotation of the z axis onto a direction of any length."""
    x, y, z = map(float, direction)
    if x == y == 0.0:
        return IDENTITY if z > 0.0 else (0.0, 1.0, 0.0, 0.0)
    return about(np.array([-y, x, 0.0]), math.atan2(math.hypot(x, y), z))


class Pose(NamedTuple):
    """Place and orientation of a frame in another."""

    position: Array
    orientation: Quaternion

    def of(self, inner: "Pose") -> "Pose":
        """Return the pose, in the outer frame, of what has a pose in this frame."""
        return Pose(
            self.position + matrix(self.orientation) @ inner.position,
            product(self.orientation, inner.orientation),
        )


ORIGIN = Pose(np.zeros(3), IDENTITY)


def pose_of(attributes: Mapping[str, str], field: str, angles: AngleUnits) -> Pose:
    """Return the pose that an element's attributes state."""
    position = numbers(attributes, "pos", field, (3,)) or (0.0, 0.0, 0.0)
    return Pose(np.array(position), orientation_of(attributes, field, angles))


def orientation_of(attributes: Mapping[str, str], field: str, angles: AngleUnits) -> Quaternion:
    """Return the orientation that an element's attributes state; the identity without any."""
    stated = [name for name in ORIENTATIONS if name in attributes]
    if len(stated) > 1:
        raise InvalidInput(
            f"{field}.{stated[1]}",
            attributes[stated[1]],
            "",
            f"is beside {stated[0]}, which states the same",
            "leave out one",
        )
    if not stated:
        return IDENTITY
    (name,) = stated
    values = numbers(attributes, name, field, (ORIENTATIONS[name],)) or ()
    if not any(values) and name != "euler":
        raise InvalidInput(f"{field}.{name}", attributes[name], "", "states no direction")
    match name:
        case "quat":
            w, x, y, z = values
            return (w, x, y, z)
        case "axisangle":
            return about(np.array(values[:3]), values[3] * angles.unit)
        case "zaxis":
            return onto(np.array(values))
        case "xyaxes":
            return _of_axes(np.array(values[:3]), np.array(values[3:]))
    turned = IDENTITY
    for letter, angle in zip(angles.sequence, values, strict=True):
        turn = about(np.eye(3)["xyz".index(letter.lower())], angle * angles.unit)
        turned = product(turned, turn) if letter.islower() else product(turn, turned)
    return turned


def _of_axes(x: Array, y: Array) -> Quaternion:
    """Return the orientation of a frame with these x and y axes; y is made orthogonal to x."""
    x = x / np.linalg.norm(x)
    y = y - (y @ x) * x
    y = y / np.linalg.norm(y)
    z_turn = onto(np.cross(x, y))
    # What is left is a rotation about the frame's z axis.
    x_inside = matrix(inverse(z_turn)) @ x
    return product(z_turn, about(np.array([0.0, 0.0, 1.0]), math.atan2(x_inside[1], x_inside[0])))
