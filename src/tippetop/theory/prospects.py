"""What a toy can be expected to do, from its body alone: does it turn over, and can it stand on its stem."""

from dataclasses import dataclass

from tippetop.bodies import Body, EccentricSphere, Shape, Sphere
from tippetop.frictions import ViscousFriction
from tippetop.mechanics.friction import ViscousLaw
from tippetop.mechanics.top import Top
from tippetop.problem import Launch, Problem
from tippetop.theory.groups import Group, classify
from tippetop.theory.steady import SteadyKind
from tippetop.theory.thresholds import CriticalSpins, critical_jellett, critical_spin, critical_spins


@dataclass(frozen=True)
class StemTest:
    """What it takes to stand on a stem: the inverted spin of the sphere at its tip holds above this.

    Attributes
    ----------
    jellett
        Jellett's integral about the tip, -L.a, kg m^3/s; inf if nothing is enough.
    spin
        The axial spin that goes with it when the axis is vertical, rad/s.
    """

    jellett: float
    spin: float


@dataclass(frozen=True)
class Prospects:
    """What is known of a toy that is launched on its sphere.

    Attributes
    ----------
    eccentricity
        alpha: how far the centre of mass is below the centre of the sphere, in radii.
    group
        How such eccentric spheres behave.
    critical_spins
        For launches at `tilt`, at rest in tilt, rad/s.
    tilt
        That tilt, rad.
    stem
        What it takes to stand on the sphere at the other end; None if there is none.
    """

    eccentricity: float
    group: Group
    critical_spins: CriticalSpins
    tilt: float
    stem: StemTest | None


def prospects(body: Body, shapes: list[Shape], gravity: float = 9.8, tilt: float = 0.1) -> Prospects | None:
    """What a toy can be expected to do; None if it does not lie on a sphere, below the centre of that.

    Parameters
    ----------
    body
        Its mass and moments of inertia.
    shapes
        Its surfaces, from the one it stands on upright to the one it stands on inverted.
    gravity
        Acceleration of gravity, m/s^2.
    tilt
        Tilt of the launches that are spoken of, rad.
    """
    match shapes[0]:
        case EccentricSphere() as sphere:
            pass
        case Sphere(radius=radius, center=center) if 0.0 < center < radius:
            sphere = EccentricSphere(radius=radius, eccentricity=center / radius)
        case _:
            return None
    problem = Problem(
        body=body.model_copy(update={"shape": sphere}),
        friction=ViscousFriction(mu=1.0),
        launch=Launch(tilt=tilt, spin=0.0),
        gravity=gravity,
    )
    group = classify(body.I1 / body.I3, sphere.eccentricity)
    spins = critical_spins(problem)
    return Prospects(sphere.eccentricity, group, spins, tilt, _stem(body, shapes[1:], gravity))


def _stem(body: Body, others: list[Shape], gravity: float) -> StemTest | None:
    if not others or not isinstance(others[-1], Sphere):
        return None
    top = Top(body.mass, body.I1, body.I3, others[-1].surface, ViscousLaw(1.0), gravity)
    inverted = SteadyKind.INVERTED
    return StemTest(critical_jellett(inverted, top), critical_spin(inverted, top))
