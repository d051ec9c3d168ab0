# The game of examples/godot_game in a lockstep loop without the client: the same physics, monitor and
# states, but the engine's own JSON, which rounds, and no checks.

extends Spatial

const Judge = preload("res://judge.gd")

var connection = StreamPeerTCP.new()
var judge = Judge.new([])
var level = preload("res://courtyard.tscn").instance()


func _ready() -> void:
	add_child(level)
	connection.connect_to_host("127.0.0.1", int(OS.get_environment("TLTL_PORT")))
	while connection.get_status() == StreamPeerTCP.STATUS_CONNECTING:
		OS.delay_msec(1)
	connection.set_no_delay(true)


func _physics_process(_delta) -> void:
	connection.get_u8()  # waits for a line
	if not connection.is_connected_to_host():
		get_tree().quit()
		return
	var text = "{" + connection.get_utf8_string(connection.get_available_bytes())
	var message = parse_json(text)
	if message.has("step"):
		var action = message["step"]["action"]
		level.tick(action[0] - 1, action[1] - 1)
		judge.step(level.signals())
	else:
		level.begin("v0", 1)
		judge.begin("courtyard")
	var positions = level.positions()
	for name in positions:
		var place = positions[name]
		positions[name] = [place.x, -place.z, place.y]
	var state = {
		"signals": level.signals(), "observation": Array(level.observation()), "ended": level.is_over(),
		"cause": level.cause(), "positions": positions,
	}
	connection.put_data((JSON.print({"state": state}) + "\n").to_utf8())
