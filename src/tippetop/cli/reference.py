"""`tippetop reference`: the reference suite, written for other programs."""

import math
from pathlib import Path
from typing import Annotated

import typer

from tippetop.cli.options import Force, Json
from tippetop.cli.terminal import listing, show, show_json
from tippetop.support.progress_bar import progress_bar


def reference(
    out: Annotated[Path, typer.Option(help="Folder to write into.")] = Path("tippetop-suite"),
    case: Annotated[
        list[str] | None, typer.Option(help="Write only this case; may be repeated.")
    ] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Write reference problems, results and tests to which other programs can be compared.

    Each result states the agreement of two methods that share no code. The exit code is 1 if they
    differ by more than the limits of a case, which are listed with it: 1e-10 s in an event and 1e-8
    in a state, and more after an infinite sequence of rebounds and after many events.
    """
    from tippetop.engines.reference import SUITE_VERSION, write_suite  # noqa: PLC0415 - slow to import

    with progress_bar("starting") as progress:
        results = write_suite(out, case, force, progress)
    apart = [one.case.name for one in results if not one.agrees]
    if as_json:
        cases = {
            one.case.name: {
                "events": len(one.events),
                "event_agreement": one.event_agreement,
                "state_agreement": one.state_agreement,
                "event_limit": one.event_limit,
                "state_limit": one.state_limit,
                "energy_error": one.energy_error,
                "agrees": one.agrees,
            }
            for one in results
        }
        show_json({"suite": SUITE_VERSION, "folder": str(out), "cases": cases})
    else:
        headings = ("case", "events", "agree to (s)", "states agree to", "energy kept to")
        rows = [
            (
                one.case.name,
                str(len(one.events)),
                _within(one.event_agreement, one.event_limit),
                _within(one.state_agreement, one.state_limit),
                f"{one.energy_error:.0e}",
            )
            for one in results
        ]
        listed = listing(f"Reference suite {SUITE_VERSION}", headings, rows, words=("case",))
        worse = f"The two methods differ by more than they may: {', '.join(apart)}."
        show(listed, *([worse] if apart else []), files=[out / "README.md"])
    if apart:
        raise typer.Exit(1)


def _within(agreement: float, limit: float) -> str:
    """Return an agreement beside its limit; "" where there is nothing to compare."""
    return "" if math.isnan(agreement) else f"{agreement:.0e} of {limit:.0e}"
