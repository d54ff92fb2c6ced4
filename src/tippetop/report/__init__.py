"""The report redone: its figures and its claims, each computed by its own method and by a converged
one.
"""
