"""Account of a run: its launch, motion and end as clauses with a name and numbers.

`account_of` makes the clauses from the facts of a run and from the theory of its launch; it is
translated for the page. `tippetop.results.account_text.describe` collects the facts of a run. The
texts of the clauses are in one catalogue per language (`account_en.json` here, the part "account"
of `web/texts/de.json`).
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from tippetop.contact.mode import Event, EventKind, Status
from tippetop.mechanics.motion import angular_velocity, point_velocity
from tippetop.mechanics.surfaces.hull import Hull, acting, is_edge, lowest_surface
from tippetop.mechanics.surfaces.surface import POLE, contact_vector
from tippetop.mechanics.view import PoleExact
from tippetop.problem.problem import Problem, top_of
from tippetop.results.catalogue import LEANS_AT_LAUNCH, NEAR_FINAL, NEAR_POLE, RISE
from tippetop.results.metrics import came_down
from tippetop.results.settling import spins_for_ever
from tippetop.support.errors import InvalidInput
from tippetop.theory.prediction import Prediction, predicted
from tippetop.theory.slow_time import time_to_end
from tippetop.theory.steady import SteadyKind, SteadyState, is_neutral
from tippetop.theory.thresholds import CriticalSpins, stability_limits

POINT_LAWS = ("coulomb", "static_coulomb")
"""Kinds of dry friction at a point, which alone lets slip begin at rest."""

LEAST_SLIP = 1e-9
"""Slip at launch, m/s, below which it is rounding and not mentioned."""


class Facts(NamedTuple):
    """Facts of a run that its account uses, in SI."""

    problem: Problem
    status: Status
    metrics: Mapping[str, float]
    """Numbers of `tippetop.results.catalogue.METRICS`."""
    peak: tuple[float, float]
    """Largest tilt within the run, rad, and its time, s."""
    settling_time: float
    """Time since which the tilt stays near its final value, s; nan if it has not settled."""
    events: Sequence[Event]
    flights: Sequence[tuple[float, float]]
    """Begin and end of every flight, s."""


class Clause(NamedTuple):
    """Statement of an account."""

    name: str
    """Key of its text in the catalogues."""
    numbers: Mapping[str, float]
    """Numbers in SI, by the names of the placeholders in the text."""
    part: str
    """Part of the account: "launch", "motion", "end" or "theory"."""


def account_of(facts: Facts) -> list[Clause]:
    """Return the clauses of a run: of its launch, its motion, its end, and of theory."""
    if facts.status is Status.INACCURATE:
        return [_ended_early(facts)]
    return [*_launch(facts), *_motion(facts), *_end(facts), *_theory(facts)]


def predicted_end(problem: Problem) -> Prediction | None:
    """Return the steady states that a launch can end in; None if theory does not know them."""
    if problem.friction.vanishes:
        return None
    try:
        prediction = predicted(problem)
    except InvalidInput:
        return None
    return prediction if prediction.reachable else None


def predicted_spins(problem: Problem) -> CriticalSpins | None:
    """Return the critical spins of a launch; None if Jellett's integral is not conserved, or there
    are none.
    """
    if not top_of(problem).conserves_jellett or problem.friction.vanishes:
        return None
    try:
        return stability_limits(problem)
    except InvalidInput:
        return None


def _launch(facts: Facts) -> list[Clause]:
    """Return the clauses of the launch: in the air, with an impact, with slip or without."""
    problem = facts.problem
    if problem.launch.gap > 0.0:
        drop = Clause("drops", {"height": problem.launch.gap}, "launch")
        if not facts.events:
            return [drop, Clause("never_touches", {"duration": _end_time(facts)}, "motion")]
        return [drop, Clause("comes_down", {"time": facts.flights[0][1]}, "launch")]
    clauses = list[Clause]()
    struck = [event for event in facts.events if event.time == 0.0 and event.impulse > 0.0]
    if struck:
        lost = sum([event.energy_lost for event in struck])
        clauses.append(Clause("strikes_at_launch", {"energy": lost}, "launch"))
    speed = _slip_at_launch(problem)
    is_flat = _is_launched_flat(problem)
    if is_flat:
        clauses.append(Clause("starts_flat", {}, "launch"))
    if any(event.time == 0.0 and event.kind is EventKind.STICK for event in facts.events):
        return clauses  # the clauses of the motion say that it rolls
    if any(event.time == 0.0 and event.kind is EventKind.LIFT_OFF for event in facts.events):
        return clauses
    if speed > LEAST_SLIP:
        clauses.append(Clause("slips_at_launch", {"speed": speed}, "launch"))
    elif not struck and not is_flat:
        # Dry friction strong enough to hold the top would have made it stick at launch.
        name = "starts_to_slip" if problem.friction.kind in POINT_LAWS else "starts_without_slip"
        clauses.append(Clause(name, {}, "launch"))
    return clauses


def _slip_at_launch(problem: Problem) -> float:
    """Return the speed of the contact point at launch, m/s."""
    start, top = problem.start(), problem.standing()
    arm = contact_vector(start.axis, top.surface)
    turning = angular_velocity(start.axis, start.momentum, top)
    x, y, _ = point_velocity(start.velocity, turning, arm)
    return math.hypot(float(x), float(y))


def _motion(facts: Facts) -> list[Clause]:
    """Return the clauses of the motion in order of time.

    They are about passing the horizontal, flights, rocking, sticking and a fall.
    """
    clauses = list[Clause]()
    turned, final = facts.metrics["turnover_time"], facts.metrics["final_tilt"]
    ends_level = abs(final - 0.5 * math.pi) < NEAR_FINAL
    tilted = facts.problem.launch.tilt
    if tilted > 0.5 * math.pi and final < 0.5 * math.pi:
        clauses.append(Clause("falls_from_launch", {"tilt": tilted}, "motion"))
    elif math.isfinite(turned) and tilted < LEANS_AT_LAUNCH and not ends_level:
        stays_over = final > 0.5 * math.pi + RISE and facts.peak[0] - final < RISE
        name = "turns_over" if stays_over else "passes_the_horizontal"
        clauses.append(Clause(name, {"time": turned}, "motion"))
    clauses += _flights(facts)
    doubles = [event.time for event in facts.events if event.kind is EventKind.DOUBLE_CONTACT]
    if doubles:
        strikes = [
            event
            for event in facts.events
            if event.time <= doubles[0] and event.kind is EventKind.IMPACT
        ]
        name = "rocks" if len(strikes) > 2 else "touches_with_two"
        clauses.append(Clause(name, {"count": len(strikes), "time": doubles[0]}, "motion"))
    clauses += _onto_face(facts)
    sticks = _sticks_since(facts)
    if math.isfinite(sticks):
        name = "never_slips" if sticks == 0.0 else "sticks"
        clauses.append(Clause(name, {"time": sticks}, "motion"))
    highest, when = facts.peak
    if fell_back(facts):
        numbers = {"highest": highest, "time": when, "tilt": final}
        clauses.append(Clause("falls_back", numbers, "motion"))
    elif (
        not math.isfinite(sticks)
        and not facts.metrics["is_settled"]
        and highest - max(facts.problem.launch.tilt, final) > 2.0 * NEAR_POLE
    ):
        clauses.append(Clause("is_highest", {"highest": highest, "time": when}, "motion"))
    return [*sorted(clauses, key=_time_of), *_pulled(facts)]


def _pulled(facts: Facts) -> list[Clause]:
    """Return the clause that the table would have to pull, if it would."""
    force = facts.metrics["min_normal_force"]
    if facts.problem.contact.liftoff != "ignore" or force >= 0.0:
        return []
    return [Clause("is_pulled", {"force": -force}, "motion")]


def _time_of(clause: Clause) -> float:
    """Return the time of the event of a clause, s; 0 if it has none."""
    return clause.numbers.get("time", 0.0)


def is_jump(begin: float, problem: Problem) -> bool:
    """Return whether a flight begins on the table: that of a launch above it does not."""
    return begin > 0.0 or problem.launch.gap == 0.0


def _flights(facts: Facts) -> list[Clause]:
    """Return the clause of the jumps, if there are any."""
    jumps = [flight for flight in facts.flights if is_jump(flight[0], facts.problem)]
    clauses = list[Clause]()
    if jumps:
        name = "flies_once" if len(jumps) == 1 else "flies"
        numbers = {"count": len(jumps), "time": jumps[0][0]}
        clauses.append(Clause(name, numbers, "motion"))
    return clauses


TOLD_AT_EITHER_END = 3
"""How many of the first and of the last changes between a face and its rim are told: more would
hide the rest of the account.
"""


def _onto_face(facts: Facts) -> list[Clause]:
    """Return the clauses of rocking on the rim, of lying down on a face and of tipping over it.

    Of many the first and the last are told.
    """
    names = {
        EventKind.LIES_DOWN: "lies_down",
        EventKind.TIPS: "tips_over",
        EventKind.PRESSED_AT_RIM: "pressed_at_rim",
        EventKind.ROLLS_ON_RIM: "rolls_on_rim",
    }
    clauses = _rocking_on_rim(facts)
    rocked = [clause.numbers["time"] for clause in clauses]
    happened = [event for event in facts.events if event.kind in names and event.time not in rocked]
    for number, event in enumerate(happened):
        if min(number, len(happened) - 1 - number) < TOLD_AT_EITHER_END:
            clauses.append(Clause(names[event.kind], {"time": event.time}, "motion"))
    return clauses


def _rocking_on_rim(facts: Facts) -> list[Clause]:
    """Return the clause that a body rocks from one side of its rim to the other until it lies."""
    downs = [event for event in facts.events if event.kind is EventKind.LIES_DOWN]
    landings = [event.time for event in facts.events if event.kind is EventKind.TOUCHDOWN]
    if not downs or any(event.kind is EventKind.DOUBLE_CONTACT for event in facts.events):
        return []
    struck = [
        event
        for event in facts.events
        if event.kind is EventKind.IMPACT
        and 0.0 < event.time <= downs[0].time
        and event.time not in landings
        and event.surface == downs[0].surface
    ]
    if len(struck) < 2:
        return []
    return [Clause("rocks_on_rim", {"count": len(struck), "time": downs[0].time}, "motion")]


def _is_launched_flat(problem: Problem) -> bool:
    """Return whether a body is launched on its face."""
    flat = PoleExact(math).sin(problem.launch.tilt) ** 2 <= POLE
    return flat and problem.launch.gap == 0.0 and is_edge(problem.standing().surface)


def _is_on_face(facts: Facts) -> bool:
    """Return whether the body lies on its face at the end of its run."""
    on_face = _is_launched_flat(facts.problem)
    for event in facts.events:
        if event.kind in (EventKind.LIES_DOWN, EventKind.RESTS):
            on_face = True
        elif event.kind in (EventKind.TIPS, EventKind.LIFT_OFF):
            on_face = False
    return on_face


def _rolls_on_rim(facts: Facts) -> bool:
    """Return whether the body rolls on the rim of its face, upright, at the end of its run."""
    return bool(facts.events) and facts.events[-1].kind is EventKind.ROLLS_ON_RIM


def _sticks_since(facts: Facts) -> float:
    """Return the time since which the top rolls without slip or loss to the end, s, or nan."""
    if not spins_for_ever(top_of(facts.problem)) or facts.status is not Status.COMPLETED:
        return math.nan
    changes = [event for event in facts.events if event.kind in CHANGES_OF_STICKING]
    if not changes or changes[-1].kind is not EventKind.STICK:
        return math.nan
    return changes[-1].time


CHANGES_OF_STICKING = (
    EventKind.STICK,
    EventKind.SLIP,
    EventKind.LIFT_OFF,
    EventKind.IMPACT,
    EventKind.LIES_DOWN,
)
"""Events after which a contact sticks, or no longer does."""


def fell_back(facts: Facts) -> bool:
    """Return whether the top rose and fell back, by the definition of `Outcome.FELL_BACK`."""
    if facts.status in (Status.LIFTED_OFF, Status.FAILED, Status.INACCURATE):
        return False
    has_turned = math.isfinite(facts.metrics["turnover_time"])
    is_settled = facts.metrics["is_settled"] > 0
    final, launched = facts.metrics["final_tilt"], facts.problem.launch.tilt
    return bool(came_down(final, facts.peak[0], launched, has_turned, is_settled))


def _end(facts: Facts) -> list[Clause]:
    """Return the clauses of the end: the tilt, whether it is settled, and the surfaces in
    contact.
    """
    final, spin = facts.metrics["final_tilt"], facts.metrics["final_spin"]
    status, time = facts.status, _end_time(facts)
    clauses = list[Clause]()
    on_face = _is_on_face(facts)
    if status is Status.AT_REST:
        name = "comes_to_rest_on_face" if on_face else "comes_to_rest"
        clauses.append(Clause(name, {"tilt": final, "time": time}, "end"))
    elif status is Status.LIFTED_OFF:
        numbers = {"time": facts.metrics["liftoff_time"], "tilt": final}
        clauses.append(Clause("lifts_off", numbers, "end"))
    elif status is not Status.COMPLETED:
        clauses.append(_ended_early(facts))
    elif _rolls_on_rim(facts):
        clauses.append(Clause("rolls_flat", {"time": time, "spin": abs(spin)}, "end"))
    elif on_face:
        name = "lies_flat" if abs(spin) < LEAST_SPIN else "lies_flat_and_spins"
        clauses.append(Clause(name, {"time": time, "spin": abs(spin)}, "end"))
    elif facts.metrics["is_settled"]:
        clauses.append(_settled(facts))
    elif _is_undisturbed(facts):
        name = "stays_exactly_upright" if final < 1.0 else "stays_exactly_inverted"
        clauses.append(Clause(name, {}, "end"))
    elif math.isfinite(_sticks_since(facts)):
        clauses.append(Clause("rolls_on", {"tilt": final, "time": time}, "end"))
    else:
        clauses.append(_moving(facts))
    return [*clauses, *_standing(facts), *_travelled(facts)]


def _travelled(facts: Facts) -> list[Clause]:
    """Return the clause of how far a top has moved down a table that slopes, or up."""
    distance = facts.metrics["descent"]
    if facts.problem.table.is_level:
        return []
    name = "has_descended" if distance >= 0.0 else "has_climbed"
    return [Clause(name, {"distance": abs(distance)}, "end")]


def _moving(facts: Facts) -> Clause:
    """Return the clause of a top that still moves when its run ends."""
    final, highest = facts.metrics["final_tilt"], facts.peak[0]
    numbers = {"tilt": final, "time": _end_time(facts)}
    name = "still_moves"
    if _is_aloft(facts):
        name = "still_flies"
    elif final < NEAR_FINAL:
        name = "is_upright"
    elif final < NEAR_POLE < facts.problem.launch.tilt:
        name = "still_upright"
    elif final > math.pi - NEAR_FINAL:
        name = "is_inverted"
    elif final > math.pi - NEAR_POLE:
        name = "still_inverted"
        if highest - final > NEAR_FINAL:
            name = "has_been_inverted"
            numbers["highest"] = highest
    return Clause(name, numbers, "end")


def _is_aloft(facts: Facts) -> bool:
    """Return whether the run ends in a flight."""
    return any(end >= _end_time(facts) for _, end in facts.flights)


LEAST_SPIN = 1e-6
"""Spin below which a body that lies flat turns no more, rad/s."""


def _is_undisturbed(facts: Facts) -> bool:
    """Return whether the axis was exactly vertical during the whole run."""
    return (
        facts.problem.launch.tilt in (0.0, math.pi)
        and facts.metrics["final_tilt"] == facts.problem.launch.tilt
        and (facts.peak[0] == 0.0 or facts.problem.launch.tilt > 0.0)
    )


def _settled(facts: Facts) -> Clause:
    """Return the clause of a settled motion, with the time since which it has settled."""
    final, since = facts.metrics["final_tilt"], facts.settling_time
    launch = facts.problem.launch.tilt
    numbers = {"tilt": final, "time": since}
    stays = abs(final - launch) < RISE and facts.peak[0] - max(final, launch) < RISE
    upright = final < NEAR_FINAL
    if upright or final > math.pi - NEAR_FINAL:
        pole = "upright" if upright else "inverted"
        if stays and abs(launch - final) >= NEAR_FINAL:
            return Clause(f"comes_{pole}", {"tilt": launch}, "end")
        return Clause(f"stays_{pole}" if stays else f"settles_{pole}", numbers, "end")
    if since == 0.0:
        return Clause("stays_at", numbers, "end")
    return Clause("settles_at", numbers, "end")


def _standing(facts: Facts) -> list[Clause]:
    """Return the clause of the surface that a body of several surfaces stands on at the end."""
    surface = top_of(facts.problem).surface
    if (
        not isinstance(surface, Hull)
        or _is_aloft(facts)
        or _is_on_face(facts)
        or facts.status not in (Status.COMPLETED, Status.AT_REST)
    ):
        return []
    cosine = math.cos(facts.metrics["final_tilt"])
    lowest = lowest_surface(surface, cosine)
    least = float(lowest.height(cosine)) - STANDS_LEVEL * float(surface.size)
    touching = [one.active for one in surface.each if float(one.height(cosine)) >= least]
    if len(touching) > 1:
        return [_standing_on_two(surface, touching[0], touching[1])]
    name = "stands_on_edge" if is_edge(lowest) else "stands_on_surface"
    if acting(lowest).spherical:
        name = "stands_on_sphere"
    number = getattr(lowest, "active", 0)
    size = float(surface.sizes[number])
    return [Clause(name, {"surface": number, "length": size}, "end")]


STANDS_LEVEL = 1e-6
"""Difference of height, in sizes, up to which a body stands on two surfaces. Errors of a run are
below 1e-9; above 1e-5 a body that leans on one surface would be said to stand on two.
"""


def _standing_on_two(surface: Hull, first: int, second: int) -> Clause:
    """Return the clause of two surfaces, by number, on which a body stands; a sphere first."""
    spheres = [surface.units[number].spherical for number in (first, second)]
    if spheres[1] and not spheres[0]:
        return _standing_on_two(surface, second, first)
    edges = [is_edge(surface.units[number]) for number in (first, second)]
    name = "stands_on_two"
    if spheres[1]:
        name = "stands_on_spheres"
    elif spheres[0] and edges[1]:
        name = "stands_on_sphere_and_edge"
    elif edges[0] and edges[1]:
        name = "stands_on_edges"
    numbers = {
        "surface": first,
        "second": second,
        "length": float(surface.sizes[first]),
        "other_length": float(surface.sizes[second]),
    }
    return Clause(name, numbers, "end")


def _ended_early(facts: Facts) -> Clause:
    """Return the clause of the reason why a run ended early."""
    return Clause(f"ended_{facts.status.name}", {"time": _end_time(facts)}, "end")


def _theory(facts: Facts) -> list[Clause]:
    """Return the clauses of the theory: what explains the run, and where it ends."""
    problem = facts.problem
    launch, settled = problem.launch, facts.metrics["is_settled"]
    if top_of(problem).field is not None:
        return _outer_field(facts)
    if problem.friction.vanishes:
        return [Clause("no_friction", {}, "theory")]
    pulled = problem.contact.liftoff == "ignore" and facts.metrics["min_normal_force"] < 0.0
    stays_aloft = launch.gap > 0.0 and not facts.events
    if facts.status is not Status.COMPLETED or pulled or stays_aloft or _is_on_face(facts):
        return []
    if math.isfinite(_sticks_since(facts)):
        if settled or math.isfinite(facts.metrics["turnover_time"]):
            return []
        name = "sticking_explained" if _sticks_since(facts) > 0.0 else "slip_missing"
        return [Clause(name, {}, "theory")]
    if not top_of(problem).torque_free:
        numbers = {"spin": facts.metrics["final_spin"]}
        return [Clause("torque_takes_spin", numbers, "theory")]
    if is_neutral(top_of(problem)):
        return [Clause("neutral", {}, "theory")]
    clauses, spins, spin = list[Clause](), predicted_spins(problem), abs(launch.spin)
    low = launch.tilt < RISE and facts.peak[0] < RISE
    if spins is not None and low and spin < spins.upright:
        name = "too_slow_to_rise" if math.isfinite(spins.upright) else "never_rises"
        clauses.append(Clause(name, {"spin": spins.upright}, "theory"))
    end = None if settled else predicted_end(problem)
    if end is None:
        return clauses
    if _is_undisturbed(facts):
        return [*clauses, _of_state("beside", end.final)]
    rises = end.is_certain and end.final.tilt > 0.5 * math.pi
    if rises and launch.tilt < 0.5 * math.pi and not math.isfinite(facts.metrics["turnover_time"]):
        clauses.append(Clause("not_yet_over", {"duration": _end_time(facts)}, "theory"))
    if not end.is_certain:
        clauses.append(Clause("ends_are_several", {"count": len(end.reachable)}, "theory"))
    clauses += [_of_state("heads_for", state) for state in end.reachable]
    if end.is_certain:
        about = time_to_end(problem, end.final.tilt, NEAR_FINAL)
        if about > _end_time(facts):
            clauses.append(Clause("is_there_after", {"about": about}, "theory"))
    return clauses


def _outer_field(facts: Facts) -> list[Clause]:
    """Return the clauses of a sloping table and of air."""
    clauses, table = list[Clause](), facts.problem.table
    if not table.is_level and facts.status is Status.COMPLETED:
        clauses.append(Clause("table_slopes", {"tilt": table.slope}, "theory"))
    lost = facts.metrics["energy_lost_air"]
    if lost > 0.0:
        clauses.append(Clause("air_brakes", {"energy": lost}, "theory"))
    return clauses


def _of_state(verb: str, state: SteadyState[float]) -> Clause:
    """Return the clause of a steady state that a launch, or one near it, tends to."""
    numbers = {"tilt": state.tilt, "spin": state.spin, "precession": state.precession}
    name = "upright"
    if state.kind is SteadyKind.INVERTED:
        name = "inverted"
    elif state.kind is SteadyKind.PRECESSION:
        name = "precession"
    elif state.kind is SteadyKind.LEVEL:
        name = "level"
    return Clause(f"{verb}_{name}", numbers, "theory")


def _end_time(facts: Facts) -> float:
    return facts.metrics["end_time"]
