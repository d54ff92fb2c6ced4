"""The mechanics of a body of revolution on a table: numbers in, numbers out.

Every function is written once in plain operators, so that the same line serves floats, NumPy
arrays, compiled expressions and computer algebra. Nothing here knows arrays, files or units of
input.
"""
