"""Numbers that the report prints and that several figures or claims need, each with its place."""

SPIN, TILT, MU = 155.0, 0.1, 0.3
"""Spin (rad/s), tilt (rad) and friction (s/m) of the report's main launch (section 3.1)."""

TURNED_AT = {"fig04": "7.4", "fig05": "8.9"}
"""Times at which the top has turned over completely and half, s (captions of Figs. 4, 5)."""

REVERSALS = {"fig04": ("3.3", "7.9"), "fig05": ("1.1",)}
"""Times at which the precession reverses, s (captions of Figs. 4 and 5)."""

END_OF_FIG_5 = {"tilt": 1.503, "precession": 35.257, "spin": -8.201}
"""End state of the run at 50 rad/s, rad and rad/s (section 3.1, below Fig. 5)."""

CRITICAL_SPINS = ("26.3", "78.6")
"""omega_c1 and omega_c2, rad/s (section 3.2)."""

ABNORMAL_SPIN = "170"
"""omega_a, rad/s (section 3.2)."""

EXPONENT, NORMAL_FRICTION = "-0.985", (0.2, 1.0)
"""Power of mu in the flip time, and its range of mu, s/m (section 3.3, Fig. 7)."""

ROUGH_FRICTION = 100.0
"""Friction of Fig. 8, s/m."""

ENERGY, ENERGY_TIME, FALL = "0.06", "6", "15"
"""Energy at 175 rad/s, J, its time, s, and the fall that is compared, R (section 4, Fig. 10)."""

STOP = "5.62"
"""Time at which the run at 175 rad/s is stopped "before" it flies, s (section 4, Fig. 12)."""
