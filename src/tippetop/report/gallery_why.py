"""The figures of the section "Why": steady states, their stability, and the limit of weak friction."""

from functools import partial

from tippetop.figures import theory, theory_runs
from tippetop.report.experiments.runs import WINDOW
from tippetop.report.experiments.theory import LONG_RUN
from tippetop.report.experiments.theory_runs import DIAGNOSED_SPIN, SPIN
from tippetop.report.plate import plate
from tippetop.report.quoted import CRITICAL_SPINS
from tippetop.report.readings import SETTLED

SECTION = "Why"

_plate = partial(plate, section=SECTION)

PLATES = (
    _plate(
        "why-bifurcation",
        "Where it ends: the steady states",
        "Steady tilts against the spin. a, the report's top: upright, tilted and inverted states take over "
        "from each other at the two critical spins, and at every spin one of them is stable. b, the same top "
        "with less transverse inertia: between the fold and the first critical spin two states are stable, "
        f"and the launch decides. Circles and diamonds: ends of runs of {LONG_RUN:g} s, launched near "
        "upright and near inverted; the spin is that of a launch at 0.1 rad with the same lambda.",
        theory.bifurcation_figure,
        finding="Where every launch ends, from one conserved number and without a run.",
    ),
    _plate(
        "why-growth",
        "Why 20 s show other critical spins",
        "a, growth rates of small tilts about both vertical spins, which change sign at the critical spins; "
        "in the grey band they change by less than a factor e in 20 s. b and c, the critical spins that runs "
        "of 20 s show, against the least tilt that one tells from none: from growth rates alone, and read "
        "from runs. The report's values are drawn where they meet the line, for it "
        "names no least tilt. In c the line is a lower bound, because the time "
        "that the top takes to turn over is not counted.",
        theory.growth_figure,
        finding="Why 20 s show other critical spins than there are, from growth rates.",
        needs=("why-critical", "critical-spins"),
        reported=(float(CRITICAL_SPINS[0]), float(CRITICAL_SPINS[1])),
    ),
    _plate(
        "why-groups",
        "Which tops turn over",
        "All eccentric spheres by their inertia ratio and eccentricity. On the left of the first line the "
        "upright spin is stable at any speed, though at high speed another state is stable beside it; on the "
        "right of the last line the inverted spin never is. Dashed: both vertical spins change stability "
        "together. The report's top by its listing and by its Table 1, and that of Leine and Glocker, Eur. "
        "J. Mech. A/Solids 22 (2003) 193. The three groups are those of Ueda, Sasaki and Watanabe, SIAM J. "
        "Appl. Dyn. Syst. 4 (2005) 1159.",
        theory.groups_figure,
        finding="Which tops turn over at all, by their eccentricity and inertias.",
    ),
    _plate(
        "why-collapse",
        "Why the time goes as 1/mu",
        f"The tilt against mu t for launches at {SPIN:g} rad/s and 0.1 rad, on a linear (a) and a "
        "logarithmic scale (b). With less friction the runs fall onto one curve, that of the motion averaged "
        "over a nutation, which has no mu in it. It gives the limit of mu times the flip time without one "
        "full run.",
        theory_runs.collapse_figure,
        finding="Why the time goes as 1/mu: without friction as a scale, only mu t is left.",
    ),
    _plate(
        "why-exponent",
        "Where the law ends, and what the last 0.01 rad hide",
        f"a, mu times the time to turn over at {SPIN:g} rad/s, which the law keeps level, in four senses. "
        "With more friction the last oscillation about pi decays ever more slowly, and whether its first "
        f"swings miss or meet the {SETTLED:g} rad decides the flip time, which jumps. The first tilt of more "
        f"than a right angle is free of that. On the left, {WINDOW:g} s are too short for the report's "
        "definition. b, the local exponents.",
        theory_runs.exponent_figure,
        finding="Where that law ends, and what its definition of the flip time hides.",
    ),
    _plate(
        "why-balance",
        "Inside the main run: nutation and gyroscopic balance",
        f"The report's launch at {DIAGNOSED_SPIN:g} rad/s. a, the tilt, and the turning points between which "
        "a table that turned smooth at that instant would leave it. b, xi = I1 phi' cos(theta) - I3 omega3 "
        "in parts of the axial angular momentum at launch: the top climbs while xi is small, in gyroscopic "
        "balance. The peaks are passages of the axis close to the vertical.",
        theory_runs.balance_figure,
        finding="How the top climbs: nutation between turning points, in gyroscopic balance.",
        needs=("why-diagnostics",),
    ),
    _plate(
        "why-potential",
        "Inside the main run: the well that moves",
        "The effective potential of the tilt on a smooth table at six instants of the same run, with the "
        "energy (orange) and the tilt (dot). Friction lowers the energy and moves the well from upright to "
        "inverted, and the tilt goes along at its bottom. Every panel shows the same range of energies.",
        theory_runs.potential_figure,
        finding="The well that carries the tilt from upright to inverted.",
        needs=("why-diagnostics",),
    ),
)
"""The figures in the order of the page."""
