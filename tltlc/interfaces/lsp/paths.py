"""Convert between the URIs of documents, their source texts, and their locations.

The location of a file is its absolute path. The location of a document that is not a file, such as
a new text that was never saved, is its URI; in messages, its name is the URI in angle brackets.
"""

from __future__ import annotations

import os
from pathlib import Path

from pygls import uris

from tltlc.core.source import SourceFile


def location_at(uri: str) -> str:
    """Return the location of the document that has this URI."""
    return _file_path(uri) or uri


def source_at(uri: str, text: str) -> SourceFile:
    """Return ``text`` as the source of the document at ``uri``; its name is the path, or ``<URI>`` if it is no file."""
    path = _file_path(uri)
    return SourceFile(path, text) if path else SourceFile(f"<{uri}>", text, "text", uri)


def location_of(source: SourceFile) -> str:
    """Return the location of a source text."""
    return source.location if source.kind == "text" else os.path.abspath(source.location)  # noqa: PTH100


def uri_of(source: SourceFile) -> str:
    """Return the URI of the file or document that has this source text."""
    return source.location if source.kind == "text" else uris.from_fs_path(location_of(source)) or ""


def is_below(path: str, folder: str) -> bool:
    """Whether a path lies in a folder."""
    return Path(path).is_relative_to(folder)


def _file_path(uri: str) -> str | None:
    """Return the absolute path of the file that a URI names; None if it names no file."""
    try:
        path = uris.to_fs_path(uri) if uri.startswith("file:") else None
    except ValueError:
        # For example, ``file://[`` is not a valid URI.
        return None
    return os.path.abspath(path) if path else None  # noqa: PTH100 (keeps links as they are)
