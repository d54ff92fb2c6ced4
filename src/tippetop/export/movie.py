"""Films of a run: .mp4 by ffmpeg, .gif by Pillow."""

import math
import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from tippetop.export.poses import contact_path, poses_at
from tippetop.export.raycast import fine_path, picture, view_of
from tippetop.figures.style import INK
from tippetop.figures.toy import Toy
from tippetop.problem.problem import Problem
from tippetop.results.account_text import describe
from tippetop.results.dataset import require_run
from tippetop.support.errors import FileTrouble, InvalidInput, Unavailable, is_number, is_whole
from tippetop.support.files import path_of, place_for, require_ending, written_beside
from tippetop.support.validation import require_callback

Frame = NDArray[np.uint8]

MOST_FRAMES = 20_000
"""Largest number of pictures in a film: more take hours to draw."""

RATES = {".mp4": 30.0, ".gif": 20.0}
"""Default pictures per second of film, by kind of file."""

LEAST_RATE = 0.01
"""Smallest number of pictures per second: one in 100 s."""

_EYE = np.array([2.6, -6.0, 3.0])
"""Place of the eye from the toy's place on the table, in sizes of the toy."""

_MP4 = ("-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-movflags", "+faststart")


def write_movie(
    run: xr.Dataset,
    path: Path | str,
    overwrite: bool = False,
    *,
    frame_rate: float | None = None,
    speed: float = 1.0,
    pixels: tuple[int, int] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write a run as a film, .mp4 or .gif by the path's suffix.

    Parameters
    ----------
    run
        Run to be shown.
    path
        File to write: .mp4 or .gif.
    overwrite
        Whether an existing file is replaced.
    frame_rate
        Pictures per second; None for 30 in an .mp4 and 20 in a .gif. A .gif shows each picture for
        a whole number of hundredths of a second, at least two: it gets the nearest such rate, and
        still plays at `speed`.
    speed
        Seconds of the run per second of film: less than 1 for slow motion.
    pixels
        Width and height, even numbers; None for 640 x 480 in an .mp4 and 360 x 270 in a .gif.
    progress
        Called after every picture with the number of pictures drawn and the number of all.

    Raises
    ------
    InvalidInput
        If the suffix, the rate, the speed or the size is not accepted, or the film would have more
        than `MOST_FRAMES` pictures.
    Unavailable
        If there is no ffmpeg for an .mp4.
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=0.5, samples=501)
    >>> tt.write_movie(run, "run.gif", frame_rate=10, pixels=(120, 90)).name
    'run.gif'
    """
    require_run(run)
    require_callback("progress", progress)
    path = path_of(path)
    ending = require_ending("path", path, tuple(RATES))
    encoder = ffmpeg() if ending == ".mp4" else ""
    place_for(path, overwrite)
    rate = frame_rate if frame_rate is not None else RATES[ending]
    extent = pixels if pixels is not None else (640, 480) if encoder else (360, 270)
    _check(rate, speed, extent)
    rate, speed = float(rate), float(speed)
    if not encoder:
        # A .gif holds hundredths of a second; browsers slow down films faster than 50 a second.
        rate = 100.0 / min(max(round(100.0 / rate), 2), 0xFFFF)
    pictures = frames(run, rate, speed, extent, progress or (lambda drawn, count: None))
    with written_beside(path, overwrite) as beside:
        if encoder:
            _encode(encoder, pictures, beside, rate, extent)
        else:
            _save_gif(pictures, beside, rate)
    return path


def ffmpeg() -> str:
    """Return the path of ffmpeg; raise `Unavailable` if it is not installed."""
    path = shutil.which("ffmpeg")
    if path is None:
        raise Unavailable(
            "an .mp4 is made by ffmpeg, which is not on the PATH; install it, or ask for a .gif"
        )
    return path


def require_film(ending: str, duration: float) -> None:
    """Raise an error if a film of a run of this duration (s) cannot be made.

    This is asked before the run is computed.

    Raises
    ------
    InvalidInput
        If the film would have more than `MOST_FRAMES` pictures.
    Unavailable
        If there is no ffmpeg for an .mp4.
    """
    if ending == ".mp4":
        ffmpeg()
    rate = RATES[ending]
    if is_number(duration) and _is_too_long(duration, rate):
        longest = (MOST_FRAMES - 1) / rate
        raise InvalidInput(
            "duration", duration, f"at most {longest:.6g} s", "is too long for a film"
        )


def _is_too_long(duration: float, frame_rate: float, speed: float = 1.0) -> bool:
    """Return whether the film of a run of this duration (s) has more than `MOST_FRAMES`
    pictures.
    """
    return duration * frame_rate / speed >= MOST_FRAMES


def frames(
    run: xr.Dataset,
    frame_rate: float,
    speed: float,
    pixels: tuple[int, int],
    progress: Callable[[int, int], None] = lambda drawn, count: None,
) -> Iterator[Frame]:
    """Yield the pictures of a film, each of shape (height, width, 3).

    Raises `InvalidInput` if the film would have more than `MOST_FRAMES` pictures.
    """
    start, end = run["time"].values[[0, -1]].tolist()
    if _is_too_long(end - start, frame_rate, speed):
        least = (end - start) * frame_rate / (MOST_FRAMES - 1)
        raise InvalidInput(
            "speed", speed, f"at least {least:.2g}", f"is too slow for a run of {end - start:g} s"
        )
    count = math.floor((end - start) * frame_rate / speed) + 1
    problem = Problem.from_json(run.attrs["problem"])
    toy, table = Toy(problem.body), problem.table
    times = start + np.arange(count) * speed / frame_rate
    poses = poses_at(run, times)
    positions, turns = poses.positions / toy.size, poses.turns.as_matrix()
    path, reached = fine_path(contact_path(run) / toy.size, run["normal_force"].values != 0.0)
    seen = reached[np.searchsorted(run["time"].values, times, side="right") - 1]
    headline = describe(run).headline
    cell = 10 ** round(math.log10(toy.size / 2)) / toy.size
    for number, (position, frame) in enumerate(zip(positions, turns, strict=True)):
        view = view_of(np.array([position[0], position[1], 0.85]), _EYE, pixels, table)
        drawn = picture(toy, view, position, frame, path[: seen[number]], cell)
        yield _captioned(
            drawn, f"{headline[:1].upper()}{headline[1:]}", f"t = {times[number]:.3f} s", speed
        )
        progress(number + 1, count)


def _captioned(drawn: Frame, headline: str, clock: str, speed: float) -> Frame:
    """Return a picture with the headline of the run and the time written on it."""
    image = Image.fromarray(drawn)
    pen = ImageDraw.Draw(image)
    size = max(10, image.width // 38)
    font = ImageFont.load_default(size=size)
    if speed != 1.0:
        clock += f"   (speed {speed:g})"
    pen.text((10, 8), headline, fill=INK, font=font)
    pen.text((10, 8 + 1.4 * size), clock, fill=INK, font=font)
    return np.asarray(image)


def _check(frame_rate: float, speed: float, pixels: tuple[int, int]) -> None:
    """Raise `InvalidInput` if the rate, the speed or the size of a film is not accepted."""
    if not (is_number(frame_rate) and LEAST_RATE <= frame_rate <= 240):
        raise InvalidInput(
            "frame_rate", frame_rate, f"a number at least {LEAST_RATE:g} and at most 240"
        )
    if not (is_number(speed) and 0 < speed <= 100):
        raise InvalidInput("speed", speed, "a number greater than 0 and at most 100")
    is_size = (
        isinstance(pixels, Sequence) and len(pixels) == 2 and all(is_whole(side) for side in pixels)
    )
    if not is_size or any(side < 16 or side > 4096 or side % 2 for side in pixels):
        raise InvalidInput("pixels", pixels, "two even numbers from 16 to 4096")


def _encode(
    encoder: str, pictures: Iterator[Frame], path: Path, frame_rate: float, pixels: tuple[int, int]
) -> None:
    """Write the pictures as an .mp4 by ffmpeg; raise `FileTrouble` with its last message if it
    fails.
    """
    width, height = pixels
    source = (
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-s",
        f"{width}x{height}",
        "-r",
        f"{frame_rate:g}",
        "-i",
        "-",
    )
    command = [encoder, "-y", "-loglevel", "error", *source, *_MP4, "-f", "mp4", str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdin is not None
        assert process.stderr is not None
        try:
            for drawn in pictures:
                process.stdin.write(drawn.tobytes())
            process.stdin.close()
        except BrokenPipeError:
            pass
        complaint = process.stderr.read().decode(errors="replace").strip()
    if process.returncode:
        last = complaint.splitlines()[-1] if complaint else f"exit code {process.returncode}"
        raise FileTrouble(f"{path} cannot be written: ffmpeg says: {last}")


def _save_gif(pictures: Iterator[Frame], path: Path, frame_rate: float) -> None:
    """Write the pictures as a .gif in the colours of the first."""
    first = Image.fromarray(next(pictures)).quantize(128)
    later = (
        Image.fromarray(drawn).quantize(palette=first, dither=Image.Dither.NONE)
        for drawn in pictures
    )
    first.save(
        path,
        format="GIF",
        save_all=True,
        append_images=later,
        duration=round(1000 / frame_rate),
        loop=0,
    )
