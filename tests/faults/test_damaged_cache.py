"""Compiled code that was damaged in the cache is never run, and costs a compilation."""

import json
import os
import pickle
import subprocess
import sys
import zlib
from hashlib import sha256

import numpy as np
import pytest

from campaigns import among, examples, seeds
from children import posix_only
from tippetop.integrators import sealed_folders
from tippetop.integrators.sealed_folders import CONTENT, SEAL, VARIABLE, kept_content

SWINGS = """
import numpy as np
from tippetop.integrators import Motion, make_integrator
for degree in (1, 3):
    motion = Motion(lambda y, p: (y[1], -p[0] ** 2 * y[0] ** degree), size=2, parameters=1)
    start = 0.0, np.array([1.0, 0.0])
    *_, arc = make_integrator("taylor").integrate(motion, (np.pi,), start, 1.0)
    assert degree == 3 or abs(arc.end_state[0] + 1.0) < 1e-14, arc
    energy = arc.end_state[1] ** 2 / 2 + np.pi**2 * arc.end_state[0] ** (degree + 1) / (degree + 1)
    assert abs(energy - np.pi**2 / (degree + 1)) < 1e-13, arc
"""


@pytest.fixture(autouse=True)
def cleared_for_every_folder(monkeypatch):
    monkeypatch.setattr(sealed_folders, "NEW_BETWEEN_CLEARINGS", 1)


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


def damage(content, rng, number):
    """A content in which bits flipped, or bytes are zero or of another place, or missing."""
    damaged = bytearray(content)
    first = int(rng.integers(len(content)))
    length = int(min(rng.integers(1, 5000), len(content) - first))
    match number % 4:
        case 0:
            damaged[first] ^= 1 << int(rng.integers(8))
        case 1:
            damaged[first : first + length] = bytes(length)
        case 2:
            other = int(rng.integers(len(content) - length + 1))
            damaged[first : first + length] = content[other : other + length]
        case 3:
            del damaged[first:]
    return bytes(damaged)


@pytest.mark.parametrize("seed", seeds(check=1, sample=3, claim=20))
def test_damage_at_any_place_is_dropped(tmp_path, monkeypatch, seed):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    rng, made = np.random.default_rng(seed), []
    content = rng.bytes(9000)

    def make():
        made.append(True)
        return content

    for number in range(300):
        assert kept_content("code", make) == content
        [folder] = tmp_path.iterdir()
        for file in folder.iterdir():
            if file.name == [SEAL, CONTENT][rng.integers(2)]:
                file.write_bytes(damage(file.read_bytes(), rng, number))
    assert len(made) > 200


def test_what_is_whole_is_not_made_again(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    assert kept_content("code", lambda: b"made") == b"made"
    assert kept_content("code", lambda: b"again") == b"made"
    assert kept_content("other", lambda: b"again") == b"again"


@pytest.mark.parametrize("seed", seeds(check=1, sample=3, claim=20))
def test_a_damaged_cache_is_as_good_as_none(tmp_path, seed):
    rng = np.random.default_rng(seed)
    for number in rng.permutation(4)[: examples(check=2, claim=4)]:
        swing(tmp_path)
        files = sorted(path for path in tmp_path.rglob("*") if path.is_file())
        assert len(files) == 6, "two motions and their steps, each with its seal"
        for file in files:
            file.write_bytes(damage(file.read_bytes(), rng, number))
    swing(tmp_path)


@pytest.mark.parametrize(
    "content",
    among(
        [zlib.compress(pickle.dumps({})), b"", zlib.compress(b"nothing that can be loaded")],
        check=1,
    ),
)
def test_what_is_whole_but_cannot_be_loaded_is_made_anew(tmp_path, content):
    swing(tmp_path)
    for folder in tmp_path.iterdir():
        (folder / CONTENT).write_bytes(content)
        (folder / SEAL).write_text(json.dumps({CONTENT: sha256(content).hexdigest()}))
    swing(tmp_path)


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="folders have no owner here")
def test_what_another_user_made_is_not_run(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    assert kept_content("code", lambda: b"made") == b"made"
    monkeypatch.setattr(os, "getuid", lambda: tmp_path.stat().st_uid + 1)
    assert kept_content("code", lambda: b"own") == b"own"


def test_what_was_not_used_for_longest_goes_first(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    monkeypatch.setattr(sealed_folders, "LARGEST", 2500)
    places = {}
    for when, name in enumerate("ab"):
        kept_content(name, lambda: os.urandom(1000))
        [places[name]] = set(tmp_path.iterdir()) - set(places.values())
        os.utime(places[name], (when, when))
    kept_content("a", lambda: os.urandom(1000))
    kept_content("c", lambda: os.urandom(1000))
    assert all(place.exists() for place in places.values())
    kept_content("d", lambda: os.urandom(1000))
    assert places["a"].exists()
    assert not places["b"].exists()


def test_folders_of_compiled_code_go_by_their_age_and_nothing_else(tmp_path, monkeypatch):
    monkeypatch.setattr(sealed_folders, "users_folder", lambda: tmp_path)
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    monkeypatch.setattr(sealed_folders, "LARGEST", 1500)
    old, others = [tmp_path / f"code-{when:032x}" for when in range(2)], tmp_path / "code-of-mine"
    for when, folder in enumerate([*old, others]):
        folder.mkdir()
        (folder / CONTENT).write_bytes(bytes(1000))
        if folder in old:
            (folder / SEAL).write_text(json.dumps({CONTENT: sha256(bytes(1000)).hexdigest()}))
        os.utime(folder, (when, when))
    (tmp_path / "cache.db").write_bytes(bytes(1000))
    os.utime(tmp_path / "cache.db", (0, 0))
    kept_content("new", lambda: os.urandom(1000))
    assert [folder.exists() for folder in (*old, others)] == [False, True, True]
    assert (tmp_path / "cache.db").exists(), "it is not of this package"


NOT_OURS = {
    "making-music/song": "not compiled",
    f"making-{2**22 + 1}-pictures/first.png": "not compiled",
    f"photos-2024/{SEAL}": json.dumps({"beach.jpg": 64 * "0"}),
    f"code-{32 * '0'}/{SEAL}": "[]",
    f"code-{32 * '1'}/{SEAL}": json.dumps({"closed": "with wax"}),
    f"code-{32 * '2'}/notes": "no seal",
    "code-of-mine/notes": "no seal",
}


def test_what_others_keep_in_the_same_folder_stays(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    monkeypatch.setattr(sealed_folders, "MOST", 1)
    for name, content in NOT_OURS.items():
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(content)
    for made in "ab":
        kept_content(made, lambda: b"new")
    assert {
        name: (tmp_path / name).read_text() for name in NOT_OURS if (tmp_path / name).exists()
    } == NOT_OURS


@posix_only
def test_a_link_to_nothing_in_a_folder_does_not_keep_code_from_being_kept(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    (tmp_path / f"code-{32 * '0'}").mkdir()
    (tmp_path / f"code-{32 * '0'}/link").symlink_to(tmp_path / "nothing")
    assert kept_content("code", lambda: b"made") == b"made"
    assert kept_content("code", lambda: b"again") == b"made"


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="folders have no owner here")
def test_what_another_user_made_is_not_removed(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    monkeypatch.setattr(sealed_folders, "MOST", 1)
    kept_content("theirs", lambda: b"made")
    [theirs] = tmp_path.iterdir()
    left = tmp_path / f"{theirs.name}-{2**22 + 1}-a1_45678"
    left.mkdir()
    monkeypatch.setattr(os, "getuid", lambda: tmp_path.stat().st_uid + 1)
    kept_content("ours", lambda: b"made")
    assert theirs.exists()
    assert left.exists()
