"""The files that a case depends on, and the selection of the cases that a change affects.

If a file has errors, its readable parts are still searched for further dependencies. When in doubt,
a file counts as a dependency: a case that is selected without need costs minutes, but a case that is
left out by mistake hides a finding.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from os.path import normpath
from pathlib import Path
from typing import Final

from tltl_runtime.game.registry import game_of
from tltl_runtime.regression.suite.named_files import policy_file
from tltl_runtime.regression.suite.suite import Suite, SuiteCase
from tltl_runtime.regression.suite.trace_case import TraceCase
from tltl_runtime.spec.spec_files import spec_files
from tltlc.api import fileio, record, traces

_ESCAPE: Final = re.compile(rb"\\([0-7]{3}|.)", re.DOTALL)
_LETTERS: Final = {bytes([key]): bytes([code]) for key, code in zip(b"abtnvfr", range(7, 14), strict=True)}


@record
class Selection:
    """The result of selecting cases by the names of changed files.

    ``cases`` are the cases that depend on a changed file, and ``left_out`` all other cases of the
    suite. ``unknown`` are the names that match no dependency of any case. ``suggestions`` are pairs of
    an unknown name and a similar name that matches a dependency.
    """

    cases: tuple[SuiteCase, ...]
    left_out: tuple[SuiteCase, ...] = ()
    unknown: tuple[str, ...] = ()
    suggestions: tuple[tuple[str, str], ...] = ()


def select(suite: Suite, changed: Sequence[str]) -> Selection:
    r"""Select the cases that depend on a file that ``changed`` names, or on a file in a named folder.

    A name is the path of a file, the last parts of the path (``assets/guard.toml``,
    ``guard.toml``), one of these without the extension (``guard``), or the path of a folder. Names
    that git has quoted are accepted, too (``"assets/w\303\244chter.toml"``).
    """
    dependencies_of = {case.name: dependencies(suite, case) for case in suite.cases}
    affected = {
        case.name for case in suite.cases if any(_matches_any(name, dependencies_of[case.name]) for name in changed)
    }
    known = {path for paths in dependencies_of.values() for path in paths}
    unknown = tuple(name for name in dict.fromkeys(changed) if not _matches_any(name, known))
    # Do not suggest files that `changed` names already: the unknown name may be the old name of a renamed file.
    candidates = {
        path for path in known if fileio.is_file(path) and not any(_matches_any(name, [path]) for name in changed)
    }
    suggestions = ((name, _similar_name(name, candidates)) for name in unknown)
    return Selection(
        tuple(case for case in suite.cases if case.name in affected),
        tuple(case for case in suite.cases if case.name not in affected),
        unknown,
        tuple((name, suggestion) for name, suggestion in suggestions if suggestion),
    )


def dependencies(suite: Suite, case: SuiteCase) -> tuple[Path, ...]:
    """Return the absolute paths of the files that a case depends on.

    For a path with symbolic links, the result also has the path with the links resolved. A path
    without a file is included, too, if a file created there would be read in place of an existing
    file.
    """
    if isinstance(case, TraceCase):
        named = (*case.traces, *case.baseline)
        # A trace that was removed is below a named folder, too.
        files = [suite.path, *map(Path, (*named, *traces.find_traces(named).traces))]
    else:
        files = [suite.path, suite.baseline, policy_file(case.policy)]
        files += game_of(case.level).level_files.dependencies(case.level, case.variant)
        files += [] if case.game_file is None else [case.game_file]
    if case.spec is not None:
        files += spec_files(Path(fileio.split_spec_name(case.spec)[0]))
    return tuple(
        dict.fromkeys(spelling for path in files for spelling in (Path(normpath(path.absolute())), path.resolve()))
    )


def files_of(suite: Suite) -> frozenset[Path]:
    """Return the files that the cases of a suite depend on, including the baseline."""
    return frozenset(path for case in suite.cases for path in dependencies(suite, case))


def _matches_any(name: str, paths: Iterable[Path]) -> bool:
    """Whether a name matches one of the paths, as :func:`select` describes, or lies in one of them."""
    named_path = Path(_unquote(name))
    resolved, parts = named_path.resolve(), named_path.parts
    return any(
        resolved == path
        or resolved in path.parents
        or path in resolved.parents
        or path.parts[-len(parts) :] == parts
        or any((*path.parts[-len(parts) : -1], stem) == parts for stem in (path.stem, path.name.partition(".")[0]))
        for path in paths
    )


def _similar_name(name: str, paths: Iterable[Path]) -> str | None:
    """Return a name that is similar to ``name`` and matches one of ``paths``; None if there is none.

    Also return None if ``name`` is the path of an existing file, or contains a folder: then it may be
    a deleted file that git lists.
    """
    named_path = Path(_unquote(name))
    if len(named_path.parts) > 1 or fileio.exists(named_path):
        return None
    stems = sorted({path.stem for path in paths if named_path.suffix in ("", path.suffix)})
    matches = get_close_matches(named_path.stem, stems, n=1, cutoff=0.7)
    return f"{matches[0]}{named_path.suffix}" if matches else None


def _unquote(name: str) -> str:
    """Undo git's quoting: double quotes, and non-ASCII bytes in octal.

    A name that is not quoted is returned unchanged.
    """
    if len(name) < 2 or not (name.startswith('"') and name.endswith('"')):
        return name
    parts = _ESCAPE.split(os.fsencode(name[1:-1]))
    # Every second part, from the second on, is what comes after a backslash.
    parts[1::2] = [
        bytes([int(escape, 8) % 256]) if escape.isdigit() else _LETTERS.get(escape, escape) for escape in parts[1::2]
    ]
    return os.fsdecode(b"".join(parts))
