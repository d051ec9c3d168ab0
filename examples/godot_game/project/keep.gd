# The game: a player fetches a key, opens a door, crosses a chasm on a ferry, and walks to the beacon.
#
# tltlc plays it through `tltl_client_godot3.gd`. If tltlc has not started the game, a person plays
# with the arrow keys, and each episode is recorded in user://traces, as a trace and a tape.
#
# A tick is a tenth of a second. x points east, y up and z south; lengths are in metres.

extends Spatial

const Tltl = preload("res://tltl_client_godot3.gd")
const Judge = preload("res://judge.gd")
const Level = preload("res://level.gd")
const FARTHEST = 25.0

var hello = {
	"name": "keep",
	"clock_hz": 10,
	"signals":
	{
		"has_key": {"type": "bool"},
		"door_open": {"type": "bool"},
		"on_ferry": {"type": "bool"},
		"seen": {"type": "bool"},
		"caught": {"type": "bool"},
		"fallen": {"type": "bool"},
		"distance(key)": {"range": [0, FARTHEST]},
		"distance(door)": {"range": [0, FARTHEST]},
		"distance(ferry)": {"range": [0, FARTHEST]},
		"distance(beacon)": {"range": [0, FARTHEST]},
		"distance(guard_1)": {"range": [0, FARTHEST]},
		"height": {"range": [-20, 20]},
	},
	"actions": {"type": "multi_discrete", "nvec": [3, 3]},
	"observation": {"type": "box", "low": -10, "high": 10, "shape": [20]},
	"scenes": ["courtyard", "pier"],
	"capabilities": ["seed", "positions"],
}
var tltl = Tltl.new()
var levels = {}
var level = null
var judge = null  # the monitor inside the game
var recorder = null
var snapshots = []
var waiting = null  # an action that waits for the frame after which rays hit bodies where they were put


func _ready() -> void:
	for scene in hello["scenes"]:
		levels[scene] = load("res://%s.tscn" % scene).instance()
	judge = Judge.new(OS.get_cmdline_args())
	if OS.has_environment("TLTL_PORT"):
		tltl.begin(self)
	else:
		recorder = Tltl.Recorder.new("user://traces", hello["signals"].keys(), hello["clock_hz"], hello["name"])
		begin_by_hand()


func _physics_process(_delta) -> void:
	if recorder == null:
		var action = waiting if waiting != null else tltl.next_action()
		waiting = null
		if action != null and level.is_put:
			level.is_put = false
			waiting = action
		elif action != null:
			level.tick(action[0] - 1, action[1] - 1)
			judge.step(level.signals())
		return
	if level.is_put:
		level.is_put = false
		return
	var east = int(Input.is_action_pressed("ui_right")) - int(Input.is_action_pressed("ui_left"))
	var north = int(Input.is_action_pressed("ui_up")) - int(Input.is_action_pressed("ui_down"))
	level.tick(east, north)
	var signals = level.signals()
	recorder.sample(signals, [east + 1, north + 1])
	if judge.step(signals) or level.is_over():
		print(judge.verdict())
		begin_by_hand()


func begin_by_hand() -> void:
	randomize()
	var seed_ = randi()
	reset("courtyard", "v0", seed_)
	recorder.begin("courtyard", "v0", seed_)


func reset(scene, variant, seed_) -> Dictionary:
	if not levels.has(scene):
		return Tltl.refusal("there is no scene `%s`" % scene)
	if not (variant in Level.VARIANTS):
		return Tltl.refusal("there is no variant `%s`" % variant)
	if level != levels[scene]:
		if level != null:
			remove_child(level)
		level = levels[scene]
		add_child(level)
	level.begin(variant, 0 if seed_ == null else seed_)
	judge.begin(scene)
	return state()


func state() -> Dictionary:
	return {
		"signals": level.signals(),
		"observation": level.observation(),
		"ended": level.is_over(),
		"cause": level.cause(),
		"positions": level.positions(),
	}


func outline() -> Dictionary:
	return level.outline()


func snapshot() -> int:
	snapshots.append([level, level.kept(), judge.kept()])
	return snapshots.size()


func restore(id) -> Dictionary:
	if not (id is int) or id < 1 or id > snapshots.size():
		return Tltl.refusal("there is no snapshot %s" % id)
	var snapshot = snapshots[id - 1]
	if level != snapshot[0]:
		remove_child(level)
		level = snapshot[0]
		add_child(level)
	level.restore(snapshot[1])
	judge.restore(snapshot[2])
	return state()


func close() -> void:
	judge.close()
	for other in levels.values():
		if other != level:
			other.free()
