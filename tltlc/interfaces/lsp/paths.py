"""Convert between URIs of documents and the names of files in messages."""

from __future__ import annotations

import os
from pathlib import Path

from pygls import uris

from tltlc.resolve.imports import STANDARD_LIBRARY_NAME, standard_library


def name_of(uri: str) -> str:
    """Return the name of a document: its absolute path, or ``<URI>`` if it is not a file."""
    try:
        path = uris.to_fs_path(uri) if uri.startswith("file:") else None
    except ValueError:
        # For example, ``file://[`` is not a valid URI.
        path = None
    return os.path.abspath(path) if path else f"<{uri}>"  # noqa: PTH100 (keeps links as they are)


def path_of(name: str) -> str:
    """Return the absolute path for the name of a file in messages.

    A document that is not a file keeps its name.
    """
    if name.startswith(STANDARD_LIBRARY_NAME):
        return str(standard_library().absolute() / name[len(STANDARD_LIBRARY_NAME) + 1 :])
    return name if name.startswith("<") else os.path.abspath(name)  # noqa: PTH100


def uri_of(name: str) -> str:
    """Return the URI for the name of a file or document in messages."""
    path = path_of(name)
    return path[1:-1] if path.startswith("<") else uris.from_fs_path(path) or ""


def is_below(path: str, folder: str) -> bool:
    """Whether a path lies in a folder."""
    return Path(path).is_relative_to(folder)
