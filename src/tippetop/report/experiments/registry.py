"""All experiments by name: importing the modules of this folder registers them."""

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
