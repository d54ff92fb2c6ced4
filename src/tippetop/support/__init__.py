"""What every room uses and none owns: errors, files, interrupts, processes and checked fields.

Read `errors` first: every refusal in the package is one of its classes. `validation` holds the
base class of checked, frozen parts of a problem; `accepted_values`, `field_paths` and `parsing`
serve it. `files`, `interrupts` and `processes` stand alone.
"""
