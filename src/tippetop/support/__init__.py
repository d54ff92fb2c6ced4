"""Shared services of all rooms: errors, files, interrupts, processes, units, checked fields.

Read `errors` first: every refusal in the package is one of its classes. `validation` holds the base
class of checked, frozen parts of a problem; `accepted_values`, `field_paths`, `suggestions`,
`units` and `parsing` serve it. `files`, `interrupts` and `processes` need none of these.
"""
