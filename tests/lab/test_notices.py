"""Whoever receives a bundled npm package receives its licence: in pages, bundles and the wheel."""

import json
import re
import tomllib
from pathlib import Path

import pytest

import tippetop as tt
from node import printed
from tippetop.export import bundle
from tippetop.report.page import render
from tippetop.report.playable import playable

ROOT = Path(__file__).parents[2]
WEB = ROOT / "web"
NOTICES = (WEB / "notices.txt").read_text(encoding="utf-8")
BUILT = Path(bundle.__file__).parent / "built"
OWN = {"engine", "engine-tables", "engine-units", "worker-code"}
"""Names of imports that the build replaces by code of this package."""


def licences() -> dict[str, str]:
    _, *parts = re.split(r"^=== (\S+) ===\n", NOTICES, flags=re.MULTILINE)
    return {name: text.strip() for name, text in zip(parts[::2], parts[1::2], strict=True)}


def imported() -> set[str]:
    """Names of the npm packages that the sources of the bundles import."""
    statement = re.compile(
        r"""(?:\bfrom\s*|\bimport\s*\(?\s*|@import\s+)["']([^"'.:/][^"':]*)["']"""
    )
    names = {
        found
        for path in (WEB / "src").rglob("*.*")
        if path.suffix in (".js", ".jsx", ".mjs", ".css", ".html")
        for found in statement.findall(path.read_text(encoding="utf-8"))
    }
    return {"/".join(name.split("/")[: 1 + name.startswith("@")]) for name in names - OWN}


def refusals(script: str) -> list[str]:
    """The messages with which functions of `notices.mjs` refuse, one for each line of a script."""
    address = json.dumps((WEB / "notices.mjs").as_uri())
    attempts = ",\n".join(f"() => {line}" for line in script.strip().splitlines())
    return json.loads(
        printed(
            f"import * as notices from {address};\n"
            "const { licencesIn, noticeOf, packagesOf, requireLicences } = notices;\n"
            "const refusal = (attempt) => {\n"
            "  try { attempt(); return ''; } catch ({ message }) { return message; }\n"
            "};\n"
            f"console.log(JSON.stringify([{attempts}].map(refusal)));"
        )
    )


def test_every_package_that_is_imported_has_its_licence() -> None:
    packages = json.loads((WEB / "package.json").read_text(encoding="utf-8"))["dependencies"]
    assert len(packages) > 3
    assert imported() == set(packages) == set(licences())


def test_a_licence_has_its_copyright_and_its_permission() -> None:
    for name, text in licences().items():
        assert re.search(r"^Copyright", text, re.MULTILINE), name
        assert re.search(r"Permission is hereby granted|Redistribution and use", text), name
        assert "WARRANT" in text, name


def test_licences_end_no_comment() -> None:
    """In the comments of bundles and pages."""
    assert not re.search(r"\*/|--!?>", NOTICES)


def test_the_build_refuses_a_bundle_whose_licences_are_not_its_own() -> None:
    one = json.dumps("Head.\n\n=== one ===\n\nCopyright\n\nof one\n")
    text = f"licencesIn({one})"
    assert refusals(
        f"""
        requireLicences(["one"], {text}, new Map([["one", "Copyright\\n\\nof one"]]))
        requireLicences(["one", "@a/two"], {text}, new Map([["one", "Copyright\\n\\nof one"]]))
        requireLicences([], {text}, new Map())
        requireLicences(["one"], {text}, new Map([["one", "Copyright 2030"]]))
        """
    ) == [
        "",
        "web/notices.txt has no licence of @a/two, which is bundled: add it there",
        "web/notices.txt has a licence of one, which is not bundled: remove it",
        "web/notices.txt has another licence of one than the package: renew it",
    ]


def test_the_build_sees_what_esbuild_has_bundled() -> None:
    """Packages of packages too."""
    paths = ["src/a.js", "node_modules/one/x.js", "node_modules/one/node_modules/@a/two/lib/y.js"]
    inputs = json.dumps({"inputs": {path: {} for path in paths}})
    (message,) = refusals(f"{{ throw new Error(String(packagesOf({inputs}))); }}")
    assert message == "@a/two,one"


def test_pages_of_runs_have_the_licences_of_their_player(tmp_path: Path) -> None:
    run = tt.simulate(tt.presets.report_problem(), 0.05, samples=11)
    page = tt.write_html(run, tmp_path / "run.html").read_text(encoding="utf-8")
    notices = bundle.player_notices()
    assert notices.startswith("=== ")
    assert f"<!--\n{notices}\n-->" in page


def test_the_page_of_the_report_has_the_licences_of_its_player(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tippetop.report.playable.DURATION", 0.1)
    page = render([], [], tmp_path, player=playable(True), quick=True)
    assert f"<!--\n{bundle.player_notices()}\n-->" in page


def test_the_distributions_have_the_licences() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert "web/notices.txt" in project["project"]["license-files"]
    assert "web" in project["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]


@pytest.mark.browser  # with these tests, the bundles are built
def test_the_bundles_have_the_licences_of_their_packages() -> None:
    player = (BUILT / "player.js").read_text(encoding="utf-8")
    page = (BUILT / "lab.html").read_text(encoding="utf-8")
    assert player.startswith(f"/*!\n=== three ===\n\n{licences()['three']}")
    for text in licences().values():
        assert text in page
