"""Contact modes: how the top moves in each, what ends it, and what follows.

Read `mode` first: what a mode states. `contact_mode` is the mode of one or two closed contacts, by
the status of each; `closed_contacts` is such contacts at an instant, of which `guards` are
functions. `slip_onset` and `slip_end_mode` are transforms of a contact mode: the first and the last
moments of one of its velocities, by `slip_phase` and `slip_end_motion`. `flight` is free flight,
and `face_mode` the motion on a flat face, over whose rim a body tips by `tip_onset`. `automaton`
decides which mode follows: it asks `touching`, `collision`, `soonest_end`, `settling_flat` (how a
disk comes to lie flat) and `closed_pair` (the resolver of two contacts), and it alone names next
modes. `impact` is the one process of every impact, with the equations of `impact_motion`, and
`face_impact` that of a body that lands flat.
`trajectory` follows one launch; `readings` and `block` read results off modes.
"""
