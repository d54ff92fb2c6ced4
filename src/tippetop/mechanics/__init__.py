"""The mechanics of a body of revolution on a table: numbers in, numbers out.

Every function is written once in plain operators, so that the same line serves floats, NumPy
arrays, compiled expressions and computer algebra. Nothing here knows arrays, files or units of
input.

Read `top`, `surface` and `friction` first, then `motion`: a body that slides on one contact.
`contacts` has the multiplier system of any number of contacts, and `rolling` the forces by the
status of each. `stick_slip` and `ending` follow slip to its end, `beginning` and `pair_resolver`
find what sticks and in which direction slip begins, `impact` is the process of an impact.
"""
