"""``tltlc serve`` as a command."""

from __future__ import annotations

import http.client
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from html import unescape
from pathlib import Path
from urllib.request import url2pathname
from zipfile import ZipFile

import pytest

from tests.interfaces.cli.conftest import ROOT, inside, tltlc  # noqa: F401 (fixtures)
from tests.waiting import HANG_S
from tltlc.interfaces.playground.browser import redirect_file
from tltlc.interfaces.playground.site import PYODIDE

needs_signals = pytest.mark.skipif(sys.platform == "win32", reason="needs a signal that reaches one process alone")


@contextmanager
def serve(
    *options: str, program: tuple[str, ...] = ("-m", "tltlc"), folder: Path | None = None, **environment: str
) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """Start ``tltlc serve``, and yield the process and its port."""
    running = subprocess.Popen(
        [sys.executable, *program, "serve", "--port", "0", *options],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    try:
        assert running.stderr is not None
        line = running.stderr.readline()
        match = re.fullmatch(
            r"the playground is at http://127\.0\.0\.1:(\d+)/#token=[\w-]{32} \(press Ctrl-C to stop\)\n", line
        )
        assert match, line
        yield running, int(match[1])
    finally:
        running.kill()
        running.communicate()


def rest_of_errors(running: subprocess.Popen[str]) -> str:
    """Read standard error to the end of the process, including buffered text, which `communicate`
    omits."""
    assert running.stderr is not None
    return running.stderr.read()


@needs_signals
def test_the_command_serves_until_it_is_interrupted() -> None:
    with serve() as (running, port):
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=HANG_S)
        connection.request("GET", "/")
        assert connection.getresponse().status == 200
        connection.close()
        running.send_signal(signal.SIGINT)
        assert rest_of_errors(running) == ""
        assert running.wait(HANG_S) == 130


def messages_after_address(*options: str, folder: Path) -> str:
    """Return what `tltlc serve` writes to standard error until it answers, without the first line."""
    with serve(*options, folder=folder) as (running, port):
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=HANG_S)
        connection.request("GET", "/")
        connection.getresponse().read()
        connection.close()
        running.send_signal(signal.SIGINT)
        return rest_of_errors(running)


@needs_signals
def test_an_ignored_project_file_is_named(tmp_path: Path) -> None:
    below = tmp_path / "levels" / "first"
    below.mkdir(parents=True)
    (tmp_path / "tltl.toml").write_text("")
    assert messages_after_address(folder=below) == (
        f"{tmp_path / 'tltl.toml'} is ignored, because it is above this folder; "
        f"to use it, start `tltlc serve` in {tmp_path}\n"
    )
    # The nearest project file applies here, so there is no message.
    (below / "tltl.toml").write_text("")
    for folder in (below, tmp_path):
        assert messages_after_address(folder=folder) == ""


ELSEWHERE = """
import signal, sys
from threading import Thread, get_ident, main_thread
from time import sleep
number = int(sys.argv.pop())
def send():
    while True:
        frame = sys._current_frames()[main_thread().ident]
        if frame.f_code.co_name == "select" and frame.f_locals["timeout"] in (None, -1):
            signal.pthread_kill(get_ident(), number)
            return
        sleep(0.001)
Thread(target=send, daemon=True).start()
from tltlc.interfaces.cli.main import main
main()
"""
"""A program that sends a signal from another thread while the main thread waits for requests."""


@needs_signals
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_received_by_another_thread_ends_the_server(number: signal.Signals) -> None:
    with serve(str(number.value), program=("-c", ELSEWHERE)) as (running, _):
        assert running.wait(HANG_S) == 128 + number


BROWSER = """
import json, os, re, sys, urllib.request
path = urllib.request.url2pathname(sys.argv[1].removeprefix("file:"))
address = re.search('href="([^"]+)"', open(path).read())[1]
page = urllib.request.urlopen(address.partition("#")[0]).read()
mode = os.stat(path).st_mode & 0o777
seen = {"arguments": sys.argv, "path": path, "mode": mode, "address": address, "size": len(page)}
sys.stderr.write(json.dumps(seen) + "\\n")
"""


@needs_signals
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_browser_gets_the_address_in_a_private_file(tmp_path: Path, number: int) -> None:
    """Every user can see the arguments of a process. This browser runs in the foreground, and gets
    an answer."""
    (tmp_path / "browser.py").write_text(BROWSER)
    with serve("--open", BROWSER=f"{sys.executable} {tmp_path / 'browser.py'} %s") as (running, port):
        assert running.stderr is not None
        seen = json.loads(running.stderr.readline())
        base, _, token = seen["address"].partition("#token=")
        assert (base, seen["mode"]) == (f"http://127.0.0.1:{port}/", 0o600)
        assert seen["size"] > 100
        assert len(token) == 32
        assert not any(token in argument for argument in seen["arguments"])
        running.send_signal(number)
        running.wait(HANG_S)
        assert not Path(seen["path"]).parent.exists()


def test_the_file_contains_the_exact_address() -> None:
    address = "http://127.0.0.1:1/#token=a&b"
    with redirect_file(address) as uri:
        text = Path(url2pathname(uri.removeprefix("file:"))).read_text(encoding="utf-8")
    assert unescape(text).count(address) == 2


@needs_signals
def test_without_a_temporary_file_the_page_is_served(tmp_path: Path) -> None:
    code = "import tempfile; tempfile.tempdir = 'none/there'\nfrom tltlc.interfaces.cli.main import main; main()"
    with serve("--open", program=("-c", code)) as (running, _):
        assert running.stderr is not None
        assert running.stderr.readline() == "cannot write a temporary file: open the address yourself\n"


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the system itself opens pages")
def test_without_a_browser_the_page_is_served(tmp_path: Path) -> None:
    with serve("--open", BROWSER="", PATH=str(tmp_path), DISPLAY="") as (running, _):
        assert running.stderr is not None
        assert running.stderr.readline() == "no browser was found: open the address yourself\n"


def pyodide(folder: Path) -> Path:
    """Make a folder with the file names of Pyodide."""
    folder.mkdir()
    for name in PYODIDE:
        (folder / name).write_text(name)
    return folder


def test_the_site_has_all_files_of_the_page(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]  # noqa: F811
    outcome = tltlc("serve", "--static", "site", "--pyodide", pyodide(inside / "given"))
    assert (outcome.status, outcome.out) == (0, "")
    assert re.fullmatch(r"wrote \d+ files, \d+ MB, into site; any web server can show them\n", outcome.err)
    site = inside / "site"
    page = (site / "index.html").read_text()
    assert 'data-compiler="browser"' in page
    assert all((site / name).is_file() for name in re.findall(r'(?:src|href)="([^"]+)"', page))
    assert (site / "pyodide" / "pyodide.mjs").read_text() == "pyodide.mjs"
    before = (site / "tltlc.zip").read_bytes()
    assert tltlc("serve", "--static", "site", "--pyodide", "given").status == 0
    assert (site / "tltlc.zip").read_bytes() == before


PROGRAM = """
import json, sys
sys.path.insert(0, "unpacked")
from tltlc.interfaces.playground.protocol import answer

for example in json.loads(answer("{}"))["examples"]:
    analysis = json.loads(answer(json.dumps({"text": example["text"]})))
    assert analysis["spec"] and not analysis["diagnostics"], analysis

# In a browser sympy is no file that is missing: what it alone can prove stays unproved.
sys.platform = "emscripten"
text = "signal a: ratio  signal b: ratio  predicate p in [0, 1] = a*a + b*b - 2*a*b  spec x { limit 9 steps reach p }"
analysis = json.loads(answer(json.dumps({"text": text})))
assert analysis["specs"] == ["x"]
print(sys.modules["tltlc"].__file__, [diagnostic["code"] for diagnostic in analysis["diagnostics"]])
"""


def test_the_compiler_of_the_site_needs_only_python(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]  # noqa: F811
    tltlc("serve", "--static", "site", "--pyodide", pyodide(inside / "given"))
    with ZipFile("site/tltlc.zip") as archive:
        archive.extractall("unpacked")
    # Run without installed packages and without the cache.
    completed = subprocess.run(
        [sys.executable, "-I", "-S", "-c", PROGRAM],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "TLTLC_CACHE_DIR": ""},
    )
    assert (completed.returncode, completed.stderr) == (0, "")
    assert completed.stdout == f"{inside / 'unpacked' / 'tltlc' / '__init__.py'} ['TLT0401']\n"


def test_without_pyodide_no_site_is_written(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]  # noqa: F811
    outcome = tltlc("serve", "--static", "site")
    assert (outcome.status, outcome.err) == (
        4,
        "error[TLT0730]: the site needs Pyodide, but `node_modules/pyodide` does not contain `pyodide.mjs`\n"
        "  help: run `npm install pyodide`, and name its folder: `--pyodide node_modules/pyodide`\n",
    )
    assert not (inside / "site").exists()
    assert tltlc("serve", "--static", "site", "--open").status == 2
