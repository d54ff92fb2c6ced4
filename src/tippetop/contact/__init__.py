"""Contact modes: how the top moves in each, what ends it, and what follows.

Read `mode` first: what a mode states. `contact_mode` is the mode of one or two closed contacts, by
the status of each, and `guards` is what ends it; `flight` is free flight; `slip_onset` and
`slip_end` are the first and the last moments of slip, or of rolling, by `slip_phase` and
`slip_clock`, and `slip_onset_on_two` and `slip_end_on_two` those on two contacts. `automaton`
decides which mode follows: it asks `touching`, `collision`, `soonest_end`, `settling_flat` (how a
disk comes to lie flat) and `two_closed` (the resolver of two contacts), and it alone names next
modes. `trajectory` follows one launch; `readings` and `block` read results off modes.
"""
