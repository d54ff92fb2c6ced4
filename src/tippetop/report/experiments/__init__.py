"""The computations behind the figures and claims, a file for each subject."""
