"""What is conserved, and what friction takes: the quantities every run is checked by."""

from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, dot


def energy(state: State, top: Top) -> Scalar:
    """Kinetic and potential energy, (m |r'|^2 + omega.L)/2 + m g z, J; zero at rest with z = 0."""
    omega = angular_velocity(state.axis, state.momentum, top)
    translation = top.mass * dot(state.velocity, state.velocity)
    return 0.5 * (translation + dot(omega, state.momentum)) + top.mass * top.gravity * state.height


def jellett(state: State, top: Top) -> Scalar:
    """Jellett's integral lambda = -L.a, kg m^3/s.

    Constant for a top that conserves it (`Top.conserves_jellett`), an eccentric sphere under
    friction without torque, because the moment a x F of the contact force is perpendicular to a,
    and the rate of a to L (Jellett 1872). A torque M of the table changes it at the rate -M.a.
    """
    return -dot(state.momentum, contact_vector(state.axis, top.surface))
