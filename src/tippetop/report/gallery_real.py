"""The figures of the section "Real tops": stems, an egg, a disk and two balls."""

from functools import partial

from tippetop.figures import real
from tippetop.report.experiments.real import EGG_MU, LEINE_WINDOW, REACH, STEM_WINDOW
from tippetop.report.plate import plate

SECTION = "Real tops"

_plate = partial(plate, section=SECTION)

PLATES = (
    _plate(
        "real-leine",
        "Onto the stem and back",
        "Tilt of the top of Leine and Glocker, Eur. J. Mech. A/Solids 22 (2003) 193, with the stem that they "
        f"give it, for {LEINE_WINDOW:g} s: 180 rad/s, mu = 0.3, a patch of 0.5 mm. The stem strikes, the "
        "top rises on it, drills its spin away, falls back, and rocks from one surface to the other, ever "
        "faster, until both touch (shaded).",
        real.leine_figure,
        finding="A top with a stem rises onto it, loses its spin by drilling, falls back, and rests on both.",
    ),
    _plate(
        "real-stepping",
        "What a time-stepping method misses",
        "The same top by Moreau's time-stepping, with the friction of an ellipsoidal limit surface, at "
        "several steps. a, tilt while it rocks: the dashed line is an exact run. b, how far from it four "
        "instants are.",
        real.stepping_figure,
        finding="A fixed step rests on both surfaces too early: it misses the strikes of the rocking.",
    ),
    _plate(
        "real-stems",
        "Which stems the report's top can stand on",
        "The report's top, launched as in its Fig. 4, with stems that end in spheres of several radii, their "
        f"ends {1e3 * REACH:g} mm above the centre of mass. a, its tilt after {STEM_WINDOW:g} s: pi is "
        "upright on the stem. b, Jellett's integral about the tip as this first touches, over the least "
        "with which a top stands on it.",
        real.stems_figure,
        finding="Whether a top can stand on its stem is decided by Jellett's integral when the stem strikes.",
    ),
    _plate(
        "real-egg",
        "The egg that rises",
        "A hard-boiled egg, a spheroid of 44 by 56 mm, is spun on its side about the vertical, on viscous "
        f"friction of {EGG_MU:g} s/m. Dots: where it first leaves the table.",
        real.egg_figure,
        finding="A hard-boiled egg that is spun fast stands up on its end, and leaves the table on its way.",
    ),
    _plate(
        "real-rolling",
        "Euler's disk and hurricane balls",
        "How fast they go round while they roll with their centres at rest, by a closed formula that holds "
        "for every body of revolution, and in runs on dry friction. Dashed: a disk without thickness, "
        "Omega^2 = 4 g / (R sin(theta)).",
        real.rolling_figure,
        finding="One formula gives the rate at which disks and hurricane balls roll around their centres.",
    ),
)
"""The figures in the order of the page."""
