"""All experiments by name: each module here registers its own."""

from tippetop.report.experiment import EXPERIMENTS as EXPERIMENTS
from tippetop.report.experiments import (  # noqa: F401 - for what they register
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
