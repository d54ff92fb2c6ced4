"""Functions that examine the claims, a file for each subject; `registry` collects them."""
