"""MJCF, the XML of MuJoCo, read as a problem.

`document` has the text: elements, their names in refusals, and default classes. `poses` turns
positions and orientations into numbers, `geoms` has shapes and their masses. `reading` puts them
together: the one free body, the table, the contact between them, and the launch.
"""
