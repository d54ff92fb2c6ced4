"""Everything the report claims that can be put to numbers: told in `claims.toml`, examined here."""

from tippetop.report.claim import Chapter, Claim, Source
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
from tippetop.report.told import told

EXAMINERS = Chapter()
"""How the claims are examined, by their names."""
for module in (
    *(launches, end_state, spins, friction, flight, abnormal),
    *(equations, steady, methods, why, dry, real),
):
    EXAMINERS |= module.CHAPTER

CLAIMS: dict[str, Claim] = {
    name: Claim(name, EXAMINERS[name], Source(**fields.pop("source")), **fields)
    for name, fields in told("claims").items()
}
"""Every claim by its name, in the order of the report."""
