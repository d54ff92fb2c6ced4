"""Figures: results in, matplotlib figures out; nothing here solves anything."""
