// Connect a game in C# to tltlc, and record the play of a person: copy this file into your game.
//
// It needs C# 6 and nothing else: Unity, Mono and .NET compile it as it is. A game is a class that implements IGame,
// and ISnapshots, IScreenshots and IOutlines if it can do what they ask:
//
//     using Tltl;
//
//     public sealed class Walk : IGame
//     {
//         private int _position;
//
//         public Message Hello
//         {
//             get
//             {
//                 return new Message
//                 {
//                     {"name", "walk"},
//                     {"clock_hz", 10},
//                     {"signals", new Message
//                     {
//                         {"position", new Message {{"range", new[] {0, 10}}}},
//                         {"at_goal", new Message {{"type", "bool"}}},
//                     }},
//                     {"actions", new Message {{"type", "discrete"}, {"n", 3}}},
//                     {"observation", new Message {{"type", "box"}, {"low", 0}, {"high", 10}, {"shape", new[] {1}}}},
//                     {"scenes", new[] {"short", "long"}},
//                     {"capabilities", new[] {"seed"}},
//                 };
//             }
//         }
//
//         // Begin an episode, and return its first state.
//         public State Reset(string scene, string variant, long? seed)
//         {
//             if (variant != "v0") throw new Refusal("there is no variant `" + variant + "`");
//             _position = (int)((seed ?? 0) % 4);
//             return Now();
//         }
//
//         // Play one tick, and return the state.
//         public State Step(object action)
//         {
//             _position = System.Math.Max(_position + TltlClient.Int(action) - 1, 0);
//             return Now();
//         }
//
//         private State Now()
//         {
//             bool atGoal = _position >= 5;
//             var signals = new Message {{"position", _position}, {"at_goal", atGoal}};
//             return new State(signals, new[] {_position}, ended: atGoal, cause: atGoal ? "goal" : null);
//         }
//
//         private static int Main() { return TltlClient.Play(new Walk()); }
//     }
//
// In Unity, put a component such as this on one object of the first scene. The clock of the game stands still until
// tltlc asks for a tick; what your game does in FixedUpdate belongs into Tick. In the game file, write
// `process = ["./walk.x86_64", "-batchmode", "-nographics"]`.
//
//     using Tltl;
//     using UnityEngine;
//
//     public abstract class TltlGame : MonoBehaviour, IGame
//     {
//         private Client _client;
//
//         public abstract Message Hello { get; }
//         public abstract State Reset(string scene, string variant, long? seed);
//         protected abstract void Tick(object action);    // move the game by one tick
//         protected abstract State Now();                 // the state of the game
//
//         public State Step(object action)
//         {
//             Tick(action);
//             Physics.Simulate(Time.fixedDeltaTime);
//             return Now();
//         }
//
//         private void Start()
//         {
//             // Without tltlc, a person plays, and a Recorder can write it down.
//             if (string.IsNullOrEmpty(System.Environment.GetEnvironmentVariable("TLTL_PORT"))) return;
//             // Unity calls FixedUpdate no more, and moves nothing by itself. (Before Unity 2022.2:
//             // Physics.autoSimulation = false.)
//             Time.timeScale = 0;
//             Physics.simulationMode = SimulationMode.Script;
//             QualitySettings.vSyncCount = 0;
//             try { _client = new Client(TltlClient.GameHello(this)); }
//             catch (Disconnected error) { Quit(error.Message); }
//         }
//
//         private void Update()
//         {
//             if (_client == null) return;
//             try
//             {
//                 Request request = _client.Request();    // waits
//                 if (request.Kind == "close") Quit("");
//                 else TltlClient.Answer(this, _client, request);
//             }
//             catch (Disconnected error) { Quit(error.Message); }
//         }
//
//         private void Quit(string reason)
//         {
//             if (_client != null) _client.Close();
//             _client = null;
//             if (reason != "") System.Console.Error.WriteLine(reason);
//             Application.Quit(reason == "" ? 0 : 1);
//         }
//     }
//
// A class `Message` is an object of JSON: names and their values, which are null, bools, numbers, texts, arrays, lists
// and dictionaries. Received whole numbers are of the type long, others of the type double; use TltlClient.Int and
// TltlClient.Numbers to convert actions. A float is sent with exactly its value. In positions, x points east, y north
// and z up: those of Unity are `new[] {p.x, p.z, p.y}`. Outlines have the same axes. In Unity, the box of a collider,
// with `b = collider.bounds`, is `new[] {new[] {b.min.x, b.min.z, b.min.y}, new[] {b.max.x, b.max.z, b.max.y}}`.
//
// `docs/wire.md` of tltlc describes the protocol.

namespace Tltl
{
    using System;
    using System.Collections;
    using System.Collections.Generic;
    using System.Globalization;
    using System.IO;
    using System.Net;
    using System.Net.Sockets;
    using System.Text;

    /// <summary>
    /// Throw this in a method of the game if a request cannot be met. tltlc shows the text, which says why.
    /// </summary>
    public sealed class Refusal : Exception
    {
        public Refusal(string reason) : base(reason) { }
    }

    /// <summary>
    /// Thrown if tltlc has closed the connection, or refuses this game. The text says why; it is empty if that is
    /// unknown.
    /// </summary>
    public sealed class Disconnected : Exception
    {
        public Disconnected(string reason = "") : base(reason) { }
    }

    /// <summary>An object of JSON: values by name.</summary>
    public sealed class Message : Dictionary<string, object>
    {
    }

    /// <summary>The state of the game after a reset or a tick.</summary>
    public sealed class State
    {
        public readonly IDictionary Signals;
        public readonly object Observation;
        public readonly bool Ended;
        public readonly string Cause;
        public readonly IDictionary Positions;

        /// <summary>
        /// <paramref name="signals"/> are numbers in SI units and bools, by name. <paramref name="ended"/> says whether
        /// the episode has ended, and <paramref name="cause"/> who or what ended it. <paramref name="positions"/> are
        /// arrays of two or three coordinates in metres, by the name of the entity; the player's name is `player`.
        /// </summary>
        public State(
            IDictionary signals, object observation = null, bool ended = false, string cause = null,
            IDictionary positions = null)
        {
            if (signals == null) throw new ArgumentNullException(nameof(signals));
            Signals = signals;
            Observation = observation;
            Ended = ended;
            Cause = cause;
            Positions = positions;
        }

        internal Message Content()
        {
            var message = new Message {{"signals", Signals}, {"ended", Ended}, {"cause", Cause}};
            if (Observation != null) message["observation"] = Observation;
            if (Positions != null) message["positions"] = Positions;
            return message;
        }
    }

    /// <summary>What tltlc asks for.</summary>
    public sealed class Request
    {
        internal Request(string kind, object body)
        {
            Kind = kind;
            Body = body as Message ?? new Message();
        }

        /// <summary>
        /// The kind of the request: `reset`, `step`, `snapshot`, `restore`, `release`, `screenshot`, `outline`,
        /// `close`, or another word.
        /// </summary>
        public string Kind { get; private set; }

        /// <summary>All that the request contains.</summary>
        public Message Body { get; private set; }

        /// <summary>The scene of a reset; null if tltlc names none.</summary>
        public string Scene { get { return Optional("scene") as string; } }

        /// <summary>The variant of a reset, by default `v0`.</summary>
        public string Variant { get { return Optional("variant") as string ?? "v0"; } }

        /// <summary>The seed of a reset; null if tltlc gives none.</summary>
        public long? Seed { get { return Optional("seed") == null ? (long?)null : TltlClient.Whole(Body["seed"]); } }

        /// <summary>The action of a step.</summary>
        public object Action { get { return Needed("action"); } }

        /// <summary>How many ticks a step has, by default 1.</summary>
        public int Repeat { get { return Optional("repeat") == null ? 1 : TltlClient.Int(Body["repeat"]); } }

        /// <summary>The id of the snapshot to return to, or to let go: a long or a string.</summary>
        public object Id { get { return Needed("id"); } }

        private object Optional(string key)
        {
            object value;
            return Body.TryGetValue(key, out value) ? value : null;
        }

        private object Needed(string key)
        {
            object value = Optional(key);
            if (value == null) throw new Refusal("the request `" + Kind + "` has no `" + key + "`");
            return value;
        }
    }

    /// <summary>A game that moves only when it is asked to.</summary>
    public interface IGame
    {
        /// <summary>The declaration of the game, without version and token.</summary>
        Message Hello { get; }

        /// <summary>
        /// Begins an episode, and returns its first state. <paramref name="scene"/> is null if the game has no scenes,
        /// and <paramref name="seed"/> if it takes none.
        /// </summary>
        State Reset(string scene, string variant, long? seed);

        /// <summary>Plays one tick, and returns the state.</summary>
        State Step(object action);
    }

    /// <summary>A game that can keep its state.</summary>
    public interface ISnapshots
    {
        /// <summary>Keeps the state of the game, and returns an id: a whole number or a text.</summary>
        object Snapshot();

        /// <summary>Returns to a snapshot, and returns the state. The id is a long or a string.</summary>
        State Restore(object id);
    }

    /// <summary>A game that can let its snapshots go.</summary>
    public interface IReleases : ISnapshots
    {
        /// <summary>Forgets a snapshot: there will be no return to it. The id is a long or a string.</summary>
        void Release(object id);
    }

    /// <summary>A game that can draw itself.</summary>
    public interface IScreenshots
    {
        /// <summary>Returns a picture; see <see cref="TltlClient.Array"/>.</summary>
        object Screenshot();
    }

    /// <summary>A game that can say what maps of it show.</summary>
    public interface IOutlines
    {
        /// <summary>Returns the outline of the current scene and variant, in metres.</summary>
        /// <example>
        /// <code>
        /// var wall = new[] {new[] {new[] {0, 0}, new[] {8, 1}}, new[] {new[] {8, 0}, new[] {9, 6}}}; // two boxes
        /// return new Message {{"boxes", new Message {{"wall", wall}}}};
        /// </code>
        /// </example>
        object Outline();
    }

    /// <summary>Plays games, and makes and reads parts of messages.</summary>
    public static class TltlClient
    {
        public const int Protocol = 1;
        internal const int LongestLine = 1 << 25;
        private const int LongestFirstLine = 1 << 16;

        /// <summary>
        /// Connects to tltlc and answers its requests, until it closes the connection; returns the exit status for the
        /// process.
        /// </summary>
        /// <remarks>
        /// If tltlc refuses the game, or has not started it, the status is 1, and standard error says why. If the
        /// game is started first and tltlc connects to it, pass a <paramref name="client"/>, and play again after
        /// each connection. A game that is IDisposable is disposed at the end of each: the next one needs a new game.
        /// <code>
        /// while (TltlClient.Play(game, TltlClient.Listen(TltlClient.GameHello(game), 5000)) == 0) { }
        /// </code>
        /// </remarks>
        public static int Play(IGame game, Client client = null)
        {
            try
            {
                client = client ?? new Client(GameHello(game));
                while (true)
                {
                    Request request = client.Request();
                    if (request.Kind == "close") return 0;
                    Answer(game, client, request);
                }
            }
            catch (Disconnected error)
            {
                if (error.Message.Length == 0) return 0;
                Console.Error.WriteLine(error.Message);
                return 1;
            }
            finally
            {
                if (client != null) client.Close();
                var disposable = game as IDisposable;
                if (disposable != null) disposable.Dispose();
            }
        }

        /// <summary>Lets the game meet one request other than `close`, and answers.</summary>
        /// <exception cref="Disconnected">tltlc has closed the connection.</exception>
        public static void Answer(IGame game, Client client, Request request)
        {
            try
            {
                client.Answer(AnswerOf(game, request));
            }
            catch (Refusal refusal)
            {
                client.Refuse(refusal.Message);
            }
        }

        /// <summary>
        /// Returns the `hello` of a game, with the capabilities `snapshot`, `release`, `screenshot` and `outline` if it
        /// has the methods.
        /// </summary>
        public static Message GameHello(IGame game)
        {
            var hello = new Message();
            foreach (KeyValuePair<string, object> part in game.Hello) hello[part.Key] = part.Value;
            var words = new SortedSet<string>(StringComparer.Ordinal);
            object declared;
            if (hello.TryGetValue("capabilities", out declared))
            {
                foreach (object word in (IEnumerable)declared) words.Add((string)word);
            }
            if (game is ISnapshots) words.Add("snapshot");
            if (game is IReleases) words.Add("release");
            if (game is IScreenshots) words.Add("screenshot");
            if (game is IOutlines) words.Add("outline");
            hello["capabilities"] = words;
            return hello;
        }

        /// <summary>Returns a large array, such as a picture, for a message.</summary>
        /// <param name="data">The bytes of the array, little-endian; the last index changes fastest.</param>
        /// <param name="dtype">A word such as `uint8`.</param>
        /// <param name="shape">The lengths, such as 84, 84, 3.</param>
        public static Message Array(byte[] data, string dtype, params int[] shape)
        {
            return new Message {{"base64", Convert.ToBase64String(data)}, {"dtype", dtype}, {"shape", shape}};
        }

        /// <summary>Returns a whole number of a message, such as a discrete action.</summary>
        /// <exception cref="Refusal">The value is no whole number.</exception>
        public static int Int(object value)
        {
            long number = Whole(value);
            if (number < int.MinValue || number > int.MaxValue) throw new Refusal(number + " is too large");
            return (int)number;
        }

        /// <summary>Returns a list of numbers of a message, such as the action of a box.</summary>
        /// <exception cref="Refusal">The value is no list of numbers.</exception>
        public static double[] Numbers(object value)
        {
            var items = value as List<object>;
            if (items == null) throw new Refusal("expected a list of numbers, received " + Json.Text(value));
            var numbers = new double[items.Count];
            for (int i = 0; i < numbers.Length; i++)
            {
                if (!(items[i] is long) && !(items[i] is double))
                {
                    throw new Refusal("expected a number, received " + Json.Text(items[i]));
                }
                numbers[i] = Convert.ToDouble(items[i], CultureInfo.InvariantCulture);
            }
            return numbers;
        }

        /// <summary>Waits on a port of 127.0.0.1 until tltlc connects; returns the Client.</summary>
        /// <remarks>
        /// Use this if the game file has <c>connect = "127.0.0.1:PORT"</c>. The default of <paramref name="token"/> is
        /// the environment variable TLTL_TOKEN. If the token is not empty, tltlc must send the same one. While one
        /// tltlc plays, no other can connect.
        /// </remarks>
        /// <exception cref="Disconnected">Another program uses the port.</exception>
        public static Client Listen(IDictionary hello, int port, string token = null)
        {
            token = token ?? Environment.GetEnvironmentVariable("TLTL_TOKEN") ?? "";
            while (true)
            {
                var line = new LineConnection(Accepted(port));
                string reason = RefusalOf(line, token);
                if (reason == "") return new Client(hello, line);
                try
                {
                    line.Write(Json.Text(new Message {{"error", new Message {{"message", reason}}}}));
                }
                catch (SocketException)
                {
                    // The other program has gone already.
                }
                line.Close();
            }
        }

        internal static long Whole(object value)
        {
            if (value is long) return (long)value;
            double number = value is double ? (double)value : double.NaN;
            if (Math.Abs(number) <= 1L << 53 && Math.Floor(number) == number) return (long)number;
            throw new Refusal("expected a whole number, received " + Json.Text(value));
        }

        private static Message AnswerOf(IGame game, Request request)
        {
            var snapshots = game as ISnapshots;
            var releases = game as IReleases;
            var screenshots = game as IScreenshots;
            var outlines = game as IOutlines;
            if (request.Kind == "reset")
            {
                return StateMessage(game.Reset(request.Scene, request.Variant, request.Seed));
            }
            if (request.Kind == "step")
            {
                object action = request.Action;
                State state = game.Step(action);
                for (int left = request.Repeat - 1; left > 0 && !state.Ended; left--) state = game.Step(action);
                return StateMessage(state);
            }
            if (request.Kind == "snapshot" && snapshots != null)
            {
                return new Message {{"snapshot", new Message {{"id", snapshots.Snapshot()}}}};
            }
            if (request.Kind == "restore" && snapshots != null) return StateMessage(snapshots.Restore(request.Id));
            if (request.Kind == "release" && releases != null)
            {
                releases.Release(request.Id);
                return new Message {{"release", new Message {{"id", request.Id}}}};
            }
            if (request.Kind == "screenshot" && screenshots != null)
            {
                return new Message {{"screenshot", screenshots.Screenshot()}};
            }
            if (request.Kind == "outline" && outlines != null) return new Message {{"outline", outlines.Outline()}};
            throw new Refusal("this game does not know the request `" + request.Kind + "`");
        }

        internal static Message StateMessage(State state)
        {
            return new Message {{"state", state.Content()}};
        }

        private static Socket Accepted(int port)
        {
            var server = new TcpListener(IPAddress.Loopback, port);
            try
            {
                server.Start(1);
            }
            catch (SocketException error)
            {
                throw new Disconnected(
                    "cannot listen on port " + port + ": " + error.Message + "; does this game run twice?");
            }
            try
            {
                return server.AcceptSocket();
            }
            finally
            {
                server.Stop();
            }
        }

        /// <summary>Returns why the game refuses the first line of tltlc; empty if it accepts the line.</summary>
        private static string RefusalOf(LineConnection line, string token)
        {
            Message hello;
            try
            {
                string text = line.Read(LongestFirstLine);
                var message = text == null ? null : Json.Parse(text) as Message;
                object body = null;
                if (message != null) message.TryGetValue("hello", out body);
                hello = body as Message;
            }
            catch (FormatException)
            {
                hello = null;
            }
            if (hello == null) return "the first line must be a `hello`";
            object version, sent;
            hello.TryGetValue("tltl", out version);
            hello.TryGetValue("token", out sent);
            if (!Equals(version, (long)Protocol)) return "this game speaks version " + Protocol + " of the protocol";
            if (token != "" && sent as string != token)
            {
                return "the token is wrong: start tltlc with the variable TLTL_TOKEN of this game";
            }
            return "";
        }
    }

    /// <summary>A connection to tltlc, which sends `hello` at once.</summary>
    public sealed class Client : IDisposable
    {
        private static readonly string[] Kinds =
        {
            "reset", "step", "snapshot", "restore", "release", "screenshot", "outline", "close"
        };
        private readonly LineConnection _line;

        /// <summary>Connects to tltlc.</summary>
        /// <param name="hello">The declaration of the game, without version and token.</param>
        /// <param name="port">The port of tltlc; by default that in the environment variable TLTL_PORT.</param>
        /// <param name="token">By default that in the environment variable TLTL_TOKEN.</param>
        /// <exception cref="Disconnected">No tltlc can be reached.</exception>
        public Client(IDictionary hello, int? port = null, string token = null)
        {
            token = token ?? Environment.GetEnvironmentVariable("TLTL_TOKEN") ?? "";
            _line = new LineConnection(Connected(port));
            SendHello(hello, token);
        }

        /// <summary>Uses a connection that tltlc has opened.</summary>
        internal Client(IDictionary hello, LineConnection line)
        {
            _line = line;
            SendHello(hello, "");
        }

        /// <summary>Waits for the next request.</summary>
        /// <exception cref="Disconnected">tltlc has closed the connection, or refuses this game.</exception>
        public Request Request()
        {
            Message message = Read();
            object body;
            if (message.TryGetValue("error", out body)) throw new Disconnected(Reason(body));
            foreach (string kind in Kinds)
            {
                if (message.TryGetValue(kind, out body)) return new Request(kind, body);
            }
            foreach (string key in message.Keys) return new Request(key, null);
            return new Request("", null);
        }

        /// <summary>Answers a `reset`, a `step` or a `restore`.</summary>
        /// <exception cref="Disconnected">tltlc has closed the connection.</exception>
        public void AnswerState(State state)
        {
            Answer(TltlClient.StateMessage(state));
        }

        /// <summary>Answers that the request cannot be met.</summary>
        /// <exception cref="Disconnected">tltlc has closed the connection.</exception>
        public void Refuse(string reason)
        {
            Answer(new Message {{"error", new Message {{"message", reason}}}});
        }

        /// <summary>Sends a message.</summary>
        /// <exception cref="ArgumentException">
        /// A number in it is not finite, or it contains something that JSON has no word for.
        /// </exception>
        /// <exception cref="Disconnected">tltlc has closed the connection.</exception>
        public void Answer(IDictionary message)
        {
            string text = Json.Text(message);
            try
            {
                _line.Write(text);
            }
            catch (SocketException)
            {
                throw new Disconnected(LastWords());
            }
        }

        /// <summary>Closes the connection.</summary>
        public void Close()
        {
            _line.Close();
        }

        /// <summary>Closes the connection.</summary>
        public void Dispose()
        {
            Close();
        }

        private void SendHello(IDictionary hello, string token)
        {
            var body = new Message {{"tltl", TltlClient.Protocol}};
            if (token != "") body["token"] = token;
            foreach (DictionaryEntry part in hello) body[(string)part.Key] = part.Value;
            Answer(new Message {{"hello", body}});
        }

        private Message Read()
        {
            string text = _line.Read(TltlClient.LongestLine);
            if (text == null) throw new Disconnected();
            try
            {
                var message = Json.Parse(text) as Message;
                if (message != null) return message;
            }
            catch (FormatException)
            {
                // It is reported below.
            }
            throw new Disconnected("tltlc sent a line that is no object of JSON");
        }

        /// <summary>Returns why tltlc closed the connection, if it said so.</summary>
        private string LastWords()
        {
            object body = null;
            try
            {
                Read().TryGetValue("error", out body);
            }
            catch (Disconnected)
            {
                // It said nothing.
            }
            return body == null ? "" : Reason(body);
        }

        private static string Reason(object error)
        {
            object reason = null;
            var body = error as Message;
            if (body != null) body.TryGetValue("message", out reason);
            return string.IsNullOrEmpty(reason as string) ? "tltlc refuses this game" : (string)reason;
        }

        private static Socket Connected(int? port)
        {
            string text = port == null
                ? Environment.GetEnvironmentVariable("TLTL_PORT") ?? ""
                : port.Value.ToString(CultureInfo.InvariantCulture);
            if (text == "") throw new Disconnected("tltlc must start this game: the variable TLTL_PORT is not set");
            ushort number;
            if (!ushort.TryParse(text, NumberStyles.None, CultureInfo.InvariantCulture, out number))
            {
                throw new Disconnected("cannot connect to tltlc at port " + text + ": that is no port");
            }
            var socket = new Socket(AddressFamily.InterNetwork, SocketType.Stream, ProtocolType.Tcp);
            try
            {
                socket.Connect(IPAddress.Loopback, number);
            }
            catch (SocketException error)
            {
                socket.Close();
                throw new Disconnected("cannot connect to tltlc at port " + text + ": " + error.Message);
            }
            return socket;
        }
    }

    /// <summary>
    /// Writes the play of a person as traces, which `tltlc monitor` can judge later; needs no connection.
    /// </summary>
    /// <remarks>
    /// Each episode is a file in the folder: `trace-0001.csv`, `trace-0002.csv` and so on; no file is overwritten.
    /// <code>
    /// var recorder = new Recorder("traces", new[] {"position", "at_goal"}, clockHz: 10);
    /// recorder.Begin();
    /// recorder.Sample(new Message {{"position", 1}, {"at_goal", false}}); // after each tick
    /// recorder.End();
    /// </code>
    /// With the actions of the person, as tltlc would send them, each episode is also a tape, `trace-0001.tape.jsonl`,
    /// with which the play can be repeated:
    /// <code>
    /// recorder.Begin("short", "v0", 7);
    /// recorder.Sample(new Message {{"position", 1}, {"at_goal", false}}, 2);
    /// </code>
    /// </remarks>
    public sealed class Recorder : IDisposable
    {
        private readonly string _folder;
        private readonly string[] _signals;
        private readonly double? _clockHz;
        private readonly string _game;
        private StreamWriter _file, _tape;
        private string _path;
        private Message _played;
        private long _samples;
        private uint _low, _high;
        private bool[] _areBools;

        /// <param name="folder">Where the files are written; it is made if need be.</param>
        /// <param name="signals">The names of the signals, as specs write them.</param>
        /// <param name="clockHz">The number of samples in a second; with it, the files have a column `time`.</param>
        /// <param name="game">The name of the game, for tapes.</param>
        public Recorder(
            string folder, IEnumerable<string> signals, double? clockHz = null, string game = "game")
        {
            _folder = folder;
            _game = game;
            _signals = new List<string>(signals).ToArray();
            _clockHz = clockHz;
        }

        /// <summary>
        /// Begins a new trace, and ends the one before; returns the path of its file, which the first sample makes. A
        /// tape says which scene, variant and seed were played; without a variant it is `v0`.
        /// </summary>
        public string Begin(string scene = null, string variant = null, long? seed = null)
        {
            End();
            _played = new Message {{"scene", scene}, {"variant", variant ?? "v0"}, {"seed", seed}};
            _samples = 0;
            _low = 1;
            _high = 0;
            return FreePath();
        }

        /// <summary>
        /// Writes the values of all signals at one moment to the file at once; begins a trace if there is none.
        /// With <paramref name="action"/>, what the person did in the tick before it, the step is written to the
        /// tape, too.
        /// </summary>
        /// <exception cref="ArgumentException">
        /// A number is not finite, or a value is no number and no bool, or the action is no value of JSON.
        /// </exception>
        /// <exception cref="InvalidOperationException">
        /// Some samples of an episode have an action, and others have none.
        /// </exception>
        /// <exception cref="KeyNotFoundException">A signal is missing.</exception>
        public void Sample(IDictionary signals, object action = null)
        {
            var values = new List<string>();
            foreach (string name in _signals) values.Add(Value(name, signals));
            string actionText = action == null ? null : Json.Text(action);
            if (_played == null) Begin();
            if (_file == null) MakeTrace();
            if (_samples > 0 && (action == null) != (_tape == null))
            {
                throw new InvalidOperationException("give the action of each sample of an episode, or of none");
            }
            if (action != null) WriteStep(actionText, signals);
            if (_clockHz != null) values.Insert(0, Json.Number(_samples / _clockHz.Value));
            Write(values);
            _samples++;
        }

        /// <summary>Ends the trace and its tape, if there is one.</summary>
        public void End()
        {
            if (_file != null) _file.Dispose();
            if (_tape != null) _tape.Dispose();
            _file = _tape = null;
            _played = null;
        }

        /// <summary>Ends the trace and its tape, if there is one.</summary>
        public void Dispose()
        {
            End();
        }

        /// <summary>Returns the path of the first trace that is not there, nor its tape.</summary>
        private string FreePath()
        {
            for (int number = 1; ; number++)
            {
                string path = Path.Combine(
                    _folder, "trace-" + number.ToString("0000", CultureInfo.InvariantCulture) + ".csv");
                if (!File.Exists(path) && !File.Exists(TapePath(path))) return path;
            }
        }

        private void MakeTrace()
        {
            Directory.CreateDirectory(_folder);
            FileStream stream = null;
            while (stream == null)
            {
                _path = FreePath();
                try
                {
                    stream = new FileStream(_path, FileMode.CreateNew, FileAccess.Write, FileShare.Read);
                }
                catch (IOException)
                {
                    if (!File.Exists(_path)) throw;
                    // Another recorder has just made this file.
                }
            }
            _file = new StreamWriter(stream, new UTF8Encoding(false));
            var names = new List<string>();
            if (_clockHz != null) names.Add("time");
            foreach (string name in _signals) names.Add(Cell(name));
            Write(names);
        }

        private void Write(List<string> cells)
        {
            _file.Write(string.Join(",", cells) + "\n");
            _file.Flush();
        }

        /// <summary>Writes a step to the tape, and before the first one the header.</summary>
        private void WriteStep(string action, IDictionary signals)
        {
            if (_tape == null)
            {
                var stream = new FileStream(TapePath(_path), FileMode.CreateNew, FileAccess.Write, FileShare.Read);
                _tape = new StreamWriter(stream, new UTF8Encoding(false));
                _tape.Write(Json.Text(Header(signals)) + "\n");
            }
            var members = new List<string>();
            for (int i = 0; i < _signals.Length; i++)
            {
                // A signal keeps the type of its first value.
                double number = ((IConvertible)signals[_signals[i]]).ToDouble(CultureInfo.InvariantCulture);
                if (_areBools[i]) number = number != 0 ? 1 : 0;
                string text = !_areBools[i] ? Json.Number(number) : number != 0 ? "true" : "false";
                members.Add(Json.Text(_signals[i]) + ":" + text);
                Digest(number);
            }
            string digest = (_high * 65536 + _low).ToString("x8", CultureInfo.InvariantCulture);
            string end = (_samples + 1) % 60 == 0 ? ",\"digest\":\"" + digest + "\"" : "";
            _tape.Write(
                "{\"action\":" + action + ",\"signals\":{" + string.Join(",", members) + "}" + end + "}\n");
            _tape.Flush();
        }

        private Message Header(IDictionary signals)
        {
            var types = new Message();
            _areBools = new bool[_signals.Length];
            for (int i = 0; i < _signals.Length; i++)
            {
                _areBools[i] = signals[_signals[i]] is bool;
                types[_signals[i]] = new Message {{"type", _areBools[i] ? "bool" : "number"}};
            }
            var header = new Message {{"tape", 1}, {"game", _game}};
            foreach (KeyValuePair<string, object> part in _played) header[part.Key] = part.Value;
            header["spec"] = null;
            header["versions"] = new Message {{"csharp", Environment.Version.ToString()}};
            header["clock_hz"] = _clockHz;
            header["signals"] = types;
            return header;
        }

        /// <summary>
        /// Adds a value to the digest, Adler-32 of the bytes of all values; -0 counts as 0.
        /// </summary>
        private void Digest(double value)
        {
            long bits = BitConverter.DoubleToInt64Bits(value == 0 ? 0.0 : value);
            for (int place = 0; place < 64; place += 8)
            {
                _low = (_low + (uint)(bits >> place & 255)) % 65521;
                _high = (_high + _low) % 65521;
            }
        }

        private static string TapePath(string trace)
        {
            return Path.ChangeExtension(trace, ".tape.jsonl");
        }

        private static string Value(string name, IDictionary signals)
        {
            if (!signals.Contains(name)) throw new KeyNotFoundException("the signal " + name + " is missing");
            object value = signals[name];
            if (value is bool) return (bool)value ? "true" : "false";
            var number = value as IConvertible;
            if (number == null || value is string || value is char)
            {
                throw new ArgumentException("the signal " + name + " is no number and no bool");
            }
            double real = number.ToDouble(CultureInfo.InvariantCulture);
            if (double.IsNaN(real) || double.IsInfinity(real))
            {
                throw new ArgumentException(
                    "the signal " + name + " is " + real.ToString(CultureInfo.InvariantCulture)
                    + ", and numbers must be finite");
            }
            return Json.Number(real);
        }

        private static string Cell(string name)
        {
            bool isPlain = name.IndexOf(',') < 0 && !name.StartsWith("\"", StringComparison.Ordinal);
            return isPlain ? name : "\"" + name.Replace("\"", "\"\"") + "\"";
        }
    }

    /// <summary>A connection that carries lines.</summary>
    internal sealed class LineConnection
    {
        private static readonly UTF8Encoding Utf8 = new UTF8Encoding(false, true);
        private readonly Socket _socket;
        private byte[] _received = new byte[1 << 16];
        private byte[] _sent = new byte[1 << 12];
        private int _start, _end;

        public LineConnection(Socket socket)
        {
            _socket = socket;
            _socket.NoDelay = true;
        }

        /// <summary>
        /// Returns the next line, without its end; null if the connection has ended, or if the line is longer than
        /// <paramref name="longest"/> bytes.
        /// </summary>
        /// <exception cref="FormatException">The line is not UTF-8.</exception>
        public string Read(int longest)
        {
            int seen = _start;
            while (true)
            {
                int end = Array.IndexOf(_received, (byte)'\n', seen, _end - seen);
                if (end - _start > longest || end < 0 && _end - _start > longest) return null;
                if (end >= 0)
                {
                    int start = _start;
                    _start = end + 1;
                    return Decoded(start, end - start);
                }
                MakeRoom();
                seen = _end;
                if (!Receive()) return null;
            }
        }

        /// <summary>Sends a line.</summary>
        /// <exception cref="SocketException">The connection has ended.</exception>
        public void Write(string text)
        {
            int most = Utf8.GetMaxByteCount(text.Length) + 1;
            if (_sent.Length < most) _sent = new byte[Math.Max(most, 2 * _sent.Length)];
            int count = Utf8.GetBytes(text, 0, text.Length, _sent, 0);
            _sent[count++] = (byte)'\n';
            for (int sent = 0; sent < count;) sent += _socket.Send(_sent, sent, count - sent, SocketFlags.None);
        }

        public void Close()
        {
            _socket.Close();
        }

        private string Decoded(int start, int count)
        {
            try
            {
                return Utf8.GetString(_received, start, count);
            }
            catch (DecoderFallbackException)
            {
                throw new FormatException("the line is not UTF-8");
            }
        }

        private void MakeRoom()
        {
            if (_start > 0) Buffer.BlockCopy(_received, _start, _received, 0, _end - _start);
            _end -= _start;
            _start = 0;
            if (_end == _received.Length) Array.Resize(ref _received, 2 * _end);
        }

        private bool Receive()
        {
            int count;
            try
            {
                count = _socket.Receive(_received, _end, _received.Length - _end, SocketFlags.None);
            }
            catch (SocketException)
            {
                return false;
            }
            _end += count;
            return count > 0;
        }
    }

    /// <summary>Texts of JSON, in every culture alike.</summary>
    internal static class Json
    {
        private const int Deepest = 100;
        private static readonly CultureInfo Plain = CultureInfo.InvariantCulture;

        /// <summary>
        /// Returns the value of a text: null, a bool, a long, a double, a string, a List of objects, or a Message.
        /// </summary>
        /// <exception cref="FormatException">
        /// The text is not JSON, nests too deep, or has a number that is too large.
        /// </exception>
        public static object Parse(string text)
        {
            return new Parser(text).Whole();
        }

        /// <summary>Returns the text of a value.</summary>
        /// <exception cref="ArgumentException">
        /// A number is not finite, or a part has a type that JSON has no word for.
        /// </exception>
        public static string Text(object value)
        {
            var text = new StringBuilder();
            Write(text, value, 0);
            return text.ToString();
        }

        /// <summary>Returns a short text that every reader reads as exactly this number.</summary>
        /// <exception cref="ArgumentException">The number is not finite.</exception>
        public static string Number(double value)
        {
            if (double.IsNaN(value) || double.IsInfinity(value))
            {
                throw new ArgumentException("the number " + value.ToString(Plain) + " is not finite");
            }
            if (Math.Abs(value) < 1e15 && Math.Floor(value) == value) return ((long)value).ToString(Plain);
            string text = value.ToString("R", Plain);
            return Decimals.Parse(text) == value ? text : value.ToString("G17", Plain);
        }

        private static void Write(StringBuilder text, object value, int depth)
        {
            if (depth > Deepest) throw new ArgumentException("the message nests too deep");
            if (value == null)
            {
                text.Append("null");
                return;
            }
            var single = value as IConvertible;
            var table = value as IDictionary;
            var array = value as Array;
            var items = value as IEnumerable;
            if (single != null) WriteSingle(text, single);
            else if (table != null) WriteTable(text, table, depth);
            else if (array != null && array.Rank > 1) WriteGrid(text, array, new int[array.Rank], 0);
            else if (items != null) WriteItems(text, items, depth);
            else throw Unknown(value);
        }

        private static void WriteSingle(StringBuilder text, IConvertible value)
        {
            switch (value.GetTypeCode())
            {
                case TypeCode.Boolean:
                    text.Append(value.ToBoolean(Plain) ? "true" : "false");
                    break;
                case TypeCode.String:
                case TypeCode.Char:
                    WriteQuoted(text, value.ToString(Plain));
                    break;
                case TypeCode.Single:
                case TypeCode.Double:
                    text.Append(Number(value.ToDouble(Plain)));
                    break;
                case TypeCode.Decimal:
                    text.Append(value.ToDecimal(Plain).ToString(Plain));
                    break;
                case TypeCode.UInt64:
                    text.Append(value.ToUInt64(Plain).ToString(Plain));
                    break;
                case TypeCode.SByte:
                case TypeCode.Byte:
                case TypeCode.Int16:
                case TypeCode.UInt16:
                case TypeCode.Int32:
                case TypeCode.UInt32:
                case TypeCode.Int64:
                    text.Append(value.ToInt64(Plain).ToString(Plain));
                    break;
                default:
                    throw Unknown(value);
            }
        }

        private static void WriteTable(StringBuilder text, IDictionary table, int depth)
        {
            char before = '{';
            foreach (DictionaryEntry part in table)
            {
                var key = part.Key as string;
                if (key == null) throw Unknown(part.Key);
                text.Append(before);
                WriteQuoted(text, key);
                text.Append(':');
                Write(text, part.Value, depth + 1);
                before = ',';
            }
            text.Append(before == '{' ? "{}" : "}");
        }

        private static void WriteItems(StringBuilder text, IEnumerable items, int depth)
        {
            char before = '[';
            foreach (object item in items)
            {
                text.Append(before);
                Write(text, item, depth + 1);
                before = ',';
            }
            text.Append(before == '[' ? "[]" : "]");
        }

        /// <summary>Writes an array such as float[,] as nested lists.</summary>
        private static void WriteGrid(StringBuilder text, Array array, int[] index, int axis)
        {
            if (axis == index.Length)
            {
                Write(text, array.GetValue(index), 0);
                return;
            }
            text.Append('[');
            for (int i = 0; i < array.GetLength(axis); i++)
            {
                if (i > 0) text.Append(',');
                index[axis] = array.GetLowerBound(axis) + i;
                WriteGrid(text, array, index, axis + 1);
            }
            text.Append(']');
        }

        private static void WriteQuoted(StringBuilder text, string value)
        {
            text.Append('"');
            foreach (char c in value)
            {
                if (c == '"' || c == '\\') text.Append('\\').Append(c);
                else if (c < ' ' || char.IsSurrogate(c)) text.Append("\\u").Append(((int)c).ToString("x4", Plain));
                else text.Append(c);
            }
            text.Append('"');
        }

        private static ArgumentException Unknown(object value)
        {
            return new ArgumentException("a message cannot contain a " + value.GetType());
        }

        /// <summary>Reads one text.</summary>
        private sealed class Parser
        {
            private readonly string _text;
            private int _at;

            public Parser(string text)
            {
                _text = text;
            }

            public object Whole()
            {
                object value = Value(0);
                Skip();
                if (_at < _text.Length) throw Wrong();
                return value;
            }

            private object Value(int depth)
            {
                if (depth > Deepest) throw Wrong();
                Skip();
                switch (Next())
                {
                    case '{': return Table(depth);
                    case '[': return Items(depth);
                    case '"': return Quoted();
                    case 't': return Word("true", true);
                    case 'f': return Word("false", false);
                    case 'n': return Word("null", null);
                    default: return Numeral();
                }
            }

            private Message Table(int depth)
            {
                var table = new Message();
                _at++;
                Skip();
                if (Take('}')) return table;
                do
                {
                    Skip();
                    string key = Quoted();
                    Skip();
                    Expect(':');
                    table[key] = Value(depth + 1);
                    Skip();
                }
                while (Take(','));
                Expect('}');
                return table;
            }

            private List<object> Items(int depth)
            {
                var items = new List<object>();
                _at++;
                Skip();
                if (Take(']')) return items;
                do
                {
                    items.Add(Value(depth + 1));
                    Skip();
                }
                while (Take(','));
                Expect(']');
                return items;
            }

            private string Quoted()
            {
                Expect('"');
                int start = _at;
                while (Next() != '"' && Next() != '\\') Character();
                if (Next() == '"') return _text.Substring(start, _at++ - start);
                var value = new StringBuilder(_text, start, _at - start, _text.Length - start + 1);
                while (!Take('"')) value.Append(Take('\\') ? Escaped() : Character());
                return value.ToString();
            }

            private char Character()
            {
                char c = Next();
                if (c < ' ') throw Wrong();
                _at++;
                return c;
            }

            private char Escaped()
            {
                char c = Character();
                switch (c)
                {
                    case 'b': return '\b';
                    case 'f': return '\f';
                    case 'n': return '\n';
                    case 'r': return '\r';
                    case 't': return '\t';
                    case 'u': return Unicode();
                    case '"':
                    case '\\':
                    case '/': return c;
                    default: throw Wrong();
                }
            }

            private char Unicode()
            {
                int code;
                if (_at + 4 > _text.Length || !int.TryParse(
                    _text.Substring(_at, 4), NumberStyles.AllowHexSpecifier, Plain, out code)) throw Wrong();
                _at += 4;
                return (char)code;
            }

            private object Word(string word, object value)
            {
                if (string.CompareOrdinal(_text, _at, word, 0, word.Length) != 0) throw Wrong();
                _at += word.Length;
                return value;
            }

            private object Numeral()
            {
                int start = _at;
                Take('-');
                if (!Take('0')) Digits();
                bool isWhole = true;
                if (Take('.'))
                {
                    isWhole = false;
                    Digits();
                }
                if (Take('e') || Take('E'))
                {
                    isWhole = false;
                    if (!Take('+')) Take('-');
                    Digits();
                }
                string numeral = _text.Substring(start, _at - start);
                long whole;
                if (isWhole && long.TryParse(numeral, NumberStyles.AllowLeadingSign, Plain, out whole)) return whole;
                double real = Decimals.Parse(numeral);
                if (double.IsInfinity(real)) throw Wrong();
                return real;
            }

            private void Digits()
            {
                int start = _at;
                while (Next() >= '0' && Next() <= '9') _at++;
                if (_at == start) throw Wrong();
            }

            private void Skip()
            {
                while (Next() == ' ' || Next() == '\t' || Next() == '\n' || Next() == '\r') _at++;
            }

            private bool Take(char c)
            {
                if (Next() != c) return false;
                _at++;
                return true;
            }

            private void Expect(char c)
            {
                if (!Take(c)) throw Wrong();
            }

            /// <summary>
            /// Returns the next character; a null character at the end, which no text of JSON may contain.
            /// </summary>
            private char Next()
            {
                return _at < _text.Length ? _text[_at] : '\0';
            }

            private FormatException Wrong()
            {
                return new FormatException("the line is not JSON at character " + (_at + 1).ToString(Plain));
            }
        }
    }

    /// <summary>Reads decimal numbers exactly; Mono is wrong by one bit for some.</summary>
    internal static class Decimals
    {
        private const long Infinity = 0x7FF0000000000000;
        private const ulong Hidden = 1UL << 52;
        private const int ExactDigits = 15;
        private const int ExactPower = 22;
        private const int MostDigits = 800;
        private const int MostPower = 1300;

        /// <summary>
        /// Returns the number nearest to a numeral of JSON; it is infinite if the numeral is too large. Numerals of
        /// more than 800 digits may be wrong by one bit.
        /// </summary>
        public static double Parse(string numeral)
        {
            string digits;
            int exponent;
            bool isShort = Split(numeral, out digits, out exponent);
            bool isNegative = numeral[0] == '-';
            double size;
            if (isShort && digits.Length <= ExactDigits && Math.Abs(exponent) <= ExactPower)
            {
                double power = 1.0;
                for (int i = 0; i < Math.Abs(exponent); i++) power *= 10.0;
                double whole = digits == "" ? 0.0 : long.Parse(digits, NumberStyles.None, CultureInfo.InvariantCulture);
                size = exponent < 0 ? whole / power : whole * power;
                return isNegative ? -size : size;
            }
            string rest = isNegative ? numeral.Substring(1) : numeral;
            bool isRead = double.TryParse(rest, NumberStyles.Float, CultureInfo.InvariantCulture, out size);
            if (!isRead) size = double.PositiveInfinity;
            if (isShort && digits != "") size = Nearest(digits, exponent, size);
            return isNegative ? -size : size;
        }

        /// <summary>
        /// Returns the digits without a point, and the power of ten by which to multiply them; false if they are too
        /// many, or the power is too large.
        /// </summary>
        private static bool Split(string numeral, out string digits, out int exponent)
        {
            int end = numeral.IndexOfAny(new[] {'e', 'E'});
            string mantissa = (end < 0 ? numeral : numeral.Substring(0, end)).TrimStart('-');
            int point = mantissa.IndexOf('.');
            digits = mantissa.Replace(".", "").TrimStart('0');
            exponent = 0;
            if (end >= 0 && !int.TryParse(
                numeral.Substring(end + 1), NumberStyles.AllowLeadingSign, CultureInfo.InvariantCulture, out exponent))
            {
                return false;
            }
            if (digits.Length > MostDigits || Math.Abs((long)exponent) > MostPower) return false;
            if (point >= 0) exponent -= mantissa.Length - point - 1;
            return Math.Abs(exponent) <= MostPower;
        }

        /// <summary>Returns the number nearest to digits times a power of ten, given one that is near.</summary>
        private static double Nearest(string digits, int exponent, double near)
        {
            long bits = Math.Min(BitConverter.DoubleToInt64Bits(near), Infinity - 1);
            while (bits < Infinity && IsAbove(digits, exponent, bits)) bits++;
            while (bits > 0 && bits < Infinity && !IsAbove(digits, exponent, bits - 1)) bits--;
            return BitConverter.Int64BitsToDouble(bits);
        }

        /// <summary>
        /// Whether digits times a power of ten is nearer to the next number than to that of these bits.
        /// </summary>
        private static bool IsAbove(string digits, int exponent, long bits)
        {
            int power = (int)(bits >> 52);
            ulong mantissa = (ulong)bits & (Hidden - 1);
            if (power == 0) power = 1;
            else mantissa += Hidden;
            power -= 1076;
            // The middle between the two numbers is (2 * mantissa + 1) * 2^power.
            var left = new List<uint>();
            foreach (char digit in digits) MultiplyAdd(left, 10, (ulong)(digit - '0'));
            var right = new List<uint> {(uint)(2 * mantissa + 1), (uint)(mantissa >> 31)};
            if (right[1] == 0) right.RemoveAt(1);
            Scale(exponent < 0 ? right : left, 10, Math.Abs(exponent), 9);
            Scale(power < 0 ? left : right, 2, Math.Abs(power), 31);
            int order = left.Count.CompareTo(right.Count);
            for (int i = left.Count - 1; i >= 0 && order == 0; i--) order = left[i].CompareTo(right[i]);
            return order > 0 || order == 0 && bits % 2 == 1;
        }

        /// <summary>Multiplies by a power of the base, of which 32 bits hold <paramref name="most"/>.</summary>
        private static void Scale(List<uint> limbs, uint root, int power, int most)
        {
            for (; power > 0; power -= most)
            {
                ulong factor = 1;
                for (int i = 0; i < Math.Min(power, most); i++) factor *= root;
                MultiplyAdd(limbs, factor, 0);
            }
        }

        private static void MultiplyAdd(List<uint> limbs, ulong factor, ulong carry)
        {
            for (int i = 0; i < limbs.Count; i++)
            {
                ulong product = limbs[i] * factor + carry;
                limbs[i] = (uint)product;
                carry = product >> 32;
            }
            if (carry > 0) limbs.Add((uint)carry);
        }
    }
}
