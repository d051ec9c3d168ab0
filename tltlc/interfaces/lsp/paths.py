"""Convert between the URIs of documents, their names in messages, and their paths.

In messages, a file is named by a path, a file of the standard library by a short name, and a
document that is not a file by its URI in angle brackets.
"""

from __future__ import annotations

import os
from pathlib import Path

from pygls import uris

from tltlc.resolve.imports import STANDARD_LIBRARY_NAME, standard_library


def name_of(uri: str) -> str:
    """Return a document's name for messages: the absolute path of a file, or ``<URI>`` if it is no file."""
    try:
        path = uris.to_fs_path(uri) if uri.startswith("file:") else None
    except ValueError:
        # For example, ``file://[`` is not a valid URI.
        path = None
    return os.path.abspath(path) if path else f"<{uri}>"  # noqa: PTH100 (keeps links as they are)


def path_of(name: str) -> str:
    """Return the absolute path of the file that has this name in messages.

    For a document that is not a file, return the name, ``<URI>``.
    """
    if name.startswith(STANDARD_LIBRARY_NAME):
        return str(standard_library().absolute() / name[len(STANDARD_LIBRARY_NAME) + 1 :])
    return name if name.startswith("<") else os.path.abspath(name)  # noqa: PTH100


def uri_of(name: str) -> str:
    """Return the URI of the file or document that has this name in messages."""
    path = path_of(name)
    return path[1:-1] if path.startswith("<") else uris.from_fs_path(path) or ""


def is_below(path: str, folder: str) -> bool:
    """Whether a path lies in a folder."""
    return Path(path).is_relative_to(folder)
