from __future__ import annotations

from importlib.util import find_spec

if find_spec("mcp") is None:
    # Without the extra `mcp` nothing can be tested; the extra `dev` includes it.
    collect_ignore_glob = ["test_*.py"]
