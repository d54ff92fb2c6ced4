"""What is told in words: the data beside the code, in files of TOML."""

import tomllib
from pathlib import Path
from typing import Any

from tippetop.report import quoted, readings
from tippetop.report.experiments import dry, flights, patches, real, runs, theory, theory_runs

_MODULES = (quoted, readings, dry, flights, patches, real, runs, theory, theory_runs)


def told(name: str) -> dict[str, Any]:
    """Return the tables of a file of this folder, with what stands in braces in their texts filled
    in.

    That is a constant of `quoted`, `readings` or the experiments, such as {dry.SPIN:g}, or one of
    the words that the file itself explains.
    """
    tables = tomllib.loads(Path(__file__).with_name(f"{name}.toml").read_text(encoding="utf-8"))
    names = {module.__name__.rpartition(".")[2]: module for module in _MODULES} | tables.pop(
        "words", {}
    )

    def filled(value: Any) -> Any:
        return (
            value.format(**names)
            if isinstance(value, str)
            else tuple(value)
            if isinstance(value, list)
            else value
        )

    return {
        key: {name: filled(value) for name, value in table.items()} for key, table in tables.items()
    }
