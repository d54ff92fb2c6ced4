"""Names of the JavaScript runtime that translated code may use.

`tests/translate` checks that the runtime has each of them.
"""

FUNCTIONS: dict[str, tuple[str, ...]] = {
    "abs": (),
    "all": (),
    "any": (),
    "bool": (),
    "complex": (),
    "dict": (),
    "enumerate": ("iterable", "start"),
    "float": (),
    "getattr": (),
    "hasattr": (),
    "int": (),
    "isinstance": (),
    "len": (),
    "list": (),
    "map": (),
    "max": (),
    "min": (),
    "next": (),
    "pairwise": (),
    "range": (),
    "repr": (),
    "reversed": (),
    "set": (),
    "sorted": (),
    "str": (),
    "sum": ("values", "start"),
    "tuple": (),
    "type": (),
    "zip": (),
}
"""Python's functions that the runtime has, with the parameters that may be passed by name."""

IMPORTED = {
    "dataclasses": ("replace",),
    "functools": ("partial",),
    "itertools": ("pairwise",),
    "operator": ("mul",),
}
"""Functions of Python's library that the runtime has, by their modules."""

ERRORS = (
    "ArithmeticError",
    "AssertionError",
    "NotImplementedError",
    "ValueError",
    "ZeroDivisionError",
)
VALUES = ("NotImplemented",)

MATH = (
    *("acos", "asin", "atan", "atan2", "ceil", "copysign", "cos", "cosh", "dist", "exp", "expm1"),
    *("factorial", "floor", "hypot", "inf", "isfinite", "isinf", "isnan", "log", "log10"),
    *("acosh", "log1p", "nan", "pi", "radians", "sin", "sinh", "sqrt", "tan", "tanh", "tau"),
)
"""Members of `math`."""

NUMPY = (
    *("abs", "any", "arctan2", "array", "copysign", "cos", "cosh", "empty", "fmax", "hypot"),
    *("inf", "isfinite", "less", "max", "maximum", "min", "minimum", "nan", "pi", "sin"),
    *("sinh", "sqrt", "stack", "where", "zeros"),
)
"""Members of NumPy."""

NUMPY_ARRAYS = (
    *("abs", "angle", "arange", "arcsin", "arctan2", "argmin", "array", "asarray", "clip"),
    *("concatenate", "cos", "diff", "exp", "flatnonzero", "full", "hypot", "inf", "linspace"),
    *("maximum", "minimum", "mod", "ones", "pi", "ptp", "sin", "sinc", "sqrt", "where", "zeros"),
)
"""Members of NumPy in modules that declare ``numpy``."""

CMATH = ("exp", "phase", "rect")
"""Members of `cmath`."""

MODULES = {"math": MATH, "np": NUMPY, "cmath": CMATH}

METHODS: dict[str, tuple[str, int, int]] = {
    "all": ("{0}.all()", 0, 0),
    "any": ("{0}.any()", 0, 0),
    "append": ("{0}.push({1})", 1, 1),
    "add": ("py.add_to({0}, {1})", 1, 1),
    "conjugate": ("{0}.conjugate()", 0, 0),
    "copy": ("{0}.copy()", 0, 0),
    "get": ("{0}.get({1})", 1, 2),
    "index": ("py.index({0}, {1})", 1, 1),
    "isprintable": ("py.isprintable({0})", 0, 0),
    "items": ("{0}.entries()", 0, 0),
    "join": ("py.join({0}, {1})", 1, 1),
    "keys": ("{0}.keys()", 0, 0),
    "lower": ("{0}.toLowerCase()", 0, 0),
    "max": ("{0}.max()", 0, 0),
    "mean": ("{0}.mean()", 0, 0),
    "min": ("{0}.min()", 0, 0),
    "model_copy": ("{0}.model_copy({1})", 1, 1),
    "model_dump": ("{0}.model_dump({1})", 0, 0),
    "pop": ("py.pop({0}, {1})", 0, 1),
    "removeprefix": ("py.removeprefix({0}, {1})", 1, 1),
    "split": ("{0}.split({1})", 1, 1),
    "startswith": ("{0}.startsWith({1})", 1, 1),
    "sum": ("{0}.sum()", 0, 0),
    "tolist": ("py.list({0})", 0, 0),
    "values": ("{0}.values()", 0, 0),
}
"""Methods of Python's types in JavaScript, with the least and largest number of arguments."""
