"""Small powers of several launches at once are what the C library makes of each."""

import numpy as np
import pytest

from tippetop.graph.llvm import ABREAST
from tippetop.graph.recording import record

EDGES = [
    0.0,
    np.inf,
    np.nan,
    -1.0,
    5e-324,
    2.0**-1022,
    1.797e308,
    1.0,
    2.0,
    0.5,
    1.0 - 2.0**-53,
    1.0 + 2.0**-52,
]


@pytest.mark.parametrize("exponent", [1.0 / 24.0, 1.0 / 22.0, 0.4])
def test_powers(exponent):
    from tippetop.integrators.machine_code import machine_code  # noqa: PLC0415 - LLVM may be missing

    numbers = np.concatenate(
        [EDGES, 10.0 ** np.random.default_rng(1).uniform(-323.0, 308.0, 20_000)]
    )
    numbers = np.concatenate([numbers, np.ones(-len(numbers) % ABREAST)])
    function = machine_code({"made": record(lambda y, p: [y[0] ** exponent], 1, 0)}, ABREAST)[
        "made"
    ]
    found = np.empty((1, len(numbers)))
    function(numbers[None].copy(), np.empty((0, len(numbers))), found)
    with np.errstate(invalid="ignore"):
        expected = numbers**exponent
    np.testing.assert_allclose(found[0], expected, rtol=5e-16, atol=0.0)
