"""Compiled code that was damaged in the cache is never run, and costs a compilation."""

import os
import sqlite3
import subprocess
import sys

import numpy as np
import pytest

from tippetop.integrators import has_taylor

if not has_taylor():
    pytest.skip("heyoka is not installed", allow_module_level=True)

from tippetop.integrators.cache_folder import VARIABLE
from tippetop.integrators.compile_cache import compiling, drop_damaged, use_compile_cache

MANY = int(os.environ.get("TIPPETOP_FAULTS", "1"))
"""How many times more faults than in a quick run."""

SWINGS = """
import numpy as np
from tippetop.integrators import Motion, make_integrator
for degree in (1, 3):
    motion = Motion(lambda y, p: (y[1], -p[0] ** 2 * y[0] ** degree), size=2, parameters=1)
    start = 0.0, np.array([1.0, 0.0])
    *_, arc = make_integrator("taylor").integrate(motion, (np.pi,), start, 1.0)
    assert degree == 3 or abs(arc.end_state[0] + 1.0) < 1e-14, arc
    assert abs(arc.end_state[1] ** 2 / 2 + np.pi**2 * arc.end_state[0] ** (degree + 1) / (degree + 1)
        - np.pi**2 / (degree + 1)) < 1e-13, arc
"""


def swing(folder):
    """Follow two motions in another process, which must be right and silent."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", SWINGS],
        env={**os.environ, VARIABLE: str(folder)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stdout, done.stderr, done.returncode) == ("", "", 0)


def entries(database):
    """The compiled code in a cache by its key."""
    with sqlite3.connect(database) as opened:
        rows = opened.execute("SELECT hash, bitcode, comp_flag, opt_bc, opt_ir, obj FROM cache").fetchall()
    opened.close()
    return {row[0]: row[1:] for row in rows}


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """A cache with two entries, closed."""
    folder = tmp_path_factory.mktemp("filled")
    swing(folder)
    assert len(entries(folder / "cache.db")) >= 2
    return (folder / "cache.db").read_bytes()


def damage(content, rng, number):
    """A content in which bits flipped, or bytes are zero or of another place."""
    damaged = bytearray(content)
    first = int(rng.integers(len(content)))
    length = int(min(rng.integers(1, 5000), len(content) - first))
    match number % 4:
        case 0 | 1:
            damaged[first] ^= 1 << int(rng.integers(8))
        case 2:
            damaged[first : first + length] = bytes(length)
        case 3:
            other = int(rng.integers(len(content) - length + 1))
            damaged[first : first + length] = content[other : other + length]
    return bytes(damaged)


def test_a_cache_that_is_whole_is_kept(filled, tmp_path):
    database = tmp_path / "cache.db"
    database.write_bytes(filled)
    before = entries(database)
    assert drop_damaged(database)
    assert entries(database) == before
    swing(tmp_path)
    assert entries(database) == before


def test_damage_at_any_place_is_dropped(filled, tmp_path):
    database, rng = tmp_path / "cache.db", np.random.default_rng(7)
    database.write_bytes(filled)
    good, kept = entries(database), 0
    for number in range(1000 * MANY):
        database.write_bytes(damage(filled, rng, number))
        assert drop_damaged(database)
        if database.exists():
            left = entries(database)
            assert left.items() <= good.items()
            kept += len(left)
            database.unlink()
    assert kept > 200 * MANY, "one damaged entry is no reason to drop the others"


def test_a_damaged_cache_is_as_good_as_none(filled, tmp_path):
    rng = np.random.default_rng(8)
    for number in range(8 * MANY):
        (tmp_path / "cache.db").write_bytes(damage(filled, rng, number))
        swing(tmp_path)
        for path in tmp_path.iterdir():
            path.unlink()


def test_code_without_a_digest_is_compiled_again(filled, tmp_path):
    """As a process that was killed leaves it."""
    database = tmp_path / "cache.db"
    database.write_bytes(filled)
    with sqlite3.connect(database) as opened:
        one = opened.execute("SELECT hash FROM digest").fetchone()
        opened.execute("DELETE FROM digest WHERE hash = ?", one)
    opened.close()
    keys = entries(database).keys()
    assert drop_damaged(database)
    assert entries(database).keys() == keys - set(one)
    swing(tmp_path)
    assert entries(database).keys() == keys


def test_code_that_takes_the_place_of_other_does_not_take_its_digest(filled, tmp_path):
    database = tmp_path / "cache.db"
    database.write_bytes(filled)
    with sqlite3.connect(database) as opened:
        opened.execute("CREATE TEMP TABLE moved AS SELECT * FROM cache")
        opened.execute("DELETE FROM cache")
        assert opened.execute("SELECT count(*) FROM digest").fetchone() == (0,)
        opened.execute("INSERT INTO cache SELECT * FROM moved")
    opened.close()
    assert drop_damaged(database)
    assert entries(database) == {}


def test_what_is_compiled_is_kept_also_where_noting_it_fails(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, "off")
    use_compile_cache.cache_clear()
    try:
        with compiling():
            pass
        assert use_compile_cache() is None
    finally:
        use_compile_cache.cache_clear()
