"""What the package costs, as ratios to other programs in the same run; `python -m benchmarks`."""
