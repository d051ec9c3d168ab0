"""``tltlc import``: turn the automaton of another tool into an artefact."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tltlc.interfaces.cli.numbers import WholeRange
from tltlc.interfaces.cli.outputs import files_of, output_option, target_option, targets_of, write_and_report
from tltlc.interfaces.cli.settings import CompileSettings, parse_assignments, source_options

if TYPE_CHECKING:
    from tltlc.resolve.spec import JudgeMode


def _name(_: click.Context, __: click.Parameter, name: str | None) -> str | None:
    from tltlc.io.spec_file import is_plain_name

    if name is not None and not is_plain_name(name):
        raise click.BadParameter(f"`{name}` is not a name: use ASCII letters, digits and `_`, and no digit first")
    return name


@click.command(
    epilog="""\b
Examples:
  tltlc import patrol.hoa --predicates game.tltl     three files in the current folder
  tltlc import patrol.hoa --predicates game.tltl --atom "p0=near(post_1)" -t json,svg -o build
  ltl2tgba -G -D -C "GFp0" | tltlc import - --predicates game.tltl --atom "p0=near(post_1)"
"""
)
@click.argument("file", metavar="FILE.hoa")
@click.option(
    "--predicates",
    metavar="LIB.tltl",
    required=True,
    help="The file whose predicates give the atomic propositions their meaning. Its specs are ignored.",
)
@click.option(
    "--atom",
    "atom_texts",
    metavar="AP=PREDICATE",
    multiple=True,
    help="The predicate for an atomic proposition with another name, e.g. `p0=near(exit)` (repeatable).",
)
@click.option("--name", metavar="NAME", callback=_name, help="The name of the spec (default: the name in the file).")
@click.option("--level", metavar="LEVEL", help="The name of the level that the spec is for.")
@click.option("--limit", metavar="STEPS", type=WholeRange(min=1), help="End each episode after this many steps.")
@click.option(
    "--judge",
    type=click.Choice(("goal", "limit")),
    help="What ends an episode: the goal or the limit (default: the limit if the first state accepts, else the goal).",
)
@output_option
@target_option
@source_options
def command(
    file: str,
    predicates: str,
    atom_texts: tuple[str, ...],
    name: str | None,
    level: str | None,
    limit: int | None,
    judge: JudgeMode | None,
    folder: Path,
    target_lists: tuple[str, ...],
    settings: CompileSettings,
    format: str,  # noqa: A002
) -> int:
    """Convert FILE.hoa, an automaton in the Hanoi format, to an artefact (- is standard input).

    The automaton must be deterministic and complete. It may have any acceptance on edges or states; Spot, Owl and
    Rabinizer write such files. Its atomic propositions are predicates of LIB.tltl, written as in a spec: "near(exit)".
    """
    from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
    from tltlc.diagnostics.diagnostic import stop_at_errors
    from tltlc.interfaces.cli.inputs import check_text
    from tltlc.interfaces.cli.report import Report
    from tltlc.interfaces.cli.settings import check_libraries
    from tltlc.io.files import MAX_ARTEFACT_BYTES, read_source
    from tltlc.io.project import project_for
    from tltlc.io.spec_file import read_text
    from tltlc.resolve.options import ResolveOptions
    from tltlc.tools.hoa.load import ImportOptions, load

    atoms = parse_assignments(atom_texts, "AP=PREDICATE", "--atom")
    with Report(format) as report:
        targets = targets_of(target_lists)
        check_libraries(settings.libraries)
        project = project_for(predicates)
        source = read_text(file, MAX_ARTEFACT_BYTES)
        library = read_source(predicates)
        check_text(library)
        resolve = ResolveOptions((*settings.libraries, *project.libraries), settings.params)
        budget = settings.state_budget or DEFAULT_STATE_BUDGET
        options = ImportOptions(atoms, name, level, limit, judge, resolve, budget)
        with project.apply_lint_levels():
            fspa, diagnostics = load(source, library, options)
        diagnostics = project.with_lint_levels(diagnostics)
        stop_at_errors(diagnostics)
        report.add(diagnostics)
        advice = "name another folder with -o, or another spec with --name"
        write_and_report(folder, files_of([fspa], targets, project, report), report, advice)
    return report.status
