"""``tltlc serve``: run the playground on this machine, or write it as a static site."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from pathlib import Path

import click

from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.numbers import WholeRange
from tltlc.interfaces.cli.paths import OutputPath


@click.command(
    epilog="""\b
Examples:
  tltlc serve --open               the playground in your browser
  tltlc serve --port 8080
  tltlc serve --static site        files for any web server, which need no tltlc there

\b
The page sends requests only to this machine. The server answers only the page at the address that it prints. A spec
may import files from the current folder and its subfolders, and the libraries of tltlc.
"""
)
@click.option(
    "--port", metavar="N", type=WholeRange(0, 65535), default=8765, help="The port of the server (default: 8765)."
)
@click.option("--open", "open_browser", is_flag=True, help="Open the page in a browser.")
@click.option(
    "--static",
    "folder",
    metavar="DIR",
    type=OutputPath("folder"),
    help="Write the page, with the compiler in it, to this folder, and start no server.",
)
@click.option(
    "--pyodide",
    metavar="DIR",
    type=click.Path(path_type=Path),
    default=Path("node_modules/pyodide"),
    help="The folder of the npm package Pyodide for --static (default: node_modules/pyodide).",
)
def command(port: int, open_browser: bool, folder: Path | None, pyodide: Path) -> int:
    """Serve a page for trying out specs: errors as you type, the automaton, traces that you build by clicking.

    The server runs until you press Ctrl-C. Only this machine can reach it.
    """
    from tltlc.interfaces.cli.report import Report

    with Report() as report:
        if folder is not None:
            if open_browser:
                raise click.UsageError(
                    "--static only writes files, and a browser can open them only from a server: leave out --open"
                )
            _write_site(folder, pyodide)
        else:
            _serve(port, open_browser)
    return report.status


def _write_site(folder: Path, pyodide: Path) -> None:
    from tltlc.interfaces.playground.site import site_files
    from tltlc.io.writing import write_files

    files = site_files(pyodide)
    write_files(folder, files, "name another folder with --static")
    size = sum(map(len, files.values())) / 1e6
    print(f"wrote {len(files)} files, {size:.0f} MB, into {folder}; any web server can show them", file=sys.stderr)


def _serve(port: int, open_browser: bool) -> None:
    from tltlc.interfaces.playground.server import PlaygroundServer

    with PlaygroundServer(port) as server, ExitStack() as stack:
        print(f"the playground is at {server.address} (press Ctrl-C to stop)", file=sys.stderr, flush=True)
        _report_ignored_project()
        if open_browser:
            _open_browser(server.address, stack)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            raise exits.StopQuietlyError(exits.interrupted_status()) from None


def _report_ignored_project() -> None:
    """If a project file (``tltl.toml``) is in a folder above the current one, say that the playground ignores it.

    The specs in the playground may read nothing outside the current folder.
    """
    from tltlc.io.project import project_file

    try:
        here = Path.cwd()
    except FileNotFoundError:
        return  # the current folder has been deleted
    file = project_file(here)
    if file is not None and file.parent != here:
        hint = f"to use it, start `tltlc serve` in {file.parent}"
        print(f"{file} is ignored, because it is above this folder; {hint}", file=sys.stderr, flush=True)


def _open_browser(address: str, stack: ExitStack) -> None:
    """Open an address in a browser, through a temporary file that redirects to the address.

    The file is removed when ``stack`` is closed.
    """
    from threading import Thread

    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.interfaces.playground.browser import redirect_file

    try:
        file = stack.enter_context(redirect_file(address))
    except (OSError, TltlError):
        print("cannot write a temporary file: open the address yourself", file=sys.stderr, flush=True)
        return
    # `webbrowser.open` may block until the browser is closed, and the browser needs our answer before that.
    Thread(target=_start_browser, args=(file,), daemon=True).start()


def _start_browser(file: str) -> None:
    import webbrowser

    if not webbrowser.open(file):
        print("no browser was found: open the address yourself", file=sys.stderr, flush=True)
