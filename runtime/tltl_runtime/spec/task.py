"""A task: the automaton of a spec, the values of its params, and the options of its reward."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tltlc.api import (
    EMPTY,
    Diagnostic,
    Fspa,
    Monitor,
    RewardOptions,
    SourceFile,
    Spec,
    TltlError,
    compiler,
    fileio,
    monitors,
    record,
)

_FILE: Final = re.compile(r"(?s:.+)\.(tltl|json)(:[A-Za-z_][A-Za-z0-9_]*)?\Z")


@record
class Task:
    """All that is needed to judge an episode: the automaton of a spec, values of params, reward options.

    ``params`` are in SI units and override the defaults of the automaton. A task is plain data and
    can be pickled; a :class:`Monitor` cannot.
    """

    fspa: Fspa
    params: Mapping[str, float]
    reward: RewardOptions = RewardOptions()

    def monitor(self) -> Monitor:
        """Return a new monitor for one episode, which judges by this task."""
        return Monitor(self.fspa, self.params, self.reward)


def load_task(
    spec: str | Path | Fspa,
    params: Mapping[str, float] = EMPTY,
    reward: RewardOptions | None = None,
    *,
    offered: Mapping[str, float] = EMPTY,
) -> Task:
    """Return the task that a spec describes.

    ``spec`` is one of these:

    - an automaton;
    - a path ``FILE.tltl`` or ``FILE.fspa.json``, followed by ``:NAME`` if the file has several
      specs. The file's project (``tltl.toml``) provides its libraries;
    - the text of a spec or of an artefact (a compiled automaton as JSON). A string is such a text if
      it has several lines or begins with a brace, or if it has blanks and does not end like a path.

    ``params`` are values of the spec's params, in SI units. ``offered`` are values that a level
    provides. Such a value is used if the spec has a param of this name and ``params`` does not set
    it.

    Raises:
        TltlError: errors of reading and compiling; TLT0720, no spec has that name; TLT0721, there
            is not exactly one spec; TLT0307 and TLT0308, a param has an invalid value or does not
            exist.
        TypeError: ``spec``, ``params`` or ``reward`` is of another type.
    """
    if not isinstance(params, Mapping):
        raise TypeError(f"params must map names to numbers, e.g. {{'top_speed': 0.06}}, not {params!r:.60}")
    fspa, _ = read_spec(spec)
    param_names = {param.name for param in fspa.params}
    values = {name: value for name, value in offered.items() if name in param_names}
    task = Task(fspa, {**values, **params}, monitors.reward_options_argument(reward))
    task.monitor()
    return task


def read_spec(spec: str | Path | Fspa) -> tuple[Fspa, Spec | None]:
    """Return the automaton that ``spec`` describes, and the spec that was compiled into it.

    The second is None if ``spec`` is an automaton or an artefact, which have no source text. ``spec``
    and the errors are those of :func:`load_task`.
    """
    if isinstance(spec, Fspa):
        return spec, None
    if not isinstance(spec, (str, os.PathLike)) or not str(spec).strip():
        advice = ": give one of them, e.g. the first, `[0]`" if isinstance(spec, (tuple, list)) else ""
        raise TypeError(f"a spec must be a path, a text or an automaton, not {spec!r:.60}{advice}")
    is_text = isinstance(spec, str) and _is_text(spec)
    if isinstance(spec, str) and is_text:
        source, path, name = SourceFile("<text>", spec, "text"), "<text>", None
        is_artefact = _is_artefact(spec)
    else:
        path, name = fileio.split_spec_name(os.fspath(spec))
        source, is_artefact = fileio.read_spec_file(path)
    if is_artefact:
        fspa = compiler.read_artefact(source)
        if name not in (None, fspa.name):
            raise TltlError([compiler.unknown_spec(str(name), [fspa.name], path)])
        return fspa, None
    libraries = () if is_text else fileio.project_for(path).libraries
    compiled = compiler.compile_source(
        source, compiler.CompileOptions(library_dirs=libraries, specs=(name,) if name else ())
    )
    fspa = _only_automaton(compiled.automata, path, is_text=is_text)
    return fspa, next(candidate for candidate in compiled.program.specs if candidate.name == fspa.name)


def _is_text(spec: str) -> bool:
    """Whether ``spec`` is the text of a spec or of an artefact, not a path."""
    if "\n" in spec or _is_artefact(spec):
        return True
    return " " in spec and not _FILE.match(spec)


def _is_artefact(text: str) -> bool:
    """Whether ``text`` is an artefact (JSON), not a spec: no spec begins with a brace."""
    return text.lstrip().startswith("{")


def _only_automaton(automata: tuple[Fspa, ...], file: str, *, is_text: bool) -> Fspa:
    if len(automata) == 1:
        return automata[0]
    names = [fspa.name for fspa in automata]
    if not names:
        title, advice = f"`{file}` contains no spec", "declare one: `spec NAME { … }`"
    else:
        listed = ", ".join(f"`{name}`" for name in names[:10]) + (", …" if len(names) > 10 else "")
        title = f"`{file}` contains {len(names)} specs, and only one can be used: {listed}"
        advice = "give a text with one spec" if is_text else f"name one of them, e.g. `{file}:{names[0]}`"
    raise TltlError([Diagnostic("TLT0721", title, help=advice)])
