// Passes of one monitor over a trace.

using System;
using System.Globalization;
using System.Linq;
using Monitor = @MONITOR@;
using Result = @RESULT@;
using Signals = @SIGNALS@;

public sealed class @PASS@ : Pass
{
    private readonly Monitor _monitor = new Monitor();
    private Signals[] _samples;
    private Result[] _results;

    public override void Load(double[][] rows)
    {
        _samples = rows.Select(row => new Signals {@ASSIGNMENTS@}).ToArray();
        _results = new Result[rows.Length];
    }

    public override void Run()
    {
        _monitor.Reset();
        for (int i = 0; i < _samples.Length; i++) _results[i] = _monitor.Step(_samples[i]);
    }

    public override double Rewards()
    {
        return _results.Sum(result => result.Reward);
    }

    public override void Print()
    {
        foreach (var result in _results)
        {
            var cells = new[]
            {
                "@WHO@", result.State.ToString(CultureInfo.InvariantCulture), result.Label,
                result.Verdict.ToString().ToLowerInvariant(), result.Accepting ? "true" : "false",
                result.Done ? "true" : "false", Exact(result.Progress), Exact(result.Reward),
                Exact(result.Robustness), result.Limiting, result.LabelEnglish, result.FailedClause,
                result.FailedAtom, result.FailedStep > 0 ? result.FailedStep.ToString() : ""
            };
            Console.WriteLine(string.Join("\t", cells));
        }
    }

    private static string Exact(double number)
    {
        return number.ToString("G17", CultureInfo.InvariantCulture);
    }
}
