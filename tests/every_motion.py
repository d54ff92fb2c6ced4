"""Every motion of every mode, for every surface and friction law there is, and states to look at it
in.
"""

from typing import NamedTuple

import numpy as np

from tippetop.contact.contact_mode import ContactMode, mode_on_two, sliding_motion
from tippetop.contact.slip_end_mode import SlipEnd
from tippetop.integrators.base import Motion
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.contacts.slip_clock import SlipComponent
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzBranch, HertzDrillingLaw, HertzSlidingLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import RingSurface, SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top

BALL = SphereSurface(1.0, 0.3)
SURFACES = {
    "sphere": BALL,
    "spheroid": SpheroidSurface(1.0, 1.4, 0.1),
    "ring": RingSurface(1.0, 0.2, 0.1),
    "hull": Hull.of((BALL, SphereSurface(0.2, 1.5), RingSurface(0.5, -0.4, 0.1))),
}
SLIDING = {
    "viscous": ViscousLaw(0.7),
    "regularized": RegularizedCoulombLaw(0.4, 0.01),
    "coulomb": CoulombLaw(0.3),
    "ellipsoidal": EllipsoidalLaw(0.3, 0.02),
    "numbered": HertzBranch(0.3, 0.9, 1.0),
    "drilling": HertzDrillingLaw(0.3, 0.9),
    "slipping": HertzSlidingLaw(0.3, 0.9),
}
STICKING = {
    "coulomb": CoulombLaw(0.3),
    "ellipsoidal": EllipsoidalLaw(0.3, 0.02),
    "drilling": HertzDrillingLaw(0.3, 0.9),
    "slipping": HertzSlidingLaw(0.3, 0.9),
}


class Case(NamedTuple):
    """A motion, and parameters for it."""

    name: str
    motion: Motion
    parameters: tuple[float, ...]


def sliding_motions(top):
    """Every motion of a top in which it slips."""
    kind, numbers, surface, law, rolls = (
        top.kind,
        top.numbers,
        top.surface,
        top.friction,
        top.resists_rolling,
    )
    yield "sliding", sliding_motion(kind, True), numbers
    free, held = (ContactMode(top, prevents_rolling=still) for still in (False, True))
    ends = [SlipEnd.of(free, SlipComponent(slip=False))] if rolls else []
    if rolls:
        yield "held", sliding_motion(kind, True, held=True), numbers
    if is_set_valued(law):
        ends += [SlipEnd.of(mode, SlipComponent(slip=True)) for mode in (free, held)[: 1 + rolls]]
    for end in ends:
        yield end.form, end.motion, (*numbers, 1e9, 1e-3)
    if isinstance(surface, Hull):
        other = top._replace(number=1)
        statuses = {"": (False, False)}
        if isinstance(law, CoulombLaw):
            statuses |= {
                " turning": (True, False),
                " sticking": (True, True),
            }
        for way in (0.0, -1.0)[: 1 + rolls]:
            for told, sticks in statuses.items():
                mode = mode_on_two((top, other), way, sticks, sense=-1.0)
                yield f"two {way}{told}", mode.motion, mode.parameters
            if is_set_valued(law):
                end = SlipEnd.of(mode_on_two((top, other), way), SlipComponent(slip=True))
                parameters = (*end.contact_mode.parameters, 1e9, 1e-3)
                yield f"two {way} closing", end.motion, parameters


def sticking_motions(top):
    """Every motion of a top in which it sticks."""
    numbers, rolls = top.numbers, top.resists_rolling
    for held in (False, True)[: 1 + rolls]:
        mode = ContactMode(top, sticks=(True,), prevents_rolling=held)
        yield mode.status, mode.motion, numbers
    if rolls:
        end = SlipEnd.of(ContactMode(top, sticks=(True,)), SlipComponent(slip=False))
        yield "sticking closing", end.motion, (*numbers, 1e9, 1e-3)


CASES = [
    Case(f"{shape} {name} {mode}", motion, tuple(map(float, parameters)))
    for laws, motions in ((SLIDING, sliding_motions), (STICKING, sticking_motions))
    for shape, surface in SURFACES.items()
    for law_name, law in laws.items()
    for name, resistance in ((law_name, None), (f"{law_name} and rolling", RollingResistance(1e-3)))
    for mode, motion, parameters in motions(Top.of(1.0, 0.45, 0.38, surface, law, 1.0, resistance))
]


def states(motion, count):
    """Random numbers for a motion, the axis a unit vector, shape (count, size)."""
    found = np.random.default_rng(motion.size).normal(size=(count, motion.size))
    found[:, :3] /= np.linalg.norm(found[:, :3], axis=1, keepdims=True)
    return found


def everything(motion):
    """The rates of a motion and its guards as one function."""
    return lambda y, p: (*motion.rates(y, p), *[guard.value(y, p) for guard in motion.guards])
