import pytest
import xarray as xr

import tippetop as tt
from tippetop.results.sample_counts import sample_count


@pytest.fixture(scope="session")
def flying() -> xr.Dataset:
    """A run that turns over and leaves the table on the way."""
    problem = tt.presets.report_problem(spin=175.0)
    return tt.simulate(problem, 8.0, samples=sample_count(problem, 8.0))
