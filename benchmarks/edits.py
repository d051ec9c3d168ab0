"""What ``tltlc regress`` says of edits that were made at random, beside what is true of them.

Each edit changes an asset of a shipped level.  What nobody can reach any more is known by an over-approximation of
reach, and the scripted expert plays the level before and after.  Then the level's policy plays, and is judged.

``python -m benchmarks.edits --quick`` tries all of this on two edits with a few episodes, and keeps nothing.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Final

from benchmarks import edits_report
from benchmarks.edits_report import EXPERT
from benchmarks.random_edits import WANTED, Asset, Edit, Wanted, random_edits
from benchmarks.store import Record, Store, measure_missing, source_digest

if TYPE_CHECKING:
    from tltl_runtime.evaluation.figures import Figures
    from tltl_runtime.regression.explain.account import ExplainedEpisode
    from tltl_runtime.regression.suite.suite import Case, Suite
    from tltl_runtime.regression.verdict.baseline import Reference
    from tltl_runtime.stealth.recordings.episode import Episode

SECTION = "regression"
SOURCES: Final = ("tltlc", "runtime")
NEEDED = ("torch", "safetensors", "pybullet")

FOLDER = Path(__file__).with_name(".edits")
BASE: Final = "v0"

ENOUGH_FAILURES: Final = 5
"""After so many failures in a row the expert stops: each may take it minutes, and more would tell no more."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What is measured: edits of ``wanted`` kinds, so many episodes of the expert, and of a policy at the most."""

    wanted: Sequence[Wanted] = WANTED
    seed: int = 15
    expert_episodes: int = 25
    episodes: int = 300
    suite_seed: int = 7000


FULL = Plan()
QUICK = Plan(
    wanted=(Wanted("navigation", "corridor", "words"), Wanted("navigation", "corridor", "shut")),
    expert_episodes=1,
    episodes=25,
)


def measure(store: Store, _: float, say: Callable[[str], None], plan: Plan = FULL, folder: Path = FOLDER) -> None:
    """Play what the store does not have yet; what was played so far stays in ``folder``."""
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        say(f"{SECTION} left out: {', '.join(missing)} not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    from tltl_runtime.regression.suite.suite import read_suite

    # What was played by other code is not taken again.
    folder /= source_digest(*SOURCES)
    edits = random_edits(plan.seed, _assets({each.asset for each in plan.wanted}), _loads, plan.wanted)
    suite = read_suite(_written(edits, plan, folder))
    levels = {f"{EXPERT}{edit.level}": edit.level for edit in edits}
    measure_missing(store, SECTION, levels, lambda name: expert(levels[name], BASE, plan), say, done="ways")
    cases = {edit_name(edit): (edit, case) for edit, case in zip(edits, suite.cases, strict=True)}

    def record(name: str) -> Record:
        edit, case = cases[name]
        told = {"level": edit.level, "asset": edit.asset, "kind": edit.kind, "doc": edit.doc}
        return {**told, **truth(case, store.section(SECTION)[f"{EXPERT}{edit.level}"], plan), **judged(suite, case)}

    measure_missing(store, SECTION, cases, record, say, done="verdict")


def discard(folder: Path = FOLDER) -> None:
    """Forget what was played so far."""
    shutil.rmtree(folder, ignore_errors=True)


def edit_name(edit: Edit) -> str:
    """As it stands in the results."""
    return f"{edit.number:02d} {edit.level} {edit.asset} {edit.kind}"


def truth(case: Case, before: Record, plan: Plan) -> Record:
    """What is true of an edited level, whoever plays: what nobody reaches, and how it goes for the expert.

    ``infeasible``: nobody can do what the spec asks; ``in part``: not in all episodes, since chance decides what is
    asked; ``unchanged``: the expert's episodes are those of ``before``, step by step; else ``changed``.
    """
    now = expert(case.level, case.variant, plan)
    same = sum(new == old for new, old in zip(now["ways"], before["ways"], strict=False))
    if now["far"]:
        found = "infeasible" if now["undoable"] else "in part"
    else:
        found = "unchanged" if same == len(now["ways"]) else "changed"
    figures = {"episodes": len(now["ways"]), "successes": now["successes"], "same": same}
    return {"truth": found, "far": now["far"], "expert": figures}


def expert(level: str, variant: str, plan: Plan) -> Record:
    """How the careful expert's episodes go, of the seeds from 0 on; what nobody reaches, and whether that is needed."""
    from tltl_runtime.stealth.capabilities.feasible import check_reach
    from tltl_runtime.stealth.capabilities.reach import reachable
    from tltl_runtime.stealth.capabilities.spec_places import SpecPlaces
    from tltl_runtime.stealth.env import make_env
    from tltl_runtime.stealth.expert.expert import Expert, play_episode
    from tltl_runtime.stealth.recording import RecordEpisode

    env = RecordEpisode(make_env(level, variant))
    try:
        player = Expert(env)
        fspa = env.get_wrapper_attr("task").fspa
        far = check_reach(player.level, reachable(player.level), fspa, SpecPlaces(None))
        ways, successes, failures = [], 0, 0
        for seed in range(plan.expert_episodes):
            play_episode(env, player, seed)
            ways.append(way_digest(env.episode))
            successes += env.episode.success
            failures = 0 if env.episode.success else failures + 1
            if failures == ENOUGH_FAILURES:
                break
    finally:
        env.close()
    return {
        "far": [each.title for each in far],
        "undoable": any(each.severity == "error" for each in far),
        "successes": successes,
        "ways": ways,
    }


def way_digest(episode: Episode) -> str:
    """Twelve hexadecimal digits that stand for what was done in an episode, and for how the automaton went."""
    return hashlib.sha256(episode.actions.tobytes() + episode.states.tobytes()).hexdigest()[:12]


def judged(suite: Suite, case: Case) -> Record:
    """The verdict of ``tltlc regress`` on a case, and what it rests upon."""
    from tltl_runtime.regression.verdict.suite_run import regress

    reference = _reference(suite, case)
    (done,) = regress(suite, [case], (reference,), suite.path.parent / "run", 1, lambda *_: None)
    now, before = done.report.figures, done.report.baseline
    if now is None or before is None:
        return {"failed": "; ".join(done.report.reasons)}
    pairs = zip(done.report.accounts, reference.accounts, strict=False)
    return {
        "verdict": done.report.verdict,
        "certain": done.report.certain,
        "episodes": now.episodes,
        "same": sum(_played(new) == _played(old) for new, old in pairs),
        "now": _rates(now),
        "before": _rates(before),
        "source": source_digest(*SOURCES),
    }


def _played(account: ExplainedEpisode) -> tuple[object, ...]:
    """What shows that two episodes were alike."""
    return account.summary.steps, account.summary.reward, account.way


def _rates(figures: Figures) -> dict[str, float]:
    return {"pass_rate": figures.pass_rate, "progress": figures.progress.mean, "reward": figures.reward.mean}


def _reference(suite: Suite, case: Case) -> Reference:
    """What the level's policy did before the edit, played once."""
    from tltl_runtime.regression.verdict.baseline import read_baseline, write_baseline
    from tltl_runtime.regression.verdict.baseline_run import record_baseline
    from tltlc.core.record import replace

    path = suite.path.with_name(f"{case.level}.baseline.json")
    kept = read_baseline(path) if path.exists() else ()
    (made,) = record_baseline(replace(suite, cases=(case,)), 1, lambda *_: None, kept)
    write_baseline(path, (made.reference,))
    return made.reference


def _written(edits: Sequence[Edit], plan: Plan, folder: Path) -> Path:
    """Write the edits, and a suite with a case for each of them; its path."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = [f"seed = {plan.suite_seed}", f"episodes = {plan.episodes}"]
    for edit in edits:
        name = f"edit_{edit.number:02d}"
        (folder / f"{name}.toml").write_text(edit.overlay, encoding="utf-8")
        keys = {"name": name, "level": edit.level, "variant": BASE, "overlay": f"{name}.toml"}
        lines += ["", "[[case]]", *(f"{key} = {json.dumps(value)}" for key, value in keys.items())]
    path = folder / "suite.toml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _assets(names: set[str]) -> dict[str, Asset]:
    from tltl_runtime.stealth.levels.made_for import LEVELS
    from tltlc.io.files import read_source
    from tltlc.io.toml_text import parse

    paths = {name: LEVELS / "assets" / f"{name}.toml" for name in sorted(names)}
    return {name: parse(read_source(path, path.name), "TLT0801", "") for name, path in paths.items()}


def _loads(level: str, overlay: str) -> bool:
    from tltl_runtime.stealth.levels.file import load_level
    from tltlc.diagnostics.diagnostic import TltlError

    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "overlay.toml"
        path.write_text(overlay, encoding="utf-8")
        try:
            load_level(level, f"{BASE}+{path}")
        except TltlError:
            return False
        return True


def main() -> None:
    """Try the section on two edits."""
    if sys.argv[1:] != ["--quick"]:
        sys.exit("usage: python -m benchmarks.edits --quick")
    with tempfile.TemporaryDirectory() as place:
        store = Store(Path(place) / "results.json")
        measure(store, 0.0, _say, QUICK, Path(place) / "edits")
        print(edits_report.section(store.section(SECTION)))


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
