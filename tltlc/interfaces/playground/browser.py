"""Lead a browser to an address without putting it into the browser's arguments, which every user of the machine sees.

The browser opens a file instead, which only its owner can read, and which leads on to the address.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from typing import Final

from tltlc.io.temporary import temporary_folder

_PAGE: Final = """\
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta http-equiv="refresh" content="0; url={address}">
<title>tltlc serve</title>
<p><a href="{address}">Open the playground</a></p>
</html>
"""


@contextmanager
def leading_to(address: str) -> Iterator[str]:
    """Within, the URI of a file that leads to an address, and that only this user can read.

    Raises OSError or TltlError if there is no room for a temporary file.
    """
    with temporary_folder() as folder:
        path = folder / "open.html"
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
            file.write(_PAGE.format(address=escape(address)))
        yield path.as_uri()
