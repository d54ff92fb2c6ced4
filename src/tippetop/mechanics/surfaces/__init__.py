"""Surfaces of revolution that touch the table, and outlines of bodies.

Read `surface` first: support functions h(c) of each kind of surface. `hull` is a body of several
surfaces; `outline` draws a body's outline.
"""
