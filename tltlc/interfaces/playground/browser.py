"""Open an address in a browser without passing the address as an argument of a process.

Every user of the machine can see the arguments of a process. So the browser opens a temporary file
that only its owner can read, and the file redirects to the address.
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
def redirect_file(address: str) -> Iterator[str]:
    """Yield the URI of a temporary file that redirects to an address.

    Only this user can read the file, which is removed at the end of the context.

    Raises OSError or TltlError if no temporary file can be written.
    """
    with temporary_folder() as folder:
        path = folder / "open.html"
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
            file.write(_PAGE.format(address=escape(address)))
        yield path.as_uri()
