"""Formulas in the words of claims."""

import re

import pytest

from tippetop.report.claim import Claim
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.typeset import formula, typeset


@pytest.mark.parametrize(
    ("plain", "page"),
    [
        ("theta = pi/4", "θ = π/4"),
        ("phi' and phi''", "φ′ and φ″"),
        ("omega3, omega_c1", "ω<sub>3</sub>, ω<sub>c1</sub>"),
        ("I1 = 2/5 m R^2", "I<sub>1</sub> = 2/5 m R<sup>2</sup>"),
        ("as mu^-0.985, nearly", "as μ<sup>−0.985</sup>, nearly"),
        ("M = a x (g_n z + f)", "M = a × (g<sub>n</sub> z + f)"),
        ("the report's method, run-mu-100", "the report's method, run-mu-100"),
        (
            "1e-06 of 2.7e-15 or 3e+04",
            "10<sup>−6</sup> of 2.7 × 10<sup>−15</sup> or 3 × 10<sup>4</sup>",
        ),
        ("run-1e5 and 0.15 rad", "run-1e5 and 0.15 rad"),
        ("if gn<0 & so", "if gn&lt;0 &amp; so"),
    ],
)
def test_formulas_get_letters_indices_and_powers(plain: str, page: str) -> None:
    assert typeset(plain) == page


SET_APART = {name: claim for name, claim in CLAIMS.items() if claim.formula}


@pytest.mark.parametrize("claim", SET_APART.values(), ids=SET_APART)
def test_formulas_are_drawn_in_the_color_of_the_text_with_their_source_as_words(
    claim: Claim,
) -> None:
    lines = claim.formula + claim.formula_right
    drawn = formula(lines)
    assert drawn.count("<svg") == drawn.count('role="img"') == len(lines)
    assert "fill=" not in drawn
    assert set("".join(re.findall(r' d="([^"]*)"', drawn))) <= set("MLQCZ0123456789.e- ")


def test_formula_fills_its_box() -> None:
    left, top, width, height = (
        float(v) for v in re.findall(r'viewBox="([^"]*)"', formula(("x^2",)))[0].split()
    )
    path = re.findall(r' d="([^"]*)"', formula(("x^2",)))[0]
    numbers = [float(number) for number in re.findall(r"-?[\d.]+(?:e-?\d+)?", path)]
    x, y = numbers[::2], numbers[1::2]
    assert left + 1 == pytest.approx(min(x), abs=0.1)
    assert left + width - 1 == pytest.approx(max(x), abs=0.1)
    assert top + 1 == pytest.approx(min(y), abs=0.1)
    assert top + height - 1 == pytest.approx(max(y), abs=0.1)
