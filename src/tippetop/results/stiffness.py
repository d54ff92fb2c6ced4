"""A sentence for runs of too many steps: friction damps slip much faster than the body moves."""

from collections.abc import Sequence

import numpy as np

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import Segment
from tippetop.contact.transient import TransientMode
from tippetop.mechanics.natural_units import Units

EXAMINED = 64
"""Steps whose damping is computed: enough for a median, within milliseconds."""

ABOUT = 30.0
"""Step times damping up to which the two are about as short: explicit steps stay below 10, and
implicit ones, which damping does not bound, are often hundreds of times as long."""


def stiffness_sentence(segments: Sequence[Segment], units: Units) -> str:
    """Return a sentence that names the time in which friction damps slip, where most steps of the
    longest of a run's last segments of slip are about as short as that; else an empty one.
    """
    from tippetop.integrators.relief import STIFF, fastest_damping  # noqa: PLC0415 - slow to import

    longest = max(segments, key=lambda segment: segment.steps, default=None)
    if longest is None or not len(longest.solution.terms):
        return ""
    mode, solution = longest.mode, longest.solution
    moving = mode.contact_mode if isinstance(mode, TransientMode) else mode
    if not isinstance(moving, ContactMode):
        return ""
    count = len(solution.terms)
    examined = np.linspace(0, count - 1, min(count, EXAMINED)).astype(int)
    numbers = solution.terms[examined, : moving.motion.size, 0]
    damping = fastest_damping(moving.motion, moving.parameters, numbers)
    steps = np.diff(solution.knots)[examined]
    if not STIFF < np.median(steps * damping) <= ABOUT:
        return ""
    time = units.time / float(np.median(damping))
    return f"Reason: friction damps slip within {time:.1e} s, and the steps are about as short."
