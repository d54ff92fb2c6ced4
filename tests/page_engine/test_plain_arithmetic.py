"""Where what is generated has operators of JavaScript between two operands, both are numbers.

Of lists and what has arithmetic of its own they would make something else, without a word.
"""

import json
import shutil

import pytest

import tippetop as tt
from launches import TOLERANCE, asked, in_javascript
from node import printed
from tippetop.page_engine import HERE
from tippetop.page_engine.generate import translated
from tippetop.translate.expressions import ARITHMETIC, ATOM, BITS, Expressions

NUMBER = """
export function number(one) {
  if (typeof one !== "number" && typeof one !== "boolean") throw new TypeError(`no number: ${one}`);
  return one;
}
"""
SEEDS = (1, 3, 32, 62, 64, 104, 195, 327, 374)


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    """The engine with every operand of such an operator looked at."""
    plainly = Expressions._arithmetic

    def looked_at(self, node):
        text, binds = plainly(self, node)
        if binds in (ATOM, BITS):
            return text, binds
        left, right = self.text(node.left), self.text(node.right)
        return f"py.number({left}) {ARITHMETIC[type(node.op)][1]} py.number({right})", binds

    folder = tmp_path_factory.mktemp("checked") / "engine"
    shutil.copytree(HERE, folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Expressions, "_arithmetic", looked_at)
        (folder / "mechanics.js").write_text(translated(), encoding="utf-8")
    with (folder / "runtime.js").open("a", encoding="utf-8") as runtime:
        runtime.write(NUMBER)
    return folder


def test_operands_are_numbers_in_launches_of_every_kind(checked):
    launches = [asked(seed, 0.3) for seed in SEEDS]
    for friction in (tt.ViscousFriction(mu=0.3), tt.CoulombFriction(mu=0.3)):
        problem = tt.presets.report_problem(spin=175.0).replace(
            {"friction": friction, "contact.restitution": 0.3}
        )
        launches.append(
            asked(0, 6.0) | {"problem": json.loads(problem.to_json()), "tolerance": TOLERANCE}
        )
    found = [*in_javascript(launches, engine=checked)]
    assert [one["broken"] for one in found if "broken" in one] == []
    assert sum(len(one["flights"]) for one in found) > 10


def test_what_is_no_number_is_seen(checked):
    asking = f"""
      import * as m from {json.dumps((checked / "mechanics.js").as_uri())};
      for (const one of [[1], new m.Tip(), "1"]) {{
        try {{ m.stays_positive(one, 0, 0, 0, 0.5); }}
        catch (error) {{ console.log(error.message); }}
      }}
    """
    assert printed(asking).count("no number: ") == 3
