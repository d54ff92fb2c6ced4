"""Launch of a top as users state it, validated."""

import math
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from tippetop.mechanics.vectors import Vector, add, cross, dot, scale
from tippetop.mechanics.view import PoleExact
from tippetop.support.errors import InvalidInput, is_number, within_part
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import number_in
from tippetop.support.validation import NO_WORD, NotNegative, Number, Padded, Part, Quantity

Tilt = Annotated[float, Field(ge=0, le=math.pi), NO_WORD]

LEANING = (
    "along the direction into which the axis leans",
    "90 degrees to the left of the direction into which the axis leans",
)


class Launch(Part):
    """Initial state of the top.

    Attributes
    ----------
    tilt
        Angle theta between the axis and the vertical, rad, in [0, pi].
    spin
        Axial spin omega3, rad/s.
    azimuth
        Direction phi into which the axis leans, rad.
    tilt_rate
        theta', rad/s.
    precession
        phi', rad/s.
    slip
        Slip velocity of the contact point, m/s: along the direction into which the axis leans, and
        90 degrees to the left of it. None beside a gap.
    gap
        Height of the lowest point above the table, m: more than 0 for a top that is dropped or
        thrown. Without a velocity its centre of mass is at rest.
    velocity
        Velocity of the centre of mass along x, y and z, m/s; it takes the place of `slip`. Of two
        numbers, or with 0 for the third, it is horizontal: a top on the table gets the vertical
        part that keeps contact. Any other third number is meant. Without a velocity the contact
        point of a top on the table moves with the slip velocity.

    Every number may be a text with a unit, such as "2200 rpm", or a quantity of pint.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.Launch(tilt=0.1, spin=155.0).slip
    (0.0, 0.0)
    >>> dropped = tt.Launch(tilt="5 deg", spin="2200 rpm", gap="1 cm")
    >>> round(dropped.spin, 2)  # rad/s
    230.38
    """

    tilt: Annotated[Tilt, Quantity("rad", "tilt of the axis at launch")]
    spin: Annotated[Number, Quantity("rad s-1", "axial spin at launch")]
    azimuth: Annotated[Number, Quantity("rad", "azimuth of the axis at launch")] = 0.0
    tilt_rate: Annotated[Number, Quantity("rad s-1", "rate of the tilt at launch")] = 0.0
    precession: Annotated[Number, Quantity("rad s-1", "precession at launch")] = 0.0
    slip: Annotated[
        tuple[Number, Number], Quantity("m s-1", "slip velocity at launch", LEANING)
    ] = (0.0, 0.0)
    gap: Annotated[NotNegative, Quantity("m", "height of the lowest point at launch")] = 0.0
    velocity: Annotated[
        tuple[Number, Number, Number] | None,
        Padded(2),
        Quantity(
            "m s-1", "velocity of the centre of mass at launch", ("along x", "along y", "along z")
        ),
    ] = None

    @model_validator(mode="after")
    def _moves_one_way(self) -> Self:
        if self.velocity is not None and self.slip != (0.0, 0.0):
            raise InvalidInput(
                "slip",
                self.slip,
                "0",
                "stands beside a velocity, which determines it",
                "leave out one",
            )
        if self.gap and self.slip != (0.0, 0.0):
            raise InvalidInput(
                "slip",
                self.slip,
                "0",
                "stands beside a gap, across which nothing slips",
                "write a velocity instead",
            )
        return self

    # translate: skip
    @classmethod
    def from_euler(
        cls,
        *,
        theta: Any,
        phi: Any = 0.0,
        theta_dot: Any = 0.0,
        phi_dot: Any = 0.0,
        psi_dot: Any = 0.0,
        **others: Any,
    ) -> Self:
        """Return the launch with given Euler angles and rates.

        Parameters
        ----------
        theta, phi
            Tilt and azimuth of the axis, rad.
        theta_dot, phi_dot, psi_dot
            Rates of tilt and precession, and of the rotation about the axis, rad/s. The axial spin
            is omega3 = psi' + phi' cos(theta).
        others
            Other fields of a launch: slip, gap, velocity.

        Examples
        --------
        >>> import tippetop as tt
        >>> tt.Launch.from_euler(theta="60 deg", phi_dot=10.0, psi_dot=100.0).spin
        105.0
        """
        rotation = number_in("psi_dot", psi_dot, "rad s-1")
        launch = cls(
            **others, tilt=theta, azimuth=phi, tilt_rate=theta_dot, precession=phi_dot, spin=0.0
        )
        if not is_number(rotation):
            raise InvalidInput("psi_dot", psi_dot, "a finite number")
        turn = launch.precession * math.cos(launch.tilt)
        return launch.model_copy(update={"spin": rotation + turn})

    # translate: skip
    def euler(self) -> dict[str, float]:
        """Return Euler angles and their rates, as `from_euler` takes them, rad and rad/s."""
        return {
            "theta": self.tilt,
            "phi": self.azimuth,
            "theta_dot": self.tilt_rate,
            "phi_dot": self.precession,
            "psi_dot": self.spin - self.precession * math.cos(self.tilt),
        }

    # translate: skip
    @classmethod
    def from_angular_velocity(
        cls,
        omega: Any,
        *,
        tilt: Any,
        azimuth: Any = 0.0,
        frame: Literal["table", "body"] = "table",
        **others: Any,
    ) -> Self:
        """Return the launch with a given angular velocity.

        Parameters
        ----------
        omega
            Its three components, rad/s.
        tilt, azimuth
            Tilt and azimuth of the axis, rad.
        frame
            "table": components along x, y and z. "body": along 1, 2 and 3 of the body, where 3 is
            its axis, 2 is horizontal, 90 degrees to the left of the direction into which the axis
            leans, and 1 = 2 x 3.
        others
            Other fields of a launch: slip, gap, velocity.

        Notes
        -----
        A vertical axis leans in no direction. If omega makes it lean, the azimuth of the launch is
        the direction into which it begins to lean, and the argument `azimuth` is ignored.

        Examples
        --------
        >>> import tippetop as tt
        >>> launch = tt.Launch.from_angular_velocity((0, 0, 100), tilt="60 deg")
        >>> round(launch.spin, 9), round(launch.precession, 9)
        (50.0, 100.0)
        """
        if frame not in FRAMES:
            raise not_one_of("frame", frame, FRAMES)
        launch = cls(**others, tilt=tilt, azimuth=azimuth, spin=0.0)
        first, second, third = launch.frame
        components = _components(omega)
        if frame == "table":
            components = (dot(components, first), dot(components, second), dot(components, third))
        across, tilt_rate, spin = components
        rates = {"tilt_rate": tilt_rate, "spin": spin}
        sine = PoleExact(math).sin(launch.tilt)
        if sine:
            rates["precession"] = -across / sine
        elif across or tilt_rate:
            # The axis moves by omega x n.
            x, y, _ = cross(add(scale(across, first), scale(tilt_rate, second)), third)
            rates["tilt_rate"] = math.copysign(math.hypot(x, y), third[2])
            rates["azimuth"] = math.atan2(y, x)
        return launch.model_copy(update=rates)

    # translate: skip
    def angular_velocity(self, frame: Literal["table", "body"] = "table") -> Vector:
        """Return the angular velocity, rad/s, in a frame of `from_angular_velocity`."""
        if frame not in FRAMES:
            raise not_one_of("frame", frame, FRAMES)
        components = (-self.precession * PoleExact(math).sin(self.tilt), self.tilt_rate, self.spin)
        if frame == "body":
            return components
        first, second, third = self.frame
        return add(
            add(scale(components[0], first), scale(components[1], second)),
            scale(components[2], third),
        )

    # translate: skip
    @property
    def frame(self) -> tuple[Vector, Vector, Vector]:
        """The directions 1, 2 and 3 of the body at launch, along the table's axes."""
        exact = PoleExact(math)
        sine, cosine = exact.sin(self.tilt), exact.cos(self.tilt)
        third = (sine * math.cos(self.azimuth), sine * math.sin(self.azimuth), cosine)
        second = (-math.sin(self.azimuth), math.cos(self.azimuth), 0.0)
        return cross(second, third), second, third


FRAMES = ("table", "body")
"""Frames in which the components of an angular velocity may be given."""


# translate: skip
def _components(omega: Any) -> Vector:
    """Return the three components of an angular velocity, rad/s; raise `InvalidInput` for
    others.
    """
    try:
        numbers = Quantity("rad s-1", "angular velocity").in_si(
            omega.tolist() if isinstance(omega, np.ndarray) else omega
        )
    except InvalidInput as error:
        raise within_part(error, "omega") from None
    listed = isinstance(numbers, list | tuple) and len(numbers) == 3
    if not listed or not all(is_number(number) for number in numbers):
        raise InvalidInput("omega", omega, "3 finite numbers")
    x, y, z = map(float, numbers)
    return x, y, z
