"""Procedure that redoes the report: compute, judge, draw, and write a folder with a page."""

import json
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import xarray as xr

from tippetop.figures.style import save
from tippetop.problem.implausible import Implausible
from tippetop.report.claim import Judgement, count_verdicts
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import PLATES
from tippetop.report.page import render
from tippetop.report.playable import playable
from tippetop.report.selection import Selection, select
from tippetop.report.tasks import Task, carry_out
from tippetop.results.netcdf import write_run
from tippetop.support.errors import FileTrouble
from tippetop.support.files import in_words, put_in_place, refuse_overwriting
from tippetop.support.processes import processors

PAGE, CLAIMS_FILE, FIGURES, DATA = "index.html", "claims.json", "figures", "data"

_PLAYER = "run to play"

Progress = Callable[[float, float, str], None]
"""Callback with the work done, all the work (both in estimated seconds), and the last task's
name.
"""


@dataclass(frozen=True)
class Reproduction:
    """Results of redoing the report."""

    folder: Path
    """Folder with the results."""
    judgements: tuple[Judgement, ...]
    """Judged claims, in the order of the report."""
    figures: tuple[str, ...]
    """Names of the figures drawn."""
    quick: bool
    """Whether the computations were coarse."""
    seconds: float
    """Duration of the computation, s."""

    @property
    def counts(self) -> dict[str, int]:
        """Number of the report's claims of each verdict."""
        return count_verdicts(one for one in self.judgements if one.claim.is_of_report)

    @property
    def counts_of_others(self) -> dict[str, int]:
        """Number of claims of each verdict that others make."""
        return count_verdicts(one for one in self.judgements if not one.claim.is_of_report)


def reproduce(
    folder: Path | str,
    *,
    only: str | None = None,
    quick: bool = False,
    overwrite: bool = False,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Reproduction:
    """Redo the report's figures and judge its claims, all or `only` one; see `select`.

    The folder gets index.html, claims.json, figures/ and data/ once everything is computed. A
    `quick` run has coarser sweeps and fewer samples, and its results say so. Without a number of
    `workers` there are as many processes as processors, at most 2.

    Raises `InvalidInput` if there is no such figure or claim; `FileTrouble` if the folder has
    results already, or cannot be written.
    """
    began = time.monotonic()
    folder = Path(folder)
    chosen = select(only)
    names = _files(chosen)
    for name in names:
        refuse_overwriting(folder / name, overwrite)
    with _staging(folder) as stage:
        tasks = _tasks(chosen, quick, stage)
        if only is None:
            tasks.append(Task(_PLAYER, 1.0, playable, (quick,)))
        processes = min(2, processors()) if workers is None else max(1, workers)
        results = carry_out(tasks, processes, progress)
        data = {experiment.id: results[experiment.id] for experiment in chosen.experiments}
        judgements = tuple(claim.judge(data, quick) for claim in chosen.claims)
        for name in _unseen(chosen):
            write_run(data[name], stage / DATA / f"{name}.nc")
        records = [judgement.record() for judgement in judgements]
        text = json.dumps(records, indent=2, ensure_ascii=False)
        (stage / CLAIMS_FILE).write_text(text + "\n", encoding="utf-8")
        figures = tuple(plate.id for plate in chosen.plates)
        seconds = time.monotonic() - began
        page = render(
            chosen.plates,
            judgements,
            stage / FIGURES,
            player=results.get(_PLAYER),
            quick=quick,
            partial=only,
        )
        (stage / PAGE).write_text(page, encoding="utf-8")
        _move(stage, folder, names, overwrite)
    return Reproduction(folder, judgements, figures, quick, seconds)


def _files(chosen: Selection) -> list[str]:
    """Return the names of the files to be written, the page last."""
    names = [f"{FIGURES}/{plate.id}.{kind}" for plate in chosen.plates for kind in ("png", "svg")]
    names += [f"{DATA}/{plate.id}.nc" for plate in chosen.plates if plate.needs]
    names += [f"{DATA}/{name}.nc" for name in _unseen(chosen)]
    return [*names, CLAIMS_FILE, PAGE]


def _unseen(chosen: Selection) -> list[str]:
    """Return the names of the experiments that no figure shows; their data get files of their
    own.
    """
    shown = {name for plate in chosen.plates for name in plate.needs}
    return [experiment.id for experiment in chosen.experiments if experiment.id not in shown]


def _tasks(chosen: Selection, quick: bool, stage: Path) -> list[Task]:
    """Return the computations and the drawings, with their estimated durations."""
    share = 0.3 if quick else 1.0
    computing = [
        Task(one.id, one.cost * share, _compute, (one.id, quick)) for one in chosen.experiments
    ]
    drawing = [
        Task(f"figure {plate.id}", 0.8, _draw, (plate.id, stage, quick), plate.needs)
        for plate in chosen.plates
    ]
    return computing + drawing


def _compute(name: str, quick: bool) -> xr.Dataset:
    """Return the data of an experiment, without warnings of launches that are implausible on
    purpose.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Implausible)
        return EXPERIMENTS[name].run(quick)


def _draw(name: str, stage: Path, quick: bool, *data: xr.Dataset) -> None:
    """Draw a figure and write it with the data behind it; this runs in another process."""
    plate = PLATES[name]
    dataset = plate.dataset(dict(zip(plate.needs, data, strict=True)))
    if plate.needs:
        write_run(dataset, stage / DATA / f"{name}.nc")
    figure = plate.draw(dataset)
    for kind in ("png", "svg"):
        save(figure, stage / FIGURES / f"{name}.{kind}", **({"dpi": 100} if quick else {}))
        figure.set_layout_engine("none")  # the first file has placed everything


@contextmanager
def _staging(folder: Path) -> Iterator[Path]:
    """Yield a temporary folder beside the one to be written; it is removed in any case."""
    with in_words(folder, "written"):
        folder.parent.mkdir(parents=True, exist_ok=True)
        if folder.exists() and not folder.is_dir():
            raise FileTrouble(f"{folder} is not a folder")
        stage = TemporaryDirectory(
            dir=folder.parent, prefix=f".{folder.name}.", ignore_cleanup_errors=True
        )
    with stage as name:
        for part in (FIGURES, DATA):
            (Path(name) / part).mkdir()
        yield Path(name)


def _move(stage: Path, folder: Path, names: list[str], overwrite: bool) -> None:
    """Move the finished files to their places."""
    with in_words(folder, "written"):
        for name in names:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            put_in_place(stage / name, folder / name, overwrite)
