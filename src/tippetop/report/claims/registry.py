"""Everything the report claims that can be put to numbers."""

from tippetop.report.claim import Claim
from tippetop.report.claims import (
    abnormal,
    dry,
    end_state,
    equations,
    flight,
    friction,
    launches,
    methods,
    real,
    spins,
    steady,
    why,
)

_CHAPTERS = (
    launches,
    end_state,
    spins,
    friction,
    flight,
    abnormal,
    equations,
    steady,
    methods,
    why,
    dry,
    real,
)

CLAIMS: dict[str, Claim] = {claim.id: claim for module in _CHAPTERS for claim in module.CHAPTER.claims}
"""Every claim by its name, in the order of the report."""
