"""Commands that install what is missing, for how this package is installed."""

import json
from importlib import metadata
from pathlib import Path
from typing import Any
from urllib.parse import urlparse
from urllib.request import url2pathname


def install_command(extra: str) -> str:
    """Return the command that installs an extra: from the folder that this package was installed
    from, if it was, or else by the package's name.
    """
    return f"pip install '{_source() or 'tippetop'}[{extra}]'"


def reinstall_command() -> str:
    """Return the command that builds and installs this package again, as it was installed."""
    source = _source()
    if source is None:
        return "pip install --force-reinstall --no-cache-dir tippetop"
    editable = _origin().get("dir_info", {}).get("editable", False)
    return f"pip install {'--editable ' * editable}'{source}'"


def _source() -> Path | None:
    """Return the folder that the package was installed from, or runs in; None if it has none."""
    url = urlparse(_origin().get("url", ""))
    if url.scheme != "file":
        return None
    folder = Path(url2pathname(url.path))
    return folder if (folder / "pyproject.toml").exists() else None


def _origin() -> dict[str, Any]:
    """Return what the installer recorded of the source: {} for an index.

    A package that is not installed counts as an editable installation of the folder it runs in.
    """
    try:
        text = metadata.distribution("tippetop").read_text("direct_url.json")
    except metadata.PackageNotFoundError:
        return {"url": Path(__file__).parents[3].as_uri(), "dir_info": {"editable": True}}
    origin: dict[str, Any] = json.loads(text) if text else {}
    return origin
