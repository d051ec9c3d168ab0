"""The documentation site: complete, with valid links, and without requests to other hosts."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path
from string import ascii_lowercase
from urllib.parse import unquote

import pytest

from tests.docs.blocks import DOCS, ROOT
from tests.runtime.regression.page import chromium
from tests.shared import made_once
from tests.waiting import HANG_S
from tltlc.diagnostics.code_pages import codes, title
from tltlc.interfaces.cli.command_line import BUILT_IN
from tltlc.tools.lint import allow
from tltlc.tools.lint.rules import rules

MISSING = [name for name in ("mkdocs", "material", "pymdownx") if find_spec(name) is None]
pytestmark = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")

if not MISSING:
    from docs_site import commands, hooks, links

SOURCES = sorted([*DOCS.rglob("*.md"), *ROOT.glob("*.md"), *(ROOT / "tltlc" / "diagnostics" / "pages").glob("*.md")])
LOADING = {("script", "src"), ("link", "href"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("video", "src")}


class ParsedPage(HTMLParser):
    """A parsed page: the URLs that it loads, its links, its anchors and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loads: set[str] = set()
        self.links: set[str] = set()
        self.anchors: set[str] = set()
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if (tag, name) in LOADING:
                self.loads.add(value or "")
            elif name == "href":
                self.links.add(value or "")
            elif name == "id":
                self.anchors.add(value or "")

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built with warnings as errors."""
    return made_once(tmp_path_factory, "site", _build)


def _build(folder: Path) -> None:
    completed = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", folder],
        cwd=ROOT,
        env={
            **os.environ,
            "NO_MKDOCS_2_WARNING": "1",
            "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")]),
        },
        capture_output=True,
        encoding="utf-8",
        timeout=HANG_S,
        check=False,
    )
    assert completed.returncode == 0, completed.stderr


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, ParsedPage]:
    return {path: ParsedPage(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}


def test_every_code_has_a_page(site: Path, pages: dict[Path, ParsedPage]) -> None:
    for code in codes():
        text = pages[site / "diagnostics" / f"{code}.html"].text
        assert f"{code}: {title(code)}".replace("`", "") in text
        assert code in pages[site / "diagnostics" / "index.html"].text


def test_every_command_has_a_page(site: Path, pages: dict[Path, ParsedPage]) -> None:
    assert set(BUILT_IN) <= set(commands.names())
    for name in commands.names():
        assert f"tltlc {name}" in pages[site / "commands" / f"{name}.html"].text
    compile_ = pages[site / "commands" / "compile.html"].text
    assert all(
        text in compile_ for text in ("--state-budget N", "-h, --help", "tltlc compile [OPTIONS] SPEC", "Examples")
    )


def test_the_guide_lists_every_lint_rule(pages: dict[Path, ParsedPage], site: Path) -> None:
    guide = pages[site / "guides" / "linting.html"]
    listed = dict(re.findall(r"(TLT04[0-9]{2})\n(\w+)\n", guide.text))
    assert listed == {**{rule.code: rule.severity for rule in rules()}, allow.CODE: allow.SEVERITY}
    assert {f"../diagnostics/{code}.html" for code in listed} <= guide.links


def test_no_page_loads_from_another_host(site: Path, pages: dict[Path, ParsedPage]) -> None:
    for path, page in pages.items():
        assert [url for url in page.loads if re.match(r"(\w+:)?//", url)] == [], path
    for path in site.rglob("*.css"):
        assert not re.search(r"url\([\"']?(https?:)?//|@import", path.read_text(encoding="utf-8")), path


def test_every_link_has_a_target(site: Path, pages: dict[Path, ParsedPage]) -> None:
    for path, page in pages.items():
        if path.name == "404.html":
            continue
        for url in page.links | page.loads:
            if re.match(r"\w+:|$", url):
                continue
            place, _, anchor = url.partition("#")
            target = Path(os.path.normpath(path.parent / unquote(place))) if place else path
            target = target / "index.html" if target.is_dir() else target
            assert target.is_file(), f"{path}: {url}"
            if anchor and target in pages and not anchor.startswith("__"):
                assert unquote(anchor) in pages[target].anchors, f"{path}: {url}"


def test_specifications_are_coloured(site: Path) -> None:
    text = (site / "language.html").read_text(encoding="utf-8")
    blocks = re.findall(r'<div class="language-tltl highlight">(.*?)</div>', text, re.DOTALL)
    assert len(blocks) >= 14
    assert all('<span class="kd">spec</span>' in block or "let" in block for block in blocks)
    assert not any('class="err"' in block for block in blocks)


def test_hidden_commands_of_the_tests_are_not_shown(site: Path) -> None:
    assert "<!-- in first_level.tltl" not in (site / "tutorial.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("page", SOURCES, ids=lambda page: page.name)
def test_lists_have_an_empty_line_before_them(page: Path) -> None:
    """Otherwise Python-Markdown treats a list as a part of the paragraph."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    assert re.findall(r"^(?![-*] |\d+\. |\s).+\n(?:[-*]|\d+\.) .*$", text, re.MULTILINE) == []


@pytest.mark.slow
@pytest.mark.skipif(bool(chromium.MISSING), reason=f"not installed: {', '.join(chromium.MISSING)}")
def test_the_search_works_without_a_server(site: Path) -> None:
    wrong: list[str] = []
    with chromium.browser() as browser:
        page = browser.new_page()
        page.set_default_timeout(chromium.HANG_MS)
        page.on("console", lambda message: wrong.append(message.text))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", lambda request: wrong.append(request.url) if request.url.startswith("http") else None)
        page.goto((site / "tutorial.html").as_uri())
        page.click("[data-md-component=search-query]")
        page.keyboard.type("units do not fit")
        page.wait_for_selector(".md-search-result__item a[href*=TLT0305]", timeout=chromium.HANG_MS)
        # A letter stands for all words that start with it. The index fails for some letters if it splits words badly.
        for text in (*ascii_lowercase, "dt", "13", "<>", "near(s1)", "F[0,3] a & G b", "Büchi", "*", ":", "tlt0412"):
            page.fill("[data-md-component=search-query]", text)
            page.keyboard.press("Shift")
            page.wait_for_timeout(50)
        page.wait_for_selector(".md-search-result__item a[href*=TLT0412]", timeout=chromium.HANG_MS)
    assert wrong == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[a](../../README.md#installing)", "[a](../installing.md#installing)"),
        ("[a](../../README.md#try-it)", "[a](../index.md#try-it)"),
        ("[a](../../CHANGELOG.md)", "[a](../changelog.md)"),
        ("[a](../language.md#a-file) and [b](#here)", "[a](../language.md#a-file) and [b](#here)"),
        ("[`a`](../../tltlc/diagnostics/pages/TLT0305.md)", "[`a`](../diagnostics/TLT0305.md)"),
        ("as TLT0305 says; `TLT0305`", "as [TLT0305](../diagnostics/TLT0305.md) says; `TLT0305`"),
        ("## TLT0305\n```\nTLT0305 [a](b.md)\n```", "## TLT0305\n```\nTLT0305 [a](b.md)\n```"),
        ("it says\n\n    error TLT0305", "it says\n\n    error TLT0305"),
        ("TLT9999, [a](https://example.org)", "TLT9999, [a](https://example.org)"),
        ("[a](../../nowhere.md)", "[a](../../nowhere.md)"),
    ],
)
def test_links_to_files_become_links_to_pages(text: str, expected: str) -> None:
    assert links.to_pages(text, "docs/adr/here.md", "adr/here.md", hooks.homes()) == expected
