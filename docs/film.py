"""Make the film and the figure of the README: `python docs/film.py`."""

from pathlib import Path

import tippetop as tt

STATIC = Path(__file__).parent / "_static"

run = tt.simulate(tt.presets.report_problem(spin=155.0), duration=8.0, samples=20001)
tt.write_movie(
    run, STATIC / "flip.gif", overwrite=True, frame_rate=100 / 12, speed=1.6, pixels=(240, 180)
)
tt.plot(run).savefig(STATIC / "flip.png", dpi=110)
