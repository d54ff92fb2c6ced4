"""The published equations (2.8)-(2.15) in Euler angles: the reference model, singular where
sin(theta) = 0.

They are kept to check the others by and to redo what was done with them. They hold for the
eccentric sphere with viscous friction only.
"""

from collections.abc import Sequence

from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Functions, Scalar


def published_normal_force(y: Sequence[Scalar], top: Top, functions: Functions) -> Scalar:
    """Normal force g_n of equation (2.15), N, for y = (theta, theta', phi, phi', omega3, v_x,
    v_y).
    """
    parameters = published_parameters(top)
    return _normal_force(y, parameters, functions.sin(y[0]), functions.cos(y[0]))


def _normal_force(
    y: Sequence[Scalar], parameters: Sequence[Scalar], s: Scalar, c: Scalar
) -> Scalar:
    """Return the normal force from the parameters, and the sine and cosine of the tilt."""
    _, tilt_rate, _, precession, spin, slip_x, _ = y
    m, I1, I3, R, alpha, mu, g = parameters
    swinging = I1 * c * (precession**2 * s**2 + tilt_rate**2) - I3 * precession * spin * s**2
    friction = m * R**2 * alpha * s * (1.0 - alpha * c) * mu * slip_x
    return (m * g * I1 + m * R * alpha * swinging) / (I1 + m * R**2 * alpha**2 * s**2 - friction)


def published_rates(
    y: Sequence[Scalar],
    top: Top,
    functions: Functions,
    wrap: float | None = None,
    *,
    unilateral: bool = False,
) -> tuple[Scalar, ...]:
    """Time derivative of y = (theta, theta', phi, phi', omega3, v_x, v_y) by equations
    (2.8)-(2.15).

    Parameters
    ----------
    y
        Euler angles, rates and slip, SI.
    top
        An eccentric sphere with viscous friction.
    functions
        Where sin and cos come from.
    wrap
        When given, theta is replaced by theta modulo this number first, as the report's listing
        does with pi; the right-hand side then jumps wherever theta crosses a multiple of it.
    unilateral
        Whether a negative normal force is set to zero, as lines that the listing has commented out
        would (for numbers that can be compared).

    Notes
    -----
    Equation (2.9) is misprinted in the report (I1 stands in the numerator); its listing is right.
    """
    if wrap is not None:
        y = (y[0] % wrap, *y[1:])
    tilt, tilt_rate, _, precession, spin, slip_x, slip_y = y
    parameters = published_parameters(top)
    m, I1, I3, R, alpha, mu, _ = parameters
    s, c = functions.sin(tilt), functions.cos(tilt)
    normal = _normal_force(y, parameters, s, c)
    if unilateral and normal < 0:
        normal = 0.0
    friction_x, friction_y = mu * normal * slip_x, mu * normal * slip_y
    reach, offset = 1.0 - alpha * c, alpha - c
    return (
        tilt_rate,
        s / I1 * (I1 * precession**2 * c - I3 * spin * precession - R * alpha * normal)
        + R * friction_x * reach / I1,
        precession,
        (I3 * tilt_rate * spin - 2.0 * I1 * tilt_rate * precession * c - friction_y * R * offset)
        / (I1 * s),
        -friction_y * R * s / I3,
        R
        * s
        / I1
        * (
            precession * spin * (I3 * reach - I1)
            + normal * R * alpha * reach
            - I1 * alpha * (tilt_rate**2 + precession**2 * s**2)
        )
        - friction_x * (I1 + m * R**2 * reach**2) / (m * I1)
        + precession * slip_y,
        -friction_y * (I1 * I3 + m * R**2 * I3 * offset**2 + m * R**2 * I1 * s**2) / (m * I1 * I3)
        + spin * tilt_rate * R / I1 * (I3 * offset + I1 * c)
        - precession * slip_x,
    )


def published_energy(y: Sequence[Scalar], top: Top, functions: Functions) -> Scalar:
    """Energy (4.1) of the report, J: the true energy only while the slip velocity is zero."""
    tilt, tilt_rate, _, precession, spin, _, _ = y
    m, I1, I3, R, alpha, _, g = published_parameters(top)
    s, c = functions.sin(tilt), functions.cos(tilt)
    offset = alpha - c
    transverse = tilt_rate**2 + precession**2 * s**2
    rolling = offset**2 * transverse + s**2 * (
        tilt_rate**2 + spin**2 + 2.0 * spin * precession * offset
    )
    return (
        0.5 * m * R**2 * rolling
        + 0.5 * (I1 * transverse + I3 * spin**2)
        + m * g * R * (1.0 - alpha * c)
    )


def published_parameters(top: Top) -> tuple[Scalar, ...]:
    """(m, I1, I3, R, alpha, mu, g) of the published equations.

    Raises
    ------
    TypeError
        If the top is not an eccentric sphere with viscous friction.
    """
    surface, friction = top.surface, top.friction
    if not (isinstance(surface, SphereSurface) and isinstance(friction, ViscousLaw)):
        raise TypeError(
            "the published equations hold for an eccentric sphere with viscous friction only"
        )
    return (
        top.mass,
        top.transverse_inertia,
        top.axial_inertia,
        surface.radius,
        surface.center / surface.radius,
        friction.mu,
        top.gravity,
    )
