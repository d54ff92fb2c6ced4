"""Real tops measured: data as people have it, fits with errors, plans of measurements.

Read `delimited` (text to columns), `observations` (what a run would have shown a camera or a
clock), `measurement` (data and what they observe), `model` (numbers of a problem to values and
their derivatives), then `least_squares`, `search`, `fit_result` (standard errors and cautions) and
`planning`. Derivatives of runs are `sensitivities`: read `variable_slopes` for how they are read
off runs beside a run, `linearized_run` for how they go through events, and before that
`variational` (equations of motion with their derivatives) and `problem_numbers` (fields of a
problem to what a run starts from). `improve` finds better tops by them and by theory.
"""
