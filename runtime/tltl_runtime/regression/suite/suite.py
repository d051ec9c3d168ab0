"""Suites: TOML files that list the cases of a regression test (``docs/regression.md`` describes every key)."""

from __future__ import annotations

import json
from os.path import normpath
from pathlib import Path
from typing import Final

from tltl_runtime.policies.file import SUFFIX
from tltl_runtime.policies.shipped import shipped_policies, shipped_policy
from tltl_runtime.regression.suite.named_files import level_like, policy_faults, policy_for_its_spec, spec_faults
from tltl_runtime.stealth.levels.file import level_names, level_path, shared_names, variants
from tltl_runtime.stealth.levels.made_for import shown
from tltl_runtime.stealth.levels.place import level_place, overlays_of, with_overlays
from tltl_runtime.stealth.levels.table import REQUIRED, Table, suggestion, wrong
from tltl_runtime.stealth.levels.toml_tree import Entry, read_tree
from tltlc.core.record import record
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.files import exists, is_file, read_source
from tltlc.io.limits import SUITE
from tltlc.io.resources import bounded
from tltlc.io.spec_file import split

SHIPPED: Final = Path(__file__).with_name("shipped") / "suite.toml"
"""The suite that comes with the package: its three levels, each in its three variants."""

LEAST_EPISODES: Final = 25
"""No verdict comes of fewer episodes, which an explanation needs, too; those of the paper's Table I."""

MOST_EPISODES: Final = 300
"""Are played of a case at the most, where its suite says nothing else."""

_MOST_FAULTS: Final = 100
"""Of a suite with more faults, no more cases are read: what is wrong with each may take long to find out."""

_LIMIT: Final = 10_000
_MOST: Final = {"pass_rate": 0.999}
"""Of thresholds; no number of episodes makes certain that all meet the spec."""
_HELP: Final = 'values are written as in `episodes = 100`, texts as in `level = "navigation"`'


@record
class Thresholds:
    """What counts as played as designed.

    A case passes where its pass rate is certainly at least ``pass_rate``, and fails where it is certainly at most
    ``fail_rate``, both in [0, 1].  ``progress`` and ``reward`` are the least changes of the mean that count.
    """

    pass_rate: float = 0.85
    fail_rate: float = 0.5
    progress: float = 0.05
    reward: float = 0.05


@record
class Case:
    """What is played and judged: a policy, on a level in a variant, by a spec.

    ``level`` and ``variant`` are what :func:`~tltl_runtime.stealth.levels.file.load_level` takes, ``reference`` is the
    variant whose figures it is compared with, ``spec`` ``FILE:NAME`` or None for the policy's.  ``episodes`` are
    played at the most.  ``place`` tells levels of one name apart: the level's file as seen from the suite, empty for a
    level that comes with the package.
    """

    name: str
    level: str
    variant: str
    reference: str
    spec: str | None
    policy: Path
    episodes: int
    thresholds: Thresholds
    place: str = ""


@record
class Suite:
    """Cases that are judged together.

    ``seed`` is that of the episodes; ``error``, in (0, 1), bounds the probability that any certain fail or review is
    wrong, or any case passes whose pass rate is below the one that it asks for; ``baseline`` is the file that they are
    judged against.
    """

    path: Path
    seed: int
    error: float
    cases: tuple[Case, ...]
    baseline: Path


def baseline_path(suite: Path) -> Path:
    """Where the baseline of a suite lies, unless another one is named: ``NAME.baseline.json`` beside ``NAME.toml``."""
    return suite.with_name(f"{suite.stem}.baseline.json")


@bounded()
def read_suite(path: Path, baseline: Path | None = None) -> Suite:
    """The suite in a file, judged against the baseline beside it or another one; paths in it are relative to it.

    Raises:
        TltlError: all that is wrong, as far as it can be told at once.  TLT0801 no TOML; TLT0802 an unknown key;
            TLT0803 a missing key, a value of the wrong kind or out of range; TLT0804 two cases of one name; TLT0805
            there is no such file; TLT0800 there is no such level or variant; TLT0853 no policy comes with the level;
            and of the files of policies and specs as of :mod:`~tltl_runtime.regression.suite.named_files`.
    """
    source = read_source(path, shown(path))
    log: list[Diagnostic] = []
    table = Table(Entry(read_tree(source, help_=_HELP), Label(source, Span(0, 0))), "the suite", log)
    if "case" not in table.entries:
        help_ = "a suite lists cases that name levels, each under `[[case]]`"
        if other := _something_else(table):
            raise TltlError([Diagnostic("TLT0803", f"this is {other}, and no suite", (table.label,), help_)])
        if "level" in table.entries:
            title, help_ = "the suite has no cases, and `level` is a key of one", "write `[[case]]` in a line above it"
            raise TltlError([Diagnostic("TLT0802", title, (table.place("level"),), help_)])
    seed = table.whole("seed", 0, low=0, high=2**31 - 1)
    error = table.number("error", 0.05, low=0.0001, high=0.5, unit="")
    episodes = _episodes(table, MOST_EPISODES)
    thresholds = _thresholds(table, Thresholds())
    listed = table.tables("case")
    if len(listed) > (SUITE.values or 0):
        title, help_ = f"the suite has more than {SUITE.values:,} cases", "make several suites of it"
        raise TltlError([Diagnostic("TLT0006", title, (table.label,), help_)])
    known: dict[str, tuple[str, ...]] = {}
    cases = []
    for number, each in enumerate(listed):
        if len(log) >= _MOST_FAULTS:
            log.append(_unread(len(listed) - number, each.label))
            break
        cases.append(_case(each, path.parent, episodes, thresholds, known))
    table.done()
    if not cases and not log:
        log.append(Diagnostic("TLT0803", "the suite has no cases", (table.label,), "give one, under `[[case]]`"))
    found: dict[str, Label] = {}
    for case, label in [each for each in cases if each is not None]:
        if case.name in found:
            title, help_ = f"two cases are called `{case.name}`", "give one of them another `name`"
            log.append(Diagnostic("TLT0804", title, (label, found[case.name]), help_))
        found[case.name] = label
    if log:
        raise TltlError(log)
    return Suite(path, seed, error, tuple(case for case, _ in filter(None, cases)), baseline or baseline_path(path))


def _something_else(table: Table) -> str | None:
    """What other file this is, by its keys."""
    kinds = {"an asset": {"type"}, "a level": {"bounds", "start"}, "an overlay": {"change", "add"}}
    return next((kind for kind, keys in kinds.items() if keys & table.entries.keys()), None)


def _unread(count: int, label: Label) -> Diagnostic:
    title = f"so much is wrong that the last {count:,} cases were not read"
    return Diagnostic("TLT0803", title, (label,), "mend what is above, and try again")


def _case(
    table: Table, folder: Path, episodes: int, thresholds: Thresholds, known_variants: dict[str, tuple[str, ...]]
) -> tuple[Case, Label] | None:
    """A case and its place, None where something is wrong with it; ``known_variants`` is as of :func:`_variants`."""
    before = len(table.log)
    level, place = _level(table, folder)
    variant = _text(table, "variant", "")
    overlays = _overlays(table, folder)
    reference = _text(table, "reference", "")
    spec = _spec(table, folder)
    episodes, thresholds = _episodes(table, episodes), _thresholds(table, thresholds)
    name = _text(table, "name", "")
    policy = _policy(table, folder, level)
    table.done()
    if len(table.log) > before or policy is None:
        return None
    there = _variants(table, level, known_variants)
    for key, given in (("variant", variant), ("reference", reference)):
        if given and given not in there:
            title = f"the level `{level}` has no variant `{given}`"
            table.log.append(Diagnostic("TLT0800", title, (table.place(key),), suggestion(given, there)))
    known = shared_names(level_path(level), "overlays")
    for each in overlays:
        if not each.endswith(".toml") and each not in known:
            title = f"there is no overlay `{each}`"
            table.log.append(Diagnostic("TLT0805", title, (table.place("overlay"),), suggestion(each, known)))
    base = variant or there[0]
    name = name or f"{Path(level).stem}:{'+'.join((base, *(Path(each).stem for each in overlays)))}"
    played = with_overlays(base, overlays)
    return Case(name, level, played, reference or there[0], spec, policy, episodes, thresholds, place), table.label


def _text(table: Table, key: str, default: str = REQUIRED) -> str:
    """A text that is not empty."""
    found, entry = table.text(key, default), table.entries.get(key)
    if entry is not None and entry.value == "":
        table.log[-1] = wrong(entry, key, "a text that is not empty")
    return found


def _variants(table: Table, level: str, known: dict[str, tuple[str, ...]]) -> tuple[str, ...]:
    """The variants of a level; of one that does not load any more, which is its case's finding, what is asked for.

    ``known`` has those of levels that were read before, none for one that does not load.
    """
    if level not in known:
        try:
            known[level] = variants(level)
        except TltlError:
            known[level] = ()
    asked = (table.entries[key].value for key in ("reference", "variant") if key in table.entries)
    return known[level] or (*asked, "v0")


def _level(table: Table, folder: Path) -> tuple[str, str]:
    """A level, and its place as seen from the suite where it is a file."""
    level = _text(table, "level")
    if not level:
        return "", ""
    if level.endswith(".toml"):
        if not is_file(folder / level):
            help_ = level_like(level, folder) or "paths are relative to the suite"
            table.log.append(Diagnostic("TLT0800", f"there is no level `{level}`", (table.place("level"),), help_))
        return str(folder / level), Path(normpath(level)).as_posix()
    try:
        level_path(level)
    except TltlError as error:
        (found,) = error.diagnostics
        name, variant = level_place(level)
        is_there = name in level_names() or is_file(folder / name)
        way_out = found.help
        if variant and is_there:
            way_out = _apart(name, variant)
        elif not level.endswith((".tltl", ".json")) and "+" not in level:
            way_out = level_like(level, folder) or found.help
        table.log.append(Diagnostic(found.code, found.title, (table.place("level"),), way_out))
    return level, ""


def _apart(level: str, variant: str) -> str:
    """How a suite writes what commands write as ``LEVEL:VARIANT+OVERLAY``."""
    base, added = overlays_of(variant)
    lines = [f'`level = "{level}"`', f'`variant = "{base}"`', *([f"`overlay = {json.dumps(added)}`"] if added else [])]
    return f"write {', '.join(lines)}"


def _overlays(table: Table, folder: Path) -> tuple[str, ...]:
    """What is added to the variant: names, or paths from here."""
    entry = table.entries.get("overlay")
    single = entry is not None and not isinstance(entry.value, list)
    names = (_text(table, "overlay"),) if single else table.names("overlay", ())
    found = []
    for name in names:
        path = folder / name
        if name.endswith(".toml") and not is_file(path):
            table.log.append(_missing("overlay", name, table.place("overlay")))
        found.append(str(path) if name.endswith(".toml") else name)
    return tuple(found)


def _spec(table: Table, folder: Path) -> str | None:
    text = _text(table, "spec", "")
    if not text:
        return None
    file, name = split(text)
    if not is_file(folder / file):
        table.log.append(_missing("spec", file, table.place("spec")))
    spec = f"{folder / file}:{name}" if name else str(folder / file)
    if is_file(folder / file):
        table.log += spec_faults(spec, table.place("spec"))
    return spec


def _policy(table: Table, folder: Path, level: str) -> Path | None:
    """The policy's file, or the folder of its training; by default what comes with the level."""
    named = _text(table, "policy", "")
    if not named or named in shipped_policies():
        found = shipped_policy(named or level)
        if found is None and level and not table.log:
            title, label = f"no policy comes with the level `{level}`", table.place("level")
            help_ = f'name one that was trained, e.g. `policy = "training/{Path(level).stem}"`'
            if other := policy_for_its_spec(level):
                help_ += f', or the one for the same spec that comes with tltlc: `policy = "{other}"`'
            table.log.append(Diagnostic("TLT0853", title, (label,), help_))
        return found
    path = folder / named
    if not exists(path):
        known = (*shipped_policies(), *sorted(each.name for each in folder.glob(f"*{SUFFIX}")))
        table.log.append(_missing("policy", named, table.place("policy"), known))
    else:
        table.log += policy_faults(path, table.place("policy"))
    return path


def _episodes(table: Table, default: int) -> int:
    return table.whole("episodes", default, low=LEAST_EPISODES, high=_LIMIT)


def _thresholds(table: Table, defaults: Thresholds) -> Thresholds:
    found = table.table("thresholds", needed=False)
    if found is None:
        return defaults
    before = len(table.log)
    values = [
        found.number(key, getattr(defaults, key), low=0.0, high=_MOST.get(key, 1.0), unit="")
        for key in defaults.__match_args__
    ]
    found.done()
    made = Thresholds(*values)
    if made.fail_rate > made.pass_rate and len(table.log) == before:
        if "fail_rate" in found.entries:
            expected = f"a `fail_rate` of {made.pass_rate:g}, the `pass_rate`, at the most"
            table.log.append(wrong(found.entries["fail_rate"], "fail_rate", expected))
        else:
            title = f"`pass_rate` is {made.pass_rate:g}, below the `fail_rate`, which is {made.fail_rate:g} by default"
            help_ = f"give a `fail_rate`, too, of {made.pass_rate:g} at the most"
            table.log.append(Diagnostic("TLT0803", title, (found.place("pass_rate"),), help_))
    return made


def _missing(what: str, name: str, label: Label, known: tuple[str, ...] = ()) -> Diagnostic:
    help_ = suggestion(name, known) if known else "paths are relative to the suite"
    return Diagnostic("TLT0805", f"there is no {what} `{name}`", (label,), help_)
