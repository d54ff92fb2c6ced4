"""Real tops measured: data as people have it, fits with errors, plans of measurements.

Read `delimited` (text to columns), `observations` (what a run would have shown a camera or a
clock), `measurement` (data and what they observe), `model` (numbers of a problem to values and
their derivatives), then `least_squares`, `fitted` and `planning`.
"""
