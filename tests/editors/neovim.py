"""A headless Neovim that gets keys, and whose state can be queried."""

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
    """The version of Neovim, for example (0, 11, 4)."""
    output = subprocess.run([str(PROGRAM), "--version"], capture_output=True, text=True, timeout=HANG_S).stdout
    match = re.search(r"v(\d+)\.(\d+)\.(\d+)", output)
    assert match, output
    return tuple(map(int, match.groups()))


def settings() -> str:
    """The guide's settings in `init.lua` for this version. The guide's last block is for versions
    before 0.11."""
    part = GUIDE.read_text(encoding="utf-8").partition("## Neovim\n")[2].partition("\n## ")[0]
    blocks = re.findall(r"```lua\n(.*?)```", part, re.DOTALL)
    return "\n".join(blocks[:-1] if version() >= (0, 11) else blocks[-1:])


class Neovim:
    """A Neovim that runs in a folder, with the `tltlc` of this checkout."""

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
            **{
                f"XDG_{directory}_HOME": str(home / directory.lower())
                for directory in ("CONFIG", "DATA", "STATE", "CACHE")
            },
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
        """Type keys; special keys are written `<CR>`, `<Esc>` and so on."""
        self._remote("--remote-send", text)

    def lua(self, expression: str) -> Any:
        """Return the value of a Lua expression."""
        # The answer goes through a file: some versions print it to standard error, and only its first 1,000
        # characters.
        answer = self.home / "answer.json"
        quoted = expression.replace("'", "''")
        self._remote("--remote-expr", f"writefile([json_encode(luaeval('{quoted}'))], '{answer}')")
        return json.loads(answer.read_text(encoding="utf-8"))

    def lines(self) -> list[str]:
        """The text of the current buffer, in lines."""
        buffer_lines: list[str] = self.lua("vim.api.nvim_buf_get_lines(0, 0, -1, true)")
        return buffer_lines

    def diagnostics(self) -> list[str]:
        """The messages of the diagnostics in the current buffer."""
        return [diagnostic["message"] for diagnostic in self.lua("vim.diagnostic.get(0)")]

    def until(self, holds: Callable[[], Any], what: str) -> Any:
        """Wait until ``holds`` returns something true, and return it."""

        def holds_now() -> Any:
            assert self.process.poll() is None, self.errors()
            return holds()

        return until(holds_now, what, 0.1)

    def errors(self) -> str:
        """The last 1,000 characters that Neovim wrote."""
        return (self.home / "errors").read_text(encoding="utf-8")[-1000:]

    def running_processes(self) -> list[str]:
        """The command lines of processes started by this Neovim that are still running; on Linux."""
        command_lines = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                if str(self.home).encode() in (process / "environ").read_bytes():
                    command_lines.append((process / "cmdline").read_bytes().replace(b"\0", b" ").decode())
            except OSError:
                continue
        return [command_line for command_line in command_lines if command_line]

    def end(self) -> None:
        """Kill Neovim if it still runs, and close its log."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self._errors.close()

    def _answers(self) -> bool:
        return Path(self._socket).exists() and self._run_remote("--remote-expr", "1").returncode == 0

    def _remote(self, *words: str) -> None:
        done = self._run_remote(*words)
        assert done.returncode == 0, done.stderr

    def _run_remote(self, *words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(PROGRAM), "--server", self._socket, *words],
            env=self._environment,
            capture_output=True,
            text=True,
            timeout=HANG_S,
        )
