"""What `tippetop` says where it is misused, in a process of its own."""

import subprocess
import sys
from pathlib import Path


def misused(folder: Path | str, *arguments: str) -> str:
    """What it says in a folder with these arguments, which is all it says, with exit code 2."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-m", "tippetop", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (done.stdout, done.returncode) == ("", 2), done.stderr
    return done.stderr
