"""Powers with small exponents in LLVM's code, for several launches an instruction.

LLVM itself calls the C library for them, once for every launch.
"""

import math
from collections.abc import Sequence
from struct import pack

from tippetop.graph import graph

LARGEST = 0.5
"""Exponents between 0 and this are served: so no power of a number overflows."""

LOGARITHM_TERMS = [2.0 / math.log(2.0) / (2 * k + 1) for k in range(11)]
"""log2((1 + s) / (1 - s)) / s in powers of s^2: to rounding for numbers from 2^(-1/2) to 2^(1/2).
"""

EXPONENTIAL_TERMS = [math.log(2.0) ** k / math.factorial(k) for k in range(14)]
"""2^f in powers of f, to rounding for |f| <= 1/2."""

FUNCTION = """\
declare {v} @llvm.floor.v{n}f64({v})
declare {v} @llvm.fma.v{n}f64({v}, {v}, {v})
define internal {v} @small_power({v} %x, {v} %y) {{
  %subnormal = fcmp ogt {v} {smallest}, %x
  %larger = fmul {v} %x, {scale}
  %base = select <{n} x i1> %subnormal, {v} %larger, {v} %x
  %bits = bitcast {v} %base to {i}
  %above = sub {i} %bits, {half}
  %doublings = ashr {i} %above, {places}
  %exponent = shl {i} %doublings, {places}
  %rest = sub {i} %bits, %exponent
  %m = bitcast {i} %rest to {v}
  %whole = trunc {i} %doublings to <{n} x i32>
  %e_base = sitofp <{n} x i32> %whole to {v}
  %e_larger = fsub {v} %e_base, {scaled}
  %e = select <{n} x i1> %subnormal, {v} %e_larger, {v} %e_base
  %down = fsub {v} %m, {one}
  %up = fadd {v} %m, {one}
  %s = fdiv {v} %down, %up
  %s2 = fmul {v} %s, %s
{logarithm}
  %part = fmul {v} %s, %log
  %small = fmul {v} %y, %part
  %sum = call {v} @llvm.fma.v{n}f64({v} %y, {v} %e, {v} %small)
  %nearly = fadd {v} %sum, {nearest}
  %turns = call {v} @llvm.floor.v{n}f64({v} %nearly)
  %less = fneg {v} %turns
  %exactly = call {v} @llvm.fma.v{n}f64({v} %y, {v} %e, {v} %less)
  %f = fadd {v} %exactly, %small
{exponential}
  %count = fptosi {v} %turns to <{n} x i32>
  %wide = sext <{n} x i32> %count to {i}
  %places = shl {i} %wide, {places}
  %mantissa = bitcast {v} %exp to {i}
  %power_bits = add {i} %mantissa, %places
  %power = bitcast {i} %power_bits to {v}
  %low = fcmp ogt {v} %x, zeroinitializer
  %high = fcmp ogt {v} {infinity}, %x
  %usual = and <{n} x i1> %low, %high
  %root = call {v} @llvm.sqrt.v{n}f64({v} %x)
  %found = select <{n} x i1> %usual, {v} %power, {v} %root
  ret {v} %found
}}
"""
"""x^y by x = 2^e m: y e less the nearest whole number is exact.

Where x has no logarithm, its square root is what the power is.
"""


def is_small_power(node: graph.Node) -> bool:
    """Return whether a node is a power that `small_power` computes."""
    return node.name == graph.POWER and 0.0 < node.operands[1].value <= LARGEST


def spread(value: float, abreast: int) -> str:
    """Return a vector of so many times a number."""
    bits = pack(">d", value).hex().upper()
    return f"<{', '.join([f'double 0x{bits}'] * abreast)}>"


def power_function(abreast: int) -> str:
    """Return the function `small_power(x, y)`, y from 0 to `LARGEST`, of vectors of so many
    numbers.
    """
    v = f"<{abreast} x double>"
    numbers = {
        "smallest": 2.0**-1022,
        "scale": 2.0**54,
        "scaled": 54.0,
        "one": 1.0,
        "nearest": 0.5,
        "infinity": math.inf,
    }
    wholes = {"half": 0x3FE6A09E667F3BCD, "places": 52}

    def polynomial(name: str, terms: Sequence[float], place: str) -> str:
        total, lines = spread(terms[-1], abreast), []
        for k in range(len(terms) - 2, -1, -1):
            result, term = f"%{name}{k}" if k else f"%{name}", spread(terms[k], abreast)
            sum_of = f"({v} {total}, {v} {place}, {v} {term})"
            lines.append(f"  {result} = call {v} @llvm.fma.v{abreast}f64{sum_of}")
            total = result
        return "\n".join(lines)

    return FUNCTION.format(
        v=v,
        i=f"<{abreast} x i64>",
        n=abreast,
        logarithm=polynomial("log", LOGARITHM_TERMS, "%s2"),
        exponential=polynomial("exp", EXPONENTIAL_TERMS, "%f"),
        **{name: spread(value, abreast) for name, value in numbers.items()},
        **{name: f"<{', '.join([f'i64 {value}'] * abreast)}>" for name, value in wholes.items()},
    )
