"""Commands that install what is missing, for how this package is installed."""

import json
from importlib import metadata
from pathlib import Path
from urllib.parse import urlparse
from urllib.request import url2pathname


def install_command(extra: str) -> str:
    """Return the command that installs an extra: from the folder that this package was installed
    from, if it was, or else by the package's name.
    """
    return f"pip install '{_source() or 'tippetop'}[{extra}]'"


def _source() -> Path | None:
    """Return the folder that the package was installed from, or runs in; None if it has none."""
    try:
        text = metadata.distribution("tippetop").read_text("direct_url.json")
    except metadata.PackageNotFoundError:
        root = Path(__file__).parents[3]
        return root if (root / "pyproject.toml").exists() else None
    url = urlparse(json.loads(text)["url"]) if text else None
    if url is None or url.scheme != "file":
        return None
    folder = Path(url2pathname(url.path))
    return folder if (folder / "pyproject.toml").exists() else None
