"""docs/policy-file.md describes the written files, and its programs run."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import get_args

import pytest
from safetensors import safe_open

from tests.docs.blocks import DOCS, Block, blocks
from tests.runtime.policies.examples import card_of, policy_of
from tests.runtime.policies.spaces.space_policies import policy_of_spaces
from tests.runtime.policies.spaces.test_space_policy import GRID, MIXED
from tltl_runtime.policies.file import write_policy
from tltl_runtime.policies.onnx import to_onnx
from tltl_runtime.policies.spaces.observation_layout import PartKind

PAGE = DOCS / "policy-file.md"
TEXT = PAGE.read_text(encoding="utf-8")


def keys(head: str) -> set[str]:
    rows = TEXT[TEXT.index(head) :].split("\n\n")[0].splitlines()[2:]
    return {key for row in rows for key in re.findall(r"`(\w+)`", row.split("|")[1])}


@pytest.fixture(name="folder", scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("page")
    policy = policy_of(card_of())
    write_policy(folder / "bot.safetensors", policy)
    (folder / "bot.onnx").write_bytes(to_onnx(policy))
    return folder


def test_the_page_lists_every_key_of_a_card(folder: Path) -> None:
    with safe_open(folder / "bot.safetensors", framework="np") as file:
        assert list(file.metadata()) == ["card"]
        assert set(json.loads(file.metadata()["card"])) == keys("| key of `card` |")


def test_the_page_lists_the_metadata_of_a_model(folder: Path) -> None:
    onnxruntime = pytest.importorskip("onnxruntime")
    meta = onnxruntime.InferenceSession(folder / "bot.onnx").get_modelmeta()
    assert set(meta.custom_metadata_map) == keys("| metadata |")


def test_the_page_lists_what_policies_of_other_games_have(tmp_path: Path) -> None:
    policy = policy_of_spaces(GRID, MIXED)
    write_policy(tmp_path / "bot.safetensors", policy)
    with safe_open(tmp_path / "bot.safetensors", framework="np") as file:
        card = json.loads(file.metadata()["card"])
    assert card.keys() - keys("| key of `card` |") == keys("| further key |") & card.keys() == {"spaces"}
    assert keys("| kind |") == set(get_args(PartKind))
    onnxruntime = pytest.importorskip("onnxruntime")
    outputs = onnxruntime.InferenceSession(to_onnx(policy)).get_outputs()
    assert {output.name for output in outputs} == keys("| output |")


@pytest.mark.parametrize(
    "program", [block for block in blocks(PAGE) if block.kind == "python"], ids=lambda block: f"line {block.line}"
)
def test_the_programs_on_the_page_run(
    program: Block, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if "onnxruntime" in program.text:
        pytest.importorskip("onnxruntime")
    monkeypatch.chdir(folder)
    exec(compile(program.text, str(PAGE), "exec"), {})
    assert capsys.readouterr().out
