"""Texts of figures and claims from the files of TOML in this folder, with constants filled in."""

import tomllib
from pathlib import Path
from typing import Any

from tippetop.report import printed_numbers, readings
from tippetop.report.experiments import dry, flights, patches, real, runs, theory, theory_runs

_MODULES = (printed_numbers, readings, dry, flights, patches, real, runs, theory, theory_runs)


def filled_tables(name: str) -> dict[str, Any]:
    """Return the tables of a file of this folder with the names in braces replaced by their values.

    The names are constants of `printed_numbers`, of `readings` or of the experiments, such as
    {dry.SPIN:g}, or the words that the file itself defines.
    """
    tables = tomllib.loads(Path(__file__).with_name(f"{name}.toml").read_text(encoding="utf-8"))
    names = {module.__name__.rpartition(".")[2]: module for module in _MODULES} | tables.pop(
        "words", {}
    )

    def filled(value: Any) -> Any:
        if isinstance(value, str):
            return value.format(**names)
        if isinstance(value, list):
            return tuple(value)
        return value

    return {
        key: {name: filled(value) for name, value in table.items()} for key, table in tables.items()
    }
