"""What the engine has of its own where Python has NumPy: functions of values abreast, compiled."""

import json

import numpy as np

from node import printed
from tippetop.page_engine import HERE


def told(expression, **given):
    """What an expression of compile.js is, with some numbers."""
    script = "\n".join(
        [
            f"import * as compile from {json.dumps((HERE / 'compile.js').as_uri())};",
            *(
                f"const {name} = {json.dumps(np.asarray(value).tolist())};"
                for name, value in given.items()
            ),
            f"console.log(JSON.stringify({expression}));",
        ]
    )
    return json.loads(printed(script))


def test_numbers_of_several_values_are_made_better_until_they_are_good():
    """Heron's roots of two numbers abreast, whose errors are told beside them."""
    found = told(
        """(() => {
          const better = ([y], [p], values) => [(y.__add__(p.__truediv__(y))).__mul__(0.5),
            values.total(y.__mul__(y).__sub__(p).__abs__())];
          const improve = compile.iterated(better, 1, 1, 2);
          const y = compile.room(2), out = compile.room(2);
          compile.put_rows(y, 0, [2], 2);
          return [improve(y, Float64Array.from(squares), out, 1e-12, 50), ...y, ...out];
        })()""",
        squares=[2.0, 9.0],
    )
    turns, *roots = found[:3]
    assert 3 < turns < 10
    np.testing.assert_allclose(roots, np.sqrt([2.0, 9.0]), rtol=1e-15)
    assert found[3] == found[4] < 1e-12


def test_trouble_in_what_is_made_of_a_mode_is_told():
    """What cannot be recorded, and what is recorded and not compiled, says so."""
    kinds = told("""(() => {
          const plus = ([y]) => [y.__add__(1.0)];
          const branches = () => { throw new RangeError("a branch"); };
          const found = [typeof compile.compiled(plus, 1, 0)];
          for (const one of [branches, plus]) {
            try { compile.compiled(one, 1, 0); } catch ({ name }) { found.push(name); }
            globalThis.Function = function () { throw new TypeError("no such operation"); };
          }
          return found;
        })()""")
    assert kinds == ["function", "RangeError", "TypeError"]
