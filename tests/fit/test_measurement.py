"""Data as people have it become measurements, and what is no data gets one sentence."""

import sys
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import tippetop as tt
from tippetop.fit.observations import Camera, EventTimes, SpinRate, Variables


@pytest.fixture
def written(tmp_path):
    """Return the path of a file with a text."""

    def write(text, name="data.csv"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


TABLES = {
    "commas": "t,tilt\n0,0.1\n0.02,0.12\n0.04,0.16\n",
    "semicolons and decimal commas": "t;theta\n0;0,1\n0,02;0,12\n0,04;0,16\n",
    "tabs": "t\ttilt\n0\t0.1\n0.02\t0.12\n0.04\t0.16\n",
    "tabs and decimal commas": "t\ttilt\t\n0,0\t1,0E-1\t\n2,0E-2\t0,12\t\n0,04\t0,16\t\n",
    "spaces": "t   tilt\n0.0  0.1\n0.02 0.12\n0.04 0.16\n",
    "units in brackets": "Time [ms],tilt (mrad)\n0,100\n20,120\n40,160\n",
    "units after a slash": "t / ms;tilt / mrad\n0;100\n20;120\n40;160\n",
    "a byte order mark and a comment": "\ufeff# my film\nt,tilt\n0,0.1\n0.02,0.12\n0.04,0.16\n",
    "the name of a track": "mass_A\nt\ttilt\n0\t0.1\n0.02\t0.12\n0.04\t0.16\n",
    "a column more": "frame,t,tilt\n0,0,0.1\n1,0.02,0.12\n2,0.04,0.16\n",
}


@pytest.mark.parametrize("text", TABLES.values(), ids=TABLES)
def test_one_table_written_in_many_ways(written, text):
    data = tt.read_measurement(written(text))
    assert np.allclose(data.times, [0.0, 0.02, 0.04], rtol=1e-14)
    assert np.allclose(data.values[:, 0], [0.1, 0.12, 0.16], rtol=1e-14)
    assert isinstance(data.observation, Variables)


def test_frames_without_a_mark_are_no_numbers(written):
    data = tt.read_measurement(
        written("mass_A\nt\tx\ty\t\n0\t1\t2\t\n0.1\t\t\t\n0.2\t3\t5\t\n"), view="above"
    )
    assert np.isnan(data.values[1]).all()
    assert data.count == 4


def test_a_track_of_several_is_chosen_by_its_name(written):
    text = "#multi:\n\ttip\t\tball\t\t\nt\tx\ty\tx\ty\t\n0\t1\t2\t3\t4\n0.1\t5\t6\t7\t8\n"
    data = tt.read_measurement(written(text), view="side", track="ball")
    assert data.values.tolist() == [[3.0, 4.0], [7.0, 8.0]]
    with pytest.raises(tt.InvalidInput, match="one of tip, ball"):
        tt.read_measurement(written(text), view="side")


def test_numbers_of_pictures_become_times(written):
    data = tt.read_measurement(written("frame,tilt\n10,0.1\n12,0.2\n16,0.3\n"), frame_rate=100.0)
    assert np.allclose(data.times, [0.0, 0.02, 0.06])


def test_the_launch_may_be_later_than_the_film(written):
    data = tt.read_measurement(written("t,tilt\n0,1\n1,0.1\n1.5,0.2\n"), start=1.0)
    assert data.times.tolist() == [0.0, 0.5]


def test_pixels_may_grow_downwards(written):
    text = "t,x,y\n0,1,2\n0.1,5,6\n"
    data = tt.read_measurement(written(text), view="above", y_down=True, scale="0.2 mm")
    assert data.values[:, 1].tolist() == [-2.0, -6.0]
    assert isinstance(data.observation, Camera)
    assert data.observation.scale == 2e-4


def test_a_unit_of_length_is_the_scale(written):
    data = tt.read_measurement(written("t,x (cm),y (cm)\n0,1,2\n0.1,5,6\n"), view="above")
    assert np.allclose(data.values, [[0.01, 0.02], [0.05, 0.06]])
    assert data.observation.scale == 1.0


def test_turns_a_minute_and_events_alone(written):
    assert isinstance(tt.read_measurement(written("t,rpm\n0,1500\n1,1400\n")).observation, SpinRate)
    events = tt.read_measurement(written("event,t (ms)\nturnover_time,3100\nliftoff,700\n"))
    assert isinstance(events.observation, EventTimes)
    assert np.allclose(events.values, [[3.1, 0.7]])


HEADINGS = {
    "degrees in German": ("t (s)", "Neigung (Grad)", 1.0, np.pi / 180.0),
    "gon": ("t (s)", "theta (gon)", 1.0, np.pi / 200.0),
    "a unit after an underscore": ("time_ms", "theta_deg", 1e-3, np.pi / 180.0),
    "a unit in words": ("Zeit in ms", "theta in mrad", 1e-3, 1e-3),
    "turns a second": ("T (s)", "omega (Hz)", 1.0, 2.0 * np.pi),
    "turns a minute": ("t (s)", "w (1/min)", 1.0, np.pi / 30.0),
    "precession, heard": ("t (s)", "phi_dot (rev/s)", 1.0, 2.0 * np.pi),
}


@pytest.mark.parametrize(("time", "column", "second", "size"), HEADINGS.values(), ids=HEADINGS)
def test_headings_as_people_write_them(written, time, column, second, size):
    data = tt.read_measurement(written(f"{time};{column}\n0;1,5\n1;2\n2;3\n"), noise=0.25)
    assert np.allclose(data.times, second * np.arange(3), rtol=1e-14)
    assert np.allclose(data.values[:, 0], size * np.array([1.5, 2.0, 3.0]), rtol=1e-12)
    assert data.noise == pytest.approx([0.25 * size])


@pytest.mark.parametrize(("unit", "size"), [("Hz", 60.0), ("1/min", 1.0), ("rad/s", 30.0 / np.pi)])
def test_frequencies_are_turns_a_minute_without_sign(written, unit, size):
    data = tt.read_measurement(written(f"t,Frequenz ({unit})\n0,-3\n1,2\n"), noise="0.1 rev/s")
    assert np.allclose(data.values[:, 0], [3.0 * size, 2.0 * size])
    assert data.noise == pytest.approx([6.0])


def test_noise_of_a_film_has_a_unit(written):
    data = tt.read_measurement(
        written("T (s);x in mm;y in mm\n0;1,5;2\n0,1;3;5\n"), view="side", noise="0.3mm"
    )
    assert np.allclose(data.values, [[1.5e-3, 2e-3], [3e-3, 5e-3]])
    assert data.noise == pytest.approx([3e-4, 3e-4])
    sound = tt.read_measurement(written("T (s),f (Hz)\n0,20\n1,18\n"))
    assert sound.values[:, 0].tolist() == [1200.0, 1080.0]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_encodings_of_spreadsheets(tmp_path, encoding):
    path = tmp_path / "höhe.csv"
    path.write_bytes("Zeit (s);Höhe (mm)\n0;20,5\n0,1;21\n".encode(encoding))
    assert np.allclose(tt.read_measurement(path).values[:, 0], [0.0205, 0.021])


def test_the_encoding_of_a_chinese_tracker(tmp_path):
    path = tmp_path / "film.txt"
    path.write_bytes("质量_A\nt\tx\ty\n0\t0.1\t0.2\n0.1\t0.3\t0.5\n".encode("gbk"))
    data = tt.read_measurement(path, view="above")
    assert data.values.tolist() == [[0.1, 0.2], [0.3, 0.5]]
    assert data.observation.scale == 1.0  # Places are in metres.


def test_a_workbook_is_read_by_openpyxl(tmp_path, monkeypatch):
    path = tmp_path / "film.xlsx"
    path.write_bytes(b"")
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(tt.Unavailable, match="install openpyxl"):
        tt.read_measurement(path)
    rows = (("Zeit (s)", "Neigung (Grad)"), (0, 5.5), (0.1, 6), (0.2, None))
    sheet = SimpleNamespace(values=rows)
    book = SimpleNamespace(worksheets=[sheet])
    module = SimpleNamespace(load_workbook=lambda path, **options: book)
    monkeypatch.setitem(sys.modules, "openpyxl", module)
    assert np.allclose(np.degrees(tt.read_measurement(path).values[:2, 0]), [5.5, 6.0])


def test_tables_in_memory_are_read_as_files_are():
    columns = {"Zeit (ms)": [0, 20, 40], "tilt (deg)": [5.0, np.nan, 6.0]}
    for source in (columns, pd.DataFrame(columns)):
        data = tt.read_measurement(source, noise=0.5)
        assert np.allclose(data.times, [0.0, 0.02, 0.04])
        assert np.allclose(np.degrees(data.values[:, 0]), [5.0, np.nan, 6.0], equal_nan=True)
        assert np.degrees(data.noise[0]) == pytest.approx(0.5)
    with pytest.raises(tt.InvalidInput, match="a DataFrame, or a mapping"):
        tt.read_measurement(3.0)


def test_tracks_are_asked_for(written):
    two = "t\tx\ty\tx\ty\n0\t1\t2\t3\t4\n0.1\t5\t6\t7\t8\n"
    with pytest.raises(tt.InvalidInput, match="one of 1, 2"):
        tt.read_measurement(written(two), view="side")
    data = tt.read_measurement(written(two), view="side", track="2")
    assert data.values.tolist() == [[3.0, 4.0], [7.0, 8.0]]
    one = "mass_A\nt\tx\ty\n0\t1\t2\n0.1\t5\t6\n"
    with pytest.raises(tt.InvalidInput, match="one of mass_A"):
        tt.read_measurement(written(one), view="side", track="foo")


def test_events_in_words(written):
    data = tt.read_measurement(written("Ereignis;t (s)\nsteht auf dem Stift;5,0\n"), noise=0.2)
    assert data.observation.labels == ("arrival_time",)
    assert data.noise == pytest.approx([0.2])


BAD = {
    "a later start": ("t,tilt\n0.35,0.1\n0.36,0.2\n", "write 0.35 if the top is launched"),
    "an event of another kind": ("event,t\nfällt um,3.1\n", "turnover_time"),
    "empty": ("", "has no numbers"),
    "no header": ("0,0.1\n0.1,0.2\n", "there is no header"),
    "shuffled": ("t,tilt\n0,0.1\n0.2,0.2\n0.1,0.3\n", "times must increase"),
    "the same time twice": ("t,tilt\n0,0.1\n0.1,0.2\n0.1,0.3\n", "times must increase"),
    "degrees without a unit": ("t,tilt\n0,5\n0.1,90\n", r"tilt \(deg\)"),
    "milliseconds without a unit": ("t,tilt\n0,0.1\n5000,0.2\n", r"t \(ms\)"),
    "a wrong unit": ("t (kg),tilt\n0,0.1\n1,0.2\n", "unit of column t"),
    "one picture": ("t,tilt\n0,0.1\n", "at least two"),
    "constant": ("t,tilt\n0,0.1\n0.1,0.1\n", "nothing moves"),
    "text in a column": ("t,tilt\n0,0.1\n0.1,blurred\n0.2,0.3\n", "line 3.*blurred"),
    "a number missing": ("t,tilt\n0,0.1\n0.1\n0.2,0.3\n", "line 3"),
    "no time": ("tilt,tilt_rate\n0,0.1\n0.1,0.2\n", "have no time"),
    "columns of another kind": ("t,price\n0,0.1\n0.1,0.2\n", "t and tilt"),
    "infinite": ("t,tilt\n0,0.1\n0.1,inf\n", "line 3"),
    "points without a view": ("t,x,y\n0,1,2\n1,2,3\n", "'above' or 'side'"),
    "a unit of x alone": ("t,x (mm),y\n0,1,2\n0.1,2,3\n", "unit of column y"),
    "places in kilograms": ("t,x (kg),y (kg)\n0,1,2\n0.1,2,3\n", "unit of column x"),
    "pictures without a rate": ("frame,tilt\n0,0.1\n1,0.2\n", "frame_rate in data.csv is missing"),
    "no such event": ("event,t\nturned,3.1\n", "turnover_time"),
}


@pytest.mark.parametrize(("text", "sentence"), BAD.values(), ids=BAD)
def test_bad_data_get_a_sentence(written, text, sentence):
    with pytest.raises(tt.InvalidInput, match=sentence) as refusal:
        tt.read_measurement(written(text))
    assert "data.csv" in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_times_long_before_the_launch_are_left_out(written):
    data = tt.read_measurement(written("t,tilt\n-5000,0\n0,0.1\n0.1,0.2\n"))
    assert data.times.tolist() == [0.0, 0.1]


def still_run(tilt):
    problem = tt.presets.report_problem(spin=155.0).replace({"launch.tilt": tilt})
    return tt.simulate(problem, 0.1, samples=50)


@pytest.mark.parametrize("view", ["above", "side"])
@pytest.mark.parametrize("scale", [None, 2e-4])
def test_a_camera_finds_its_own_place(view, scale):
    # A point at a height of its own, so that both views show it move.
    run = still_run(1.0)
    camera = Camera(view, "tip", scale)
    numbers = {"camera.angle": 0.7, "camera.x": 30.0, "camera.y": -12.0, "camera.scale": 2e-4}
    guess = camera.guess(run, camera(run, numbers))
    for name in camera.parameters:
        assert guess[name] == pytest.approx(numbers[name], rel=1e-7), name


def test_the_tip_and_a_mark_at_its_place_are_the_same():
    run = still_run(0.5)
    tip = np.linalg.norm(
        Camera("above", "tip", 1.0).position(run, {})
        - Camera("above", "center", 1.0).position(run, {}),
        axis=1,
    )
    mark = Camera("above", (0.0, float(tip[0])), 1.0)
    same = Camera("above", "tip", 1.0).position(run, {})
    assert np.allclose(mark.position(run, {"mark.angle": 0.3}), same, atol=1e-15)


def test_a_mark_off_the_axis_turns_with_the_body():
    # At an upright launch the body turns about the vertical: the mark goes round a circle.
    problem = tt.presets.report_problem(spin=155.0).replace({"launch.tilt": 0.0})
    run = tt.simulate(problem, 0.02, samples=11)
    mark = Camera("above", (0.01, 0.0), 1.0).position(run, {"mark.angle": 0.2})
    angle = 0.2 + 155.0 * run["time"].values
    assert np.allclose(mark[:, 0], 0.01 * np.cos(angle), atol=1e-12)
    assert np.allclose(mark[:, 1], 0.01 * np.sin(angle), atol=1e-12)
