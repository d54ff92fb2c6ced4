"""Functions in plain operators recorded as expression graphs, and printed as LLVM or JavaScript.

Read `graph` (nodes) and `recording` first. `hoisting`, `unrolling` and `taylor_coefficients`
transform recorded functions; `llvm` (with `llvm_powers`) and `javascript` print them, and
`llvm_series` prints the loop over the orders of their Taylor series.
"""
