"""Contacts of a body with the table, and the one linear system of their forces.

`system` has the multiplier system of any number of contacts.
"""
