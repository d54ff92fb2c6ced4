"""Contacts of a body with the table, and the one linear system of their forces.

Read `contact_point` first: the kinematics of one contact, and its response to a wrench. `system`
is the multiplier system of any number of contacts, and `forces` states which components a status
holds and asks the system; `sticking` has the same forces of one contact that sticks, in the fewest
operations. `slip_variables` has the velocities that slip, `onset_forces` and `slip_direction` the
directions in which they begin, `slip_clock` the clock in which they end, and `slip_collocation` a
step along either. `pair` and `pair_resolution` are of two contacts.
"""
