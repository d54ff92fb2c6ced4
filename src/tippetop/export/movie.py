"""A run as a film: .mp4 by ffmpeg where there is one, .gif by Pillow."""

import math
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from tippetop.errors import FileTrouble, InvalidInput, Unavailable
from tippetop.export.camera import view_of
from tippetop.export.poses import poses_at, turned
from tippetop.export.raycast import CAPTION, Toy, fine_path, picture
from tippetop.export.words import tell
from tippetop.files import place_for, written_beside
from tippetop.mechanics.shape import contact_vector
from tippetop.problem import Problem

Frame = NDArray[np.uint8]
Watcher = Callable[[int, int], None]

MOST_FRAMES = 20_000
_EYE = np.array([2.6, -6.0, 3.0])
_MP4 = ("-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-movflags", "+faststart")


def write_movie(
    run: xr.Dataset,
    path: Path | str,
    overwrite: bool = False,
    *,
    fps: float | None = None,
    speed: float = 1.0,
    pixels: tuple[int, int] | None = None,
    watcher: Watcher | None = None,
) -> Path:
    """Write a run as a film, .mp4 or .gif by the path's suffix.

    Parameters
    ----------
    run, path, overwrite
        What, where, and whether a file there may go.
    fps
        Pictures per second; None for 30 in an .mp4 and 20 in a .gif. A .gif shows each for a whole number of
        hundredths of a second, two at least: it gets the nearest rate that it can hold, and plays in time.
    speed
        Seconds of the run per second of film: less than 1 for slow motion.
    pixels
        Width and height, even numbers; None for 640 x 480 in an .mp4 and 360 x 270 in a .gif.
    watcher
        Told after every picture how many there are so far, and how many there will be.

    Raises
    ------
    InvalidInput
        If the suffix, the rate, the speed or the size cannot be, or the film would be too long.
    Unavailable
        If there is no ffmpeg for an .mp4.
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in (".mp4", ".gif"):
        raise InvalidInput("path", str(path), "a file name that ends in .mp4 or .gif")
    encoder = ffmpeg() if kind == ".mp4" else ""
    place_for(path, overwrite)
    rate = fps if fps is not None else 30.0 if encoder else 20.0
    extent = pixels or ((640, 480) if encoder else (360, 270))
    _check(rate, speed, extent)
    if not encoder:
        rate = gif_rate(rate)
    pictures = frames(run, rate, speed, extent)
    if watcher is not None:
        pictures = _told(pictures, frame_count(run, rate, speed), watcher)
    with written_beside(path, overwrite) as beside:
        if encoder:
            _encode(encoder, pictures, beside, rate, extent)
        else:
            _save_gif(pictures, beside, rate)
    return path


def gif_rate(fps: float) -> float:
    """The rate nearest to `fps` that a .gif can hold; browsers slow down what is faster than 50."""
    return 100.0 / min(max(round(100.0 / fps), 2), 0xFFFF)


def ffmpeg() -> str:
    """The path of ffmpeg.

    Raises
    ------
    Unavailable
        If it is not installed.
    """
    found = shutil.which("ffmpeg")
    if found is None:
        raise Unavailable(
            "an .mp4 is made by ffmpeg, which is not on the PATH; install it, or ask for a .gif"
        )
    return found


def _told(pictures: Iterator[Frame], count: int, watcher: Watcher) -> Iterator[Frame]:
    """The same pictures, each of them reported once it is done with."""
    for number, drawn in enumerate(pictures, start=1):
        yield drawn
        watcher(number, count)


def frame_count(run: xr.Dataset, fps: float, speed: float) -> int:
    """How many pictures a film has.

    Raises
    ------
    InvalidInput
        If there would be too many.
    """
    duration = float(run["time"].values[-1])
    count = math.floor(duration * fps / speed) + 1
    if count > MOST_FRAMES:
        raise InvalidInput(
            "speed", speed, f"at least {speed * count / MOST_FRAMES:.2g} for a run of {duration:g} s"
        )
    return count


def frames(run: xr.Dataset, fps: float, speed: float, pixels: tuple[int, int]) -> Iterator[Frame]:
    """The pictures of a film, shape (height, width, 3) each.

    Raises
    ------
    InvalidInput
        If there would be too many.
    """
    count = frame_count(run, fps, speed)
    problem = Problem.from_json(run.attrs["problem"])
    toy = Toy(problem.body)
    times = np.arange(count) * speed / fps
    poses = poses_at(run, times)
    axes = [turned(poses.quaternions, np.tile(unit, (count, 1))) for unit in np.eye(3)]
    arm = contact_vector(tuple(run["axis"].values.T), problem.top.shape)
    trace = np.stack([run["x"].values + arm[0], run["y"].values + arm[1]], axis=1) / toy.size
    path, reached = fine_path(trace, run["normal_force"].values != 0.0)
    seen = reached[np.searchsorted(run["time"].values, times, side="right") - 1]
    headline = tell(run).headline
    cell = 10 ** round(math.log10(toy.size / 2)) / toy.size
    for number in range(count):
        position = poses.positions[number] / toy.size
        view = view_of(np.array([position[0], position[1], 0.85]), _EYE)
        frame = np.stack([axis[number] for axis in axes], axis=1)
        drawn = picture(toy, view, position, frame, path[: seen[number]], cell, pixels)
        yield _captioned(drawn, f"{headline[:1].upper()}{headline[1:]}", f"t = {times[number]:.3f} s", speed)


def _captioned(drawn: Frame, headline: str, clock: str, speed: float) -> Frame:
    image = Image.fromarray(drawn)
    pen = ImageDraw.Draw(image)
    size = max(10, image.width // 38)
    font = ImageFont.load_default(size=size)
    if speed != 1.0:
        clock += f"   (speed {speed:g})"
    pen.text((10, 8), headline, fill=CAPTION, font=font)
    pen.text((10, 8 + 1.4 * size), clock, fill=CAPTION, font=font)
    return np.asarray(image)


def _check(fps: float, speed: float, pixels: tuple[int, int]) -> None:
    if not (math.isfinite(fps) and 0 < fps <= 240):
        raise InvalidInput("fps", fps, "a number greater than 0 and at most 240")
    if not (math.isfinite(speed) and 0 < speed <= 100):
        raise InvalidInput("speed", speed, "a number greater than 0 and at most 100")
    if any(side < 16 or side > 4096 or side % 2 for side in pixels):
        raise InvalidInput("pixels", pixels, "two even numbers from 16 to 4096")


def _encode(encoder: str, pictures: Iterator[Frame], path: Path, fps: float, pixels: tuple[int, int]) -> None:
    width, height = pixels
    source = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{fps:g}", "-i", "-")
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


def _save_gif(pictures: Iterator[Frame], path: Path, fps: float) -> None:
    first = Image.fromarray(next(pictures)).quantize(128)
    rest = (Image.fromarray(drawn).quantize(palette=first, dither=Image.Dither.NONE) for drawn in pictures)
    first.save(path, format="GIF", save_all=True, append_images=rest, duration=round(1000 / fps), loop=0)
