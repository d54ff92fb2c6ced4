"""What is read off a run, and how it is labelled and filed.

Read `catalogue` first: it names every variable of a result. `samples` and `observables` compute
them along a run, and `derived` what follows from them; `metrics` defines each single number and
`run_metrics` accumulates them, `monitor` checks what must be conserved. `dataset` labels the
result, `flags` turns numbers of flags into words, `dataframes` makes tables of it, `summary` picks
the few numbers that people want, `netcdf` files a run.
"""
