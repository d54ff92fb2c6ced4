"""Workpieces as people state them: what is refused, in a sentence that says why."""

import pytest
from profiles import BALL

import tippetop as tt

R = 20.0
IN_MM = ((0, -R), (0, R, R))


def piece(profile=IN_MM, **fields):
    return tt.Workpiece(**{"profile": profile, "density": 700.0, "unit": "mm", **fields})


def insert(*points, density=0.0):
    return {"profile": points, "density": density}


@pytest.mark.parametrize(
    ("profile", "sentence"),
    [
        ([(0, 0), (1, 1), (2, 2)], "profile: an open line from (0, 0) to (2, 2)"),
        ([(0, 0), (1, 1), (-1, 2)], "profile.2.0: -1"),
        ([(0, 0), (2, 0), (2, 2), (1, -1), (0, 2)], "edges 1 and 3 meet at (1.33333, 0)"),
        ([(1, 0), (2, 0), (1.5, 0), (1, 1), (1, 0)], "edges 1 and 2 meet at (1.5, 0)"),
        ([(0, 0), (3, 0), (3, 2, 2), (2, 2), (4, 1), (0, 3)], "meet"),
        ([(0, 0.3), (1.6, 0), (4.7, 0, 2e4), (0.3, 3, -3), (0, 2.5)], "edges 2 and 3 meet"),
        ([(0, 0), (3, 0), (3, 1, 1e5), (1, -1, -1e5), (0, 2)], "edges 1 and 3 meet"),
        ([(0, 0), (4.8, 0), (3, 2), (2, 1e-7), (3, -3, -5e3), (0, 0)], "edges 1 and 4 meet"),
        ([(0, 0), (0, 1)], "a line through the axis"),
        ([(1, 0), (2, 0), (1, 0)], "is not a line around some volume"),
        ([(1, 0), (2, 0, 1), (1, 0, -1)], "is not a line around some volume"),
        ([(0, 0), (2, 0), (0, 1), (2, 2), (0, 2)], "a line through the axis at a height of 1"),
        ([(0, 0), (1, 0), (1, 2), (0, 2, -1), (0, 3)], "a line through the axis at a height of 2"),
        (
            [(0.5, 0), (0.5, 4, -2.01), (3, 2), (0.5, 0)],
            "is not an arc that stays beside the axis",
        ),
        ([(0, 0), (2, 0, 0.5), (0, 2)], "profile.1.2: 0.5"),
        ([(0, 0, 3), (2, 0), (0, 1)], "none ends at the first point"),
        ([(0, 0), (2,), (0, 1)], "profile.1: [2]"),
        ([(0, 0), ("a", 2), (0, 1)], "profile.1.0: 'a' is not"),
        ([(0, 0), (float("nan"), 2), (0, 1)], "profile.1.0: nan"),
        ([(0, 0), (1e200, 2), (0, 1)], "is not made of numbers of at most 1e+06"),
        ([(0, 0), (1e-20, 0), (0, 1e-20)], "a body of size 1e-20"),
        ([], "0 points"),
        (5, "is not a list of points"),
        ("M 0 0", "is not a list of points"),
    ],
)
def test_what_is_no_body_is_refused(profile, sentence):
    with pytest.raises(tt.InvalidInput) as refusal:
        piece(profile)
    assert sentence in str(refusal.value)
    assert str(refusal.value).count("\n") == 0


@pytest.mark.parametrize(
    ("inserts", "sentence"),
    [
        (
            [insert((0, 12), (3, 12), (3, 25), (0, 25))],
            "inserts.0.profile: a line that leaves the body",
        ),
        ([insert((0, -R), (R, 0, R), (0, 0))], "inserts.0.profile: an open cavity"),
        ([insert(*IN_MM)], "inserts.0.profile: an open cavity"),
        (
            [insert((0, 2), (3, 2), (3, 5), (0, 5)), insert((0, 3), (3, 3), (0, 7))],
            "inserts.1.profile",
        ),
        ([insert((0, 2), (3, 2), (3, 5), (0, 5))] * 2, "inserts.1.profile"),
        ([insert((0, 2), (3, 2), (3, 5), (4, 5))], "inserts.0.profile: an open line"),
        ([insert((0, 2), (3, 2), (0, 3), density=-1.0)], "inserts.0.density: -1"),
    ],
)
def test_what_is_not_inside_is_refused(inserts, sentence):
    with pytest.raises(tt.InvalidInput) as refusal:
        piece(inserts=inserts)
    assert sentence in str(refusal.value)


def test_inserts_may_touch_and_be_in_one_another():
    below, above = (
        insert((0, -5), (5, 0, 5), (0, 0), density=8e3),
        insert((0, 0), (5, 0), (0, 5, 5), density=2e3),
    )
    assert piece(inserts=[below, above]).around == (None, None)
    hole = insert((0, -2), (1, -1), (0, -1))
    assert piece(inserts=[hole, above, below]).around == (2, None, None)


def test_a_line_is_read_either_way_round_and_from_anywhere():
    up, down = [(0, 0), (R, 0), (R, 10, 30), (0, 10)], [(0, 10), (R, 10), (R, 0, -30), (0, 0)]
    around = [(R, 0), (R, 10, 30), (0, 10), (0, 0), (R, 0)]
    expected = pytest.approx(piece(up).mass_properties, rel=1e-13)
    assert piece(down).mass_properties == expected
    assert piece(around).mass_properties == expected


def test_units_are_the_same_body():
    metres = tt.Workpiece(profile=BALL, density=700.0)
    inches = piece([[number / 25.4 for number in point] for point in IN_MM], unit="in")
    assert piece().mass_properties[0] == pytest.approx(metres.mass_properties[0], rel=1e-13)
    assert inches.mass_properties[2:] == pytest.approx(metres.mass_properties[2:], rel=1e-12)
    with pytest.raises(tt.InvalidInput, match="is not one of m, cm, mm, in"):
        piece(unit="ft")
