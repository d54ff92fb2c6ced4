"""What the report says, word for word, by the claim that examines it.

Formulas within a sentence are in the plain notation of the claims; `tippetop.report.formulas` has those that
the report sets apart.
"""

SENTENCES: dict[str, str] = {
    "why-only-simulation": (
        "The complexity leads us to the only possible approach to the dynamic of TT, that is numerical "
        "simulation."
    ),
    "eq-2.1": "The angle velocity can be easily obtained",
    "eq-2.6": "which is well known as Euler Dynamic Equations.",
    "eq-2.8": "and construct g_n by constraint condition (s + a).z = 0, we have",
    "eq-2.7": "Now, we finally give our equations",
    "eq-2.9": (
        "phi'' = I1 / (I3 theta' omega3 - 2 I1 theta' phi' cos theta - mu g_n v_y R (alpha - cos theta)) / "
        "I1 sin theta"
    ),
    "sec2-large-spin": (
        "Because to constrain the TT on the surface in this situation, g_n has to be negative."
    ),
    "why-final-tilt": (
        "When the time scale is enough, we can conclude that the TT may spin steadily without any energy"
        " loss."
    ),
    "fig04-slip": "The translation velocity which converges to 0",
    "fig05-slip": "The translation velocity which converges to 0",
    "sec2-no-slip": "in the end of evolution, v_x, v_y, v_x', v_y' must vanished.",
    "eq-2.7-mu-unit": "Where mu has dimension of s/m.",
    "eq-2.14-no-nutation": "leads to theta' = 0.",
    "eq-2.16": "Apply v_x = v_y = v_x' = v_y' = theta' = 0 to other equations we conclude",
    "eq-2.16-third": "phi_3' = 0",
    "eq-2.17-exception": "If theta != pi, we have",
    "eq-2.17-any-body": "This relation holds independently on the mass and moment of inertia.",
    "section-3-method": "we use 4-order Runge-Kutta Method to take a reliable simulation.",
    "section-3-reliable": "we use 4-order Runge-Kutta Method to take a reliable simulation.",
    "table-1-inertia": "I_1: 2/5mR^2; I_3: 131/350mR^2",
    "table-1-mu-unit": "mu: 0.3m/s",
    "table-1-g-unit": "g: 9.8ms^2",
    "fig04-inverts": "the TT will turn around completely which implies that theta = pi.",
    "fig04-flip-time": "it flips over completely around t=7.4s",
    "fig04-first-reversal": "which reverses at t=3.3s and t=7.9s.",
    "fig04-second-reversal": "which reverses at t=3.3s and t=7.9s.",
    "fig05-flip-time": "it flips over half around t=8.9s",
    "fig05-reversal": "which reverses at t=1.1s",
    "fig05-end": "In the end of the theta=1.503, phi'=35.257, omega=-8.201",
    "eq-2.17": "which perfectly correspond to the (2.17)",
    "sec3-omega-smooth": "The omega is smooth and behave similarly.",
    "sec3-no-nutation": (
        "if the omega is not enough big, the TT even can not nutate and keep stable around theta=0."
    ),
    "fig06-c1": "The two critical point is omega_c1=26.3 and omega_c2=78.6.",
    "fig06-c2": "The two critical point is omega_c1=26.3 and omega_c2=78.6.",
    "fig06-a": "an abnormal point occur around omega_a=170.",
    "why-regimes": "When omega_c1 < omega0 < omega_c2, the TT will keep a constant nutation angle",
    "sec3-friction": (
        "However, if the friction is too large, it also difficult for TT to flip because of obstacle."
    ),
    "fig07-exponent": "We conclude that t ∝ mu^-0.985, which is approach t ∝ mu^-1",
    "summary-large-mu": "Out of the normal range, the relation mentioned in 5 is lose efficacy.",
    "fig07-inverse": (
        "when mu is in the normal range (0.2 1), the flip time is inversely proportional to the mu."
    ),
    "eq-2.17-range": "the TT will keep a constant nutation angle and the final angle velocity holds (2.17)",
    "fig08-rapid": "it notate around theta = pi rapidly and finally stop notate.",
    "fig08-around-pi": "it notate around theta = pi rapidly and finally stop notate.",
    "fig08-settles": "it notate around theta = pi rapidly and finally stop notate.",
    "fig08-block": "a wedge with initial velocity 1m/s can just travel for 0.001m.",
    "sum-turns-over": "When omega_c2 < omega0, the TT will completely flip over and spin on its leg.",
    "sum-abnormal": (
        "abnormal behavior perform. In the next section we'll point out this is caused by the g_n < 0 "
        "and is a non-physical situation."
    ),
    "fig09-two-motions": "The nutation of the TT is quite complex, which mix rapid and smooth nutation.",
    "eq-4.1": "we calculate the energy of this TT, the energy function is given",
    "sec4-energy-falls": "the system is lossing it energy during the motion",
    "fig10-impossible": "the only force can do positive work is the gravity.",
    "fig10-gain": "to gain such a big energy(0.06J). at t=6s.",
    "fig10-by-falling": "the TT would have felled down for 15R to gain such a big energy(0.06J).",
    "fig10-fall": "However, the TT would have felled down for 15R to gain such a big energy(0.06J).",
    "fig11-negative": "the constrain force g_n can never be negative. However, in this system we point that",
    "sec4-huge-spin": "So, we can't constrain our Tipper Top on the surface in huge omega.",
    "sec4-may-fly": "the TT may fly from the surface and make a complex situation which is hard to discuss.",
    "fig12-stop-time": "At t=5.62s, before the critical time, the motion is",
    "section-5-stiff": "the ODE equation is stiff and ode45 function is unbearably slow.",
    "section-5-cause": "In some bad initial condition, the ODE equation is stiff",
    "section-5-ode15s": "function for stiff ode and get a reliable solution.",
    "section-5-small-mu": (
        "the conclusion which shows this dependence is true even for mu=0.01 may surprise them."
    ),
    "why-flip-law": "I believe that there is a more fundamental ruler guarantees the correctness.",
    "listing-theta-mod-pi": "the = mod(y(1), pi);",
    "eq-b.1": "for equation y = f(t, y), we have",
    "appendix-b-order": "One can proof that this method has an accuracy of order (Δt)^5.",
    "fig13-upright": "This is the theta - t relation under the omega0 = 10 rad/s",
    "fig14-inverts": "This is the theta-t relation under the omega0=90 rad/s",
    "fig15-inverts": "This is the theta-t relation under the omega0=120 rad/s",
    "fig16-stays": "This is the theta-t relation under the omega0=150 rad/s and theta0=pi/4",
}
"""Short quotations, in the report's own spelling."""
