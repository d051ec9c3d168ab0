# The hall: fetch the key, then leave by the door. Spikes end the game.
#
# A level is a text: `#` is a wall, `K` the key, `D` the door, `^` spikes. The player begins on a dot.
# tltlc plays if it has started the game; otherwise a person does, with the arrow keys, and each walk
# becomes a trace in user://traces.

extends Node2D

const Tltl = preload("res://tltl_client_godot3.gd")
const MOVES = [Vector2(0, 1), Vector2(0, -1), Vector2(-1, 0), Vector2(1, 0)]  # up, down, left, right
const KEYS = ["ui_up", "ui_down", "ui_left", "ui_right"]
const THINGS = {"K": "key", "D": "door", "^": "spikes"}

var hello = {
	"name": "hall",
	"clock_hz": 10,
	"signals": {"has_key": {"type": "bool"}, "at_door": {"type": "bool"}, "on_spikes": {"type": "bool"}},
	"actions": {"type": "discrete", "n": 4},
	"observation": {"type": "multi_discrete", "nvec": [9, 6]},  # the size of each level, in cells
	"scenes": ["hall"],
	"capabilities": ["seed", "positions"],
}
var tltl = Tltl.new()
var recorder = null
var seed_by_hand = null  # of a walk whose first move is still to come
var rows = []  # from south to north
var things = {}
var player = Vector2()
var has_key = false


func _ready() -> void:
	if OS.has_environment("TLTL_PORT"):
		tltl.begin(self)
		return
	recorder = Tltl.Recorder.new("user://traces", hello["signals"].keys(), hello["clock_hz"], hello["name"])
	begin_by_hand()


func _physics_process(_delta) -> void:
	if recorder != null:
		play_by_hand()
		return
	var action = tltl.next_action()  # answers for the last tick, and waits for the next one
	if action != null:
		move(action)


# Begins an episode, and returns its first state.
func reset(scene, variant, seed_) -> Dictionary:
	if scene != null and not scene in hello["scenes"]:
		return Tltl.refusal("there is no scene `%s`" % scene)
	if variant != "v0":
		return Tltl.refusal("there is no variant `%s`" % variant)
	var file = File.new()
	file.open("res://levels/%s.txt" % ("hall" if scene == null else scene), File.READ)
	rows = Array(file.get_as_text().strip_edges().split("\n"))
	file.close()
	rows.invert()
	var starts = []
	things = {}
	for y in range(rows.size()):
		for x in range(rows[y].length()):
			if rows[y][x] == ".":
				starts.append(Vector2(x, y))
			elif rows[y][x] in THINGS:
				things[THINGS[rows[y][x]]] = [x + 0.5, y + 0.5]
	player = starts[(0 if seed_ == null else seed_) % starts.size()]
	has_key = false
	return state()


func move(action: int) -> void:
	if mark(player + MOVES[action]) != "#":
		player += MOVES[action]
	has_key = has_key or mark(player) == "K"


# Returns the state after a tick.
func state() -> Dictionary:
	var here = mark(player)
	var positions = things.duplicate()
	positions["player"] = [player.x + 0.5, player.y + 0.5]
	return Tltl.state(
		{"has_key": has_key, "at_door": here == "D", "on_spikes": here == "^"},
		[int(player.x), int(player.y)], here == "^", "spikes" if here == "^" else null, positions
	)


func mark(cell: Vector2) -> String:
	return rows[int(cell.y)][int(cell.x)]


func begin_by_hand() -> void:
	randomize()
	seed_by_hand = randi()
	reset("hall", "v0", seed_by_hand)
	recorder.end()  # the next move begins a trace and a tape


func play_by_hand() -> void:
	for action in range(KEYS.size()):
		if Input.is_action_just_pressed(KEYS[action]):
			move(action)
			var now = state()
			if seed_by_hand != null:
				recorder.begin("hall", "v0", seed_by_hand)
				seed_by_hand = null
			recorder.sample(now["signals"], action)
			if now["ended"]:
				begin_by_hand()
	var lines = rows.duplicate()
	var row = lines[int(player.y)]
	lines[int(player.y)] = row.substr(0, int(player.x)) + "@" + row.substr(int(player.x) + 1)
	lines.invert()
	$Map.text = PoolStringArray(lines).join("\n") + ("\nYou have the key." if has_key else "")
