"""Where heyoka is not installed, other integrators give the same results: numba's, or else
SciPy's.
"""

import json
import subprocess
import sys

import numpy as np
import pytest

import tippetop as tt
from tippetop.integrators import NAMES, has_numba, has_taylor
from tippetop.problem.presets import report_problem

HIDE = """
import sys
from importlib.machinery import PathFinder


class Without(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        return None if name.partition(".")[0] in HIDDEN else super().find_spec(name, path, target)


sys.meta_path[sys.meta_path.index(PathFinder)] = Without
"""

RUN = """
import json
import tippetop as tt
from tippetop.integrators import NAMES, default_name, has_taylor
from tippetop.problem.presets import report_problem

assert not has_taylor()
run = tt.simulate(report_problem(), 1.0, samples=11)
try:
    tt.simulate(report_problem(), 1.0, integrator="taylor")
except tt.Unavailable as refusal:
    told = str(refusal)
print(json.dumps({
    "default": default_name(),
    "integrator": run.attrs["integrator"],
    "outcome": run.attrs["outcome"],
    "theta": run.theta.values.tolist(),
    "x": run.x.values.tolist(),
    "told": told,
    "others": [name for name in NAMES if name in told],
}))
"""


HIDDEN = {"compiled": ["heyoka"], "dop853": ["heyoka", "numba"]}
"""The default integrators, and what is missing where they are."""


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(
            "compiled", marks=pytest.mark.skipif(not has_numba(), reason="numba is not installed")
        ),
        "dop853",
    ],
)
def elsewhere(request):
    """What a process without heyoka says about a second of the report's run."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", f"HIDDEN = {HIDDEN[request.param]}\n{HIDE}{RUN}"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stderr, done.returncode) == ("", 0)
    return json.loads(done.stdout) | {"expected": request.param}


def test_the_default_is_the_best_that_is_there(elsewhere):
    assert elsewhere["default"] == elsewhere["integrator"] == elsewhere["expected"]
    assert elsewhere["outcome"] == "completed"


@pytest.mark.skipif(not has_taylor(), reason="heyoka is not installed")
def test_the_results_are_the_same(elsewhere):
    run = tt.simulate(report_problem(), 1.0, samples=11, integrator="taylor")
    np.testing.assert_allclose(elsewhere["theta"], run.theta, rtol=0, atol=1e-8)
    np.testing.assert_allclose(elsewhere["x"], run.x, rtol=0, atol=1e-8)


def test_asking_for_taylor_is_answered_in_one_sentence_that_names_the_others(elsewhere):
    told = elsewhere["told"]
    assert "\n" not in told
    assert "heyoka" in told
    assert "not installed" in told
    assert elsewhere["others"] == NAMES


@pytest.mark.skipif(not has_taylor(), reason="heyoka is not installed")
def test_the_default_is_taylor_where_it_is_installed():
    run = tt.simulate(report_problem(), 0.1, samples=2)
    assert run.attrs["integrator"] == "taylor"
