"""Results of a run: their computation, labels, files and description in words.

Read `catalogue` first: it names every variable of a result. `observables` and `samples` compute
them along a run, and `derived` what follows from them. `metrics` defines each single number. `sums`
lists the integrals along a run, and `accumulation` how the other quantities of its parts are
joined; `run_metrics` accumulates them. `settling` says where a motion stays, and `accuracy_monitor`
checks what must be conserved. `dataset` labels the result, `cf_flags` turns numbers of flags into
words, `dataframes` makes tables, `summary` picks the main numbers, `account` and `account_text` put
a run in words, and `netcdf` writes and reads files. `event_functions`, `motion_state` and
`run_solution` serve users' functions and dense output.
"""
