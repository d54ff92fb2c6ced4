"""All experiments by name."""

from tippetop.report.experiment import Experiment
from tippetop.report.experiments import (
    checks,
    dry,
    equations,
    flights,
    friction,
    methods,
    patches,
    real,
    runs,
    spins,
    stepping,
    theory,
    theory_runs,
)

EXPERIMENTS: dict[str, Experiment] = {}
"""Every experiment by its name."""
for module in (
    *(runs, spins, friction, flights, methods, equations, checks),
    *(theory, theory_runs, dry, patches, real, stepping),
):
    EXPERIMENTS |= module.BENCH
