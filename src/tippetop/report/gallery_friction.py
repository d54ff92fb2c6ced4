"""The figures of the section "Friction": a point and a patch on dry friction."""

from functools import partial

from tippetop.figures import dry
from tippetop.report.experiments.dry import COHEN_STEP, SLIPPERY, SMOOTHED, SMOOTHED_SPIN, SPIN, TILT
from tippetop.report.experiments.patches import MAP_WINDOW, MU
from tippetop.report.experiments.patches import SPIN as COMPARED_SPIN
from tippetop.report.plate import plate

SECTION = "Friction"

_plate = partial(plate, section=SECTION)

PLATES = (
    _plate(
        "dry-rolling",
        "A point on dry friction rolls",
        "a, the least Coulomb friction coefficient that lets the report's top, set down without slip, "
        "roll: the largest ratio of friction and normal force on its way. On any more it never slips, "
        f"loses nothing and does not turn over. b, its tilt at {SPIN:g} rad/s and {TILT:g} rad on a "
        f"little more than that, and on mu = {SLIPPERY:g}: there it slips and sticks by turns, and rises.",
        dry.rolling_figure,
        finding="On dry friction of a point a top that is set down rolls for ever, and never turns over.",
    ),
    _plate(
        "dry-cohen",
        "Cohen's top: the steps turn it over",
        "Coulomb friction of mu = 0.3 at 100 rad/s, centre of mass at rest at launch: the data of Cohen, "
        "Am. J. Phys. 45 (1977) 12. The classical Runge-Kutta method with fixed steps follows the slip "
        f"through zero as if it went on. Orange: steps of {1e3 * COHEN_STEP:g} ms, as his. With shorter "
        "steps the top stays up for longer; exactly, it sticks and rolls.",
        dry.cohen_figure,
        finding="The inversion published for Coulomb friction in 1977 came from the length of the steps.",
    ),
    _plate(
        "dry-smoothed",
        "Smoothed friction never becomes dry",
        f"Coulomb friction of mu = {SMOOTHED:g}, smoothed below the slip speed eps, at {SMOOTHED_SPIN:g} "
        "rad/s: when the axis passes the horizontal. The time runs away as eps goes to zero: at any eps "
        "the top turns over if one waits, and on Coulomb's law itself it never does.",
        dry.smoothed_figure,
        finding="Dry friction turns a top over at any smoothing, and without it never: the limit misleads.",
    ),
    _plate(
        "dry-patch",
        "A patch that drills: too small, too large",
        "When the report's top turns over on Coulomb-Contensou friction (ellipsoidal limit surface, mu = "
        f"{MU:g}, tilt 0.1 rad), by the radius of its contact patch and its spin. Grey: not within "
        f"{MAP_WINDOW:g} s. Dashed: below this spin the upright spin is stable. A small patch creeps "
        "slowly; a large one drills the spin away before the top is over.",
        dry.patch_figure,
        finding="On dry friction a patch that drills turns a top over: not too small, not too large.",
    ),
    _plate(
        "dry-viscous",
        "Which viscous friction a patch stands for",
        "A patch that drills fast has the viscous coefficient mu / (rho omega) for little slip. a, when "
        "the axis passes the horizontal, for patches of as many radii, and for viscous friction; "
        f"{COMPARED_SPIN:g} rad/s. b, their ratio. The more friction, the less the slip that is needed "
        "and the better the likeness, until drilling takes the spin: points are missing where the top "
        "does not turn over.",
        dry.viscous_figure,
        finding="For slow slip a drilling patch amounts to the report's friction, with tens of s/m.",
    ),
)
"""The figures in the order of the page."""
