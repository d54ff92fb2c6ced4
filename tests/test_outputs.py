"""What the command line prints where the output is not UTF-8, and of units without quotes."""

import os
import subprocess
import sys

import pytest

import tippetop as tt

SIMULATE = (sys.executable, "-m", "tippetop", "simulate", "--duration", "1")


@pytest.mark.parametrize("encoding", [pytest.param("cp1252", marks=pytest.mark.slow), "ascii"])
def test_outputs_that_are_not_utf_8_show_plain_characters(encoding):
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    ended = subprocess.run(SIMULATE, env=environment, capture_output=True, check=False, timeout=120)
    said = ended.stdout.decode(encoding)
    assert ended.returncode == 0, ended.stderr
    assert ended.stderr == b""
    assert "final tilt" in said
    assert "?" not in said


@pytest.mark.parametrize(
    ("line", "quoted"),
    [
        ("spin = 2200 rpm", '"2200 rpm"'),
        ("tilt = 5deg", '"5deg"'),
        ("tilt = -5.5 deg", '"-5.5 deg"'),
    ],
)
def test_a_unit_without_quotes_is_said_to_need_them(line, quoted):
    with pytest.raises(tt.InvalidInput, match=f"write {quoted} in quotation marks"):
        tt.Problem.from_toml(f"[launch]\n{line}\n")


def test_other_faults_of_toml_are_not_taken_for_units():
    with pytest.raises(tt.InvalidInput) as refusal:
        tt.Problem.from_toml('# mu = 3 m\nname = "a = 3 m"\n[launch\n')
    assert "quotation" not in str(refusal.value)
