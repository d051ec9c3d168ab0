"""``tltlc mine``: propose specs from recorded traces."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Final

import click

from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.list_options import ListOption, ListOptionCommand
from tltlc.interfaces.cli.numbers import FiniteRange, WholeRange
from tltlc.interfaces.cli.paths import OutputPath, is_stdout
from tltlc.interfaces.cli.report import Report
from tltlc.interfaces.cli.settings import CompileSettings, check_libraries, compile_settings, source_options
from tltlc.io.limits import MINED_TRACE
from tltlc.io.spec_file import STDIN, STDIN_NAME, read_data

if TYPE_CHECKING:
    from tltlc.pipeline import CompileOptions
    from tltlc.tools.mine.confirm import Proposal
    from tltlc.tools.mine.evidence import Evidence
    from tltlc.tools.mine.search import SpecSearch
    from tltlc.tools.mine.trace_letters import TraceFile
    from tltlc.tools.mine.vocabulary import MiningVocabulary

_MOST_BYTES: Final = MINED_TRACE.size
_TELL_EVERY_S: Final = 1.0


@click.command(
    cls=ListOptionCommand,
    epilog="""\b
Examples:
  tltlc mine good/ --against bad/                         columns are atoms
  tltlc mine good/*.csv --against bad/*.csv --top 3       all names after --against are counterexamples
  tltlc mine good/ --against bad/ --predicates game.tltl  atoms are computed from signals
  tltlc mine good/ --against bad/ --predicates stealth    with the library `stealth`
  tltlc mine run_*.csv --predicates game.tltl -o mined.tltl --top 3
  tltlc mine good/ --against bad/ --min-support 0.9 --time 10 --json
""",
)
@click.argument("traces", metavar="TRACES...", nargs=-1, required=True)
@click.option(
    "--against",
    "counterexamples",
    metavar="TRACES...",
    multiple=True,
    cls=ListOption,
    help="Counterexamples: traces of failed or wrong play, which specs should reject. Takes all files and folders up "
    "to the next option or to `--`.",
)
@click.option(
    "--predicates",
    metavar="LIB",
    help="Compute the atoms with the predicates in this file or library (such as `stealth`), for all entities in the "
    "traces (default: each column is an atom).",
)
@click.option(
    "--top", metavar="N", type=WholeRange(1, 100), default=5, help="Propose at most this many specs (default: 5)."
)
@click.option(
    "--min-support",
    metavar="SHARE",
    type=FiniteRange(0.0, 1.0, min_open=True),
    default=1.0,
    help="The share of the traces that must satisfy a proposal (default: 1). Lower it if some traces may be wrong.",
)
@click.option(
    "--max-length",
    metavar="ATOMS",
    type=WholeRange(min=1),
    default=12,
    help="The largest number of atoms in a proposal, counting repetitions (default: 12).",
)
@click.option(
    "--time",
    "seconds",
    metavar="S",
    type=FiniteRange(min=0.0),
    help="Stop the search after this many seconds and print the best proposals so far. Ctrl-C does the same.",
)
@click.option(
    "--output",
    "-o",
    metavar="FILE.tltl",
    type=OutputPath("file", stdout=True),
    help="Write the proposals to a source file; `-` prints it instead of the list.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document.")
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
    settings: CompileSettings,
    format: str,  # noqa: A002
) -> int:
    """Propose specs that the recorded TRACES satisfy and the counterexamples violate.

    TRACES are files in the formats of `tltlc monitor` (CSV, JSON lines, Parquet or tapes), or folders with *.csv,
    *.jsonl, *.tape.jsonl.gz and *.parquet files. The proposals are ranked by the share of traces that satisfy them and
    of counterexamples that violate them. Each one has been compiled, and its automaton has judged all traces. The exit
    status is 1 if there is no proposal.
    """
    import json

    from tltlc.io.writing import check_not_read
    from tltlc.resolve.options import ResolveOptions
    from tltlc.tools.mine.column_diagnostics import first_names
    from tltlc.tools.mine.confirm import confirm
    from tltlc.tools.mine.evidence_reader import read_evidence
    from tltlc.tools.mine.proposal_text import proposals_text
    from tltlc.tools.mine.proposals_json import document
    from tltlc.tools.mine.search import MiningOptions, SpecSearch

    if (*traces, *counterexamples).count(STDIN) > 1:
        raise click.UsageError("standard input can be only one of the traces", click.get_current_context())
    if as_json and is_stdout(output):
        raise click.UsageError(
            "--json and `-o -` both write to standard output: name a file with -o", click.get_current_context()
        )
    interrupted = False
    with Report(format, results=True) as report:
        options = _compile_options(predicates, settings)
        library = None if predicates is None else _library(predicates)
        imported = _import_line(library, predicates, output) if library and predicates and output else None
        resolve = ResolveOptions(options.library_dirs, options.params)
        words, evidence, diagnostics = read_evidence(
            _read_traces(traces), _read_traces(counterexamples), library, resolve, _every_second(report)
        )
        if output is not None and not is_stdout(output):
            check_not_read(output)
        if len(counterexamples) > 1:
            report.say(f"counterexamples: {first_names(counterexamples)}")
        for line in _column_messages(words, predicates):
            report.say(line)
        report.add(diagnostics)
        search = SpecSearch(evidence, MiningOptions(min_support, max_length))
        whole, interrupted = _run_search(search, seconds, report)
        left_out = (*_unread_messages(words), *search.omissions())
        report.add(tuple(_limit_warning(title, predicates) for title in left_out))
        proposals = confirm(search.ranking(), evidence, words, options, top)
        if not proposals:
            report.add((_no_proposal(evidence, whole=whole, interrupted=interrupted),))
        elif output is not None:
            _write_proposals(output, proposals, evidence, search, words, imported, report)
        if as_json:
            print(
                json.dumps(
                    document(proposals, evidence, search, complete=whole and not left_out), indent=2, ensure_ascii=False
                )
            )
        elif proposals and not is_stdout(output):
            print(proposals_text(proposals, evidence, search.bits))
    return exits.interrupted_status() if interrupted else report.status


def _column_messages(words: MiningVocabulary, predicates: str | None) -> Iterator[str]:
    """Yield messages about the columns that the search takes as robustness values, and those that are not atoms."""
    if words.robust:
        yield f"columns of robustness values: {', '.join(words.robust)} (an atom holds where its value is above 0)"
    misnamed = [name for name in words.left_out if name in words.misnamed]
    not_atoms = [name for name in words.left_out if name not in words.misnamed]
    if not_atoms:
        hint = "" if predicates else " (`--predicates LIB` computes atoms from numbers)"
        yield f"columns left out because they are not atoms: {', '.join(not_atoms)}{hint}"
    if misnamed:
        names = ", ".join(misnamed)
        hint = "(atoms have names like `seen` or `at(key)`)"
        yield f"columns left out because no atom can have such a name: {names} {hint}"


# --- input ----------------------------------------------------------------------------------------


def _read_traces(arguments: Sequence[str]) -> list[TraceFile]:
    """Return the trace files that the arguments name; for a folder, the trace files in and below it.

    Files in Parquet are converted to text. Raises TltlError for a file that cannot be read or is too
    large, and for a folder without traces.
    """
    from tltlc.io.files import read_bytes
    from tltlc.monitor.parquet import as_text
    from tltlc.tools.judge.trace_files import find_traces
    from tltlc.tools.mine.trace_letters import TraceFile

    files = []
    for argument in arguments:
        if argument == STDIN:
            files.append(TraceFile(STDIN_NAME, read_data(STDIN, _MOST_BYTES)[0], "text"))
        else:
            trace_files = find_traces([argument])
            if trace_files.errors:
                raise TltlError(trace_files.errors)
            files += [TraceFile(path, read_bytes(path, path, _MOST_BYTES)) for path in trace_files.traces]
    for file in files:
        if len(file.data) > _MOST_BYTES:
            title = f"`{file.name}` is larger than {_MOST_BYTES >> 20} MiB"
            raise TltlError([Diagnostic("TLT0004", title, help="record fewer steps, or fewer signals")])
    return [replace(file, data=as_text(file.data, file.name)) for file in files]


def _library(predicates: str) -> SourceFile:
    """Return the source text of the file ``predicates``.

    If ``predicates`` is the name of a library and not a file, return a text that imports the
    library.
    """
    from tltlc.interfaces.cli.inputs import check_text
    from tltlc.io.files import is_file, read_source

    if _is_name(predicates) and not is_file(predicates):
        return SourceFile(f"<{predicates}>", f"import {predicates}\n", "text")
    library = read_source(predicates)
    check_text(library)
    return library


def _is_name(predicates: str) -> bool:
    return re.fullmatch(r"[A-Za-z]\w*", predicates, re.ASCII) is not None


def _compile_options(predicates: str | None, settings: CompileSettings) -> CompileOptions:
    """Return the options to compile the proposed specs: ``settings``, and the project of the file ``predicates``."""
    from tltlc.io.project import Project, project_for

    check_libraries(settings.libraries)
    return compile_settings(settings, project_for(predicates) if predicates else Project())


# --- the search -----------------------------------------------------------------------------------


def _run_search(search: SpecSearch, seconds: float | None, report: Report) -> tuple[bool, bool]:
    """Search for specs until the search is complete, ``seconds`` have passed, or the user presses Ctrl-C.

    Return whether the search completed, and whether Ctrl-C interrupted it.
    """
    start = monotonic()
    tell = _every_second(report)
    try:
        for stage in search.run():
            now = monotonic()
            if seconds is not None and now - start >= seconds:
                report.say(f"time is up; candidates so far: {search.tried_count}")
                return False, False
            tell(f"{stage}; candidates so far: {search.tried_count}, in {now - start:.0f} s")
    except KeyboardInterrupt:
        report.say(f"interrupted; candidates so far: {search.tried_count}")
        return False, True
    return True, False


def _every_second(report: Report) -> Callable[[str], None]:
    """Return a function that reports the text it is called with, but at most once a second."""
    last_report = monotonic()

    def tell(text: str) -> None:
        nonlocal last_report
        if monotonic() - last_report >= _TELL_EVERY_S:
            last_report = monotonic()
            report.say(text)

    return tell


def _unread_messages(words: MiningVocabulary) -> Iterator[str]:
    """Yield a message if there are too many atoms in the traces, so that some were not read."""
    from tltlc.io.limits import WORK

    if words.unread_count:
        most, instances = WORK["mined columns"], WORK["mined instances"]
        of_each = f", and at most {instances:,} of one predicate" if words.entities else ""
        others = "1 other is" if words.unread_count == 1 else f"{words.unread_count:,} others are"
        yield f"at most {most:,} atoms are read{of_each}; {others} left out"


def _limit_warning(title: str, predicates: str | None) -> Diagnostic:
    help_ = "name fewer predicates in the library" if predicates else "record only the columns that matter"
    return Diagnostic("TLT0624", title, help=help_, severity="warning")


def _no_proposal(evidence: Evidence, *, whole: bool, interrupted: bool) -> Diagnostic:
    if not whole:
        help_ = "let the search run longer" if interrupted else "allow more time with --time"
        return Diagnostic("TLT0761", "no spec was found so far", help=help_)
    title = "there is no spec to propose: the counterexamples have everything that the traces have in common"
    if evidence.made_up:
        title = "there is no spec to propose: the traces have nothing in common"
    help_ = "lower --min-support, or record signals that show the difference"
    return Diagnostic("TLT0761", title, help=help_)


# --- output ---------------------------------------------------------------------------------------


def _write_proposals(
    path: Path,
    proposals: Sequence[Proposal],
    evidence: Evidence,
    search: SpecSearch,
    words: MiningVocabulary,
    imported: str | None,
    report: Report,
) -> None:
    """Write the proposed specs as a source file, or print them if ``path`` is standard output.

    ``imported`` is the ``import`` line for the library with the predicates; None if no library is
    imported.
    """
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


def _import_line(library: SourceFile, predicates: str, path: Path) -> str:
    """Return the line with which a file at ``path`` imports a library: ``import stealth`` or ``import "../game.tltl"``.

    ``predicates`` is the name or path of the library on the command line. Raises click.UsageError if
    no line can import that path.
    """
    import os

    from tltlc.grammar.quotes import quote

    if library.name != predicates:
        return f"import {predicates}\n"
    try:
        relative = os.path.relpath(predicates, path.parent)
    except ValueError:
        # The library is on another Windows drive.
        relative = str(Path(predicates).absolute())
    target = quote(Path(relative).as_posix())
    if target is None:
        raise click.UsageError(
            f"no file can import `{relative}`, because its path contains a quote or a line break: rename it"
        )
    return f"import {target}\n"
