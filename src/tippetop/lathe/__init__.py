"""Turned bodies: their profiles, mass properties, and the surfaces on which they stand.

Read `workpiece` first: what users state. `profile`, a closed line of `edges`, is the checked
outline; `fitting`, with `arcs` and `rounding`, makes arcs and lines of stated points; `mass` and
`hull` compute from the profile; `support` approximates smooth parts of a hull. `files` reads
workpieces from TOML, points, drawings (`svg`, `dxf`, `sheet`, `strokes`) and meshes (`scan`).
`design` finds bodies with desired properties.
"""
