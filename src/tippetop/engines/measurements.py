"""Numbers measured in other programs: where they are stored, and the command that measures them."""

import argparse
import importlib.metadata
import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

import tippetop as tt

Row = TypeVar("Row", bound=Any)


class Stored(NamedTuple):
    """What a file of measurements holds."""

    versions: Mapping[str, str]
    """Version of each program that was measured."""
    rows: list[Any]
    """Rows of all programs; where nothing was measured, nan."""


@dataclass(frozen=True)
class Measurements(Generic[Row]):
    """Rows of numbers that programs give, stored in a file of this package, a row a line."""

    about: str
    """What the command says of itself."""
    file: str
    row: type[Row]
    """A named tuple."""
    packages: Mapping[str, str]
    """Programs, and the packages that are installed for them."""
    measure: Callable[[str], Iterable[Row]]
    """Measures the rows of a program now."""
    program_of: Callable[[Row], str]
    line: Callable[[Row], str]
    """Returns the line of a table for a row."""
    heading: str = ""
    """The line above these lines."""

    def version_of(self, program: str) -> str | None:
        """Return the version of a program; None where it is not installed."""
        try:
            return importlib.metadata.version(self.packages[program])
        except importlib.metadata.PackageNotFoundError:
            return None

    def stored(self) -> Stored:
        """Return what was measured last."""
        record = json.loads((files(__package__) / self.file).read_text(encoding="utf-8"))
        rows = [
            self.row(**{name: math.nan if value is None else value for name, value in row.items()})
            for row in record["rows"]
        ]
        return Stored(record["versions"], rows)

    def store(self, program: str, rows: Iterable[Row]) -> None:
        """Store the rows of a program in place of its earlier ones."""
        path = Path(str(files(__package__) / self.file))
        earlier = self.stored() if path.is_file() else Stored({}, [])
        versions = {**earlier.versions, program: self.version_of(program)}
        others = [row for row in earlier.rows if self.program_of(row) != program]
        lines = ",\n".join(_json(row._asdict()) for row in (*others, *rows))
        text = f'{{"versions": {json.dumps(versions)}, "rows": [\n{lines}\n]}}\n'
        path.write_text(text, encoding="utf-8")

    def run(self, words: list[str]) -> None:
        """Measure in the programs that words name, or in all; print, and store with --write."""
        parser = argparse.ArgumentParser(description=self.about)
        parser.add_argument("--program", action="append", choices=list(self.packages))
        parser.add_argument("--write", action="store_true", help=f"store them in {self.file}")
        chosen = parser.parse_args(words)
        for program in chosen.program or self.packages:
            version = self.version_of(program)
            if version is None:
                print(f"{program} is not installed: pip install {self.packages[program]}")
                continue
            print(f"{program} {version}, tippetop {tt.__version__}")
            if self.heading:
                print(self.heading)
            rows = []
            for row in self.measure(program):
                rows.append(row)
                print(self.line(row), flush=True)
            if chosen.write:
                self.store(program, rows)


def _json(values: Mapping[str, Any]) -> str:
    """Return a row as JSON has it, without nan."""
    return json.dumps({name: None if value != value else value for name, value in values.items()})
