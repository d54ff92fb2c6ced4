"""Everything the report claims that can be put to numbers."""

from tippetop.report.claim import Claim
from tippetop.report.claims import equations, flight, friction, launches, methods, spins, why

CLAIMS: dict[str, Claim] = {
    claim.id: claim
    for module in (launches, spins, friction, flight, equations, methods, why)
    for claim in module.CHAPTER.claims
}
"""Every claim by its name, in the order of the report."""
