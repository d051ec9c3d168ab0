# The game of the conformance script in Godot 4; `tests/runtime/wire/conversation.py` describes it.
#
# Copy `tltl_client_godot4.gd` into this folder, and start the game in one of two ways, in which
# Godot's loop asks for actions, or the client asks for ticks:
#
#     godot --headless --path . --fixed-fps 10 --disable-render-loop [-- play | -- listen PORT]

extends Node

const Tltl := preload("res://tltl_client_godot4.gd")
const GOALS: Dictionary = {"short": 5, "long": 10}

var hello: Dictionary = {
	"name": "counter",
	"clock_hz": 10,
	"signals": {"position": {"range": [0, 10]}, "moves": {"range": [0, null]}, "at_goal": {"type": "bool"}},
	"params": {"goal": 10},
	"actions": {"type": "discrete", "n": 3},
	"observation": {"type": "box", "low": 0, "high": 10, "shape": [1], "dtype": "float32"},
	"scenes": ["short", "long"],
	"capabilities": ["seed", "positions"],
}
var tltl := Tltl.new()
var goal: int = 5
var has_trap: bool = false
var place: int = 1
var moves: int = 0
var snapshots: Array = []


func _ready() -> void:
	var words: Array = Array(OS.get_cmdline_user_args())
	if "play" in words:
		tltl.play(self)
	elif "listen" in words:
		var port: int = int(words[words.find("listen") + 1])
		while tltl.listen(self, port):
			tltl.play(self)
	else:
		tltl.begin(self)


func _physics_process(_delta: float) -> void:
	var action: Variant = tltl.next_action()
	if action != null:
		move(action)


func move(action: int) -> void:
	place = clampi(place + action - 1, 0, 10)
	moves += 1


func step(action: int) -> Dictionary:
	move(action)
	return state()


func reset(scene: Variant, variant: String, chosen: Variant) -> Dictionary:
	var known: String = "short"
	if scene != null:
		known = scene
	if not GOALS.has(known):
		return Tltl.refusal("there is no scene `%s`" % known)
	if not (variant in ["v0", "trap"]):
		return Tltl.refusal("there is no variant `%s`" % variant)
	goal = GOALS[known]
	has_trap = variant == "trap"
	place = 1
	if chosen != null:
		place += chosen % 4
	moves = 0
	return state()


func snapshot() -> int:
	snapshots.append([goal, has_trap, place, moves])
	return snapshots.size()


func restore(id: Variant) -> Dictionary:
	if not (id is int) or id < 1 or id > snapshots.size() or snapshots[id - 1] == null:
		return Tltl.refusal("there is no snapshot %s" % id)
	var kept: Array = snapshots[id - 1]
	goal = kept[0]
	has_trap = kept[1]
	place = kept[2]
	moves = kept[3]
	return state()


func release_snapshot(id: Variant) -> Variant:
	if not (id is int) or id < 1 or id > snapshots.size() or snapshots[id - 1] == null:
		return Tltl.refusal("there is no snapshot %s" % id)
	snapshots[id - 1] = null
	return null


func screenshot() -> Dictionary:
	var pixels := PackedByteArray()
	for pixel in range(11):
		for _channel in range(3):
			pixels.append(255 if pixel == place else 0)
	return Tltl.array(pixels, "uint8", [1, 11, 3])


# What maps show: the edges of the row, the goal, and the trap if there is one.
func outline() -> Dictionary:
	if has_trap and goal == GOALS["short"]:
		return Tltl.refusal("there is no outline of the trap in `short`")
	var trap: Dictionary = {}
	if has_trap:
		trap["trap"] = [Vector2(-0.5, 1), Vector2(0.5, 1), Vector2(0, -2)]
	return {
		"bounds": Rect2(-1, -3, 12, 5),
		"boxes": {"edge": [Rect2(-1, -2, 0.5, 3), [Vector2(10.5, 1), Vector2(11, -2)]]},
		"polygons": trap,
		"regions": {"goal": Rect2(goal - 0.5, -2, 11 - goal, 3)},
		"image": {"pixels": Tltl.array(PackedByteArray([255, 255, 255]), "uint8", [1, 1, 3]), "extent": [-0.5, -1, 10.5, 2]},
	}


func state() -> Dictionary:
	var at_goal: bool = place >= goal
	var trapped: bool = has_trap and place == 0
	var cause: String = "goal" if at_goal else "trap" if trapped else ""
	return Tltl.state(
		{"position": place, "moves": moves, "at_goal": at_goal},
		[place],
		at_goal or trapped,
		cause,
		{"player": [place, 0]}
	)
