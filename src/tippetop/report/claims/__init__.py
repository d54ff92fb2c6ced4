"""Everything the report claims that can be put to numbers, a file for each part of it."""
