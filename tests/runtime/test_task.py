"""The forms in which ``load_task`` accepts a spec, and the params and rewards of a task."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import tltlc
from tests.fixtures import cover_and_hide
from tests.waiting import HANG_S
from tltl_runtime import load_task
from tltlc.backends import emit
from tltlc.monitor import RewardOptions

EXAMPLES = Path(__file__).parents[2] / "examples"
TWO = "signal seen: bool\nspec hide = G !seen\nspec show = F seen\n"
NEAR = "import spatial\nentity e\nspec s = F near(e)\n"


def codes(error: pytest.ExceptionInfo[tltlc.TltlError]) -> list[str]:
    return [diagnostic.code for diagnostic in error.value.diagnostics]


def test_a_path_a_text_an_automaton_and_an_artefact_give_the_same_task(tmp_path: Path) -> None:
    path = EXAMPLES / "cover_and_hide.tltl"
    task = load_task(path)
    assert (task.fspa.name, task.params, task.reward) == ("cover_and_hide", {}, RewardOptions())
    assert load_task(str(path)) == load_task(f"{path}:cover_and_hide") == load_task(task.fspa) == task
    assert load_task(path.read_text(encoding="utf-8")) == task
    ((name, text),) = emit("json", task.fspa).items()
    artefact = tmp_path / name
    artefact.write_text(str(text), encoding="utf-8")
    assert load_task(artefact) == load_task(f"{artefact}:cover_and_hide") == load_task(str(text)) == task


def test_a_path_can_name_one_of_several_specs(tmp_path: Path) -> None:
    path = tmp_path / "with blanks.tltl"
    path.write_text(TWO, encoding="utf-8")
    assert load_task(f"{path}:show").fspa.name == "show"
    with pytest.raises(tltlc.TltlError, match=r"TLT0721: .*contains 2 specs, .* `hide`, `show`") as error:
        load_task(path)
    assert error.value.diagnostics[0].help == f"name one of them, e.g. `{path}:hide`"
    with pytest.raises(tltlc.TltlError) as error:
        load_task(f"{path}:shaw")
    assert (codes(error), error.value.diagnostics[0].help) == (["TLT0720"], "did you mean `show`?")


def test_a_text_of_one_line_is_a_spec() -> None:
    assert load_task("signal seen: bool spec hide = G !seen").fspa.name == "hide"


@pytest.mark.parametrize(
    ("spec", "code"),
    [
        (TWO, "TLT0721"),
        ("signal seen: bool\n", "TLT0721"),
        ("nowhere.tltl", "TLT0001"),
        ("not here.tltl:one", "TLT0001"),
        ("nowhere", "TLT0001"),
        ("signal seen: bool spec hide = G !seem", "TLT0201"),
        ("{}", "TLT0601"),
    ],
)
def test_invalid_specs_are_rejected(spec: str, code: str) -> None:
    with pytest.raises(tltlc.TltlError) as error:
        load_task(spec)
    assert code in codes(error)


def test_an_artefact_of_another_name_is_rejected(tmp_path: Path) -> None:
    (text,) = emit("json", cover_and_hide()).values()
    path = tmp_path / "a.fspa.json"
    path.write_text(str(text), encoding="utf-8")
    with pytest.raises(tltlc.TltlError, match="TLT0720"):
        load_task(f"{path}:navigation")


def test_a_task_over_infinite_traces_is_judged_at_its_limit(tmp_path: Path) -> None:
    text = "signal a: bool\nspec s { semantics infinite limit 4 steps require G F a }"
    task = load_task(text)
    assert (task.fspa.semantics, task.fspa.judge) == ("infinite", "limit")
    ((name, artefact),) = emit("json", task.fspa).items()
    (tmp_path / name).write_text(str(artefact), encoding="utf-8")
    assert load_task(tmp_path / name) == task
    monitor = task.monitor()
    steps = [monitor.step({"a": False}) for _ in range(4)]
    assert [step.done for step in steps] == [False, False, False, True]
    assert monitor.success


def test_a_file_can_import_the_libraries_of_its_project(tmp_path: Path) -> None:
    (tmp_path / "tltl.toml").write_text('libraries = ["mine"]\n', encoding="utf-8")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "words.tltl").write_text("signal seen: bool\nlet hidden = !seen\n", encoding="utf-8")
    (tmp_path / "s.tltl").write_text("import words\nspec s = G hidden\n", encoding="utf-8")
    assert len(load_task(tmp_path / "s.tltl").fspa.states) == 2


def test_given_params_override_offered_params() -> None:
    sample = {"distance(e)": 10.0}

    def value(**options: dict[str, float]) -> float:
        monitor = load_task(NEAR, **options).monitor()  # type: ignore[arg-type]
        monitor.step(sample)
        return monitor.values[0]

    assert value() == value(params={"level_size": 20.0}) == value(offered={"unknown": 1.0})
    assert value(offered={"level_size": 40.0}) == value(params={"level_size": 40.0}) != value()
    assert value(params={"level_size": 30.0}, offered={"level_size": 40.0}) == value(params={"level_size": 30.0})


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"params": {"levelsize": 3.0}}, "TLT0308"),
        ({"params": {"level_size": float("nan")}}, "TLT0308"),
        ({"params": {"level_size": 1.0}}, "TLT0307"),
        ({"offered": {"level_size": 1.0}}, "TLT0307"),
    ],
)
def test_invalid_params_are_rejected(options: dict[str, dict[str, float]], code: str) -> None:
    with pytest.raises(tltlc.TltlError) as error:
        load_task(NEAR, **options)  # type: ignore[arg-type]
    assert codes(error) == [code]


def test_a_task_can_be_pickled() -> None:
    task = load_task(NEAR, {"level_size": 30.0}, RewardOptions(mode="sparse"))
    assert pickle.loads(pickle.dumps(task)) == task


def test_the_import_loads_no_heavy_modules() -> None:
    heavy = "('torch', 'pybullet', 'matplotlib', 'imageio_ffmpeg', 'PIL', 'sympy')"
    program = (
        f"import sys, tltl_runtime; tltl_runtime.load_task; print([name for name in {heavy} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, timeout=HANG_S)
    assert done.stdout == "[]\n"


@pytest.mark.parametrize("spec", [(), [], {}, b"plan.tltl", 3, None, "", " "])
def test_a_value_that_is_no_spec_is_a_type_error(spec: Any) -> None:
    with pytest.raises(TypeError, match="a spec must be a path, a text or an automaton, not"):
        load_task(spec)


def test_a_list_of_automata_is_rejected() -> None:
    with pytest.raises(TypeError, match=r"give one of them, e\.g\. the first, `\[0\]`"):
        load_task(tltlc.compile_text("signal a: bool\nspec s = F a"))  # type: ignore[arg-type]


def test_params_and_rewards_of_the_wrong_type_are_rejected() -> None:
    spec = "signal a: bool\nspec s = F a"
    with pytest.raises(TypeError, match="params must map names to numbers"):
        load_task(spec, [("a", 1.0)])  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="RewardOptions"):
        load_task(spec, reward="sparse")  # type: ignore[arg-type]
