"""Hooks of MkDocs: add pages to those of ``docs/``, and turn links between files into links between pages.

The build fetches nothing, and writes only the site.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, Final

import pygments.lexers
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page as SitePage

from docs_site import commands, diagnostics, facade, links, readme, sources
from docs_site.page import ROOT, Page, read
from tltlc.grammar.pygments_lexer import TltlLexer

UNCHANGED: Final = {
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "benchmarks/RESULTS.md": "benchmarks.md",
    "docs/adr": "adr/README.md",
}
"""Files of the project that become pages without changes, and the folder of the records."""

COPIED: Final = {
    "LICENSE": "LICENSE",
    "benchmarks/training.png": "images/training.png",
    **{path.relative_to(ROOT).as_posix(): path.name for path in sorted((ROOT / "tltlc").rglob("*.schema.json"))},
    "docs_site/assets/style.css": "assets/tltlc.css",
    "docs_site/assets/iframe-worker.js": "assets/iframe-worker.js",
}

_ROW: Final = re.compile(r"^\|.*$", re.MULTILINE)
_CODE: Final = re.compile(r"`[^`]*`")
_LINT_RULES: Final = "<!-- lint rules -->\n"
"""The place in a page where the table of the lint rules goes."""
_COMMENT: Final = re.compile(r"^<!--.*?-->\n", re.DOTALL | re.MULTILINE)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Register the lexer of `.tltl` with Pygments, which finds it only if this project is installed."""
    cls = TltlLexer
    entry = (cls.__module__, cls.name, tuple(cls.aliases), tuple(cls.filenames), tuple(cls.mimetypes))
    pygments.lexers.LEXERS.setdefault(cls.__name__, entry)
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages, and the files of the project that pages link to."""
    for page in generated_pages().values():
        files.append(File.generated(config, page.uri, content=page.text))
    for path, uri in COPIED.items():
        files.append(File.generated(config, uri, abs_src_path=str(ROOT / path)))
    named_uris = {uri for entry in config.nav or () for uri in _uris_of(entry)}
    uris = sorted((file.src_uri for file in files.documentation_pages()), key=_sort_key)
    config.nav = _expand(config.nav or [], [uri for uri in uris if uri not in named_uris])
    return files


def on_page_markdown(markdown: str, page: SitePage, config: MkDocsConfig, files: Files) -> str:
    """Adapt the Markdown of a page to the site, and remove comments, which are for the tests of the pages.

    The table of the lint rules replaces ``_LINT_RULES``.
    """
    uri = page.file.src_uri
    origin = generated_pages()[uri].origin if uri in generated_pages() else f"docs/{uri}"
    text = markdown.replace(_LINT_RULES, diagnostics.lint_rules()) if _LINT_RULES in markdown else markdown
    text = commands.with_links(text) if uri == commands.REFERENCE else text
    text = _ROW.sub(lambda row: _CODE.sub(_unescape_bars, row[0]), _COMMENT.sub("", text))
    return links.to_pages(text, origin, uri, homes())


def _unescape_bars(code: re.Match[str]) -> str:
    """Remove the backslash before a bar in code in a table: GitHub needs it, Python-Markdown shows it."""
    return code[0].replace(r"\|", "|")


@lru_cache(maxsize=1)
def generated_pages() -> dict[str, Page]:
    """Return the pages that are not files of ``docs/``, by URI."""
    unchanged = [Page(uri, read(path), path) for path, uri in UNCHANGED.items() if path.endswith(".md")]
    pages = [*readme.pages(), facade.page(), *commands.pages(), *diagnostics.pages(), *sources.pages(), *unchanged]
    return {page.uri: page for page in pages}


@lru_cache(maxsize=1)
def homes() -> dict[str, str]:
    """Return the URIs of the files and folders of the project that have a page, by path."""
    return {"docs": "index.md"} | COPIED | UNCHANGED | readme.homes() | diagnostics.homes() | sources.homes()


def _sort_key(uri: str) -> tuple[str, bool, str]:
    """Return the sort key of a page: by folder, with the index of a folder first."""
    folder, _, name = uri.rpartition("/")
    return folder, name != "index.md", name


def _uris_of(entry: Any) -> list[str]:
    """Return the URIs that an entry of the navigation names."""
    if isinstance(entry, str):
        return [entry]
    inner = entry if isinstance(entry, list) else entry.values()
    return [uri for item in inner for uri in _uris_of(item)]


def _expand(entry: Any, unnamed: list[str]) -> Any:
    """Expand an entry of the navigation.

    In a list, ``FOLDER/`` stands for the pages of that folder that no entry names. ``unnamed`` are
    the URIs of all pages that no entry names.
    """
    if isinstance(entry, dict):
        return {title: _expand(inner, unnamed) for title, inner in entry.items()}
    if not isinstance(entry, list):
        return entry
    items: list[Any] = []
    for item in entry:
        if not isinstance(item, str) or not item.endswith("/"):
            items.append(_expand(item, unnamed))
        elif item == "diagnostics/":
            items += diagnostics.navigation()
        else:
            items += [uri for uri in unnamed if uri.startswith(item)]
    return items
