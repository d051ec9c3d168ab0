"""Check the policies, specs and levels that a case names, and suggest corrections."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable
from contextlib import suppress
from difflib import get_close_matches
from pathlib import Path, PurePosixPath
from typing import Final

from tltl_runtime.game.level import Level
from tltl_runtime.game.level_name import Variant, is_scene
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.file import SUFFIX, read_policy
from tltl_runtime.policies.shipped import shipped_policies
from tltl_runtime.spec.task import read_spec
from tltl_runtime.support.number_text import short_list
from tltl_runtime.support.suggestion import similar_name, suggestion
from tltlc.api import Diagnostic, Label, TltlError, fileio, replace

_NO_SUCH_SPEC: Final = {"TLT0720", "TLT0721"}

_MOST_NAMED: Final = 8
"""The most trainings that a message names."""


def policy_file(path: Path) -> Path:
    """Return the file of a policy that a case names by ``path``.

    If ``path`` is a folder, it should be that of a training: return the path of the policy in it. The
    file need not exist.
    """
    if not fileio.is_dir(path):
        return path
    from tltl_runtime.training.files.run_file import POLICY

    return path / POLICY


def policy_diagnostics(path: Path, label: Label) -> list[Diagnostic]:
    """Return the diagnostics, at ``label``, for a policy that cannot be read; none if it can.

    The code is TLT0872 if ``path`` is a folder without a policy. Otherwise the diagnostics are
    those of ``read_policy``.
    """
    file = policy_file(path)
    if file != path and not fileio.exists(file):
        return _with_label(label, [_no_policy(path)])
    try:
        read_policy(file)
    except TltlError as error:
        return _with_label(label, error.diagnostics)
    return []


def spec_diagnostics(spec: str, label: Label) -> list[Diagnostic]:
    """Return the diagnostics, at ``label``, for a spec that is not found; none if it is found.

    TLT0720 if the file has no spec of that name; TLT0721 if no spec is named and the file does not
    have exactly one. Other errors in the file are reported when the case is played, because a
    change of the file may have caused them.
    """
    try:
        read_spec(spec)
    except TltlError as error:
        return _with_label(label, [diagnostic for diagnostic in error.diagnostics if diagnostic.code in _NO_SUCH_SPEC])
    return []


def similar_level(name: str, folder: Path) -> str | None:
    """Return a hint such as ``did you mean `vault.toml`?``; None if no level has a similar name.

    ``name`` is a level that a suite in ``folder`` names and that does not exist. Candidates are the
    level files in the folder of the path ``name``, and the levels of the package.
    """
    names: list[str] = []
    # The name may not be a valid path on this system.
    with suppress(OSError, ValueError):
        files = sorted(filter(_is_level, (folder / name).parent.glob("*.toml")))
        names = [(Path(name).parent / path.name).as_posix() for path in files]
    matches = get_close_matches(name, (*names, *game_of(name).level_files.names()), n=1)
    return f"did you mean `{matches[0]}`?" if matches else None


def similar_policy(name: str, folder: Path, otherwise: str | None = None) -> str:
    """Return a hint for a policy that a suite in ``folder`` names and that does not exist.

    The hint has a similar name, or else it is ``otherwise``; without ``otherwise``, it has all names.
    Candidates are the policies of the package, and those up to two folders below ``folder`` or beside
    ``name``; that of a training has the name of its folder.
    """
    files: list[str] = []
    # The name may not be a valid path on this system.
    with suppress(OSError, ValueError):
        for depth in ("*", "*/*", "*/*/*"):
            files += sorted(path.relative_to(folder).as_posix() for path in folder.glob(f"{depth}{SUFFIX}"))
        beside = Path(name).parent
        files += sorted((beside / path.name).as_posix() for path in (folder / beside).glob(f"*{SUFFIX}"))
    from tltl_runtime.training.files.run_file import POLICY

    trainings = [path.rpartition("/")[0] for path in files if path.endswith(f"/{POLICY}")]
    names = dict.fromkeys((*trainings, *files))
    known = [known for known in names if name.endswith(SUFFIX) or not known.endswith(f"/{POLICY}")]
    known += shipped_policies()
    if otherwise is not None and similar_name(name, known) is None:
        return otherwise
    return suggestion(name, known, short_list([f"`{path}`" for path in known], _MOST_NAMED))


def training_help(name: str, folder: Path, scene: str, spec: str | None) -> str:
    """Return the command that trains the policy ``name`` for a scene, which a suite in ``folder`` names.

    A training writes a folder. If ``name`` is that of a file, the help also says what the suite must name then.
    ``spec`` is the one that the case names, None if it is that of the scene.
    """
    from tltl_runtime.training.files.run_file import POLICY

    path = PurePosixPath(name)
    if path.name == POLICY and path.parent.name:
        training, then = path.parent.as_posix(), ""
    elif path.suffix == SUFFIX:
        training = path.with_suffix("").as_posix()
        then = f", and write `policy = {json.dumps(training, ensure_ascii=False)}`"
    else:
        training, then = name, ""
    words = ["tltlc", "train", *([spec] if spec else []), "--game", scene, "--out", str(folder / training)]
    return f"train it: `{shlex.join(words)}`{then}; paths are relative to the suite"


def separate_keys_help(level: str, variant: Variant) -> str:
    """Return a help text that says how to write ``LEVEL:VARIANT+OVERLAY`` in a suite."""
    lines = [
        f'`level = "{level}"`',
        f'`variant = "{variant.name}"`',
        *([f"`overlay = {json.dumps(variant.overlays)}`"] if variant.overlays else []),
    ]
    return f"write {', '.join(lines)}"


def _is_level(path: Path) -> bool:
    """Whether a file looks like a level. Pipes and devices are not read."""
    if not fileio.may_be_file(path):
        return False
    try:
        return b"[bounds]" in fileio.read_bytes(path, str(path), fileio.limits.TOML.size)
    except TltlError:
        return False


def level_with_fitting_policy(level: str) -> str | None:
    """Return a level of the package whose policy may fit ``level``; None if there is no such level.

    The policy may fit if the specs of the two levels have the same name and the same file name. Then
    ``level`` may be an edited copy. It fits no scene of a game file.
    """
    if is_scene(level):
        return None
    game = game_of(level)
    with suppress(TltlError):
        levels_by_spec = {_spec_names(game.load_level(name)): name for name in shipped_policies()}
        first_variant = game.level_files.variants(level)[0]
        return levels_by_spec.get(_spec_names(game.load_level(level, first_variant)))
    return None


def _spec_names(level: Level) -> tuple[str, str] | None:
    """Return the file name and the name of a level's spec; None if the level has no spec."""
    return (level.spec.file.name, level.spec.name) if level.spec else None


def _with_label(label: Label, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    return [replace(diagnostic, labels=(label, *diagnostic.labels)) for diagnostic in diagnostics]


def _no_policy(folder: Path) -> Diagnostic:
    from tltl_runtime.training.files.run_file import RUN, resume_command

    if fileio.exists(folder / RUN):
        help_ = f"`{resume_command(folder)}` continues it until it has one; if it is running, it will have one soon"
        return Diagnostic("TLT0872", f"the training in `{folder}` has no policy yet", help=help_)
    if trainings := sorted(path.parent.name for path in folder.glob(f"*/{RUN}")):
        # The suite names the folder relative to itself, and this message relative to the working directory.
        names = short_list([f"`{name}`" for name in trainings], _MOST_NAMED)
        title = f"`{folder}` contains trainings, but is not a training itself"
        return Diagnostic("TLT0872", title, help=f"add the name of one of them to the path: {names}")
    help_ = "name a .safetensors file, or the folder that `tltlc train` named when it ended"
    return Diagnostic("TLT0872", f"there is neither a training nor a policy in `{folder}`", help=help_)
