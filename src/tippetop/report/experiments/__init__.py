"""All experiments by name."""

from tippetop.report.experiment import Experiment
from tippetop.report.experiments import checks, friction, methods, runs, spins

EXPERIMENTS: dict[str, Experiment] = {
    experiment.id: experiment
    for module in (runs, spins, friction, methods, checks)
    for experiment in module.EXPERIMENTS
}
"""Every experiment by its name."""
