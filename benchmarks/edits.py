"""Compare the verdicts of ``tltlc regress`` on random edits of levels with the truth about these edits.

Each edit changes an asset of a shipped level. An over-approximation of what the player can reach
shows what nobody can reach any more. The scripted expert plays the level before and after the edit.
Then the level's policy plays, and ``tltlc regress`` judges it.

``python -m benchmarks.edits --quick`` tries all of this on two edits with a few episodes, and stores nothing.
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
from benchmarks.random_edits import EDIT_REQUESTS, Asset, Edit, EditRequest, random_edits
from benchmarks.store import Record, Store, measure_missing, source_digest

if TYPE_CHECKING:
    from tltl_runtime.evaluation.figures import Figures
    from tltl_runtime.game.level_name import Variant
    from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
    from tltl_runtime.regression.suite.suite import Case, Suite
    from tltl_runtime.regression.verdict.baseline import Reference
    from tltl_runtime.stealth.recordings.episode import Episode

SECTION = "regression"
SOURCES: Final = ("tltlc", "runtime")
NEEDED = ("torch", "safetensors", "pybullet")

FOLDER = Path(__file__).with_name(".edits")
BASE: Final = "v0"

ENOUGH_FAILURES: Final = 5
"""The expert stops after this many failures in a row. Each may take minutes, and more would show nothing new."""


@dataclass(frozen=True, slots=True)
class Plan:
    """The size of the measurement.

    ``requests`` are the edits to make, ``expert_episodes`` the number of episodes of the expert, and
    ``episodes`` the greatest number of episodes of a policy.
    """

    requests: Sequence[EditRequest] = EDIT_REQUESTS
    seed: int = 15
    expert_episodes: int = 25
    episodes: int = 300
    suite_seed: int = 7000


FULL = Plan()
QUICK = Plan(
    requests=(EditRequest("navigation", "corridor", "words"), EditRequest("navigation", "corridor", "shut")),
    expert_episodes=1,
    episodes=25,
)


def measure(store: Store, _: float, say: Callable[[str], None], plan: Plan = FULL, folder: Path = FOLDER) -> None:
    """Play and judge the levels and edits without a record; ``folder`` keeps the episodes of interrupted runs."""
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        say(f"{SECTION} left out: {', '.join(missing)} not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    from tltl_runtime.regression.suite.suite import read_suite

    # Episodes that were played by other code are not reused.
    folder /= source_digest(*SOURCES)
    edits = random_edits(plan.seed, _assets({request.asset for request in plan.requests}), _loads, plan.requests)
    suite = read_suite(_write_suite(edits, plan, folder))
    levels = {f"{EXPERT}{edit.level}": edit.level for edit in edits}
    measure_missing(store, SECTION, levels, lambda name: expert(levels[name], BASE, plan), say, field="ways")
    cases = {edit_name(edit): (edit, case) for edit, case in zip(edits, suite.played_cases, strict=True)}

    def record(name: str) -> Record:
        edit, case = cases[name]
        description = {"level": edit.level, "asset": edit.asset, "kind": edit.kind, "doc": edit.doc}
        return {
            **description,
            **truth(case, store.section(SECTION)[f"{EXPERT}{edit.level}"], plan),
            **judge_edit(suite, case),
        }

    measure_missing(store, SECTION, cases, record, say, field="verdict")


def discard(folder: Path = FOLDER) -> None:
    """Delete the stored episodes."""
    shutil.rmtree(folder, ignore_errors=True)


def edit_name(edit: Edit) -> str:
    """Return the name of an edit in the results."""
    return f"{edit.number:02d} {edit.level} {edit.asset} {edit.kind}"


def truth(case: Case, before: Record, plan: Plan) -> Record:
    """Return the truth about an edited level: what nobody can reach, and how the expert's episodes differ.

    ``infeasible``: nobody can meet the spec. ``in part``: nobody can meet it in some episodes,
    because chance decides which barrier opens. ``unchanged``: the expert's episodes are those of
    ``before``, step by step. Otherwise the truth is ``changed``.
    """
    now = expert(case.level, case.variant, plan)
    unchanged_count = sum(new == old for new, old in zip(now["ways"], before["ways"], strict=False))
    if now["far"]:
        kind_of_truth = "infeasible" if now["undoable"] else "in part"
    else:
        kind_of_truth = "unchanged" if unchanged_count == len(now["ways"]) else "changed"
    figures = {"episodes": len(now["ways"]), "successes": now["successes"], "same": unchanged_count}
    return {"truth": kind_of_truth, "far": now["far"], "expert": figures}


def expert(level: str, variant: str | Variant, plan: Plan) -> Record:
    """Play episodes of the careful expert with seeds from 0, and find what nobody can reach.

    In the record, ``far`` has a warning for each thing that nobody can reach, and ``undoable`` says
    whether the spec cannot be met without one of them. ``successes`` is the number of successes,
    and ``ways`` has a digest of each episode.
    """
    from tltl_runtime.spec.spec_places import SpecPlaces
    from tltl_runtime.stealth.capabilities.feasible import check_reach
    from tltl_runtime.stealth.capabilities.reach import compute_reach
    from tltl_runtime.stealth.env import make_env
    from tltl_runtime.stealth.episode_recorder import RecordEpisode
    from tltl_runtime.stealth.expert.expert import Expert, play_episode

    env = RecordEpisode(make_env(level, variant))
    try:
        player = Expert(env)
        fspa = env.get_wrapper_attr("task").fspa
        unreachable = check_reach(player.level, compute_reach(player.level), fspa, SpecPlaces(None))
        ways, successes, failures = [], 0, 0
        for seed in range(plan.expert_episodes):
            play_episode(env, player, seed)
            ways.append(episode_digest(env.episode))
            successes += env.episode.success
            failures = 0 if env.episode.success else failures + 1
            if failures == ENOUGH_FAILURES:
                break
    finally:
        env.close()
    return {
        "far": [warning.title for warning in unreachable],
        "undoable": any(warning.severity == "error" for warning in unreachable),
        "successes": successes,
        "ways": ways,
    }


def episode_digest(episode: Episode) -> str:
    """Return a hash, as 12 hexadecimal digits, of the actions and automaton states of an episode."""
    return hashlib.sha256(episode.actions.tobytes() + episode.states.tobytes()).hexdigest()[:12]


def judge_edit(suite: Suite, case: Case) -> Record:
    """Return the verdict of ``tltlc regress`` on a case, with the figures behind it."""
    from tltl_runtime.regression.suite_run import regress

    reference = _reference(suite, case)
    (result,) = regress(suite, [case], (reference,), suite.path.parent / "run", 1, lambda *_: None)
    now, before = result.report.figures, result.report.baseline
    if now is None or before is None:
        return {"failed": "; ".join(result.report.reasons)}
    pairs = zip(result.report.episodes, reference.episodes, strict=False)
    return {
        "verdict": result.report.verdict,
        "certain": result.report.certain,
        "episodes": now.episodes,
        "same": sum(_episode_key(new) == _episode_key(old) for new, old in pairs),
        "now": _rates(now),
        "before": _rates(before),
        "source": source_digest(*SOURCES),
    }


def _episode_key(account: ExplainedEpisode) -> tuple[object, ...]:
    """Return a key of an episode; episodes with equal keys count as the same."""
    return account.summary.steps, account.summary.reward, account.way


def _rates(figures: Figures) -> dict[str, float]:
    return {"pass_rate": figures.pass_rate, "progress": figures.progress.mean, "reward": figures.reward.mean}


def _reference(suite: Suite, case: Case) -> Reference:
    """Return the baseline of the level's policy before the edit; it is played once and stored."""
    from tltl_runtime.regression.verdict.baseline import read_baseline, write_baseline
    from tltl_runtime.regression.verdict.baseline_run import record_baseline
    from tltlc.core.record import replace

    path = suite.path.with_name(f"{case.level}.baseline.json")
    earlier = read_baseline(path) if path.exists() else ()
    (recorded,) = record_baseline(replace(suite, cases=(case,)), 1, lambda *_: None, earlier)
    write_baseline(path, (recorded.reference,))
    return recorded.reference


def _write_suite(edits: Sequence[Edit], plan: Plan, folder: Path) -> Path:
    """Write the edits, and a suite with a case for each edit; return the path of the suite."""
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
    from tltl_runtime.stealth.levels.default_spec import LEVELS
    from tltlc.io.files import read_source
    from tltlc.io.toml_text import parse

    paths = {name: LEVELS / "assets" / f"{name}.toml" for name in sorted(names)}
    return {name: parse(read_source(path, path.name), "TLT0801", "") for name, path in paths.items()}


def _loads(level: str, overlay: str) -> bool:
    from tltl_runtime.stealth.levels.file import load_level
    from tltlc.diagnostics.diagnostic import TltlError

    with tempfile.TemporaryDirectory() as temporary:
        path = Path(temporary) / "overlay.toml"
        path.write_text(overlay, encoding="utf-8")
        try:
            load_level(level, f"{BASE}+{path}")
        except TltlError:
            return False
        return True


def main() -> None:
    """Measure two edits, and print the section."""
    if sys.argv[1:] != ["--quick"]:
        sys.exit("usage: python -m benchmarks.edits --quick")
    with tempfile.TemporaryDirectory() as temporary:
        store = Store(Path(temporary) / "results.json")
        measure(store, 0.0, _say, QUICK, Path(temporary) / "edits")
        print(edits_report.section(store.section(SECTION)))


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
