"""Computations behind the figures and claims, a file for each subject; `registry` collects them."""
