"""A body on the rim of its face in its plane, by an integration that shares no code with runs."""

import math
from collections.abc import Sequence

from scipy.integrate import solve_ivp

import tippetop as tt


def time_to_tilt(
    body: tt.Body,
    tilt: float,
    *,
    mu: float = math.inf,
    rate: float = 0.0,
    gravity: float,
    slope: float = 0.0,
) -> float:
    """Return the time until a body on one edge, flat at first with some rate of tilt, has a tilt.

    It turns about the rim, which sticks under infinite friction, or slides on it, outwards all the
    time. With the horizontal way and the height of the centre of mass from the rim, x and z, and
    the normal force N,

        N = m (g + x theta'' - z theta'^2),     I1 theta'' = N (mu z - x).

    Parameters
    ----------
    body
        A body on one edge below its centre of mass.
    tilt, rate
        The tilt to reach, rad, and the rate of tilt at first, rad/s.
    mu, gravity, slope
        Coefficient of friction, m/s^2, and the slope down which it leans, rad.
    """
    (edge,) = body.shape if isinstance(body.shape, Sequence) else (body.shape,)
    radius, half = edge.radius, -edge.center
    east, down = gravity * math.sin(slope), gravity * math.cos(slope)

    def rates(_: float, y: Sequence[float]) -> list[float]:
        theta, speed = y
        across = radius * math.cos(theta) - half * math.sin(theta)
        height = radius * math.sin(theta) + half * math.cos(theta)
        if math.isinf(mu):
            about_rim = body.I1 + body.mass * (radius**2 + half**2)
            return [speed, body.mass * (height * east - across * down) / about_rim]
        arm = mu * height - across
        pressing = body.mass * (down - height * speed**2)
        return [speed, pressing * arm / (body.I1 - body.mass * across * arm)]

    def reached(_: float, y: Sequence[float]) -> float:
        return y[0] - tilt

    reached.terminal = True
    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, "events": reached}
    return float(solve_ivp(rates, (0.0, 5.0), [0.0, rate], **options).t_events[0][0])
