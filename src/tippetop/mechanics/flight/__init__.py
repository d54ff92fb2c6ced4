"""Free flight, and the instant at which it ends.

Read `free_motion` first: the motion in closed form. `separation` is the gap as a function of time,
`touchdown` finds its first root with proof, and `complex_disc` has the bounds that this needs.
"""
