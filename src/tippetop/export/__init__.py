"""Runs as files that others open: pictures that move, models that play, tables."""
