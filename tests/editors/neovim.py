"""Neovim without a screen, given keys and asked what it shows."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.waiting import HANG_S, until

ROOT = Path(__file__).parents[2]
GUIDE = ROOT / "docs" / "guides" / "editors.md"
PROGRAM = os.environ.get("NVIM") or shutil.which("nvim")


def version() -> tuple[int, ...]:
    """(0, 11, 4), for example."""
    said = subprocess.run([str(PROGRAM), "--version"], capture_output=True, text=True, timeout=HANG_S).stdout
    found = re.search(r"v(\d+)\.(\d+)\.(\d+)", said)
    assert found, said
    return tuple(map(int, found.groups()))


def settings() -> str:
    """What the guide has for this version in `init.lua`, of which the last block is for those before 0.11."""
    part = GUIDE.read_text(encoding="utf-8").partition("## Neovim\n")[2].partition("\n## ")[0]
    blocks = re.findall(r"```lua\n(.*?)```", part, re.DOTALL)
    return "\n".join(blocks[:-1] if version() >= (0, 11) else blocks[-1:])


class Neovim:
    """One that runs in a folder, with the `tltlc` of this checkout."""

    def __init__(self, home: Path, folder: Path) -> None:
        programs = home / "bin"
        programs.mkdir(parents=True)
        tltlc = programs / "tltlc"
        tltlc.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m tltlc "$@"\n', encoding="utf-8")
        tltlc.chmod(0o755)
        (home / "tltlc").symlink_to(ROOT)
        (home / "init.lua").write_text(settings(), encoding="utf-8")
        self.home = home
        self._environment = {
            **os.environ,
            "HOME": str(home),
            **{f"XDG_{each}_HOME": str(home / each.lower()) for each in ("CONFIG", "DATA", "STATE", "CACHE")},
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, sys.path)]),
            "TLTLC_CACHE_DIR": "",
        }
        self._socket = str(home / "s")
        self._errors = (home / "errors").open("w", encoding="utf-8")
        self.process = subprocess.Popen(
            [str(PROGRAM), "--headless", "-n", "-i", "NONE", "-u", str(home / "init.lua"), "--listen", self._socket],
            cwd=folder,
            env=self._environment,
            stdin=subprocess.DEVNULL,
            stdout=self._errors,
            stderr=self._errors,
        )
        self.until(self._answers, "Neovim to start")

    def keys(self, text: str) -> None:
        """Type, with `<CR>`, `<Esc>` and the like for keys that are no signs."""
        self._remote("--remote-send", text)

    def lua(self, expression: str) -> Any:
        """The value of an expression in Lua."""
        # By way of a file: some versions print an answer to standard error, and no more than its first thousand signs.
        answer = self.home / "answer.json"
        quoted = expression.replace("'", "''")
        self._remote("--remote-expr", f"writefile([json_encode(luaeval('{quoted}'))], '{answer}')")
        return json.loads(answer.read_text(encoding="utf-8"))

    def lines(self) -> list[str]:
        """The text that is shown."""
        found: list[str] = self.lua("vim.api.nvim_buf_get_lines(0, 0, -1, true)")
        return found

    def diagnostics(self) -> list[str]:
        """The messages at the text that is shown."""
        return [each["message"] for each in self.lua("vim.diagnostic.get(0)")]

    def until(self, holds: Callable[[], Any], what: str) -> Any:
        """Wait until something is there, and give it back."""

        def happened() -> Any:
            assert self.process.poll() is None, self.errors()
            return holds()

        return until(happened, what, 0.1)

    def errors(self) -> str:
        """The end of what Neovim wrote."""
        return (self.home / "errors").read_text(encoding="utf-8")[-1000:]

    def left(self) -> list[str]:
        """The commands of the processes that were started from here and are still there, on Linux."""
        found = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                if str(self.home).encode() in (process / "environ").read_bytes():
                    found.append((process / "cmdline").read_bytes().replace(b"\0", b" ").decode())
            except OSError:
                continue
        return [each for each in found if each]

    def end(self) -> None:
        """Leave nothing behind, whatever happened."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self._errors.close()

    def _answers(self) -> bool:
        return Path(self._socket).exists() and self._asked("--remote-expr", "1").returncode == 0

    def _remote(self, *words: str) -> None:
        done = self._asked(*words)
        assert done.returncode == 0, done.stderr

    def _asked(self, *words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(PROGRAM), "--server", self._socket, *words],
            env=self._environment,
            capture_output=True,
            text=True,
            timeout=HANG_S,
        )
