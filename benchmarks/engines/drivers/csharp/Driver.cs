// Runs the generated and the handwritten monitor over the same traces, which have a line of numbers for each sample.
//
//     driver rows TRACE...               a row for each step, first of the generated, then of the handwritten one
//     driver time ROUNDS SECONDS TRACE   JSON lines: steps per second of CPU time in each round

using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;

public abstract class Pass
{
    public abstract void Load(double[][] rows);
    public abstract void Run();
    public abstract double Rewards();
    public abstract void Print();
}

internal static class Driver
{
    private static readonly Pass[] Passes = {new Generated(), new ByHandPass()};

    private static int Load(string path)
    {
        var rows = File.ReadLines(path).Select(
            line => line.Split(' ').Select(cell => double.Parse(cell, CultureInfo.InvariantCulture)).ToArray());
        var loaded = rows.ToArray();
        foreach (var pass in Passes) pass.Load(loaded);
        return loaded.Length;
    }

    // CPU time of this process in microseconds; .NET rounds its own figure to hundredths of a second.
    [DllImport("libc", EntryPoint = "clock")]
    private static extern IntPtr Clock();

    private static double SecondsOf(Pass pass, long count)
    {
        long started = Clock().ToInt64();
        for (long i = 0; i < count; i++) pass.Run();
        return (Clock().ToInt64() - started) / 1e6;
    }

    private static void Time(int rounds, double enoughSeconds, int samples)
    {
        var repeats = new long[] {1, 1};
        for (int who = 0; who < 2; who++)
        {
            while (SecondsOf(Passes[who], repeats[who]) < enoughSeconds) repeats[who] *= 2;
        }
        for (int round = 0; round < rounds; round++)
        {
            var rates = new double[2];
            for (int who = 0; who < 2; who++)
            {
                rates[who] = (double)samples * repeats[who] / SecondsOf(Passes[who], repeats[who]);
            }
            Console.WriteLine(string.Format(CultureInfo.InvariantCulture,
                "{{\"generated\": {0:F0}, \"by_hand\": {1:F0}, \"rewards\": [{2:R}, {3:R}]}}",
                rates[0], rates[1], Passes[0].Rewards(), Passes[1].Rewards()));
        }
    }

    private static void Main(string[] words)
    {
        if (words[0] == "time")
        {
            int rounds = int.Parse(words[1], CultureInfo.InvariantCulture);
            Time(rounds, double.Parse(words[2], CultureInfo.InvariantCulture), Load(words[3]));
            return;
        }
        foreach (var path in words.Skip(1))
        {
            Load(path);
            foreach (var pass in Passes)
            {
                pass.Run();
                pass.Print();
            }
        }
    }
}
