"""Everything the report claims that can be put to numbers: told in `claims.toml`, examined here."""

from tippetop.report.claim import EXAMINERS as EXAMINERS
from tippetop.report.claim import Claim, Source
from tippetop.report.claims import (  # noqa: F401 - for what they register
    abnormal,
    dry,
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

CLAIMS: dict[str, Claim] = {
    name: Claim(name, EXAMINERS[name], Source(**fields.pop("source")), **fields)
    for name, fields in told("claims").items()
}
"""Every claim by its name, in the order of the report."""
