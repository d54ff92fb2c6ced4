"""Friction laws: force and torque of the table per unit normal force.

Read `friction` first: what a law states, and the smooth laws. `coulomb` is dry friction, and the
resistance to rolling. `contensou` is a patch that slips and drills, and `contensou_hertz` such a
patch under Hertz's pressure, exactly; `hertz_shares` has its functions. `face_friction` is the
friction of a flat face.
"""
