"""What LLVM compiles for many launches is kept between processes, and run only as it was kept."""

import numpy as np
import pytest

from tippetop.graph.recording import record
from tippetop.integrators import machine_code
from tippetop.integrators.sealed_folders import CONTENT, VARIABLE


def assert_computes(function):
    y, p, out = np.arange(16.0)[None], np.full((1, 16), 3.0), np.empty((1, 16))
    function(y, p, out)
    np.testing.assert_array_equal(out, y * p - 1.0)


@pytest.fixture
def recorded():
    return {"f": record(lambda y, p: (y[0] * p[0] - 1.0,), 1, 1)}


def test_code_is_compiled_once_and_again_where_it_is_damaged(recorded, tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    assert_computes(machine_code.machine_code(recorded, 8)["f"])
    (kept,) = tmp_path.glob(f"*/{CONTENT}")
    content = kept.read_bytes()
    with monkeypatch.context() as without:
        without.setattr(machine_code, "_compiled", None)
        assert_computes(machine_code.machine_code(recorded, 8)["f"])
    kept.write_bytes(content[:100] + b"damaged" + content[107:])
    assert_computes(machine_code.machine_code(recorded, 8)["f"])
    assert kept.read_bytes() == content


@pytest.mark.parametrize("place", ["off", "file"])
def test_without_a_cache_it_is_compiled_all_the_same(recorded, place, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv(VARIABLE, place if place == "off" else str(tmp_path / place))
    assert_computes(machine_code.machine_code(recorded, 8)["f"])
