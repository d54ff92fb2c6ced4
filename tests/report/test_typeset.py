"""Formulas in the words of claims."""

import pytest

from tippetop.report.typeset import typeset


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
        ("if gn<0 & so", "if gn&lt;0 &amp; so"),
    ],
)
def test_formulas_get_letters_indices_and_powers(plain: str, page: str) -> None:
    assert typeset(plain) == page
