"""Every cause of a mode's end has a rule, and no rule is for anything else."""

from every_motion import CASES, SURFACES
from tippetop.contact.automaton import RULES
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.face_mode import SLOWED, STOPPED, FaceMode
from tippetop.contact.flight import Flight
from tippetop.contact.mode import COMPLETED, FAILURE, ModeEnd
from tippetop.contact.settling_flat import FLAT
from tippetop.contact.slip_end_motion import TIME
from tippetop.contact.slip_onset import ENDED, ONSET_OVER
from tippetop.contact.tip_onset import TILTED
from tippetop.contact.transient import AT_REST
from tippetop.integrators.base import Motion
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.laws.face_friction import UniformDiskLaw
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import MeridianSurface
from tippetop.mechanics.top import Top

NO_GUARDS = {COMPLETED, FAILURE, FLAT, STOPPED, TILTED, AT_REST, ENDED, ONSET_OVER}
"""Causes that modes name themselves."""


def causes(motion: Motion) -> set[str]:
    """The causes that its guards are."""
    state = State((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0)
    return {ModeEnd.by_guard(guard.name, state).cause for guard in motion.guards}


def test_the_rules_are_those_of_the_causes_that_modes_have() -> None:
    ball, dry = SURFACES["sphere"], CoulombLaw(0.3)
    tops = [Top.of(1.0, 0.45, 0.38, one, ViscousLaw(0.3), 1.0) for one in SURFACES.values()]
    nearly_stuck = ContactMode(Top.of(1.0, 0.45, 0.38, ball, dry, 1.0), near=True)
    on_ring = Top.of(1.0, 0.45, 0.38, SURFACES["ring"], dry, 1.0)
    on_face = FaceMode(on_ring, UniformDiskLaw)
    cut = MeridianSurface(0.0, 0.2, (1.0, 0.0), (-0.1,), (True, False))
    on_cut_ball = ContactMode(Top.of(1.0, 0.45, 0.38, cut, ViscousLaw(0.3), 1.0))
    modes = [*(Flight(top) for top in tops), nearly_stuck, on_face, on_cut_ball]
    motions = [*(case.motion for case in CASES), *(mode.motion for mode in modes)]
    named = set().union(*(causes(motion) for motion in motions))
    # The clock of a velocity that ends stops with the run, whose end the mode reports, and a stage
    # of the motion on a face is followed by the next one.
    assert named - {TIME, SLOWED} | NO_GUARDS == RULES.keys()
