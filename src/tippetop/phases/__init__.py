"""The phases of a run as values: how the top moves in each, what ends it, and what comes next."""

from tippetop.phases.base import Event, EventKind, Outcome, Phase, PhaseKind, Stretch, Transition
from tippetop.phases.start import first_phase

__all__ = ["Event", "EventKind", "Outcome", "Phase", "PhaseKind", "Stretch", "Transition", "first_phase"]
