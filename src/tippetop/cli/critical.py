"""`tippetop critical`: what the theory says of a launch, without simulating it."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from tippetop.cli.options import Choice, Json, of_a_problem
from tippetop.cli.terminal import facts, listing, show, show_json, spelled

if TYPE_CHECKING:
    from tippetop.theory.overview import Judged, Outlook
    from tippetop.theory.steady import SteadyState

TOLD = (
    *("inertia_ratio", "eccentricity", "group", "lambda_up", "lambda_down", "jellett", "swings"),
    *("mu_flip_time", "flip_time", "flip_time_needs", "standing_time", "surface", "tilts"),
)
"""What programs are told under the names that it has."""


@of_a_problem
def critical(
    choice: Choice,
    as_json: Json = False,
) -> None:
    """Say what the theory knows of a launch: its critical spins, its end, and how long it takes."""
    from tippetop.theory.overview import outlook  # noqa: PLC0415 - slow to import

    problem = choice.problem()
    found = outlook(problem)
    if as_json:
        told = {"critical_spins_tilt": problem.launch.tilt, "problem": problem.model_dump()}
        show_json({**_plain(found), **told})
    else:
        show(*_sentences(found))


def _plain(found: "Outlook") -> dict[str, Any]:
    """The record for programs."""
    prediction, stays = found.prediction, found.stays
    final = stays.state if stays else prediction and prediction.final
    possible = [stays.state] if stays else prediction and prediction.reachable
    return {
        **{name: getattr(found, name) for name in TOLD},
        "group_description": found.group and found.group.description,
        "omega_c1": found.critical_spins.upright,
        "omega_c2": found.critical_spins.inverted,
        "omega_c_tilt": found.tilt,
        "stays": (
            None if stays is None else "stable" if stays.spectrum.stable else "until disturbed"
        ),
        "final": final,
        "final_certain": possible and len(possible) == 1,
        "final_possible": possible,
        "steady_states": [
            {
                **vars(judged.state),
                "stable": judged.spectrum.stable,
                "growth_rate": judged.spectrum.growth_rate,
                "frame_rate": judged.spectrum.frame_rate,
                "eigenvalues": [
                    [value.real, value.imag] for value in judged.spectrum.eigenvalues.tolist()
                ],
                "neutral": judged.spectrum.neutral,
            }
            for judged in found.steady
        ],
        "jellett_conserved": found.conserved,
    }


def _sentences(found: "Outlook") -> Iterator[Any]:
    """The record for people."""
    if found.group is not None:
        yield f"[bold]Group {found.group.value}[/]: {found.group.description}."
    yield facts(_rows(found))
    if found.tilts != (0.0, math.pi):
        low, high = found.tilts
        yield (
            f"Of its surface {found.surface} alone, from θ = {low:.6g} to {high:.6g} rad: beyond,"
            " another touches."
        )
    if found.group is not None:
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
    headings = ("kind", "tilt", "precession", "axial spin", "energy", "", "growth rate")
    rows = (_state_row(judged) for judged in found.steady)
    yield listing("Steady states of this launch", headings, rows, words=("kind", ""))
    for judged in found.steady:
        yield f"[dim]{judged.state.kind.value}:[/] {_eigenvalues(judged)}"
    yield (
        "[dim]rad, rad/s, J; eigenvalues in 1/s, in the frame that turns with the precession (for"
        " vertical spins, a frame at rest), without the zeros of symmetry.[/]"
    )


def _rows(found: "Outlook") -> list[tuple[str, str, str]]:
    upright, inverted = found.critical_spins.upright, found.critical_spins.inverted
    sphere, kept = found.group is not None, "" if found.conserved else ", not conserved"
    rows = [
        (
            "upright spin is left above ω_c1" if sphere else "upright changes at",
            spelled(upright),
            "rad/s",
        ),
        (
            "inverted spin holds above ω_c2" if sphere else "inverted changes at",
            spelled(inverted),
            "rad/s",
        ),
        ("λ_up", spelled(found.lambda_up), "kg m³/s"),
        ("λ_down", spelled(found.lambda_down), "kg m³/s"),
        ("λ of this launch", spelled(found.jellett), "kg m³/s" + kept),
    ]
    if found.inertia_ratio is not None and found.eccentricity is not None:
        rows.insert(0, ("γ = I1/I3, α", f"{found.inertia_ratio:.6g}, {found.eccentricity:.6g}", ""))
    rows += _end_rows(found)
    if found.standing_time is not None:
        vertical = found.tilt in (0.0, math.pi)
        what = "drilling lets it stand" if vertical else "inverted with this λ it would stand"
        rows.append((what, spelled(found.standing_time), "s"))
    if found.mu_flip_time is not None:
        rows.append(("μ t until 0.01 rad from there, μ → 0", spelled(found.mu_flip_time), "s²/m"))
    if found.flip_time is not None:
        rows.append(("so at this friction about", spelled(found.flip_time), "s"))
    return rows


def _end_rows(found: "Outlook") -> list[tuple[str, str, str]]:
    """Where the launch ends: nowhere, where it is, or where friction takes it."""
    rows = []
    if found.swings is not None:
        low, high = found.swings
        rows.append(("swings for ever in θ", f"{low:.9g} to {high:.9g}", "rad"))
    if found.stays is not None:
        state, stable = found.stays.state, found.stays.spectrum.stable
        until = "" if stable else " until disturbed"
        rows.append(("stays exactly on", _told(state), f"rad{until}"))
    if found.prediction is not None and not (found.stays and found.stays.spectrum.stable):
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
    verdict = "stable" if spectrum.stable else "unstable" if spectrum.unstable else "neutral"
    motion = (spelled(value, 6) for value in (state.tilt, state.precession, state.spin))
    return (
        state.kind.value,
        *motion,
        f"{state.energy:.5g}",
        verdict,
        f"{spectrum.growth_rate:.5g}",
    )


def _eigenvalues(judged: "Judged") -> str:
    """The eigenvalues in a row; of each pair of conjugates, the one above stands for both."""
    shown = [value for value in judged.spectrum.eigenvalues.tolist() if value.imag >= 0]
    return ", ".join(f"{v.real:.5g} ± {v.imag:.6g}i" if v.imag else f"{v.real:.5g}" for v in shown)
