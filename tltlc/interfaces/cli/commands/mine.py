"""``tltlc mine``: specs proposed from recorded traces."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Final

import click

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.numbers import FiniteRange, WholeRange
from tltlc.interfaces.cli.paths import OutputPath, is_stdout
from tltlc.interfaces.cli.report import Report
from tltlc.interfaces.cli.settings import Settings, check_libraries, compile_settings, source_options
from tltlc.io.limits import MINED_TRACE
from tltlc.io.spec_file import STDIN, STDIN_NAME, read_data

if TYPE_CHECKING:
    from tltlc.pipeline import CompileOptions
    from tltlc.tools.mine.confirm import Proposal
    from tltlc.tools.mine.evidence import Evidence
    from tltlc.tools.mine.reading import TraceFile
    from tltlc.tools.mine.search import Search
    from tltlc.tools.mine.vocabulary import Words

ENDINGS: Final = (".csv", ".jsonl")
"""Of the traces in a folder."""
_MOST_BYTES: Final = MINED_TRACE.size
_TELL_EVERY_S: Final = 1.0


@click.command(
    epilog="""\b
Examples:
  tltlc mine good/ --against bad/                         columns are atoms, true or false
  tltlc mine good/ --against bad/ --predicates game.tltl  atoms are computed from signals
  tltlc mine good/ --against bad/ --predicates stealth    the same by the library of that name
  tltlc mine run_*.csv --predicates game.tltl -o mined.tltl --top 3
  tltlc mine good/ --against bad/ --min-support 0.9 --time 10 --json
"""
)
@click.argument("traces", metavar="TRACES...", nargs=-1, required=True)
@click.option(
    "--against",
    "counterexamples",
    metavar="TRACES",
    multiple=True,
    help="Failed or wrong play: a trace or a folder that must not satisfy what is proposed (repeatable).",
)
@click.option(
    "--predicates",
    metavar="LIB",
    help="What atoms there are: predicates of signals, of a file or of a library such as `stealth`, for all entities "
    "of the traces (default: the columns).",
)
@click.option(
    "--top", metavar="N", type=WholeRange(1, 100), default=5, help="Propose at most this many specs (default: 5)."
)
@click.option(
    "--min-support",
    metavar="SHARE",
    type=FiniteRange(0.0, 1.0, min_open=True),
    default=1.0,
    help="The least share of the traces to satisfy a proposal (default: 1; less where some may be wrong).",
)
@click.option(
    "--max-length",
    metavar="ATOMS",
    type=WholeRange(min=1),
    default=12,
    help="How often a proposal may name an atom (default: 12).",
)
@click.option(
    "--time",
    "seconds",
    metavar="S",
    type=FiniteRange(min=0.0),
    help="Search for so many seconds at most, and propose the best so far; so does Ctrl-C.",
)
@click.option(
    "--output",
    "-o",
    metavar="FILE.tltl",
    type=OutputPath("file", stdout=True),
    help="Write the proposals as a source file; `-` prints it in place of the list.",
)
@click.option("--json", "as_json", is_flag=True, help="One JSON document, for programs.")
@source_options
def command(
    traces: tuple[str, ...],
    counterexamples: tuple[str, ...],
    predicates: str | None,
    top: int,
    min_support: float,
    max_length: int,
    seconds: float | None,
    output: Path | None,
    as_json: bool,
    settings: Settings,
    format: str,  # noqa: A002
) -> int:
    """Propose specs that recorded TRACES satisfy and counterexamples violate: what a level asks for, from play.

    TRACES are files as `tltlc monitor` takes them, CSV or JSON lines, or folders of them (*.csv, *.jsonl).  Proposals
    are ranked by the share of the traces that satisfy them and of the counterexamples that violate them; each was
    compiled, and its automaton has judged every trace.  The exit status is 1 where there is nothing to propose.
    """
    import json

    from tltlc.io.writing import check_not_read
    from tltlc.resolve.options import ResolveOptions
    from tltlc.tools.mine.confirm import confirmed
    from tltlc.tools.mine.evidence_reader import gathered
    from tltlc.tools.mine.proposal_text import shown
    from tltlc.tools.mine.proposals_json import document
    from tltlc.tools.mine.search import Options, Search

    if (*traces, *counterexamples).count(STDIN) > 1:
        raise click.UsageError("standard input can be one trace", click.get_current_context())
    if as_json and is_stdout(output):
        raise click.UsageError("--json and `-o -` both print: name a file with -o", click.get_current_context())
    interrupted = False
    with Report(format, results=True) as report:
        options = _compile_options(predicates, settings)
        library = None if predicates is None else _library(predicates)
        imported = _import(library, predicates, output) if library and predicates and output else None
        resolve = ResolveOptions(options.library_dirs, options.params)
        words, evidence, found = gathered(
            _files(traces), _files(counterexamples), library, resolve, _every_second(report)
        )
        if output is not None and not is_stdout(output):
            check_not_read(output)
        for line in _left_out(words, predicates):
            report.say(line)
        report.add(found)
        search = Search(evidence, Options(min_support, max_length))
        whole, interrupted = _searched(search, seconds, report)
        left_out = (*_unread(words), *search.left_out())
        report.add(tuple(_beyond_the_limits(each, predicates) for each in left_out))
        proposals = confirmed(search.ranked(), evidence, words, options, top)
        if not proposals:
            report.add((_nothing(evidence, whole=whole),))
        elif output is not None:
            _write(output, proposals, evidence, search, words, imported, report)
        if as_json:
            print(
                json.dumps(
                    document(proposals, evidence, search, whole=whole and not left_out), indent=2, ensure_ascii=False
                )
            )
        elif proposals and not is_stdout(output):
            print(shown(proposals, evidence, search.bits))
    return exits.interrupted() if interrupted else report.status


def _left_out(words: Words, predicates: str | None) -> Iterator[str]:
    """What is said of columns that are no atoms."""
    misnamed = [name for name in words.left_out if name in words.misnamed]
    others = [name for name in words.left_out if name not in words.misnamed]
    if others:
        way_out = "" if predicates else " (`--predicates LIB` computes atoms from numbers)"
        yield f"columns left out, being no atoms: {', '.join(others)}{way_out}"
    if misnamed:
        names = ", ".join(misnamed)
        yield f"columns left out, as no atom can be called so: {names} (atoms are called `seen` or `at(key)`)"


# --- input ----------------------------------------------------------------------------------------


def _files(arguments: Sequence[str]) -> list[TraceFile]:
    """The traces of the command line, those of a folder in order of their names."""
    from tltlc.io.files import is_dir, read_bytes
    from tltlc.tools.mine.reading import TraceFile

    found = []
    for argument in arguments:
        if argument == STDIN:
            found.append(TraceFile(STDIN_NAME, read_data(STDIN, _MOST_BYTES)[0]))
        else:
            paths = _of_folder(argument) if is_dir(argument) else [argument]
            found += [TraceFile(path, read_bytes(path, path, _MOST_BYTES)) for path in paths]
    for file in found:
        if len(file.data) > _MOST_BYTES:
            title = f"`{file.name}` is larger than {_MOST_BYTES >> 20} MiB"
            raise TltlError([Diagnostic("TLT0004", title, help="record fewer steps, or fewer signals")])
    return found


def _of_folder(folder: str) -> list[str]:
    """The traces in a folder and those in it; error TLT0001 where there is none."""
    from tltlc.interfaces.cli.folders import below

    seen = below(Path(folder), ENDINGS)
    if not seen:
        title = f"the folder `{folder}` holds no trace"
        raise TltlError([Diagnostic("TLT0001", title, help=f"traces in it end in {' or '.join(ENDINGS)}")])
    return [str(Path(folder, path)) for path in seen]


def _library(predicates: str) -> SourceFile:
    """The file, or where it is the name of a library, a text that imports that."""
    from tltlc.interfaces.cli.inputs import check_text
    from tltlc.io.files import is_file, read_source

    if _is_name(predicates) and not is_file(predicates):
        return SourceFile(f"<{predicates}>", f"import {predicates}\n")
    library = read_source(predicates)
    check_text(library)
    return library


def _is_name(predicates: str) -> bool:
    return re.fullmatch(r"[A-Za-z]\w*", predicates, re.ASCII) is not None


def _compile_options(predicates: str | None, settings: Settings) -> CompileOptions:
    """How specs about the atoms of a library are compiled."""
    from tltlc.io.project import Project, project_for

    check_libraries(settings.libraries)
    return compile_settings(settings, project_for(predicates) if predicates else Project())


# --- the search -----------------------------------------------------------------------------------


def _searched(search: Search, seconds: float | None, report: Report) -> tuple[bool, bool]:
    """Search until the end, until time is up, or until Ctrl-C: whether it came to its end, and whether by Ctrl-C."""
    begun = monotonic()
    tell = _every_second(report)
    try:
        for stage in search.run():
            now = monotonic()
            if seconds is not None and now - begun >= seconds:
                report.say(f"time is up; candidates so far: {search.tried}")
                return False, False
            tell(f"{stage}; candidates so far: {search.tried}, in {now - begun:.0f} s")
    except KeyboardInterrupt:
        report.say(f"interrupted; candidates so far: {search.tried}")
        return False, True
    return True, False


def _every_second(report: Report) -> Callable[[str], None]:
    """Says what is being done, once a second."""
    told = monotonic()

    def tell(text: str) -> None:
        nonlocal told
        if monotonic() - told >= _TELL_EVERY_S:
            told = monotonic()
            report.say(text)

    return tell


def _unread(words: Words) -> Iterator[str]:
    """What is said where there are more atoms than are read."""
    from tltlc.io.limits import WORK

    if words.unread:
        most, instances = WORK["mined columns"], WORK["mined instances"]
        of_each = f", {instances:,} of one predicate" if words.entities else ""
        yield f"only the first {most:,} atoms are read{of_each}, and {words.unread:,} others are not"


def _beyond_the_limits(title: str, predicates: str | None) -> Diagnostic:
    way_out = "name fewer predicates in the library" if predicates else "record only the columns that matter"
    return Diagnostic("TLT0624", title, help=way_out, severity="warning")


def _nothing(evidence: Evidence, *, whole: bool) -> Diagnostic:
    if not whole:
        return Diagnostic("TLT0761", "no spec was found so far", help="give it more time, with --time")
    title = "there is no spec to propose: what the traces have in common, the counterexamples have, too"
    if evidence.made_up:
        title = "there is no spec to propose: the traces have nothing in common"
    way_out = "lower --min-support, or record signals of what makes the difference"
    return Diagnostic("TLT0761", title, help=way_out)


# --- output ---------------------------------------------------------------------------------------


def _write(
    path: Path,
    proposals: Sequence[Proposal],
    evidence: Evidence,
    search: Search,
    words: Words,
    imported: str | None,
    report: Report,
) -> None:
    """Write the proposals as a source file, or print it; ``imported`` is the line that imports their library."""
    from tltlc.io.writing import write_file
    from tltlc.tools.fmt import format_text
    from tltlc.tools.mine.source_text import declarations, source_text

    preamble = declarations(proposals, words, imported)
    text = format_text(source_text(proposals, evidence, search.bits, preamble))
    if is_stdout(path):
        click.echo(text, nl=False)
    else:
        write_file(path, text)
        report.say(f"wrote {path}")


def _import(library: SourceFile, predicates: str, path: Path) -> str:
    """The line that imports a library, or the file of that path, into a file that is to be at ``path``.

    Raises click.UsageError where there can be no such line.
    """
    import os

    from tltlc.grammar.quotes import quoted

    if library.name != predicates:
        return f"import {predicates}\n"
    try:
        relative = os.path.relpath(predicates, path.parent)
    except ValueError:
        # Another drive of Windows.
        relative = str(Path(predicates).absolute())
    target = quoted(Path(relative).as_posix())
    if target is None:
        raise click.UsageError(f"no file can import `{relative}`, for a quote or a line break in its path: rename it")
    return f"import {target}\n"
