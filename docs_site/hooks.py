"""What MkDocs calls: pages are added to those of ``docs/``, and links between files become links between pages.

Nothing is fetched, and nothing is written but the site.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, Final

import pygments.lexers
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page as SitePage

from docs_site import commands, diagnostics, links, readme, sources
from docs_site.page import ROOT, Page, read
from tltlc.grammar.pygments_lexer import TltlLexer

WHOLE: Final = {
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "benchmarks/RESULTS.md": "benchmarks.md",
    "docs/adr": "adr/README.md",
}
"""Files, and a folder, that are pages as they stand."""

COPIED: Final = {
    "LICENSE": "LICENSE",
    "benchmarks/training.png": "images/training.png",
    **{path.relative_to(ROOT).as_posix(): path.name for path in sorted((ROOT / "tltlc").rglob("*.schema.json"))},
    "docs_site/assets/style.css": "assets/tltlc.css",
    "docs_site/assets/iframe-worker.js": "assets/iframe-worker.js",
}

_ROW: Final = re.compile(r"^\|.*$", re.MULTILINE)
_CODE: Final = re.compile(r"`[^`]*`")
_COMMENT: Final = re.compile(r"^<!--.*?-->\n", re.DOTALL | re.MULTILINE)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Make the colours of `.tltl` known, also where this project is not installed."""
    cls = TltlLexer
    known = (cls.__module__, cls.name, tuple(cls.aliases), tuple(cls.filenames), tuple(cls.mimetypes))
    pygments.lexers.LEXERS.setdefault(cls.__name__, known)
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are made, and the files of the project that pages link to."""
    for page in made().values():
        files.append(File.generated(config, page.uri, content=page.text))
    for path, uri in COPIED.items():
        files.append(File.generated(config, uri, abs_src_path=str(ROOT / path)))
    named = {uri for entry in config.nav or () for uri in _named(entry)}
    uris = sorted((file.src_uri for file in files.documentation_pages()), key=_place)
    config.nav = _expanded(config.nav or [], [uri for uri in uris if uri not in named])
    return files


def on_page_markdown(markdown: str, page: SitePage, config: MkDocsConfig, files: Files) -> str:
    """Make what is written for hosts of repositories fit here; comments are for the tests of the pages."""
    uri = page.file.src_uri
    origin = made()[uri].origin if uri in made() else f"docs/{uri}"
    text = _ROW.sub(lambda row: _CODE.sub(_with_bars, row[0]), _COMMENT.sub("", markdown))
    return links.to_pages(text, origin, uri, homes())


def _with_bars(code: re.Match[str]) -> str:
    """Code in a table: hosts of repositories want a backslash before a bar, Python-Markdown shows it."""
    return code[0].replace(r"\|", "|")


@lru_cache(maxsize=1)
def made() -> dict[str, Page]:
    """The pages that are no files of ``docs/``, by their place in the site."""
    whole = [Page(uri, read(path), path) for path, uri in WHOLE.items() if path.endswith(".md")]
    pages = [*readme.pages(), *commands.pages(), *diagnostics.pages(), *sources.pages(), *whole]
    return {page.uri: page for page in pages}


@lru_cache(maxsize=1)
def homes() -> dict[str, str]:
    """Where the files of the project are in the site."""
    return {"docs": "index.md"} | COPIED | WHOLE | readme.homes() | diagnostics.homes() | sources.homes()


def _place(uri: str) -> tuple[str, bool, str]:
    """By folders, in each the page on all of it first."""
    folder, _, name = uri.rpartition("/")
    return folder, name != "index.md", name


def _named(entry: Any) -> list[str]:
    """The pages that an entry of the navigation names."""
    if isinstance(entry, str):
        return [entry]
    inner = entry if isinstance(entry, list) else entry.values()
    return [uri for each in inner for uri in _named(each)]


def _expanded(entry: Any, left: list[str]) -> Any:
    """An entry in which ``FOLDER/`` in a list stands for the pages of that folder that are named nowhere."""
    if isinstance(entry, dict):
        return {title: _expanded(inner, left) for title, inner in entry.items()}
    if not isinstance(entry, list):
        return entry
    found: list[Any] = []
    for each in entry:
        if not isinstance(each, str) or not each.endswith("/"):
            found.append(_expanded(each, left))
        elif each == "diagnostics/":
            found += diagnostics.navigation()
        else:
            found += [uri for uri in left if uri.startswith(each)]
    return found
