"""Contacts of a body with the table, and the one linear system of their forces.

Read `contact_point` first: the kinematics of one contact, and its response to a wrench. `system`
is the multiplier system of any number of contacts; `sticking` has the same forces of one contact
that sticks, in the fewest operations. `tippetop.mechanics.rolling` states which components a
status holds, and asks the system.
"""
