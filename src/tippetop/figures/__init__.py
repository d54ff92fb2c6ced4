"""Figures: results in, matplotlib figures out; nothing here solves anything.

Those of the report take the datasets of its experiments, which say themselves what their variables
are.
"""
