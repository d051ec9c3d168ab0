"""The generated C# agrees with :class:`tltlc.monitor.Monitor`, whatever the names; the corpus tests more."""

from __future__ import annotations

import csv
import io
import os
import re
import shutil
import struct
import subprocess
from contextlib import nullcontext
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.failures import ROUNDS, failure_lines, guarded
from tests.backends.monitors import FAR, Programs, batches, different, expected, trace_of
from tests.backends.state_tables import counting, with_tables
from tests.backends.strategies import hostile_automata
from tests.backends.test_c import NAMES
from tests.fixtures import cover_and_hide
from tests.tools.conformance.runner import Outcome
from tests.tools.conformance.runners.csharp import RUNNERS, STRICT
from tests.waiting import HANG_S
from tltlc import compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import emit
from tltlc.core.record import replace
from tltlc.expression.tree import Const, Op, SignalValue
from tltlc.logic import formula as f
from tltlc.monitor import Monitor
from tltlc.program.enums import pascal_case
from tltlc.resolve import spec

pytestmark = pytest.mark.skipif(not (shutil.which("mcs") and shutil.which("mono")), reason="there is no Mono here")


def write_monitor(fspa: Fspa, folder: Path) -> str:
    for name, text in emit("csharp", fspa).items():
        assert isinstance(text, str)
        (folder / name).write_text(text)
    return (folder / f"{pascal_case(fspa.name)}Monitor.cs").read_text()


def compile_program(folder: Path, *words: str) -> None:
    result = subprocess.run(["mcs", *STRICT[:-1], *words], cwd=folder, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def run_program(folder: Path, *words: str, stdin: bytes = b"") -> Outcome:
    result = subprocess.run(["mono", *words], input=stdin, capture_output=True, cwd=folder, timeout=HANG_S)
    return result.returncode, result.stdout.decode(), result.stderr.decode()


# --- names and texts ------------------------------------------------------------------------------


@batches
@given(data=st.data())
def test_hostile_texts_do_not_become_code(tmp_path: Path, data: st.DataObject) -> None:
    programs = Programs(*RUNNERS, tmp_path, different(data, hostile_automata(), 6))
    assert {status for status, _, _ in programs.run(*((number, "nothing\n1\n") for number in range(6)))} == {1}
    for number, fspa in enumerate(programs.fspas):
        name = fspa.signals[0].name
        if name == name.strip() and "\0" not in name:
            samples = [{name: value, "health": 1.0} for value in (-1.0, 0.0, 1.0)]
            assert programs.run((number, trace_of(samples, [name, "health"]))) == [expected(fspa, samples)]


@pytest.mark.slow
@pytest.mark.parametrize("every", [5, pytest.param(1, marks=pytest.mark.slow)])
def test_hostile_names_stay_distinct(tmp_path: Path, every: int) -> None:
    """Each atom reads a signal of the same name; the names are awkward ones, and all words of the generated file.

    In each sample one atom is the limiting one: an awkward one, or one of every few words.
    """
    own = re.findall(r"\w+", write_monitor(cover_and_hide(), tmp_path))
    names = [name for name in dict.fromkeys([*NAMES, *own]) if "\0" not in name]
    atoms = [f"v{index}" for index in range(len(names))]
    fspa = build(spec_from_formula(f.eventually(f.and_(*map(f.atom, atoms)))))
    fspa = replace(
        fspa,
        signals=tuple(spec.Signal(name, "number", -1.0, 1.0, name) for name in names),
        params=tuple(spec.Param(name, "number", 0.0, None, None, name) for name in names),
        atoms=tuple(spec.Atom(name, Op("+", (SignalValue(name), Const(0.0))), name) for name in names),
    )
    programs = Programs(*RUNNERS, tmp_path, [fspa])
    limiting = [*names[: len(NAMES)], *names[len(NAMES) :: every]]
    samples = [{other: -0.25 if other == name else 0.5 for other in names} for name in limiting]
    ((_, out, err),) = programs.run((0, trace_of(samples, names)))
    assert [row["limiting"] for row in csv.DictReader(io.StringIO(out, newline=""))] == limiting, err


def test_public_names_are_in_pascal_case(tmp_path: Path) -> None:
    text = """
        entity boss_door
        signal distance(boss_door): length in [0 m, 9 m]
        signal room_1_2: bool
        signal room_12: bool
        signal guard_mode: (idle, chase_down)
        signal missing in [0, 1]
        signal Missing in [0, 1]
        param min_keys in [1, 3] = 2
        spec boss_fight { reach distance(boss_door) < min_keys * 1 m then room_1_2 and room_12 then
            guard_mode is chase_down and missing > 0.5 and Missing > 0.5 }
    """
    (fspa,) = compile_text(text)
    written = write_monitor(fspa, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        *("BossFightMonitor.cs", "BossFightMonitorBehaviour.cs", "BossFightMonitorProgram.cs")
    ]
    (signals,) = re.findall(r"public struct Signals\n(.*?)public static Signals", written, re.DOTALL)
    fields = ["DistanceBossDoor", "Room1_2", "Room12", "GuardMode", "Missing_1", "Missing_2"]
    assert re.findall(r"public [\w?]+ (\w+);", signals) == fields
    for path in tmp_path.iterdir():
        code = re.sub(r"//.*", "", path.read_text())
        names = {*re.findall(r"\b(?:public|protected|internal) [^;=({]*?(\w+)\s*(?=[;=({:])", code)}
        assert path.stem in names
        assert {"MinKeys", "ChaseDown", "TryStep"} <= names or path.stem != "BossFightMonitor"
        assert all(re.fullmatch(r"[A-Z][A-Za-z0-9]*(_\d+)?", name) for name in names), names
    compile_program(tmp_path, "-target:library", "BossFightMonitor.cs")


def test_a_game_can_compile_all_files_beside_its_own_main(tmp_path: Path) -> None:
    write_monitor(cover_and_hide(), tmp_path)
    (tmp_path / "game.cs").write_text(f"{UNITY}{GAME}")
    compile_program(tmp_path, *sorted(path.name for path in tmp_path.glob("*.cs")))


# --- as a library ---------------------------------------------------------------------------------

LIBRARY = r"""
using System;
using Monitor = Tltl.CoverAndHideMonitor;

internal static class Library
{
    private static void Main()
    {
        var given = Monitor.Params.Defaults;
        given.LevelSize = 1.0;
        try { new Monitor(given); } catch (ArgumentException problem) { Console.WriteLine(problem.Message); }
        given.LevelSize = double.NegativeInfinity;
        try { new Monitor(given); } catch (ArgumentException problem) { Console.WriteLine(problem.Message); }
        given.LevelSize = 10.0;
        var monitor = new Monitor(given);
        for (int round = 0; round < 2; round++)
        {
            var sample = Monitor.Signals.Missing;
            sample.DistanceS1 = sample.DistanceS2 = sample.DistanceExit = 5.0;
            Tell(monitor, sample);
            sample.Health = 2.0;
            var result = monitor.Step(sample);
            Console.WriteLine("{0} {1} {2:R}", result.Label, result.Limiting, result.Progress);
            sample.DistanceS1 = sample.DistanceExit = 0.5;
            Tell(monitor, sample);
            Console.WriteLine("{0} {1} {2}", monitor.State, monitor.Steps, monitor.Done);
            monitor.Reset();
        }
        for (int i = 0; i < monitor.NoticeCount; i++) Console.WriteLine(monitor.NoticeAt(i));
        var far = Monitor.Signals.Missing;
        far.DistanceS1 = far.DistanceS2 = far.DistanceExit = 20.0;
        far.Health = 1.0;
        Monitor.Result ignored;
        monitor.TryStep(far, out ignored);
        long before = GC.GetTotalMemory(false);
        int collected = GC.CollectionCount(0);
        for (int i = 0; i < 1000000; i++) monitor.TryStep(far, out ignored);
        Console.WriteLine("{0} {1}", GC.GetTotalMemory(false) - before, GC.CollectionCount(0) - collected);
    }

    private static void Tell(Monitor monitor, Monitor.Signals sample)
    {
        try { monitor.Step(sample); }
        catch (Monitor.RefusedException refused) { Console.WriteLine("{0}: {1}", refused.Problem, refused.Message); }
    }
}
"""


def test_a_host_gets_results_notices_and_errors(tmp_path: Path) -> None:
    fspa = cover_and_hide()
    write_monitor(fspa, tmp_path)
    (tmp_path / "library.cs").write_text(LIBRARY)
    compile_program(tmp_path, "-out:library.exe", "library.cs", "CoverAndHideMonitor.cs")
    monitor = Monitor(fspa, {"level_size": 10.0})
    step = monitor.step({"distance(s1)": 5.0, "distance(s2)": 5.0, "distance(exit)": 5.0, "health": 1.0})
    together = "step 2: `near(s1)` and `near(exit)` hold at once, against `exclusive near(s1), near(s2), near(exit)`"
    rows = [
        "NotFinite: step 1: no finite number for the signal `health`",
        f"{step.label} near(s1) {step.progress!r}",
        f"Together: {together}",
        "0 1 False",
    ]
    lines = [
        "the param `level_size` cannot be 1: its range is [2, 10000]",
        "the param `level_size` cannot be -inf: its range is [2, 10000]",
        *rows,
        *rows,
        "step 1: the signal `health` is 2, outside [0, 1]: it counts as 1",
        "0 0",
    ]
    assert run_program(tmp_path, "library.exe") == (0, "".join(f"{line}\n" for line in lines), "")


FAILURES = r"""
using System;
using Monitor = Tltl.GuardedMonitor;

internal static class Failures
{
    private static void Main(string[] rounds)
    {
        var monitor = new Monitor();
        foreach (string letters in rounds)
        {
            foreach (char letter in letters)
            {
                var sample = Monitor.Signals.Sparse;
                sample.Health = letter == 'h' || letter == 'b' ? 0.25 : 1.0;
                if (letter == 's' || letter == 'b') sample.Seen = true;
                if (letter == 'a') sample.Alarm = true;
                // A sample that is refused changes nothing.
                Monitor.Result result;
                if (monitor.TryStep(Monitor.Signals.Sparse, out result)) throw new InvalidOperationException();
                result = monitor.Step(sample);
                Console.Write("{0}|{1}|", result.LabelEnglish, result.FailedClause);
                Console.WriteLine("{0}|{1}", result.FailedAtom, result.FailedStep);
            }
            monitor.Reset();
        }
    }
}
"""


@pytest.mark.parametrize("kept_in_tables", [False, True])
def test_a_host_learns_what_a_trace_fails_at(kept_in_tables: bool, tmp_path: Path) -> None:
    fspa = guarded()
    with with_tables() if kept_in_tables else nullcontext():
        assert ("LabelTexts" in write_monitor(fspa, tmp_path)) is kept_in_tables
    (tmp_path / "failures.cs").write_text(FAILURES)
    compile_program(tmp_path, "-out:failures.exe", "failures.cs", "GuardedMonitor.cs")
    lines = [f"{line}\n" for line in failure_lines(fspa)]
    assert run_program(tmp_path, "failures.exe", *ROUNDS) == (0, "".join(lines), "")


def test_labels_of_counting_states_are_also_in_words(tmp_path: Path) -> None:
    fspa = counting()
    write_monitor(fspa, tmp_path)
    sample = "new Tltl.QuietMonitor.Signals { Pit = i == 0 }"
    step = f"System.Console.WriteLine(monitor.Step({sample}).LabelEnglish);"
    code = f"var monitor = new Tltl.QuietMonitor(); for (int i = 0; i < 620; i++) {step}"
    (tmp_path / "labels.cs").write_text(f"static class Labels {{ static void Main() {{ {code} }} }}")
    compile_program(tmp_path, "-out:labels.exe", "labels.cs", "QuietMonitor.cs")
    monitor = Monitor(fspa)
    labels = [label_text(fspa, monitor.step({"pit": float(i == 0)}).state) for i in range(620)]
    assert len(set(labels)) > 500
    assert run_program(tmp_path, "labels.exe") == (0, "".join(f"{label}\n" for label in labels), "")


FORGOTTEN = r"""
using System;
using Monitor = Tltl.GuardedMonitor;

internal static class Forgotten
{
    private static void Main()
    {
        var monitor = new Monitor();
        var sample = Monitor.Signals.Missing;
        Tell(monitor, sample);
        sample.Seen = false;
        Tell(monitor, sample);
        sample.Health = 1.0;
        Tell(monitor, sample);
        sample.Alarm = false;
        // No clause needs it, but it is a signal.
        Tell(monitor, sample);
        sample.Open = true;
        Tell(monitor, sample);
        Tell(monitor, new Monitor.Signals { Health = 1.0 });
        sample = Monitor.Signals.Sparse;
        Tell(monitor, sample);
        sample.Health = 1.0;
        Tell(monitor, sample);
        sample.Seen = true;
        Tell(monitor, sample);
    }

    private static void Tell(Monitor monitor, Monitor.Signals sample)
    {
        Monitor.Result result;
        bool taken = monitor.TryStep(sample, out result);
        Console.WriteLine("{0} {1}", monitor.LastProblem, taken ? result.Verdict.ToString() : monitor.Message());
    }
}
"""


def test_a_forgotten_signal_is_refused_unless_it_is_a_bool_of_a_sparse_sample(tmp_path: Path) -> None:
    write_monitor(guarded(), tmp_path)
    (tmp_path / "forgotten.cs").write_text(FORGOTTEN)
    compile_program(tmp_path, "-out:forgotten.exe", "forgotten.cs", "GuardedMonitor.cs")
    first = [
        "NotSet step 1: the signal `seen` is not set",
        "NotFinite step 1: no finite number for the signal `health`",
        "NotSet step 1: the signal `alarm` is not set",
        "NotSet step 1: the signal `open` is not set",
    ]
    second = [
        "NotSet step 2: the signal `seen` is not set",
        "NotFinite step 2: no finite number for the signal `health`",
    ]
    lines = [*first, "None Holding", *second, "None Holding", "None Violated"]
    assert run_program(tmp_path, "forgotten.exe") == (0, "".join(f"{line}\n" for line in lines), "")


UNITY = r"""
namespace UnityEngine
{
    using System;

    public class Object { }

    public class MonoBehaviour : Object { }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class TooltipAttribute : Attribute { public TooltipAttribute(string text) { } }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class AddComponentMenu : Attribute { public AddComponentMenu(string path) { } }

    public static class Debug
    {
        public static void LogError(object message, Object context) { Console.WriteLine("error: " + message); }

        public static void LogWarning(object message, Object context) { Console.WriteLine("warning: " + message); }
    }

    public static class Time { public const float fixedDeltaTime = 0.5f; }
}

namespace UnityEngine.Events
{
    using System;

    public class UnityEvent
    {
        private Action _called;

        public void AddListener(Action call) { _called += call; }

        public void Invoke() { if (_called != null) _called(); }
    }

    public class UnityEvent<T>
    {
        private Action<T> _called;

        public void AddListener(Action<T> call) { _called += call; }

        public void Invoke(T value) { if (_called != null) _called(value); }
    }
}
"""
"""A stand-in for Unity's library."""

GAME = r"""
internal sealed class Game : Tltl.CoverAndHideMonitorBehaviour
{
    private static void Main()
    {
        var game = new Game();
        game.OnDone.AddListener(() => System.Console.WriteLine("done"));
        game.OnSuccess.AddListener(() => System.Console.WriteLine("success"));
        game.OnViolated.AddListener(() => System.Console.WriteLine("violated"));
        game.OnProgress.AddListener(value => System.Console.WriteLine("progress {0:F2}", value));
        System.Console.WriteLine(game.Step());
        game.OnEnable();
        game.FixedUpdate();
        System.Console.WriteLine(game.Step());
        game.Step();
        game.Signals.DistanceS1 = game.Signals.DistanceS2 = game.Signals.DistanceExit = 20.0;
        game.Signals.Health = 2.0;
        game.StepInFixedUpdate = true;
        game.FixedUpdate();
        game.Signals.DistanceS1 = 0.5;
        game.FixedUpdate();
        game.Signals.Health = 0.0;
        game.FixedUpdate();
        System.Console.WriteLine(game.Step());
        System.Console.WriteLine(game.Result.Verdict);
        game.OnEnable();
        System.Console.WriteLine(game.Monitor.Steps);
        game.RestartWhenEnabled = true;
        game.OnEnable();
        System.Console.WriteLine(game.Monitor.Steps);
        game.Signals.Health = 1.0;
        for (int button = 0; button < 3; button++)
        {
            game.Signals.DistanceS1 = button == 0 ? 0.5 : 20.0;
            game.Signals.DistanceS2 = button == 1 ? 0.5 : 20.0;
            game.Signals.DistanceExit = button == 2 ? 0.5 : 20.0;
            game.FixedUpdate();
        }
        // What comes behind the end changes nothing more.
        game.Signals.Health = 0.0;
        System.Console.WriteLine(game.Step());
        System.Console.WriteLine(game.Result.Verdict);
        // What the last episode was given is forgotten.
        game.Restart();
        System.Console.WriteLine(game.Step());
        game.Parameters.LevelSize = 0.0;
        game.Restart();
        System.Console.WriteLine(game.Step());
    }
}
"""


def test_the_component_for_unity_raises_events_and_reports_errors(tmp_path: Path) -> None:
    write_monitor(cover_and_hide(), tmp_path)
    (tmp_path / "game.cs").write_text(UNITY + GAME)
    sources = ("game.cs", "CoverAndHideMonitor.cs", "CoverAndHideMonitorBehaviour.cs")
    compile_program(tmp_path, "-out:game.exe", *sources)
    lines = [
        *("False", "error: step 1: no finite number for the signal `distance(s1)`", "False"),
        "warning: step 1: the signal `health` is 2, outside [0, 1]: it counts as 1",
        *("progress 0.33", "violated", "done", "False", "Violated"),
        *("3", "0", "progress 0.33", "progress 0.67", "progress 1.00", "success", "done", "False", "Holding"),
        *("error: step 1: no finite number for the signal `distance(s1)`", "False"),
        *("error: the param `level_size` cannot be 0: its range is [2, 10000]", "False"),
    ]
    assert run_program(tmp_path, "game.exe") == (0, "".join(f"{line}\n" for line in lines), "")


HURRY = r"""
internal sealed class Game : Tltl.HurryMonitorBehaviour
{
    private static void Main()
    {
        var game = new Game();
        game.OnDone.AddListener(() => System.Console.WriteLine("done"));
        game.StepInFixedUpdate = true;
        game.Sparse = true;
        game.OnEnable();
        System.Console.WriteLine(game.Step(-0.25) + " " + game.Step(double.NaN));
        game.Signals.X = 0.0;
        game.FixedUpdate();
        game.FixedUpdate();
        System.Console.WriteLine(game.Monitor.RegisterAt(1));
        // The time of a refused sample counts for the next one, but not a wrong time.
        game.Signals.X = double.NaN;
        System.Console.WriteLine(game.Step(0.25) + " " + game.Step(-4.0) + " " + game.Step(double.NaN));
        game.Signals.X = 0.0;
        System.Console.WriteLine(game.Step(0.5) + " " + game.Monitor.RegisterAt(1));
        game.Signals.X = double.NaN;
        game.Restart();
        System.Console.WriteLine(game.Step(9.0));
        game.Restart();
        game.Signals.X = 0.0;
        System.Console.WriteLine(game.Step(0.0) + " " + game.Step(0.125) + " " + game.Monitor.RegisterAt(1));
    }
}
"""


def test_the_component_for_unity_takes_the_time_of_a_frame(tmp_path: Path) -> None:
    signals = "signal late: bool signal x in [0, 1]"
    (fspa,) = compile_text(f"clock varies {signals} spec hurry {{ keep time_holding(not late) <= 1 s or x > 0.5 }}")
    write_monitor(fspa, tmp_path)
    (tmp_path / "game.cs").write_text(f"#pragma warning disable 1591\n{UNITY}{HURRY}")
    sources = ("game.cs", "HurryMonitor.cs", "HurryMonitorBehaviour.cs")
    compile_program(tmp_path, "-out:game.exe", "-doc:game.xml", *sources)
    refused = "error: step 1: its time since the sample before is -0.25, not a number of seconds"
    missing = ": no finite number for the signal `x`"
    lines = [refused, "False False", "0.5", f"error: step 3{missing}", "False False False", "done", "True 1.25"]
    lines += [f"error: step 1{missing}", "False", "True True 0.125"]
    assert run_program(tmp_path, "game.exe") == (0, "".join(f"{line}\n" for line in lines), "")


# --- as a program ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("program")
    write_monitor(cover_and_hide(), folder)
    compile_program(folder, "-define:TLTL_MAIN", "CoverAndHideMonitor.cs", "CoverAndHideMonitorProgram.cs")
    return folder


@pytest.mark.parametrize("culture", ["de_DE.UTF-8", "tr_TR.UTF-8", "ar_SA.UTF-8"])
def test_the_program_prints_the_same_numbers_in_other_cultures(program: Path, culture: str) -> None:
    """Some cultures write numbers with commas, or a capital i with a dot."""
    samples = [{**FAR, "distance(s1)": 0.25}, {**FAR, "distance(s2)": 7.5}, {**FAR, "health": -1.5}]
    result = subprocess.run(
        ["mono", "CoverAndHideMonitor.exe", "--full", "-"],
        input=trace_of(samples, [*FAR]).encode(),
        capture_output=True,
        cwd=program,
        env={**os.environ, "LC_ALL": culture},
    )
    assert (result.returncode, result.stdout.decode(), result.stderr.decode()) == expected(cover_and_hide(), samples)


def test_public_members_have_comments(tmp_path: Path) -> None:
    """This includes signals and params without a doc in the spec."""
    fspa = cover_and_hide()
    fspa = replace(
        fspa,
        signals=tuple(replace(signal, doc="<b> & *") for signal in fspa.signals[:1])
        + tuple(replace(signal, doc="") for signal in fspa.signals[1:]),
        params=tuple(replace(param, doc="") for param in fspa.params),
    )
    write_monitor(fspa, tmp_path)
    (tmp_path / "game.cs").write_text(f"#pragma warning disable 1591\n{UNITY}{GAME}")
    sources = ("game.cs", "CoverAndHideMonitor.cs", "CoverAndHideMonitorBehaviour.cs")
    compile_program(tmp_path, "-out:game.exe", "-doc:game.xml", *sources)
    assert "A ratio in [0, 1]." in (tmp_path / "game.xml").read_text()


DECIMALS = r"""
using System;
using Decimals = Tltl.CoverAndHideMonitorProgram.Decimals;

internal static class Numbers
{
    private static void Main()
    {
        string line;
        while ((line = Console.ReadLine()) != null)
        {
            double value;
            bool read = Decimals.Parse(line, out value);
            Console.WriteLine("{0} {1:x16} {2}", read, BitConverter.DoubleToInt64Bits(value), Decimals.Text(-value));
        }
    }
}
"""


def test_decimals_are_exact(program: Path) -> None:
    """Ties in the last digit, powers of two and ten, and numbers that Mono's own functions round wrongly."""
    values = [0.5**power for power in range(0, 1075, 7)] + [10.0**power for power in range(-323, 309)]
    values += [(2 * odd + 1) / 2.0**power for power in range(1, 60) for odd in (3, 5461, 131071, 200003)]
    values += [numerator / 97 for numerator in range(98)] + [0.00454510748386383, 3.220574384798567e-232, 5e-324]
    texts = [repr(value) for value in values]
    texts += [
        "9007199254740993",
        "9007199254740993.00001",
        "1e23",
        "1.7976931348623159e308",
        "2e-324",
        "3e-324",
        ".5",
        "5.",
    ]
    (program / "numbers.cs").write_text(DECIMALS)
    words = ("-define:TLTL_MAIN", "-main:Numbers", "-out:numbers.exe", "numbers.cs")
    compile_program(program, *words, "CoverAndHideMonitor.cs", "CoverAndHideMonitorProgram.cs")
    status, out, err = run_program(program, "numbers.exe", stdin="".join(f"{text}\n" for text in texts).encode())
    assert (status, err) == (0, "")
    for text, line in zip(texts, out.splitlines(), strict=True):
        bits = struct.pack(">d", float(text)).hex()
        assert line == f"True {bits} {-float(text):.17g}", text
