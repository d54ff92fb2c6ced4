"""Problems that nobody would ask for, in the engine: each ends as in Python, with an outcome or
refused.
"""

import json
import re
import warnings
from typing import Any

import numpy as np
import pytest

import tippetop as tt
from campaigns import seed_ranges
from launches import in_javascript
from test_hostile_problems import MODES, STEPS, hostile

DURATION, TOLERANCE, TIMES = 2.0, 1e-10, (0.0, 1e-9, 0.1, 2.0)


def named(fields: dict[str, Any]) -> str:
    """What becomes of a problem in Python: an outcome, or the field that is refused."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", category=tt.Implausible)
        try:
            run = tt.simulate(
                tt.Problem(**fields),
                DURATION,
                samples=2,
                step_limit=STEPS,
                mode_limit=MODES,
                integrator="taylor",
                tolerance=TOLERANCE,
            )
        except tt.InvalidInput as refusal:
            return refusal.field
    return str(run.attrs["status"])


def named_there(found: dict[str, Any]) -> str:
    """The same of what the engine tells."""
    return (
        found["status"]["name"]
        if "status" in found
        else found.get("refused", str(found)).split()[0].removesuffix(":")
    )


@pytest.mark.parametrize("seeds", seed_ranges(check=12, sample=64, claim=1000, size=117))
def test_hostile_problems_end_as_in_python(seeds: range) -> None:
    drawn = [hostile(np.random.default_rng(seed)) for seed in seeds]
    # Pages have no numbers but those of JSON.
    told = [fields for fields in drawn if not re.search("NaN|Infinity", json.dumps(fields))]
    limits = {"step_limit": STEPS, "mode_limit": MODES}
    asked = {"duration": DURATION, "tolerance": TOLERANCE, "times": TIMES, **limits}
    found = in_javascript([{"problem": fields, **asked} for fields in told])
    ends = [
        (named_there(theirs), named(fields)) for fields, theirs in zip(told, found, strict=True)
    ]
    assert not [(number, *both) for number, both in enumerate(ends) if both[0] != both[1]]
    outcomes = [ours for _, ours in ends]
    assert outcomes.count("completed") > 0.2 * len(outcomes)
