// Times steps of monitors that count: `steps ROUNDS MONITORS` prints nanoseconds of CPU time per step, as JSON lines.
// `first` is the time of the first steps of a count, and `last` that of the last ones.

using System;
using System.Globalization;
using System.Runtime.InteropServices;

internal static class Steps
{
    private const int Count = 20, Before = 570;

    // CPU time of this process in microseconds; .NET rounds its own figure to hundredths of a second.
    [DllImport("libc", EntryPoint = "clock")]
    private static extern IntPtr Clock();

    private static void Step(Tltl.QuietMonitor monitor, bool pit)
    {
        var sample = Tltl.QuietMonitor.Signals.Missing;
        sample.Pit = pit;
        Tltl.QuietMonitor.Result result;
        if (!monitor.TryStep(sample, out result)) throw new InvalidOperationException(monitor.Message());
    }

    private static double Nanoseconds(Tltl.QuietMonitor[] monitors, int before)
    {
        foreach (var monitor in monitors)
        {
            monitor.Reset();
            Step(monitor, true);
            for (int i = 0; i < before; i++) Step(monitor, false);
        }
        long start = Clock().ToInt64();
        foreach (var monitor in monitors)
        {
            for (int i = 0; i < Count; i++) Step(monitor, false);
        }
        return (Clock().ToInt64() - start) * 1e3 / ((double)monitors.Length * Count);
    }

    private static void Main(string[] words)
    {
        var monitors = new Tltl.QuietMonitor[int.Parse(words[1], CultureInfo.InvariantCulture)];
        for (int i = 0; i < monitors.Length; i++) monitors[i] = new Tltl.QuietMonitor();
        for (int round = int.Parse(words[0], CultureInfo.InvariantCulture); round > 0; round--)
        {
            double first = Nanoseconds(monitors, 0), last = Nanoseconds(monitors, Before);
            string numbers = string.Format(CultureInfo.InvariantCulture, "\"first\": {0:F3}, \"last\": {1:F3}", first, last);
            Console.WriteLine("{" + numbers + "}");
        }
    }
}
