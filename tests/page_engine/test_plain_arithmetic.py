"""What modules declare of their operands holds in launches of every kind.

Where the generated code has JavaScript's arithmetic operators, both operands are numbers, and where
it compares by order, they are numbers, strings or objects that tell: of lists these operators would
make something else, without a word. What is indexed by a constant is an object with such places.
"""

import ast
import json
import shutil

import pytest

import tippetop as tt
from launches import TOLERANCE, asked, in_javascript
from node import printed
from tippetop.page_engine import HERE
from tippetop.page_engine.generate import sources, translated
from tippetop.translate.expressions import ARITHMETIC, ATOM, COMPARISONS, LESS, Expressions

NUMBER = """
export function number(one) {
  if (typeof one !== "number" && typeof one !== "boolean") throw new TypeError(`no number: ${one}`);
  return one;
}
export function ordered(one) {
  if (Array.isArray(one)) throw new TypeError("no order: a list");
  return one;
}
export function row(one) {
  if (one.__getitem__ !== undefined) throw new TypeError("no row: an object with __getitem__");
  return one;
}
"""
SEEDS = (104, 1, 3, 32, 62, 64, 195, 327, 374)


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    """The engine with every operand of such an operator looked at."""
    plainly, by_order, item = Expressions._arithmetic, Expressions._compared, Expressions._item

    def looked_at(self, node):
        text, binds = plainly(self, node)
        if binds == ATOM:
            return text, binds
        left, right = self.text(node.left), self.text(node.right)
        return f"py.number({left}) {ARITHMETIC[type(node.op)][1]} py.number({right})", binds

    def compared(self, node, left, op, right):
        text, binds = by_order(self, node, left, op, right)
        if type(op) in COMPARISONS:
            sides = (f"py.ordered({self.text(one)})" for one in (left, right))
            return f" {COMPARISONS[type(op)]} ".join(sides), LESS
        return text, binds

    def indexed(self, node):
        text = item(self, node)
        row = self.text(node.value, ATOM)
        is_constant = isinstance(node.slice, ast.Constant) and text.startswith(f"{row}[")
        return f"py.row({row}){text.removeprefix(row)}" if is_constant else text

    folder = tmp_path_factory.mktemp("checked") / "engine"
    shutil.copytree(HERE, folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Expressions, "_arithmetic", looked_at)
        patch.setattr(Expressions, "_compared", compared)
        patch.setattr(Expressions, "_item", indexed)
        tables = (HERE / "tables.js").read_text(encoding="utf-8")
        text = translated({"tables.js": tables})
        (folder / "mechanics.js").write_text(text, encoding="utf-8")
    with (folder / "runtime.js").open("a", encoding="utf-8") as runtime:
        runtime.write(NUMBER)
    return folder


def broken(launches, checked):
    """Run launches in the engine that looks at its operands, and return the runs and what broke."""
    runs = [*in_javascript(launches, engine=checked)]
    return runs, [run["broken"] for run in runs if "broken" in run]


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_operands_are_numbers_in_launches_of_every_kind(checked, seed):
    assert broken([asked(seed, 0.05)], checked)[1] == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("friction", "flights"), [(tt.ViscousFriction(mu=0.3), 10), (tt.CoulombFriction(mu=0.3), -1)]
)
def test_operands_are_numbers_in_many_flights(checked, friction, flights):
    problem = tt.presets.report_problem(spin=175.0).replace(
        {"friction": friction, "contact.restitution": 0.3}
    )
    question = asked(0, 6.0) | {"problem": json.loads(problem.to_json()), "tolerance": TOLERANCE}
    (run,), trouble = broken([question], checked)
    assert trouble == []
    assert len(run["flights"]) > flights  # on dry friction it sticks, and does not fly


@pytest.mark.slow
def test_what_is_no_number_is_seen(checked):
    asking = f"""
      import * as m from {json.dumps((checked / "mechanics.js").as_uri())};
      for (const one of [[1], new m.SlipComponent(true), "1"]) {{
        try {{ m.halves([one, 0.5]); }}
        catch (error) {{ console.log(error.message); }}
      }}
    """
    assert printed(asking).count("no number: ") == 3


def test_every_declaration_is_in_a_module_that_is_translated():
    texts, _ = sources()
    package = HERE.parent
    for path in package.rglob("*.py"):
        if path.parent.name == "translate":
            continue
        module = ".".join(["tippetop", *path.relative_to(package).with_suffix("").parts])
        declares = "# translate" in path.read_text(encoding="utf-8")
        assert not declares or module in texts or path.parent == HERE, module
