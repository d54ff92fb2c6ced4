"""The report redone: its figures and its claims, by its own method and by a converged one.

`reproduce` is the whole procedure: `selection` chooses figures and claims, `tasks` carries out the
computations of `experiments/` and draws the figures of `gallery`, the functions of `claims/`
examine the claims, and `page` writes them as one page. `claim` states the rule by which claims are
judged. `listing` and `ode45` are the report's own method; `moreau` is time-stepping, which shares
no equations with the package. Texts are in the files of TOML.
"""
