// The game in Unity: put this component on one object of the first scene. tltlc plays if it has started the game;
// otherwise a person does, with the arrow keys, and each walk becomes a trace and a tape in the folder `traces`.

using System;
using Tltl;
using UnityEngine;

public sealed class HallBehaviour : MonoBehaviour
{
    private static readonly KeyCode[] Keys =
    {
        KeyCode.UpArrow, KeyCode.DownArrow, KeyCode.LeftArrow, KeyCode.RightArrow, // in the order of the moves
    };

    private readonly Hall _hall = new Hall();
    private Client _client;
    private Recorder _recorder;
    private long? _seed; // of a walk whose first move is still to come

    private void Start()
    {
        if (Environment.GetEnvironmentVariable("TLTL_PORT") == null)
        {
            _recorder = new Recorder("traces", Hall.Signals, Hall.ClockHz, "hall");
            Begin();
            return;
        }
        QualitySettings.vSyncCount = 0;
        try { _client = new Client(TltlClient.GameHello(_hall)); }
        catch (Disconnected error) { Quit(error.Message); }
    }

    private void Update()
    {
        if (_recorder != null) PlayByHand();
        if (_client == null) return;
        try
        {
            Request request = _client.Request(); // waits
            if (request.Kind == "close") Quit("");
            else TltlClient.Answer(_hall, _client, request);
        }
        catch (Disconnected error) { Quit(error.Message); }
    }

    private void Begin()
    {
        _seed = UnityEngine.Random.Range(0, int.MaxValue);
        _hall.Reset("hall", "v0", _seed);
        _recorder.End(); // the next move begins a trace and a tape
    }

    private void PlayByHand()
    {
        for (int action = 0; action < Keys.Length; action++)
        {
            if (!Input.GetKeyDown(Keys[action])) continue;
            State now = _hall.Step((long)action);
            if (_seed != null) _recorder.Begin("hall", "v0", _seed);
            _seed = null;
            _recorder.Sample(now.Signals, action);
            if (now.Ended) Begin();
        }
    }

    private void OnGUI()
    {
        if (_hall.Rows == null) return;
        for (int y = 0; y < _hall.Rows.Length; y++)
        {
            for (int x = 0; x < _hall.Rows[y].Length; x++)
            {
                bool isPlayer = x == _hall.X && y == _hall.Y;
                string mark = isPlayer ? "@" : _hall.Rows[y][x].ToString();
                GUI.Label(new Rect(40 + 30 * x, 40 + 30 * (_hall.Rows.Length - y), 30, 30), mark);
            }
        }
        GUI.Label(new Rect(40, 20, 400, 30), _hall.HasKey ? "You have the key." : "Fetch the key K.");
    }

    private void OnDestroy()
    {
        if (_recorder != null) _recorder.End();
    }

    private void Quit(string reason)
    {
        if (_client != null) _client.Close();
        _client = null;
        if (reason != "") Console.Error.WriteLine(reason);
        Application.Quit(reason == "" ? 0 : 1);
    }
}
