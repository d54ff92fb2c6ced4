"""Impacts: the impulses of the table while friction follows its law.

`tippetop.contact.impact` follows one process for all. `struck_body` has what impulses do to a body,
`unit_impulse` the equations, and `struck_status` what slips, sticks and begins. `viscous_impact` is
the closed form of viscous friction on one contact; `jamming` is the impact without approach of
Painleve's paradox.
"""
