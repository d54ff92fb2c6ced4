"""What can be known of a top without simulating it: steady states, their stability, the slow
flow.
"""
