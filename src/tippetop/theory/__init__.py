"""Analytical results about a launch, without simulating it.

Read `steady` first: steady states and Jellett's integral. `stability`, `thresholds` and `groups`
say which of them are stable, and `prediction` where a launch ends. `nutation`, `dissipation`,
`nutation_decay`, `averaging` and `slow_time` have the slow flow under weak friction. `level` has
spins about a horizontal axis, `rolling` circles and straight lines of bodies whose contact sticks,
and `spectra` judges single states. `sleeping`, `stem`, `drilling` and `resting_center` treat other
bodies and friction; `outlook`, `prospects` and `advice` collect the results for people.
"""
