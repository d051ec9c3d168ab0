// The hall: fetch the key, then leave by the door. Spikes end the game.
//
// A level is a text: `#` is a wall, `K` the key, `D` the door, `^` spikes. The player begins on a dot. This file needs
// no Unity, so that the game also runs without it.

using System;
using System.Collections.Generic;
using System.IO;
using Tltl;

public sealed class Hall : IGame
{
    private static readonly int[][] Moves =
    {
        new[] {0, 1}, new[] {0, -1}, new[] {-1, 0}, new[] {1, 0}, // up, down, left, right
    };

    public static readonly string[] Signals = {"has_key", "at_door", "on_spikes"};

    public const double ClockHz = 10;

    private readonly string _folder;
    private readonly Dictionary<string, double[]> _things = new Dictionary<string, double[]>();

    /// <summary><paramref name="folder"/> has the levels.</summary>
    public Hall(string folder = "levels")
    {
        _folder = folder;
    }

    /// <summary>The rows of the level, from south to north.</summary>
    public string[] Rows { get; private set; }

    public int X { get; private set; }

    public int Y { get; private set; }

    public bool HasKey { get; private set; }

    public Message Hello
    {
        get
        {
            var signals = new Message();
            foreach (string name in Signals) signals[name] = new Message {{"type", "bool"}};
            return new Message
            {
                {"name", "hall"},
                {"clock_hz", ClockHz},
                {"signals", signals},
                {"actions", new Message {{"type", "discrete"}, {"n", Moves.Length}}},
                {"observation", new Message {{"type", "multi_discrete"}, {"nvec", new[] {9, 6}}}}, // a level, in cells
                {"scenes", new[] {"hall"}},
                {"capabilities", new[] {"seed", "positions"}},
            };
        }
    }

    /// <summary>Begins an episode, and returns its first state.</summary>
    public State Reset(string scene, string variant, long? seed)
    {
        if (scene != null && scene != "hall") throw new Refusal("there is no scene `" + scene + "`");
        if (variant != "v0") throw new Refusal("there is no variant `" + variant + "`");
        Rows = File.ReadAllText(Path.Combine(_folder, "hall.txt")).Split(new char[0], StringSplitOptions.RemoveEmptyEntries);
        Array.Reverse(Rows);
        var starts = new List<int[]>();
        _things.Clear();
        for (int y = 0; y < Rows.Length; y++)
        {
            for (int x = 0; x < Rows[y].Length; x++)
            {
                char mark = Rows[y][x];
                if (mark == '.') starts.Add(new[] {x, y});
                string name = mark == 'K' ? "key" : mark == 'D' ? "door" : mark == '^' ? "spikes" : null;
                if (name != null) _things[name] = new[] {x + 0.5, y + 0.5};
            }
        }
        int[] start = starts[(int)((seed ?? 0) % starts.Count)];
        X = start[0];
        Y = start[1];
        HasKey = false;
        return Now();
    }

    /// <summary>Plays one tick, and returns the state.</summary>
    public State Step(object action)
    {
        int[] move = Moves[TltlClient.Int(action)];
        if (Rows[Y + move[1]][X + move[0]] != '#')
        {
            X += move[0];
            Y += move[1];
        }
        HasKey = HasKey || Rows[Y][X] == 'K';
        return Now();
    }

    public State Now()
    {
        char here = Rows[Y][X];
        bool onSpikes = here == '^';
        var positions = new Message {{"player", new[] {X + 0.5, Y + 0.5}}};
        foreach (KeyValuePair<string, double[]> thing in _things) positions[thing.Key] = thing.Value;
        var signals = new Message {{"has_key", HasKey}, {"at_door", here == 'D'}, {"on_spikes", onSpikes}};
        return new State(signals, new[] {X, Y}, onSpikes, onSpikes ? "spikes" : null, positions);
    }
}
