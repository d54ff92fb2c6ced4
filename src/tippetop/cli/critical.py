"""`tippetop critical`: results of theory for a launch, without a simulation."""

import math
from collections.abc import Iterator
from itertools import compress
from typing import TYPE_CHECKING, Any

import numpy as np

from tippetop.cli.options import Choice, Json, of_a_problem
from tippetop.cli.terminal import facts, listing, show, show_json, spelled

if TYPE_CHECKING:
    from tippetop.theory.outlook import AnalysedState, Outlook
    from tippetop.theory.stability import Spectrum
    from tippetop.theory.steady import SteadyState

QUANTITIES = (
    *(
        "inertia_ratio",
        "eccentricity",
        "group",
        "jellett_upright",
        "jellett_inverted",
        "jellett",
        "swings",
    ),
    *("mu_arrival_time", "arrival_time", "arrival_time_needs", "standing_time", "surface", "tilts"),
    *("creeps", "sticks", "standing", "lying", "resting_center"),
)
"""Fields of the outlook that JSON has under the same names."""


@of_a_problem
def critical(
    choice: Choice,
    as_json: Json = False,
) -> None:
    """Show what theory says of a launch: its critical spins, its end, and the time until then."""
    from tippetop.problem.implausible import warn_if_implausible  # noqa: PLC0415 - slow to import
    from tippetop.theory.outlook import outlook  # noqa: PLC0415

    problem = choice.problem()
    warn_if_implausible(problem)
    result = outlook(problem)
    if as_json:
        launch = {"critical_spins_tilt": problem.launch.tilt, "problem": problem.model_dump()}
        show_json({**_plain(result), **launch})
    else:
        show(*_sentences(result))


def _plain(outlook: "Outlook") -> dict[str, Any]:
    """Return the outlook as plain data."""
    prediction, stays = outlook.prediction, outlook.stays
    final = stays.state if stays else prediction and prediction.final
    possible = [stays.state] if stays else prediction and prediction.reachable
    if outlook.is_neutral:
        final, possible = None, None
    return {
        **{name: getattr(outlook, name) for name in QUANTITIES},
        "group_description": outlook.group and outlook.group.description,
        "omega_c1": outlook.critical_spins and outlook.critical_spins.upright,
        "omega_c2": outlook.critical_spins and outlook.critical_spins.inverted,
        "omega_c_tilt": outlook.tilt,
        "stays": (None if stays is None else "stable" if stays.stable else "until disturbed"),
        "is_neutral": outlook.is_neutral,
        "final": final,
        "final_certain": possible and len(possible) == 1,
        "final_possible": possible,
        "steady_states": [
            {
                **vars(entry.state),
                **_plain_spectrum(entry.spectrum),
            }
            for entry in outlook.steady
        ],
        "jellett_conserved": outlook.conserved,
    }


def _plain_spectrum(spectrum: "Spectrum | None") -> dict[str, Any]:
    """Return the stability of a steady state as plain data; null where no linear motion exists."""
    if spectrum is None:
        return dict.fromkeys(("stable", "growth_rate", "frame_rate", "eigenvalues", "neutral"))
    return {
        "stable": spectrum.stable,
        "growth_rate": spectrum.growth_rate,
        "frame_rate": spectrum.frame_rate,
        "eigenvalues": [[value.real, value.imag] for value in spectrum.eigenvalues.tolist()],
        "neutral": spectrum.neutral,
    }


STICKS = (
    "Dry friction at a point: the contact sticks as soon as friction can hold it, and the top then"
    " rolls without loss. Stability does not decide where it ends, so there are no critical spins."
    " Friction that creeps, viscous or of a patch, has critical spins: try"
    " --set friction.kind=contensou --set friction.patch_radius=0.0005."
)
RESISTED = (
    "Rolling resistance stops an axis that moves slowly, and takes energy from every precession:"
    " there are no critical spins. Without it there are: try --set rolling_resistance=0."
)
ROUNDING_OF_EIGENVALUES = 1e-12
"""Part of an eigenvalue, relative to the largest eigenvalue, below which it is rounding: computed
eigenvalues are off by some 1e-15 of the largest one.
"""
FLAT = (
    "This body lies flat when its axis is vertical: it has no vertical spin. `tippetop steady`"
    " shows the circles in which it rolls."
)


def _sentences(outlook: "Outlook") -> Iterator[Any]:
    """Yield the sentences and tables that describe the outlook."""
    if outlook.group is not None and outlook.creeps:
        yield f"[bold]Group {outlook.group.value}[/]: {outlook.group.description}."
    if not outlook.creeps:
        yield STICKS if outlook.sticks else RESISTED if outlook.steady else FLAT
    yield facts(_rows(outlook))
    if outlook.tilts != (0.0, math.pi):
        low, high = outlook.tilts
        yield (
            f"For surface {outlook.surface} alone, from θ = {low:.6g} to {high:.6g} rad: beyond"
            " these tilts another surface touches."
        )
    if outlook.group is not None and outlook.creeps:
        yield (
            f"[dim]Critical spins are of launches with this one's tilt, {outlook.tilt:.6g} rad, and"
            " rates.[/]"
        )
    if outlook.arrival_time:
        yield (
            "[dim]The last row is the limit of μ t over μ. It is far off for strong friction, or if"
            " a nutation takes the axis round the vertical just once.[/]"
        )
    if outlook.arrival_time_needs is not None:
        yield f"[dim]The flip time is known only for {outlook.arrival_time_needs}.[/]"
    if outlook.steady:
        headings = ("kind", "tilt", "precession", "axial spin", "energy", "", "growth time")
        rows = (_state_row(entry) for entry in outlook.steady)
        yield listing("Steady states of this launch", headings, rows, words=("kind", ""))
    analysed = [entry for entry in outlook.steady if entry.spectrum is not None]
    for entry in analysed:
        yield f"[dim]{entry.state.kind.value}:[/] {_eigenvalues(entry)}"
    if analysed:
        yield (
            "[dim]rad, rad/s, J; growth time: s in which a small tilt grows e times; eigenvalues in"
            " 1/s, in the frame that turns with the precession (for vertical spins, a frame at"
            " rest), without the zeros of symmetry.[/]"
        )


def _rows(outlook: "Outlook") -> list[tuple[str, str, str]]:
    rows = []
    if outlook.inertia_ratio is not None and outlook.eccentricity is not None:
        rows.append(
            ("γ = I1/I3, α", f"{outlook.inertia_ratio:.6g}, {outlook.eccentricity:.6g}", "")
        )
    rows += [*_critical_rows(outlook), *_end_rows(outlook), *_standing_rows(outlook)]
    if outlook.lying is not None and math.isfinite(outlook.lying.rate):
        on = " and ".join(map(str, outlook.lying.surfaces))
        where = "its waist" if len(outlook.lying.surfaces) == 1 else f"surfaces {on}"
        rows.append(
            (
                f"lying on {where}, it rises above",
                spelled(outlook.lying.rate),
                "rad/s about the vertical",
            )
        )
    if outlook.resting_center is not None and not outlook.conserved:
        what = "rolls at this tilt about its centre at"
        rows.append((what, spelled(outlook.resting_center.precession), "rad/s about the vertical"))
    if outlook.standing_time is not None:
        vertical = outlook.tilt in (0.0, math.pi)
        what = "drilling lets it stand" if vertical else "inverted with this λ it would stand"
        rows.append((what, spelled(outlook.standing_time), "s"))
    if outlook.mu_arrival_time is not None:
        rows.append(_arrival_row(outlook.mu_arrival_time))
    if outlook.arrival_time:
        rows.append(("so at this friction about", spelled(outlook.arrival_time, 4), "s"))
    return rows


def _arrival_row(mu_time: float) -> tuple[str, str, str]:
    """Return the row of the limit of μ t; at 0 the nutation alone brings the axis to its end."""
    from tippetop.theory.averaging import ARRIVAL_DISTANCE  # noqa: PLC0415 - slow to import

    distance = f"{ARRIVAL_DISTANCE:g} rad"
    if mu_time > 0.0:
        return f"μ t until {distance} from there, μ → 0", spelled(mu_time, 4), "s²/m"
    return f"comes within {distance} of there", "in its first nutation", ""


def _critical_rows(outlook: "Outlook") -> list[tuple[str, str, str]]:
    """Return rows of the critical spins, if slip creeps, and of Jellett's integrals."""
    jellett = (
        "λ of this launch",
        spelled(outlook.jellett),
        "kg m³/s" + ("" if outlook.conserved else ", not conserved"),
    )
    if (
        outlook.critical_spins is None
        or outlook.jellett_upright is None
        or outlook.jellett_inverted is None
    ):
        return [jellett]
    sphere = outlook.group is not None
    upright, inverted = outlook.critical_spins.upright, outlook.critical_spins.inverted
    names = ("upright spin unstable above ω_c1", "inverted spin stable above ω_c2")
    if not sphere:
        names = ("upright changes at", "inverted changes at")
    spins = [
        _threshold(names[0], upright, "rad/s"),
        _threshold(names[1], inverted, "rad/s"),
    ]
    integrals = [
        _threshold("λ_up", outlook.jellett_upright, "kg m³/s"),
        _threshold("λ_down", outlook.jellett_inverted, "kg m³/s"),
    ]
    # Where another surface touches, this one has no vertical spin.
    on_surface = [outlook.tilts[0] == 0.0, outlook.tilts[1] == math.pi]
    return [*compress(spins, on_surface), *compress(integrals, on_surface), jellett]


def _threshold(name: str, value: float, unit: str) -> tuple[str, str, str]:
    """Return a row of a threshold, which may not exist."""
    return (name, spelled(value), unit) if math.isfinite(value) else (name, "no spin", "")


def _standing_rows(outlook: "Outlook") -> list[tuple[str, str, str]]:
    """Return rows of the spins above which a top-heavy body stands on its end, and of its fall."""
    standing = outlook.standing
    if standing is None:
        return []
    rows = [
        ("sleeps on a contact that rolls above", spelled(standing.rolling.spin), "rad/s"),
        ("sleeps on a fixed point (textbooks) above", spelled(standing.pivot.spin), "rad/s"),
        ("sleeps on a smooth table above", spelled(standing.smooth.spin), "rad/s"),
        (
            "without spin it falls, e-fold in",
            spelled(1.0 / standing.rolling.growth_rate_at_rest, 3),
            "s",
        ),
    ]
    for table, threshold in (("rolling", standing.rolling), ("smooth", standing.smooth)):
        if threshold.growth_rate > 0.0:
            what = f"falls now ({table}), e-fold in"
            rows.append((what, spelled(1.0 / threshold.growth_rate, 3), "s"))
    if math.isfinite(standing.creep_time):
        below = ("slip that creeps tips it below", spelled(standing.creep_spin), "rad/s")
        always = ("slip that creeps tips it", "at any spin", "")
        rows += [
            below if math.isfinite(standing.creep_spin) else always,
            (
                f"at {spelled(standing.creep_time_spin, 3)} rad/s, e-fold in at least",
                spelled(standing.creep_time, 3),
                "s",
            ),
        ]
    return rows


def _end_rows(outlook: "Outlook") -> list[tuple[str, str, str]]:
    """Return rows of the end of a launch: swinging for ever, staying, or a steady state."""
    rows = []
    if outlook.swings is not None:
        low, high = outlook.swings
        rows.append(("swings for ever in θ", f"{low:.6g} to {high:.6g}", "rad"))
    if outlook.stays is not None:
        state, stable = outlook.stays.state, outlook.stays.stable
        until = "" if stable else " until disturbed"
        rows.append(("stays exactly on", _described(state), f"rad{until}"))
    if outlook.is_neutral:
        rows.append(("ends as", "any θ: every tilt is neutral", "rad"))
    elif outlook.prediction is not None and not (outlook.stays and outlook.stays.stable):
        rows.append(
            (
                "and then ends as" if outlook.stays else "ends as",
                _described(outlook.prediction.final),
                "rad",
            )
        )
        if not outlook.prediction.is_certain:
            rows.append(("", "of several, by least energy", ""))
    return rows


def _described(state: "SteadyState[float]") -> str:
    return f"{state.kind.value} at θ = {state.tilt:.7g}"


def _state_row(entry: "AnalysedState") -> tuple[str, ...]:
    state, spectrum = entry.state, entry.spectrum
    verdict, growth = "", ""
    if spectrum is not None:
        verdict = "stable" if spectrum.stable else "unstable" if spectrum.unstable else "neutral"
        growth = f"{1.0 / spectrum.growth_rate:.4g}" if spectrum.unstable else ""
    motion = (spelled(value) for value in (state.tilt, state.precession, state.spin))
    return (state.kind.value, *motion, f"{state.energy:.5g}", verdict, growth)


def _eigenvalues(entry: "AnalysedState") -> str:
    """Return the eigenvalues as text; one of each conjugate pair stands for both."""
    assert entry.spectrum is not None
    values = entry.spectrum.eigenvalues
    least = ROUNDING_OF_EIGENVALUES * np.abs(values).max(initial=0.0)
    parts = [(_cleared(v.real, least), _cleared(v.imag, least)) for v in values.tolist()]
    return ", ".join(
        f"{real:.5g} ± {imaginary:.6g}i" if imaginary else f"{real:.5g}"
        for real, imaginary in parts
        if not imaginary < 0.0
    )


def _cleared(value: float, least: float) -> float:
    return 0.0 if abs(value) <= least else value
