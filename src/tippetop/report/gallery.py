"""The figures: which experiments each is drawn from, how, and what to say under it."""

from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from tippetop.figures import flights, methods, runs, sweeps
from tippetop.figures.euler_angles import euler_angles_drawing
from tippetop.figures.model import model_drawing
from tippetop.figures.tippe_top import tippe_top_drawing
from tippetop.report.experiments.flights import FLIGHTS_WINDOW, MU, TILT
from tippetop.report.experiments.runs import likely_end
from tippetop.report.gallery_friction import PLATES as FRICTION
from tippetop.report.gallery_real import PLATES as REAL
from tippetop.report.gallery_why import PLATES as WHY
from tippetop.report.plate import Plate, plate
from tippetop.report.quoted import (
    ABNORMAL_SPIN,
    CRITICAL_SPINS,
    END_OF_FIG_5,
    ENERGY,
    ENERGY_TIME,
    EXPONENT,
    REVERSALS,
    STOP,
    TURNED_AT,
)

_CRITICAL = (float(CRITICAL_SPINS[0]), float(CRITICAL_SPINS[1]))


def _printed_times(figure: str) -> dict[str, Any]:
    """The times that the report prints for a figure, for its drawing."""
    times = tuple(float(time) for time in REVERSALS[figure])
    return {"reported_turn": float(TURNED_AT[figure]), "reported_reversals": times}


def _slow_launch(run: xr.Dataset) -> Figure:
    return runs.motion_figure(
        run,
        precession_limit=80.0,
        **_printed_times("fig05"),
        reported_end=(float(likely_end(run)["window"]), END_OF_FIG_5),
        zoom=(0.0, 1.6),
        inset=(0.12, 0.57, 0.34, 0.38),
    )


_BOTH = (
    "Orange, wide: the report's method, its equations with theta modulo pi by ode45 at default tolerances. "
    "Blue, thin: converged. Where swings are too fast to be seen, a band shows from where to where they go. "
)

PLATES: dict[str, Plate] = {
    one.id: one
    for one in (
        Plate(
            "fig01",
            "Figure 1: the tippe top",
            "A ball cut flat, with a stem on the cut. The centre of mass (CM) lies below the centre of the "
            "ball while the toy is upright, and higher when it spins on its stem: the spin pays for the "
            "climb.",
            (),
            lambda _: tippe_top_drawing(),
            section="1",
        ),
        Plate(
            "fig02",
            "Figure 2: the Euler angles",
            "The three turns that take the space axes x, y, z to the body axes X, Y, Z: about z, about the "
            "line of nodes N, and about Z.",
            (),
            lambda _: euler_angles_drawing(),
            section="2.1",
        ),
        Plate(
            "fig03",
            "Figure 3: the model",
            "A sphere whose centre of mass is off its centre O by alpha R along the axis 3. A is the point "
            "that touches the table, a the vector from the centre of mass to it.",
            (),
            lambda _: model_drawing(),
            section="2.2",
        ),
        plate(
            "fig04",
            "Figure 4: launch at 155 rad/s",
            _BOTH
            + "a, tilt, with 0.4 s drawn large. b, spin about the body's axis. c, precession, cut off: it "
            "has a peak whenever the axis passes close to the vertical; dots mark the two reversals between "
            "which it keeps its sense. d, slip speed of the point of contact. Squares: the times that the "
            "report prints.",
            runs.motion_figure,
            needs=("run-155",),
            zoom=(5.2, 5.6),
            **_printed_times("fig04"),
            section="3.1",
            finding="The main launch turns over: the report's method, and the converged motion.",
        ),
        plate(
            "fig05",
            "Figure 5: launch at 50 rad/s",
            _BOTH
            + "Panels as in Figure 4; the dot marks the last reversal of the precession. Squares: the times "
            "and the end that the report prints, this one where its method has it.",
            _slow_launch,
            needs=("run-50", "run-50-windows"),
            section="3.1",
        ),
        plate(
            "fig06",
            "Figure 6: final tilt against spin",
            "Tilt after 20 s. Dashed: the critical spins, the report's in orange, converged ones from the "
            "longest runs in blue. In the shaded range the table would have to pull within 20 s. If it does, "
            "as in the report, the launches end anywhere (grey); on a table that only pushes the top flies "
            "at times and falls back without rebound (green); the figure flights follows it to higher spins. "
            "The insets show the framed ends of the slope.",
            sweeps.final_tilt_figure,
            needs=("final-tilt-listing", "final-tilt", "critical-spins"),
            section="3.2",
            finding="Where launches end by their spin, with the two thresholds and the abnormal point.",
            reported=(*_CRITICAL, float(ABNORMAL_SPIN)),
        ),
        plate(
            "windows",
            "Critical spins and patience",
            "The critical spins read from runs of different length (settled: within 0.01 rad). The grey bar "
            "at 20 s spans what other meanings of settled give there, 0.001 to 0.1 rad. Dashed: the report.",
            sweeps.windows_figure,
            needs=("critical-spins",),
            section="3.2",
            finding="What the length of a run does to the critical spins that one reads from it.",
            reported=_CRITICAL,
        ),
        plate(
            "fig07",
            "Figure 7: flip time against friction",
            "a, the report's range, with fits of a power of mu by least squares and the correlation of the "
            "logarithms; the report does not say at which spin. b, three decades of friction: the curve is "
            "level where the time goes as 1/mu. The jumps come from the definition of the flip time, the "
            "gaps from runs on a table that pulls that became singular.",
            sweeps.flip_time_figure,
            needs=("flip-times", "flip-times-wide"),
            section="3.3",
            reported=float(EXPONENT),
        ),
        plate(
            "fig08",
            "Figure 8: mu = 100 s/m",
            _BOTH + "The spin is not given in the report; 155 rad/s here.",
            runs.tilt_figure,
            needs=("run-mu-100",),
            zoom=(12.8, 13.8),
            section="3.3",
        ),
        plate(
            "fig09",
            "Figure 9: launch at 175 rad/s",
            _BOTH
            + "From the dashed line on the table has to pull, which no table does; neither of these curves "
            "is physical there, and the two drift apart. Green: what happens on a table that only pushes, "
            "with impacts that do not rebound. The top flies (shaded), and still turns over.",
            runs.tilt_figure,
            needs=("run-175",),
            zoom=(5.3, 5.8),
            inset=(0.6, 0.52, 0.38, 0.44),
            section="4",
        ),
        plate(
            "fig10",
            "Figure 10: energy at 175 rad/s",
            "Orange: the report's energy (4.1), which leaves out slip, along its own motion. Blue: the full "
            "energy along the converged one. It rises only where the normal force is negative, for then "
            "friction drives the slip. Green: on a table that only pushes it falls while the top slides and "
            "in impacts, and is kept in flight (shaded).",
            runs.energy_figure,
            needs=("run-175",),
            reported=(float(ENERGY_TIME), float(ENERGY)),
            section="4",
        ),
        plate(
            "fig11",
            "Figure 11: normal force at 175 rad/s",
            _BOTH
            + "In the range shaded below zero the table would have to pull. Green: on a table that only "
            "pushes the force is zero in flight and never negative; impulses of impacts are not drawn.",
            runs.force_figure,
            needs=("run-175",),
            section="4",
        ),
        plate(
            "fig12",
            "Figure 12: 175 rad/s, stopped before flight",
            _BOTH
            + "a, tilt; b, normal force about the lift-off; both instants are dashed. The converged run ends "
            "where the force falls through zero; the report's, where it chose to stop, after its own force "
            "had. Green: there is no need to stop; the top hops (shaded) and turns over.",
            runs.stopped_figure,
            needs=("run-175",),
            reported_stop=float(STOP),
            section="4",
            finding="Where the report stops, where the top leaves the table, and how it goes on.",
        ),
        plate(
            "fig13",
            "Figure 13: launch at 10 rad/s",
            _BOTH + "The first 3 s of 20 s, on a scale of their own.",
            runs.upright_figure,
            needs=("run-10",),
            section="Appendix C",
        ),
        plate(
            "fig14",
            "Figure 14: launch at 90 rad/s",
            _BOTH,
            runs.tilt_figure,
            needs=("run-90",),
            zoom=(5.5, 6.0),
            section="Appendix C",
        ),
        plate(
            "fig15",
            "Figure 15: launch at 120 rad/s",
            _BOTH,
            runs.tilt_figure,
            needs=("run-120",),
            zoom=(5.5, 6.0),
            section="Appendix C",
        ),
        plate(
            "fig16",
            "Figure 16: launch at 150 rad/s and theta = pi/4",
            _BOTH
            + "From the dashed line on the table has to pull at times. Green: on a table that only pushes; "
            "flights are shaded.",
            runs.tilt_figure,
            needs=("run-150-pi-4",),
            zoom=(5.5, 6.0),
            section="Appendix C",
        ),
        plate(
            "onset-mu",
            "Lift-off against spin and friction",
            f"Every dot is a launch at a tilt of {TILT:g} rad; colored ones leave the table, hollow ones do "
            "not, not even in the longer time. The onset is the first spin of a column that leaves the "
            "table, refined by halving the step; below it only the dots are known to stay. On a slippery "
            "table all takes longer, and 20 s are too short to see the lift-off. Square: the report's.",
            flights.onset_figure,
            section="4",
            finding="From which spin on a launch leaves the table, whatever the friction.",
            over="mu",
            reported=float(ABNORMAL_SPIN),
        ),
        plate(
            "onset-tilt",
            "Lift-off against spin and tilt",
            f"The same for different tilts at launch, mu = {MU:g} s/m, within 20 s. Of tops launched lying "
            "down none of the scan leaves the table.",
            flights.onset_figure,
            section="4",
            finding="The same for launches at any tilt.",
            over="tilt",
            reported=float(ABNORMAL_SPIN),
        ),
        plate(
            "flights",
            "What becomes of the abnormal point",
            "Launches on a table that only pushes, followed through all their flights for "
            f"{FLIGHTS_WINDOW:g} s. a, share of the time in the air. b, when the axis first passes the "
            "horizontal. c, number of flights. d, tilt at the end. The abnormal point is none of the top's: "
            "beyond it the top hops, for more of the time the faster it spins, and turns over later, but it "
            "does turn over.",
            flights.flights_figure,
            needs=("flights", "flights-bouncing"),
            section="4",
            finding="What the top does beyond the abnormal point: it hops, and the faster it spins the more.",
        ),
        plate(
            "order",
            "Order of accuracy",
            "Error against the length of the step, on the top for the method of Appendix B and for the "
            "formula inside ode45, and on an equation that depends on time for (B.1) as printed, which takes "
            "its last stage at the wrong time, and mended. The order is the slope, here between the two "
            "shortest steps.",
            methods.order_figure,
            section="Appendix B",
        ),
        plate(
            "stiffness",
            "What a stiff launch costs",
            "Evaluations of the right-hand side, those for Jacobians included, for the same stretch of "
            "motion at the report's tolerances.",
            methods.stiffness_figure,
            section="5",
        ),
        *WHY,
        *FRICTION,
        *REAL,
    )
}
"""Every figure by its name, in the order of the page."""
