"""The mechanics of a body of revolution on a table: numbers in, numbers out.

Every function is written once in plain operators, so that the same line serves floats, NumPy
arrays, compiled expressions and computer algebra. Nothing here knows arrays, files or units of
input.

Read `top`, `surfaces` and `laws` first, then `motion`: a body that slides on one contact.
`contacts` has the multiplier system of any number of contacts, the forces by the status of each,
and how slip begins and ends; `lying_down` is the end of a disk. `impacts` is the process of an
impact, `flight` is free motion.
"""
