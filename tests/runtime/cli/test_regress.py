"""``tltlc regress``: its output, its files and its errors; the policies are untrained."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from itertools import count
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from tests.interfaces.cli.conftest import tltlc  # noqa: F401
from tests.runtime.cli.regressions import NAMES, ONE, REPORTS, Run, _recorded, verdicts  # noqa: F401
from tests.runtime.regression.game import SUITE, edit
from tests.runtime.regression.recorded_game import _game  # noqa: F401
from tests.waiting import HANG_S
from tltl_runtime.regression import suite_run
from tltl_runtime.regression.suite.suite import read_suite
from tltl_runtime.regression.suite_run import CASES, case_folder
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli.main import main


def test_the_text_report(tltlc: Run, game: Path) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", "--out", "new", *ONE)
    assert result.status == 1
    sentence, *lines = result.out.splitlines()
    assert sentence == "1 of 3 cases is not finished by its agent, as before; 2 play as before"
    assert verdicts(result.out) == ["hopeless fail", "room:v0 pass", "room:v1 pass"]
    assert lines[0].startswith("hopeless  fail      0 of 25     0%  progress")
    end = next(line for line, text in enumerate(lines) if text.startswith("room:v0"))
    reasons = lines[1:end]
    assert all(line.startswith("    ") for line in reasons)
    assert reasons[1].startswith("    nothing has changed since the baseline")
    assert "    met in 0 of 25 episodes, before in 0 of 50: certainly in less than 50%" in reasons
    assert re.fullmatch(
        r"room:v0   pass     (\d\d) of \1   100%  progress   1\.00 \(  1\.00\)  reward  0\.\d{3} \( 0\.\d{3}\)",
        lines[end],
    )
    assert lines[end + 1].startswith("room:v1   pass")
    # A variant that passes has the lines on what it changes, and on what is certain.
    assert lines[end + 2] == "    differs from `v0` by overlays/guard_alert.toml"
    assert re.fullmatch(
        r"    met in (\d\d) of \1 episodes, `v0` before in 50 of 50: certainly in 85% or more", lines[end + 4]
    )
    assert lines[-1] == "3 cases: 2 pass, 1 fail"
    progress = result.err.splitlines()
    assert "room:v0: 25 of at most 50 episodes, 25 met the spec" in progress
    assert "hopeless: 25 of at most 50 episodes, 0 met the spec" in progress
    # The verdicts are shown as soon as they are known, in the order of the suite.
    verdict_lines = ["room:v0: pass", "room:v1: pass", "hopeless: fail"]
    assert [line for line in progress if line in verdict_lines] == verdict_lines
    assert progress[-1] == "wrote new/report.html: open it in a browser"
    page = Path("new/report.html").read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>") and all(name in page for name in NAMES)


def test_cached_cases_are_marked(tltlc: Run, game: Path) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", *ONE)
    marked = [line.endswith("  (as before)") for line in result.out.splitlines() if line[0] != " "]
    assert marked == [False, True, True, True, False]
    wrote = "wrote regression/game/report.html: open it in a browser"
    assert result.err.splitlines() == ["room:v0: pass", "room:v1: pass", "hopeless: fail", wrote]
    one_case = ("regress", "game.toml", "--changed", "soon", *ONE)
    cached, fresh = tltlc(*one_case), tltlc(*one_case, "--fresh")
    assert fresh.out == cached.out.replace("  (as before)", "") != cached.out
    assert "25 of at most 50" in fresh.err


def test_several_workers_give_the_same_results(tltlc: Run, game: Path) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", "--out", "new", "--workers", "2")
    assert result.out == tltlc("regress", "game.toml", *ONE).out.replace("  (as before)", "")
    suite = read_suite(Path("game.toml"))
    for name in NAMES:
        ours, theirs = (case_folder(suite, name, Path(run) / CASES) / "case.json" for run in ("new", "regression/game"))
        assert ours.read_bytes() == theirs.read_bytes()


def test_the_json_report(tltlc: Run, game: Path) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", "--json", "-", *ONE)
    assert result.status == 1
    report = json.loads(result.out)
    head = ["format", "version", "suite", "seed", "error", "complete", "left_out", "verdicts", "summary", "cases"]
    assert list(report) == head
    assert (report["format"], report["suite"], report["complete"]) == ("tltl-regression", "game.toml", True)
    assert report["verdicts"] == {"pass": 2, "review": 0, "fail": 1}
    assert report["summary"]["sentence"] in result.err.splitlines()
    assert (report["summary"]["judged"], report["summary"]["as_before"]) == (3, 2)
    assert [case["name"] for case in report["cases"]] == NAMES
    for case in report["cases"]:
        assert {"level", "variant", "verdict", "pass_rate", "progress", "reward", "baseline", "reasons"} < case.keys()
        assert case["episodes"] == len(case["accounts"])
        assert sum(explained["success"] for explained in case["accounts"]) == pytest.approx(
            case["pass_rate"] * case["episodes"]
        )
    # The text report is on standard error then.
    assert "3 cases: 2 pass, 1 fail" in result.err
    again = tltlc("regress", "game.toml", "--json", "report.json", *ONE)
    assert json.loads(Path("report.json").read_text(encoding="utf-8")) == report
    assert "3 cases: 2 pass, 1 fail" in again.out


def test_the_reports_for_continuous_integration(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("GITHUB_WORKSPACE", str(game.parent))
    result = tltlc("regress", "game.toml", "--junit", "report.xml", "--html", "page.html", "--github", *ONE)
    (tests,) = ET.parse("report.xml").getroot()
    assert [len(test.findall("failure")) for test in tests.iter("testcase")] == [0, 0, 1]
    sentence, command = (line for line in result.out.splitlines() if line.startswith("::"))
    assert sentence == f"::notice title=game::{result.out.splitlines()[0]}"
    assert tests[-1].text == result.out.splitlines()[0]
    assert command.startswith("::error file=game/game.toml,title=hopeless%3A fail::")
    assert "%0Anothing has changed since" in command and "met in 0 of 25 episodes" in command
    assert Path("page.html").read_bytes() == Path("regression/game/report.html").read_bytes()
    assert result.err.splitlines()[-1] == "wrote page.html: open it in a browser"


def test_another_baseline_can_be_named(tltlc: Run, game: Path) -> None:  # noqa: F811
    Path("game.baseline.json").rename("tonight.json")
    result = tltlc("regress", "game.toml", "--baseline", "tonight.json", "--changed", "tonight", *ONE)
    assert verdicts(result.out) == ["hopeless fail", "room:v0 pass", "room:v1 pass"]
    result = tltlc("regress", "game.toml", "--baseline", "nowhere.json", *ONE)
    assert result.err == (
        "error[TLT0903]: the suite `game.toml` has no baseline: there is no `nowhere.json`\n"
        "  help: record it: tltlc baseline game.toml --output nowhere.json\n"
    )


def test_the_default_folder_depends_on_the_path_of_the_suite(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(game.parent)
    result = tltlc("regress", "game/game.toml", "--changed", "README.md", *ONE)
    assert result.err.splitlines()[-1] == "wrote regression/game/game/report.html: open it in a browser"
    (game.parent / "elsewhere").mkdir()
    monkeypatch.chdir(game.parent / "elsewhere")
    result = tltlc("regress", str(game / "game.toml"), "--changed", "README.md", *ONE)
    assert result.err.splitlines()[-1] == "wrote regression/game/game/report.html: open it in a browser"


def test_a_run_stopped_in_its_first_case_reports_no_case(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tltl_runtime.regression.suite_run._judge", stopped)
    result = tltlc("regress", "game.toml", "--json", "report.json", "--junit", "report.xml", *ONE)
    assert result.status == 130
    assert result.out == "no case was judged\n"
    report = json.loads(Path("report.json").read_text(encoding="utf-8"))
    assert (report["complete"], report["cases"]) == (False, [])
    (tests,) = ET.parse("report.xml").getroot()
    assert (tests.get("tests"), tests.get("errors")) == ("3", "3")


@pytest.mark.parametrize(
    ("error", "status"),
    [(TltlError([Diagnostic("TLT0850", "a worker was lost")]), 1), (KeyboardInterrupt(), 130), (RuntimeError(), 70)],
)
def test_the_error_that_ended_a_run_is_reported_although_the_page_is_unwritable(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
    error: BaseException,
    status: int,
) -> None:
    def ended(*_: object, **__: object) -> None:
        raise error

    folder = Path("regression/game")
    (folder / CASES / "hopeless" / "case.json").unlink()
    (folder / "report.html").unlink()
    (folder / "report.html").mkdir()
    monkeypatch.setattr("tltl_runtime.regression.suite_run.judge_case", ended)
    result = tltlc("regress", "game.toml", *ONE)
    assert result.status == status
    assert "error[TLT0005]: cannot write `regression/game/report.html`" in result.err
    first = {1: "error[TLT0850]: a worker was lost", 130: "stopped: 2 of 3 cases are judged", 70: "error: a bug"}
    assert first[status] in result.err


@pytest.mark.parametrize(("option", "place"), [*((option, "-") for option in REPORTS), ("--json", "/dev/stdout")])
def test_each_report_can_be_written_to_standard_output(
    tltlc: Run,  # noqa: F811
    recorded: Path,
    game: Path,
    option: str,
    place: str,
) -> None:
    result = tltlc("regress", "game.toml", option, place, *ONE)
    assert "3 cases: 2 pass, 1 fail" in result.err and "3 cases" not in result.out.splitlines()
    assert result.out == (recorded.parent / "reports" / REPORTS[option]).read_text(encoding="utf-8")
    assert not Path("-").exists()


def test_only_one_report_goes_to_standard_output(tltlc: Run, game: Path) -> None:  # noqa: F811
    reason = "both need standard output: write"
    for words, message in {
        ("--json", "-", "--html", "-"): f"`--json -` and `--html -` {reason} the page to a file",
        ("--junit", "/dev/stdout", "--html", "-"): f"`--junit /dev/stdout` and `--html -` {reason} the page to a file",
        ("--github", "--junit", "-"): f"--github and `--junit -` {reason} the XML to a file",
        ("--github", "--json", "-"): f"--github and `--json -` {reason} the JSON to a file",
    }.items():
        result = tltlc("regress", "game.toml", *words)
        assert (result.status, result.out) == (2, "") and message in result.err


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="descriptors have no names here")
def test_a_report_is_written_into_a_pipe(tltlc: Run, game: Path) -> None:  # noqa: F811
    read_end, write_end = os.pipe()
    with os.fdopen(read_end, encoding="utf-8") as pipe:
        result = tltlc("regress", "game.toml", "--json", f"/dev/fd/{write_end}", *ONE, "--changed", "README.md")
        os.close(write_end)
        assert result.status == 0, result.err
        assert json.load(pipe)["left_out"] == NAMES


pipes_that_close = pytest.mark.skipif(sys.platform == "win32", reason="pipes close otherwise")


@pipes_that_close
def test_a_closed_pipe_does_not_stop_the_run(game: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("regression/game/report.html").unlink()
    read_end, write_end = os.pipe()
    reader, judge, judged = os.fdopen(read_end, encoding="utf-8"), suite_run._judge, count(1)

    def close_after_one_line(*arguments: Any, **options: Any) -> Any:
        # Close the pipe between the first two cases, as `head -1` does.
        if next(judged) == 2:
            assert reader.readline().startswith("room:v0")
            reader.close()
        return judge(*arguments, **options)

    monkeypatch.setattr(suite_run, "_judge", close_after_one_line)
    with os.fdopen(write_end, "w", encoding="utf-8") as pipe, monkeypatch.context() as patch:
        patch.setattr(sys, "stdout", pipe)
        patch.setattr(sys, "stderr", pipe)
        with pytest.raises(SystemExit) as ended:
            main(["regress", "game.toml", "--junit", "report.xml", *ONE])
    assert reader.closed
    _check_whole_run(ended.value.code)


@pytest.mark.slow
@pipes_that_close
def test_a_closed_pipe_does_not_stop_the_process(game: Path) -> None:
    words = [sys.executable, "-m", "tltlc", "regress", "game.toml", "--fresh", "--junit", "report.xml", *ONE]
    Path("regression/game/report.html").unlink()
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as running:
        assert running.stdout is not None
        # Close the pipe after one line, as `head -1` does.
        assert running.stdout.readline().startswith(b"room:v0")
        running.stdout.close()
    _check_whole_run(running.returncode)


def _check_whole_run(status: object) -> None:
    assert status == 1
    assert [test.get("name") for test in ET.parse("report.xml").iter("testcase")] == NAMES
    assert Path("regression/game/report.html").is_file()


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are Unicode here")
def test_the_name_of_a_suite_may_be_invalid_utf_8(tltlc: Run, game: Path) -> None:  # noqa: F811
    name = os.fsdecode(b"g\xff.toml")
    Path("game.toml").rename(name)
    words = ("--baseline", "game.baseline.json", "--out", "new", "--changed", "soon", *ONE)
    result = tltlc("regress", name, "--json", "report.json", "--junit", "report.xml", *words)
    assert (result.status, result.err.splitlines()[-1]) == (1, "wrote new/report.html: open it in a browser")
    assert json.loads(Path("report.json").read_text(encoding="utf-8"))["suite"] == "g\ufffd.toml"
    assert "<title>g\ufffd: regression report</title>" in Path("new/report.html").read_text(encoding="utf-8")
    assert ET.parse("report.xml").getroot()[0].get("name") == "g\ufffd"


def test_a_level_that_does_not_load_fails_its_cases(tltlc: Run, game: Path) -> None:  # noqa: F811
    text = Path("room.toml").read_text(encoding="utf-8")
    Path("room.toml").write_text(text.replace("[start]", "[strat]"), encoding="utf-8")
    result = tltlc("regress", "game.toml", "--github", *ONE, "--changed", "room.toml")
    sentence, _, cases = result.out.partition("\n")
    assert sentence == "3 of 3 cases cannot be played"
    assert cases.startswith("room:v0   fail\n    it cannot be played\n    room.toml:")
    commands = [line for line in result.out.splitlines() if line.startswith("::error file=room.toml,")]
    assert len(commands) == 3
    assert "3 cases: 3 fail" in result.out.splitlines()
    assert result.err.splitlines()[-1].startswith("wrote regression/game/report.html")


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("--json", "game.toml"), "`game.toml`: the suite reads it"),
        (("--json", "game.baseline.json"), "`game.baseline.json`: the suite reads it"),
        (("--html", "room.toml"), "`room.toml`: the suite reads it"),
        (("--json", "j", "--html", "./j"), "`j`: --json writes it, too"),
    ],
)
def test_inputs_are_not_overwritten(
    tltlc: Run,  # noqa: F811
    game: Path,
    words: tuple[str, ...],
    reason: str,
) -> None:
    before = {path: path.read_bytes() for path in game.iterdir() if path.is_file()}
    result = tltlc("regress", "game.toml", *words)
    assert (result.status, result.out) == (3, "")
    assert result.err.startswith(f"error[TLT0005]: cannot write {reason}\n  help: name another place with --")
    assert {path: path.read_bytes() for path in game.iterdir() if path.is_file()} == before


def test_invalid_options_are_rejected(tltlc: Run, game: Path) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", "--github", "--json", "-")
    assert (result.status, result.out) == (2, "")
    assert "--github and `--json -` both need standard output" in result.err
    for minutes in ("nan", "inf", "0"):
        result = tltlc("regress", "game.toml", "--retrain", "--minutes", minutes)
        assert result.status == 2 and "invalid value for '--minutes'" in result.err
    Path("taken").touch()
    result = tltlc("regress", "game.toml", "--out", "taken/run", *ONE)
    assert (result.status, result.out) == (3, "")
    assert result.err == (
        "error[TLT0005]: cannot write into `taken/run`: a part of its path is a file, not a folder\n"
        "  help: make sure that there is room and that you may write there, or name another folder with --out\n"
    )
    for name in ("nowhere.toml", ".", "", "/"):
        result = tltlc("regress", name)
        assert result.status == 3 and "TLT000" in result.err, result.err
    for option in ("--json", "--junit", "--html"):
        result = tltlc("regress", "game.toml", "--fresh", option, "nowhere/report", *ONE)
        assert (result.status, result.out) == (3, ""), "nothing was played"
        assert result.err == (
            "error[TLT0005]: cannot write `nowhere/report`: there is no such folder\n"
            f"  help: name another place with {option}\n"
        )
        result = tltlc("regress", "game.toml", "--fresh", option, "a" * 300, *ONE)
        assert (result.status, result.out) == (3, "") and "`: file name too long\n" in result.err
    Path("game.baseline.json").unlink()
    result = tltlc("regress", "game.toml", *ONE)
    assert (result.status, result.out) == (1, "")
    assert result.err == (
        "error[TLT0903]: the suite `game.toml` has no baseline: there is no `game.baseline.json`\n"
        "  help: record it: tltlc baseline game.toml\n"
    )


@pytest.mark.slow
@pytest.mark.parametrize(("name", "status"), [("SIGINT", 130), ("SIGTERM", 143)])
def test_a_signal_ends_it_and_keeps_the_judged_cases(tltlc: Run, game: Path, name: str, status: int) -> None:  # noqa: F811
    # The case never meets its spec, and its thresholds are so low that a verdict takes thousands of episodes.
    endless = 'name = "hopeless"\nepisodes = 10000\nthresholds = { pass_rate = 0.001, fail_rate = 0.0005 }'
    text = SUITE.replace('name = "hopeless"', endless)
    Path("game.toml").write_text(text, encoding="utf-8")
    _lengthen(Path("game.baseline.json"), 10_000)
    reports = ("--json", "report.json", "--junit", "report.xml")
    command = [sys.executable, "-m", "tltlc", "regress", "game.toml", *reports, "--github", *ONE]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as playing:
        assert playing.stderr is not None
        for line in playing.stderr:
            if line.startswith("hopeless: 25 of at most 10000"):
                break
        playing.send_signal(getattr(signal, name))
        out, err = playing.communicate(timeout=HANG_S)
    assert playing.returncode == status
    assert verdicts(out) == ["room:v0 pass", "room:v1 pass"]
    again = "tltlc regress game.toml --out regression/game --json report.json --junit report.xml --workers 1 --github"
    assert f"stopped: 2 of 3 cases are judged and kept; to go on: {again}" in err.splitlines()
    (tests,) = ET.parse("report.xml").getroot()
    assert [test.get("name") for test in tests.iter("testcase") if test.find("error") is not None] == ["hopeless"]
    report = json.loads(Path("report.json").read_text(encoding="utf-8"))
    assert (report["complete"], len(report["cases"])) == (False, 2)
    assert Path("regression/game/report.html").exists()
    # The lock of the ended process is free.
    Path("game.toml").write_text(text.replace("10000", "25"), encoding="utf-8")
    result = tltlc("regress", "game.toml", *ONE)
    assert [line.endswith("(as before)") for line in result.out.splitlines() if line[:4] == "room"] == [True, True]


def _lengthen(baseline: Path, episodes: int) -> None:
    """Repeat the episodes of a baseline up to this number of episodes."""
    document = json.loads(baseline.read_text(encoding="utf-8"))
    for reference in document["references"]:
        explained_episodes = reference["accounts"]
        reference["accounts"] = [
            {**explained_episodes[index % len(explained_episodes)], "index": index} for index in range(episodes)
        ]
    baseline.write_text(json.dumps(document), encoding="utf-8")


def test_the_folder_of_a_training_is_rejected_as_output(tltlc: Run, game: Path) -> None:  # noqa: F811
    Path("training/vault").mkdir(parents=True)
    Path("training/vault/run.json").touch()
    result = tltlc("regress", "game.toml", "--out", "training/vault", *ONE)
    assert (result.status, result.out) == (3, "")
    assert result.err == (
        "error[TLT0005]: cannot write into `training/vault`: it is the folder of a training\n"
        "  help: name another folder with --out\n"
    )
    assert [path.name for path in Path("training/vault").iterdir()] == ["run.json"]


def test_the_expected_findings_of_the_shipped_suite_are_explained(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    note = "v1 and v2 of the shipped levels are changed on purpose: see the page"
    assert note not in tltlc("regress", "game.toml", *ONE, "--changed", "soon").out
    monkeypatch.setattr("tltl_runtime.cli.support.regression_run.SHIPPED", Path("game.toml"))
    assert note not in tltlc("regress", "game.toml", *ONE, "--changed", "soon").out, (
        "the finding is of a level as it was designed"
    )
    edit("game.toml", 'name = "hopeless"', 'name = "hopeless"\nvariant = "v1"')
    assert tltlc("regress", "game.toml", *ONE).out.splitlines()[-2:] == ["3 cases: 2 pass, 1 fail", note]
    assert note in tltlc("regress", "game.toml", "--json", "-", *ONE).err
    assert note not in tltlc("regress", "game.toml", *ONE, "--changed", "easy").out, "all pass"
