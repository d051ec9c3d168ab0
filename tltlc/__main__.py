"""``python -m tltlc``."""

from __future__ import annotations

from tltlc.cli.main import main

main()
