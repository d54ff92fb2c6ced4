"""Modules of the page run by Node, bundled as the page is."""

import json
from pathlib import Path
from typing import Any

import pytest

from node import printed
from tippetop.page_engine import HERE

WEB = Path(__file__).parents[1] / "web"

SCRIPT = """
import { build } from %(esbuild)s;
const engine = %(engine)s;
const { outputFiles } = await build({
  stdin: { contents: %(code)s, resolveDir: %(folder)s, loader: "js" },
  bundle: true, format: "esm", platform: "node", write: false, logLevel: "error",
  alias: {
    engine: `${engine}/index.js`,
    "engine-tables": `${engine}/tables.js`,
    "engine-units": `${engine}/units.js`,
  },
});
const code = Buffer.from(outputFiles[0].text).toString("base64");
const { found } = await import(`data:text/javascript;base64,${code}`);
console.log(JSON.stringify(found));
"""


def found_in_the_page(code: str) -> Any:
    """Return what a module calls `found`, which imports others as a module of the page does."""
    esbuild = WEB / "node_modules" / "esbuild" / "lib" / "main.js"
    if not esbuild.exists():
        pytest.skip("the packages of web/package.json are not installed (make page)")
    gaps = {
        "esbuild": esbuild.as_uri(),
        "engine": str(HERE),
        "code": code,
        "folder": str(WEB / "src" / "lab"),
    }
    return json.loads(printed(SCRIPT % {name: json.dumps(gap) for name, gap in gaps.items()}))
