# The game of the conformance script in Godot 3; `tests/runtime/wire/conversation.py` describes it.
#
# Copy `tltl_client_godot3.gd` into this folder, and start the game in one of two ways, in which
# Godot's loop asks for actions, or the client asks for ticks:
#
#     godot3-server --path . --fixed-fps 10 --disable-render-loop [play | listen PORT]

extends Node

const Tltl = preload("res://tltl_client_godot3.gd")
const GOALS = {"short": 5, "long": 10}

var hello = {
	"name": "counter",
	"clock_hz": 10,
	"signals": {"position": {"range": [0, 10]}, "moves": {"range": [0, null]}, "at_goal": {"type": "bool"}},
	"params": {"goal": 10},
	"actions": {"type": "discrete", "n": 3},
	"observation": {"type": "box", "low": 0, "high": 10, "shape": [1], "dtype": "float32"},
	"scenes": ["short", "long"],
	"capabilities": ["seed", "positions"],
}
var tltl = Tltl.new()
var goal = 5
var has_trap = false
var position = 1
var moves = 0
var snapshots = []


func _ready() -> void:
	var words = Array(OS.get_cmdline_args())
	if "play" in words:
		tltl.play(self)
	elif "listen" in words:
		while tltl.listen(self, int(words[words.find("listen") + 1])):
			tltl.play(self)
	else:
		tltl.begin(self)


func _physics_process(_delta) -> void:
	var action = tltl.next_action()
	if action != null:
		move(action)


func move(action: int) -> void:
	position = int(min(max(position + action - 1, 0), 10))
	moves += 1


func step(action: int) -> Dictionary:
	move(action)
	return state()


func reset(scene, variant, seed_) -> Dictionary:
	if scene != null and not GOALS.has(scene):
		return Tltl.refusal("there is no scene `%s`" % scene)
	if not (variant in ["v0", "trap"]):
		return Tltl.refusal("there is no variant `%s`" % variant)
	goal = GOALS["short" if scene == null else scene]
	has_trap = variant == "trap"
	position = 1 + (0 if seed_ == null else seed_) % 4
	moves = 0
	return state()


func snapshot() -> int:
	snapshots.append([goal, has_trap, position, moves])
	return snapshots.size()


func restore(id) -> Dictionary:
	if not (id is int) or id < 1 or id > snapshots.size() or snapshots[id - 1] == null:
		return Tltl.refusal("there is no snapshot %s" % id)
	var kept = snapshots[id - 1]
	goal = kept[0]
	has_trap = kept[1]
	position = kept[2]
	moves = kept[3]
	return state()


func release_snapshot(id):
	if not (id is int) or id < 1 or id > snapshots.size() or snapshots[id - 1] == null:
		return Tltl.refusal("there is no snapshot %s" % id)
	snapshots[id - 1] = null
	return null


func screenshot() -> Dictionary:
	var pixels = PoolByteArray()
	for place in range(11):
		for _channel in range(3):
			pixels.append(255 if place == position else 0)
	return Tltl.array(pixels, "uint8", [1, 11, 3])


# What maps show: the edges of the row, the goal, and the trap if there is one.
func outline() -> Dictionary:
	if has_trap and goal == GOALS["short"]:
		return Tltl.refusal("there is no outline of the trap in `short`")
	var trap = {"trap": PoolVector2Array([Vector2(-0.5, 1), Vector2(0.5, 1), Vector2(0, -2)])}
	return {
		"bounds": Rect2(-1, -3, 12, 5),
		"boxes": {"edge": [Rect2(-1, -2, 0.5, 3), [Vector2(10.5, 1), Vector2(11, -2)]]},
		"polygons": trap if has_trap else {},
		"regions": {"goal": Rect2(goal - 0.5, -2, 11 - goal, 3)},
		"image": {"pixels": Tltl.array(PoolByteArray([255, 255, 255]), "uint8", [1, 1, 3]), "extent": [-0.5, -1, 10.5, 2]},
	}


func state() -> Dictionary:
	var at_goal = position >= goal
	var trapped = has_trap and position == 0
	var cause = "goal" if at_goal else "trap" if trapped else null
	return Tltl.state(
		{"position": position, "moves": moves, "at_goal": at_goal},
		[position], at_goal or trapped, cause, {"player": [position, 0]}
	)
