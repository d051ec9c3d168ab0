// The game of the conformance script in C#; `tests/runtime/wire/conversation.py` describes it.
//
// Usage: Counter.exe [--listen PORT]

using System;
using System.Collections.Generic;
using Tltl;

/// <summary>Counts up to the goal, and in the variant `trap` never down to 0.</summary>
internal sealed class Counter : IGame, IReleases, IScreenshots, IOutlines
{
    private struct Place
    {
        public int Goal, Position, Moves;
        public bool HasTrap;
    }

    private readonly List<Place?> _snapshots = new List<Place?>();
    private Place _now = new Place {Goal = 5, Position = 1};

    public Message Hello
    {
        get
        {
            return new Message
            {
                {"name", "counter"},
                {"clock_hz", 10},
                {"signals", new Message
                {
                    {"position", new Message {{"range", new[] {0, 10}}}},
                    {"moves", new Message {{"range", new object[] {0, null}}}},
                    {"at_goal", new Message {{"type", "bool"}}},
                }},
                {"params", new Message {{"goal", 10}}},
                {"actions", new Message {{"type", "discrete"}, {"n", 3}}},
                {"observation", new Message
                {
                    {"type", "box"}, {"low", 0}, {"high", 10}, {"shape", new[] {1}}, {"dtype", "float32"},
                }},
                {"scenes", new[] {"short", "long"}},
                {"capabilities", new[] {"seed", "positions"}},
            };
        }
    }

    /// <summary>Begins at 1 + seed mod 4.</summary>
    public State Reset(string scene, string variant, long? seed)
    {
        scene = scene ?? "short";
        if (scene != "short" && scene != "long") throw new Refusal("there is no scene `" + scene + "`");
        if (variant != "v0" && variant != "trap") throw new Refusal("there is no variant `" + variant + "`");
        _now = new Place
        {
            Goal = scene == "short" ? 5 : 10,
            HasTrap = variant == "trap",
            Position = 1 + (int)((seed ?? 0) % 4),
        };
        return Now();
    }

    /// <summary>Moves left (0), stays (1) or moves right (2).</summary>
    public State Step(object action)
    {
        _now.Position = Math.Min(Math.Max(_now.Position + TltlClient.Int(action) - 1, 0), 10);
        _now.Moves++;
        return Now();
    }

    /// <summary>Keeps the state; the ids are 1, 2, 3 and so on.</summary>
    public object Snapshot()
    {
        _snapshots.Add(_now);
        return _snapshots.Count;
    }

    public State Restore(object id)
    {
        _now = Kept(TltlClient.Int(id));
        return Now();
    }

    public void Release(object id)
    {
        Kept(TltlClient.Int(id));
        _snapshots[TltlClient.Int(id) - 1] = null;
    }

    private Place Kept(int number)
    {
        Place? kept = number < 1 || number > _snapshots.Count ? null : _snapshots[number - 1];
        if (kept == null) throw new Refusal("there is no snapshot " + number);
        return kept.Value;
    }

    /// <summary>Draws a row of 11 black pixels; that of the player is white.</summary>
    public object Screenshot()
    {
        var pixels = new byte[33];
        for (int i = 0; i < 3; i++) pixels[3 * _now.Position + i] = 255;
        return TltlClient.Array(pixels, "uint8", 1, 11, 3);
    }

    /// <summary>Says what maps show: the edges of the row, the goal, and the trap if there is one.</summary>
    public object Outline()
    {
        if (_now.HasTrap && _now.Goal == 5) throw new Refusal("there is no outline of the trap in `short`");
        var edges = new[] {Corners(-1, -1, -0.5, 2), Corners(10.5, -1, 11, 2)};
        var polygons = new Message();
        if (_now.HasTrap) polygons["trap"] = new[] {new[] {-0.5, -1}, new[] {0.5, -1}, new[] {0.0, 2}};
        return new Message
        {
            {"bounds", Corners(-1, -2, 11, 3)},
            {"boxes", new Message {{"edge", edges}}},
            {"polygons", polygons},
            {"regions", new Message {{"goal", Corners(_now.Goal - 0.5, -1, 10.5, 2)}}},
            {"image", new Message
            {
                {"pixels", TltlClient.Array(new byte[] {255, 255, 255}, "uint8", 1, 1, 3)},
                {"extent", new[] {-0.5, -1, 10.5, 2}},
            }},
        };
    }

    private static double[][] Corners(double west, double south, double east, double north)
    {
        return new[] {new[] {west, south}, new[] {east, north}};
    }

    private State Now()
    {
        bool atGoal = _now.Position >= _now.Goal;
        bool isTrapped = _now.HasTrap && _now.Position == 0;
        return new State(
            signals: new Message {{"position", _now.Position}, {"moves", _now.Moves}, {"at_goal", atGoal}},
            observation: new[] {_now.Position},
            ended: atGoal || isTrapped,
            cause: atGoal ? "goal" : isTrapped ? "trap" : null,
            positions: new Message {{"player", new[] {_now.Position, 0}}});
    }

    private static int Main(string[] words)
    {
        var game = new Counter();
        if (words.Length < 2 || words[0] != "--listen") return TltlClient.Play(game);
        try
        {
            while (true)
            {
                int status = TltlClient.Play(game, TltlClient.Listen(TltlClient.GameHello(game), int.Parse(words[1])));
                if (status != 0) return status;
            }
        }
        catch (Disconnected error)
        {
            Console.Error.WriteLine(error.Message);
            return 1;
        }
    }
}
