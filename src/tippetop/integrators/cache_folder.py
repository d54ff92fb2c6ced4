"""Where compiled code is kept between processes."""

import os
from pathlib import Path

import platformdirs

VARIABLE = "TIPPETOP_CACHE"
"""Environment variable that names another folder for the cache, or "off" for none."""


def cache_folder() -> Path | None:
    """The folder of the cache: the user's, or the one that a variable names; None where it is turned off."""
    place = os.environ.get(VARIABLE, "")
    if place == "off":
        return None
    return Path(place) if place else platformdirs.user_cache_path("tippetop", appauthor=False)
