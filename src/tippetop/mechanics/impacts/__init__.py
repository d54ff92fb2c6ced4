"""Impacts: the impulses of the table while friction follows its law.

Read `impact` first. `struck_body` has what impulses do to a body; `process` steps through an
impact with the normal impulse as time. `dry_impact`, `viscous_impact` and `impact_on_two` are the
processes of dry and viscous friction, and of two surfaces; `jamming` is the impact without approach
of Painleve's paradox.
"""
