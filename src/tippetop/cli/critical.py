"""`tippetop critical`: what the theory says of a launch, without simulating it."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from tippetop.cli.options import Choice, Json, of_a_problem
from tippetop.cli.terminal import facts, listing, show, show_json, spelled

if TYPE_CHECKING:
    from tippetop.theory.overview import Judged, Outlook
    from tippetop.theory.stability import Spectrum
    from tippetop.theory.steady import SteadyState

TOLD = (
    *("inertia_ratio", "eccentricity", "group", "lambda_up", "lambda_down", "jellett", "swings"),
    *("mu_flip_time", "flip_time", "flip_time_needs", "standing_time", "surface", "tilts"),
    *("creeps", "sticks", "standing", "lying", "resting_center"),
)
"""What programs are told under the names that it has."""


@of_a_problem
def critical(
    choice: Choice,
    as_json: Json = False,
) -> None:
    """Say what the theory knows of a launch: its critical spins, its end, and how long it takes."""
    from tippetop.problem.implausible import warn_if_implausible  # noqa: PLC0415 - slow to import
    from tippetop.theory.overview import outlook  # noqa: PLC0415

    problem = choice.problem()
    warn_if_implausible(problem)
    found = outlook(problem)
    if as_json:
        told = {"critical_spins_tilt": problem.launch.tilt, "problem": problem.model_dump()}
        show_json({**_plain(found), **told})
    else:
        show(*_sentences(found))


def _plain(found: "Outlook") -> dict[str, Any]:
    """Return the record for programs."""
    prediction, stays = found.prediction, found.stays
    final = stays.state if stays else prediction and prediction.final
    possible = [stays.state] if stays else prediction and prediction.reachable
    return {
        **{name: getattr(found, name) for name in TOLD},
        "group_description": found.group and found.group.description,
        "omega_c1": found.critical_spins and found.critical_spins.upright,
        "omega_c2": found.critical_spins and found.critical_spins.inverted,
        "omega_c_tilt": found.tilt,
        "stays": (None if stays is None else "stable" if stays.stable else "until disturbed"),
        "final": final,
        "final_certain": possible and len(possible) == 1,
        "final_possible": possible,
        "steady_states": [
            {
                **vars(judged.state),
                **_plain_spectrum(judged.spectrum),
            }
            for judged in found.steady
        ],
        "jellett_conserved": found.conserved,
    }


def _plain_spectrum(spectrum: "Spectrum | None") -> dict[str, Any]:
    """Return the stability of a steady state for programs: null where nothing is linear."""
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
    "Dry friction of a point: the contact sticks wherever the table can hold it, and the top then"
    " rolls without loss. Stability does not decide where it ends, so there are no critical spins."
    " Under friction that creeps, of a patch or viscous, there are: try"
    " --set friction.kind=contensou --set friction.patch_radius=0.0005."
)
RESISTED = (
    "Rolling resistance holds an axis that hardly moves, and takes energy from every precession:"
    " there are no critical spins. Without it there are: try --set rolling_resistance=0."
)
FLAT = "This body lies flat when its axis is vertical: it has no vertical spin."


def _sentences(found: "Outlook") -> Iterator[Any]:
    """Yield the record for people."""
    if found.group is not None and found.creeps:
        yield f"[bold]Group {found.group.value}[/]: {found.group.description}."
    if not found.creeps:
        yield STICKS if found.sticks else RESISTED if found.steady else FLAT
    yield facts(_rows(found))
    if found.tilts != (0.0, math.pi):
        low, high = found.tilts
        yield (
            f"Of its surface {found.surface} alone, from θ = {low:.6g} to {high:.6g} rad: beyond,"
            " another touches."
        )
    if found.group is not None and found.creeps:
        yield (
            f"[dim]ω_c1, ω_c2: spins of launches with this one's tilt, {found.tilt:.6g} rad, and"
            " rates.[/]"
        )
    if found.flip_time is not None:
        yield (
            "[dim]The last is the limit over μ: far off where friction is strong, or where a"
            " nutation brings the axis round the vertical just once.[/]"
        )
    if found.flip_time_needs is not None:
        yield f"[dim]Of launches, the flip time is known only of {found.flip_time_needs}.[/]"
    if found.steady:
        headings = ("kind", "tilt", "precession", "axial spin", "energy", "", "growth time")
        rows = (_state_row(judged) for judged in found.steady)
        yield listing("Steady states of this launch", headings, rows, words=("kind", ""))
    judged_ones = [judged for judged in found.steady if judged.spectrum is not None]
    for judged in judged_ones:
        yield f"[dim]{judged.state.kind.value}:[/] {_eigenvalues(judged)}"
    if judged_ones:
        yield (
            "[dim]rad, rad/s, J; growth time: s in which a small tilt grows e times; eigenvalues in"
            " 1/s, in the frame that turns with the precession (for vertical spins, a frame at"
            " rest), without the zeros of symmetry.[/]"
        )


def _rows(found: "Outlook") -> list[tuple[str, str, str]]:
    rows = []
    if found.inertia_ratio is not None and found.eccentricity is not None:
        rows.append(("γ = I1/I3, α", f"{found.inertia_ratio:.6g}, {found.eccentricity:.6g}", ""))
    rows += [*_critical_rows(found), *_end_rows(found), *_standing_rows(found)]
    if found.lying is not None and math.isfinite(found.lying.rate):
        on = " and ".join(map(str, found.lying.surfaces))
        where = "its waist" if len(found.lying.surfaces) == 1 else f"surfaces {on}"
        rows.append(
            (
                f"lying on {where}, it rises above",
                spelled(found.lying.rate, 6),
                "rad/s about the vertical",
            )
        )
    if found.resting_center is not None and not found.conserved:
        what = "rolls at this tilt about its centre at"
        rows.append((what, spelled(found.resting_center.precession, 6), "rad/s about the vertical"))
    if found.standing_time is not None:
        vertical = found.tilt in (0.0, math.pi)
        what = "drilling lets it stand" if vertical else "inverted with this λ it would stand"
        rows.append((what, spelled(found.standing_time), "s"))
    if found.mu_flip_time is not None:
        rows.append(("μ t until 0.01 rad from there, μ → 0", spelled(found.mu_flip_time), "s²/m"))
    if found.flip_time is not None:
        rows.append(("so at this friction about", spelled(found.flip_time), "s"))
    return rows


def _critical_rows(found: "Outlook") -> list[tuple[str, str, str]]:
    """Return critical spins and Jellett's integrals, where slip creeps."""
    jellett = (
        "λ of this launch",
        spelled(found.jellett),
        "kg m³/s" + ("" if found.conserved else ", not conserved"),
    )
    if found.critical_spins is None or found.lambda_up is None or found.lambda_down is None:
        return [jellett]
    sphere = found.group is not None
    upright, inverted = found.critical_spins.upright, found.critical_spins.inverted
    names = ("upright spin is left above ω_c1", "inverted spin holds above ω_c2")
    if not sphere:
        names = ("upright changes at", "inverted changes at")
    return [
        _threshold(names[0], upright, "rad/s"),
        _threshold(names[1], inverted, "rad/s"),
        _threshold("λ_up", found.lambda_up, "kg m³/s"),
        _threshold("λ_down", found.lambda_down, "kg m³/s"),
        jellett,
    ]


def _threshold(name: str, value: float, unit: str) -> tuple[str, str, str]:
    """Return a row for a threshold, which may not exist."""
    return (name, spelled(value), unit) if math.isfinite(value) else (name, "no spin", "")


def _standing_rows(found: "Outlook") -> list[tuple[str, str, str]]:
    """What keeps a top-heavy body on end: its gyroscopic thresholds, and how creep undoes it."""
    standing = found.standing
    if standing is None:
        return []
    rows = [
        ("sleeps on a contact that rolls above", spelled(standing.rolling.spin, 6), "rad/s"),
        ("sleeps on a fixed point (textbooks) above", spelled(standing.pivot.spin, 6), "rad/s"),
        ("sleeps on a smooth table above", spelled(standing.smooth.spin, 6), "rad/s"),
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
        below = ("slip that creeps tips it below", spelled(standing.creep_spin, 6), "rad/s")
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


def _end_rows(found: "Outlook") -> list[tuple[str, str, str]]:
    """Where the launch ends: nowhere, where it is, or where friction takes it."""
    rows = []
    if found.swings is not None:
        low, high = found.swings
        rows.append(("swings for ever in θ", f"{low:.9g} to {high:.9g}", "rad"))
    if found.stays is not None:
        state, stable = found.stays.state, found.stays.stable
        until = "" if stable else " until disturbed"
        rows.append(("stays exactly on", _told(state), f"rad{until}"))
    if found.prediction is not None and not (found.stays and found.stays.stable):
        rows.append(
            ("and then ends as" if found.stays else "ends as", _told(found.prediction.final), "rad")
        )
        if not found.prediction.certain:
            rows.append(("", "of several, by least energy", ""))
    return rows


def _told(state: "SteadyState[float]") -> str:
    return f"{state.kind.value} at θ = {state.tilt:.7g}"


def _state_row(judged: "Judged") -> tuple[str, ...]:
    state, spectrum = judged.state, judged.spectrum
    verdict, growth = "", ""
    if spectrum is not None:
        verdict = "stable" if spectrum.stable else "unstable" if spectrum.unstable else "neutral"
        growth = f"{1.0 / spectrum.growth_rate:.4g}" if spectrum.unstable else ""
    motion = (spelled(value, 6) for value in (state.tilt, state.precession, state.spin))
    return (state.kind.value, *motion, f"{state.energy:.5g}", verdict, growth)


def _eigenvalues(judged: "Judged") -> str:
    """Return the eigenvalues in a row; of each pair of conjugates, the one above stands for
    both.
    """
    assert judged.spectrum is not None
    shown = [value for value in judged.spectrum.eigenvalues.tolist() if value.imag >= 0]
    return ", ".join(f"{v.real:.5g} ± {v.imag:.6g}i" if v.imag else f"{v.real:.5g}" for v in shown)
