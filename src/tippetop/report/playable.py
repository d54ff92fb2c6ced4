"""Run that plays on the page itself: the launch that the report calls abnormal."""

from tippetop.export.bundle import LOADER, packed, player_notices, player_packed
from tippetop.export.track import pack_run
from tippetop.problem.presets import report_problem
from tippetop.report.experiments.runs import unilateral
from tippetop.results.account_text import describe
from tippetop.results.sample_counts import sample_count
from tippetop.run import simulate
from tippetop.support.errors import Unavailable

PLAYED_SPIN, DURATION = 175.0, 9.0
"""Spin of the launch, rad/s, and length of the run, s: until the top spins inverted."""


def playable(quick: bool) -> dict[str, str] | None:
    """Return the packed run and its player for the page; None if the player is not built."""
    try:
        player = player_packed()
    except Unavailable:
        return None
    problem = unilateral(report_problem(PLAYED_SPIN))
    samples = sample_count(problem, DURATION)
    run = simulate(problem, DURATION, samples=samples // 2 if quick else samples)
    return {
        "headline": describe(run).headline,
        "spin": f"{PLAYED_SPIN:g}",
        "player": player,
        "run": packed(pack_run(run)),
        "loader": LOADER,
        "notices": player_notices(),
    }
