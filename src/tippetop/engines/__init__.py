"""The measure for other programs: exact runs of known problems, and what others make of them.

Read `cases` first: the problems. `reference` runs them here, holds every number against a solver
that shares no code (`independent/`), and writes the suite for others. `bodies` writes bodies in
the formats of other programs. `adapters/` has one file for each program, `comparison` runs the
cases in them, and `results/` has what came of it.
"""
