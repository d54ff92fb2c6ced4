"""The report's formulas as it prints them, beside what they should be, by the claim that examines them.

They are in TeX as far as matplotlib sets it, one string a line; a printed one that is right stands alone.
"""

from typing import NamedTuple


class Formula(NamedTuple):
    """A formula as printed and, where that is wrong, as it is right; each a tuple of lines."""

    printed: tuple[str, ...]
    right: tuple[str, ...] = ()


_BRACKET = r"I_3\dot{\theta}\omega_3-2I_1\dot{\theta}\dot{\varphi}\cos\theta-\mu g_n v_y R(\alpha-\cos\theta)"
_STEADY = r"\omega_3=\dot{\varphi}\,(\cos\theta-\alpha)"
_STAGES = r"y_{n+1}=y_n+\frac{\Delta t}{6}[\,f(Y_1,t_n)+2f(Y_2,t_n+\frac{\Delta t}{2})"
_INERTIAS = r"I_{%d}=\frac{2}{5}\,mR^2,\quad I_{%d}=\frac{131}{350}\,mR^2"

FORMULAS: dict[str, Formula] = {
    "eq-2.1": Formula(
        (
            r"\omega=\dot{\alpha}\,\hat{z}+\dot{\beta}\,\hat{N}+\dot{\gamma}\,\hat{Z}",
            r"\omega_X=\dot{\beta}\cos\gamma+\dot{\alpha}\sin\beta\sin\gamma",
            r"\omega_Y=-\dot{\beta}\sin\gamma+\dot{\alpha}\sin\beta\cos\gamma",
            r"\omega_Z=\dot{\gamma}+\dot{\alpha}\cos\beta",
        )
    ),
    "eq-2.6": Formula(
        (
            r"\mathbf{I}=\mathrm{diag}(I_1,I_2,I_3),\quad\mathbf{L}=\mathbf{I}\omega",
            r"m\ddot{\mathbf{r}}_c=\mathbf{F},\quad\dot{\mathbf{L}}=\mathbf{M}+\mathbf{L}\times\omega",
            r"I_1\dot{\omega}_1=M_1+(I_2-I_3)\,\omega_2\omega_3",
            r"I_2\dot{\omega}_2=M_2+(I_3-I_1)\,\omega_3\omega_1",
            r"I_3\dot{\omega}_3=M_3+(I_1-I_2)\,\omega_1\omega_2",
        )
    ),
    "eq-2.8": Formula(
        (
            r"\mathbf{a}=R\,(\sin\theta\,\mathbf{1}+(\alpha-\cos\theta)\,\mathbf{3}),"
            r"\quad(\mathbf{s}+\mathbf{a})\cdot\hat{z}=0",
            r"\ddot{\theta}=\frac{\sin\theta}{I_1}(I_1\dot{\varphi}^2\cos\theta-I_3\omega_3\dot{\varphi}"
            r"-R\alpha g_n)+\frac{R\mu g_n v_x}{I_1}(1-\alpha\cos\theta)",
            r"\dot{\omega}_3=-\frac{\mu g_n v_y R\sin\theta}{I_3}",
            r"\dot{v}_x=\frac{R\sin\theta}{I_1}(\dot{\varphi}\omega_3(I_3(1-\alpha\cos\theta)-I_1)"
            r"+g_nR\alpha(1-\alpha\cos\theta)",
            r"\quad-I_1\alpha(\dot{\theta}^2+\dot{\varphi}^2\sin^2\theta))"
            r"-\frac{\mu g_n v_x}{mI_1}(I_1+mR^2(1-\alpha\cos\theta)^2)+\dot{\varphi}v_y",
            r"\dot{v}_y=-\frac{\mu g_n v_y}{mI_1I_3}(I_1I_3+mR^2I_3(\alpha-\cos\theta)^2"
            r"+mR^2I_1\sin^2\theta)",
            r"\quad+\frac{\omega_3\dot{\theta}R}{I_1}(I_3(\alpha-\cos\theta)+I_1\cos\theta)-\dot{\varphi}v_x",
        )
    ),
    "eq-2.7": Formula(
        (r"\mathbf{F}=(g_n-mg)\,\hat{z}-\mu g_n\mathbf{v_A}", r"\mathbf{M}=\mathbf{F}\times\mathbf{a}"),
        (r"\mathbf{M}=\mathbf{a}\times(g_n\,\hat{z}-\mu g_n\mathbf{v_A})",),
    ),
    "eq-2.9": Formula(
        (r"\ddot{\varphi}=\dfrac{I_1}{" + _BRACKET + r"}\,/\,I_1\sin\theta",),
        (r"\ddot{\varphi}=\dfrac{" + _BRACKET + r"}{I_1\sin\theta}",),
    ),
    "sec2-large-spin": Formula(
        (
            r"g_n=[\,mgI_1+mR\alpha\,(\cos\theta\,(I_1\dot{\varphi}^2\sin^2\theta+I_1\dot{\theta}^2)",
            r"\quad-I_3\dot{\varphi}\omega_3\sin^2\theta)\,]\ /\ [\,I_1+mR^2\alpha^2\sin^2\theta",
            r"\quad-mR^2\alpha\sin\theta\,(1-\alpha\cos\theta)\,\mu v_x\,]",
        )
    ),
    "eq-2.14-no-nutation": Formula(
        (
            r"\frac{\omega_3\dot{\theta}R}{I_1}\,(I_3(\alpha-\cos\theta)+I_1\cos\theta)=0"
            r"\ \Rightarrow\ \dot{\theta}=0",
        )
    ),
    "eq-2.16": Formula(
        (
            r"I_1\dot{\varphi}^2\cos\theta-I_3\omega_3\dot{\varphi}-R\alpha g_n=0,\quad\ddot{\varphi}=0",
            r"\dot{\varphi}\omega_3(I_3(1-\alpha\cos\theta)-I_1)+g_nR\alpha(1-\alpha\cos\theta)"
            r"-I_1\alpha\dot{\varphi}^2\sin^2\theta=0",
        )
    ),
    "eq-2.16-third": Formula((r"\dot{\varphi}_3=0",), (r"\dot{\omega}_3=0",)),
    "eq-2.17": Formula((_STEADY,)),
    "eq-2.17-any-body": Formula((_STEADY,)),
    "eq-2.17-exception": Formula(
        (_STEADY + r"\quad\mathrm{if}\ \theta\neq\pi",), (_STEADY + r"\quad\mathrm{if}\ 0\neq\theta\neq\pi",)
    ),
    "table-1-inertia": Formula((_INERTIAS % (1, 3),), (_INERTIAS % (3, 1),)),
    "table-1-mu-unit": Formula((r"\mu=0.3\,\mathrm{m/s}",), (r"\mu=0.3\,\mathrm{s/m}",)),
    "table-1-g-unit": Formula((r"g=9.8\,\mathrm{m\,s^2}",), (r"g=9.8\,\mathrm{m\,s^{-2}}",)),
    "eq-4.1": Formula(
        (
            r"E=\frac{1}{2}mR^2[\,(\alpha-\cos\theta)^2(\dot{\theta}^2+\dot{\varphi}^2\sin^2\theta)",
            r"\quad+\sin^2\theta\,(\dot{\theta}^2+\omega_3^2+2\omega_3\dot{\varphi}(\alpha-\cos\theta))\,]",
            r"\quad+\frac{1}{2}[\,I_1(\dot{\varphi}^2\sin^2\theta+\dot{\theta}^2)+I_3\omega_3^2\,]"
            r"+mgR(1-\alpha\cos\theta)",
        ),
        (r"E_{\mathrm{as\ printed}}+m\,(\mathbf{v_A}\cdot\mathbf{w}+\frac{1}{2}v_A^2)",),
    ),
    "eq-b.1": Formula(
        (_STAGES, r"\quad+2f(Y_3,t_n+\frac{\Delta t}{2})+f(Y_4,t_n)\,]"),
        (_STAGES, r"\quad+2f(Y_3,t_n+\frac{\Delta t}{2})+f(Y_4,t_n+\Delta t)\,]"),
    ),
    "fig07-exponent": Formula((r"t\propto\mu^{-0.985}",)),
}
"""By claim; w in the energy is the velocity that the centre of mass has without slip."""
