"""All claims: their texts from `claims.toml`, and the functions that examine them."""

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
from tippetop.report.texts import filled_tables

CLAIMS: dict[str, Claim] = {
    name: Claim(name, EXAMINERS[name], Source(**fields.pop("source")), **fields)
    for name, fields in filled_tables("claims").items()
}
"""All claims by name, in the order of the report."""
