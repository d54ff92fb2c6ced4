"""What the engine has of its own where Python has NumPy: pieces of polynomials, and values abreast."""

import json
import subprocess

import numpy as np

from node import NODE
from tippetop.engine import HERE

SIZE, DEGREE = 3, 4


def told(expression, **given):
    """What an expression of compile.js is, with some numbers."""
    script = "\n".join(
        [
            f"import * as compile from {json.dumps((HERE / 'compile.js').as_uri())};",
            *(f"const {name} = {json.dumps(np.asarray(value).tolist())};" for name, value in given.items()),
            f"console.log(JSON.stringify({expression}));",
        ]
    )
    options = [NODE, "--input-type=module", "-"]
    ran = subprocess.run(options, input=script, capture_output=True, text=True, timeout=60, check=False)
    assert ran.stderr == ""
    return json.loads(ran.stdout)


def test_a_share_of_a_piece_is_the_same_polynomial():
    whole = np.random.default_rng(1).normal(size=(3, SIZE, DEGREE))
    pieces, all_of_two, change = told(
        f"""[1.3, 2].map((count) => [...compile.pieces_of(Float64Array.from(flat), {SIZE}, {DEGREE}, count)])
            .concat([compile.change_over(Float64Array.from(flat), {SIZE}, {DEGREE})])""",
        flat=whole.ravel(),
    )
    powers = np.arange(1, DEGREE + 1)
    cut = np.reshape(pieces, (2, SIZE, DEGREE))
    np.testing.assert_array_equal(cut[0], whole[0])
    np.testing.assert_allclose(cut[1] @ 0.7**powers, whole[1] @ 0.21**powers, rtol=1e-13)
    np.testing.assert_array_equal(all_of_two, whole[:2].ravel())
    np.testing.assert_allclose(change, whole.sum(axis=(0, 2)), rtol=1e-13)


def test_numbers_of_several_values_are_made_better_until_they_are_good():
    """Heron's roots of two numbers abreast, whose errors are told beside them."""
    found = told(
        """(() => {
          const better = ([y], [p], values) => [(y.__add__(p.__truediv__(y))).__mul__(0.5),
            values.total(y.__mul__(y).__sub__(p).__abs__())];
          const improve = compile.iterated(better, 1, 1, 2), y = compile.room(2), out = compile.room(2);
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
    """A mode that cannot be recorded runs as it stands; one that is recorded and not compiled says so."""
    kinds = told(
        """(() => {
          const plus = ([y]) => [y.__add__(1.0)], branches = () => { throw new RangeError("a branch"); };
          const found = [plus, branches].map((one) => typeof compile.compiled(one, 1, 0));
          globalThis.Function = function () { throw new TypeError("no such operation"); };
          try { compile.compiled(plus, 1, 0); } catch ({ name }) { found.push(name); }
          return found;
        })()"""
    )
    assert kinds == ["function", "function", "TypeError"]
