"""The laboratory: a page where anyone launches the top, and the player in a notebook. Browsers
compute it.
"""
