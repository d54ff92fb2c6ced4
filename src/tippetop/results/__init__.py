"""What is read off a run, and how it is labelled and filed.

Read `catalogue` first: it names every variable of a result. `samples` and `observables` compute
them along a run, `metrics` defines each single number and `run_metrics` accumulates them,
`monitor` checks what must be conserved. `dataset` labels the result, `summary` picks the few
numbers that people want, `netcdf` files a run.
"""
