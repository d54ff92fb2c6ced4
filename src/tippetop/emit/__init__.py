"""The mechanics recorded as a graph of operations, and printed as code for other machines."""
