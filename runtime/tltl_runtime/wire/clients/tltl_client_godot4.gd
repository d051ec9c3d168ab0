# Connect a game in Godot 4 (4.1 or newer) to tltlc, and record the play of a person.
#
# Copy this file into your project. A game is a node with the variable `hello` and some methods:
#
#     extends Node3D
#
#     const Tltl := preload("res://tltl_client_godot4.gd")
#
#     var hello: Dictionary = {
#         "name": "ice",
#         "clock_hz": 60,
#         "signals": {"speed": {"range": [0, 100]}, "at_goal": {"type": "bool"}},
#         "actions": {"type": "discrete", "n": 3},
#         "observation": {"type": "box", "low": -100, "high": 100, "shape": [2]},
#         "capabilities": ["seed", "positions"],
#     }
#     var tltl := Tltl.new()
#     @onready var player: CharacterBody3D = $Player
#
#     func _ready() -> void:
#         tltl.begin(self)
#
#     func _physics_process(_delta: float) -> void:
#         var action: Variant = tltl.next_action()  # answers for the last tick, and waits for the next one
#         if action == null:
#             return  # tltlc has closed the connection, and the game ends
#         player.velocity = Vector3(20.0 * (action - 1), 0, 0)
#         player.move_and_slide()
#
#     # Begin an episode, return its first state.
#     func reset(_scene: Variant, variant: String, seed_: Variant) -> Dictionary:
#         if variant != "v0":
#             return Tltl.refusal("there is no variant `%s`" % variant)
#         player.position = Vector3(seed_ % 4, 0, 0)
#         player.velocity = Vector3.ZERO
#         return state()
#
#     # The state after a tick.
#     func state() -> Dictionary:
#         var at_goal := player.position.x > 10.0
#         var speed := player.velocity.length()
#         return Tltl.state(
#             {"speed": speed, "at_goal": at_goal}, [player.position.x, speed], at_goal,
#             "goal" if at_goal else "", {"player": player.position})
#
#     # Optional methods:
#     # func snapshot() -> Variant:              keep the state of the game, return an id
#     # func restore(id: Variant) -> Dictionary: return to it, return the state
#     # func release_snapshot(id: Variant) -> Variant: forget it: there will be no return to it
#     # func screenshot() -> Dictionary:         return a picture, see `array`
#     # func outline() -> Dictionary:            return what maps of the current scene and variant show, such as
#     #     {"boxes": {"wall": [AABB(…), AABB(…)]}, "regions": {"hall": AABB(…)}}
#     # func close() -> void:                    called at the end
#
# `seed_` is null if the game does not declare the capability `seed`. Run the game as fast as the machine
# allows, and without a window; 60 is the number of physics frames in a second of the project:
#
#     godot --headless --path project --fixed-fps 60 --disable-render-loop
#
# If a person may play the game, too, call `begin` only if OS.has_environment("TLTL_PORT"), and record
# the play with a `Recorder`.
#
# A game that needs no physics of the engine has a method `step(action)`, which plays one tick and
# returns the state; `tltl.play(self)` then answers all requests. A game that is started first, and
# to which tltlc connects, calls `tltl.listen(self, 5000)` in place of `begin`.
#
# Positions can be a Vector2 or a Vector3: they are sent with the axes of tltlc, whose x points east,
# y north and z up: (x, -y), and (x, -z, y). So are the corners in an outline, and its boxes if they are
# a Rect2 or an AABB. A PackedFloat32Array as an observation is sent fastest.
# `docs/wire.md` of tltlc describes the protocol.

extends RefCounted

const PROTOCOL := 1
const LONGEST_LINE := 33554432
const KINDS: Array[String] = ["reset", "step", "snapshot", "restore", "release", "screenshot", "outline", "close"]

## Why the connection has ended or could not be made; empty if tltlc has closed it.
var problem: String = ""

var _game: Object = null
var _connection := StreamPeerTCP.new()
var _received := PackedByteArray()  # bytes that no line was made of yet
var _body: Dictionary = {}  # the content of the last request
var _whole_actions: bool = false
var _action: Variant = null
var _ticks_left: int = 0  # of the step that is being played
var _keys: Dictionary = {}  # the text of each key in a message, by name
var _not_finite: String = ""  # what was wrong with a number of the message that is being written
var _listens: bool = false
var _is_over: bool = false


# --- messages -------------------------------------------------------------------------------------


## Returns the state of the game for a message.  `signals` are numbers in SI units and bools, by name.
## `ended` says whether the episode has ended, and `cause` who or what ended it; it is null or empty if
## that is unknown.  `positions` are vectors, or lists of two or three coordinates in metres, by the name
## of the entity; the player's name is `player`.
static func state(
	signals: Dictionary,
	observation: Variant = null,
	ended: bool = false,
	cause: Variant = null,
	positions: Variant = null
) -> Dictionary:
	return {
		"signals": signals, "observation": observation, "ended": ended, "cause": cause, "positions": positions
	}


## Returns a large array, such as a picture, for a message.  `data` are the bytes of the array,
## little-endian; the last index changes fastest.  `dtype` is a word such as "uint8", and `shape` a
## list such as [84, 84, 3].
static func array(data: PackedByteArray, dtype: String, shape: Array) -> Dictionary:
	return {"base64": Marshalls.raw_to_base64(data), "dtype": dtype, "shape": shape}


## Returns what a method of the game returns if a request cannot be met.  tltlc shows the text.
static func refusal(reason: String) -> Dictionary:
	return {"error": {"message": reason}}


# --- the connection -------------------------------------------------------------------------------


## Connects to tltlc, and sends `hello`.  Port and token come from the environment variables
## TLTL_PORT and TLTL_TOKEN.  Returns false, and ends the game, if no tltlc can be reached.
func begin(game: Object) -> bool:
	var port: String = OS.get_environment("TLTL_PORT")
	if port == "":
		return _fail("tltlc must start this game: the variable TLTL_PORT is not set")
	if _connection.connect_to_host("127.0.0.1", port.to_int()) == OK:
		while _connection.get_status() == StreamPeerTCP.STATUS_CONNECTING:
			OS.delay_msec(1)
			_connection.poll()
	if _connection.get_status() != StreamPeerTCP.STATUS_CONNECTED:
		return _fail("cannot connect to tltlc at port %s" % port)
	return _say_hello(game, OS.get_environment("TLTL_TOKEN"))


## Waits on a port of 127.0.0.1 until tltlc connects, and answers it with `hello`.  Use this if the
## game file has `connect = "127.0.0.1:PORT"`.  If the variable TLTL_TOKEN is not empty, tltlc must
## send the same one.  While one tltlc plays, no other can connect.  Returns false, and ends the game,
## if another program uses the port.  Once this tltlc has ended, call it again.
func listen(game: Object, port: int) -> bool:
	_listens = true
	_is_over = false
	while not _is_over:
		var server := TCPServer.new()
		if server.listen(port, "127.0.0.1") != OK:
			return _fail("cannot listen on port %d; does this game run twice?" % port)
		while not server.is_connection_available():
			OS.delay_msec(5)
		_connection = server.take_connection()
		server.stop()
		_received.clear()
		var line: String = _line()
		var reason: String = _why_not(JSON.parse_string(line), OS.get_environment("TLTL_TOKEN"))
		if reason == "":
			return _say_hello(game, "")
		_connection.put_data((_text(refusal(reason)) + "\n").to_utf8_buffer())
		_connection.disconnect_from_host()
	return false


## Answers the requests of tltlc, until one asks for a step; then returns its action.  Call this at
## the beginning of each physics frame.  It first sends the state after the frame before, which the
## game's method `state` gives.  Returns null once the connection has ended; the engine then ends, too.
func next_action() -> Variant:
	if _ticks_left > 0:
		var now: Dictionary = _game.call("state")
		_ticks_left -= 1
		if _ticks_left > 0 and not now["ended"]:
			return _action
		_ticks_left = 0
		_answer_result(now)
	while not _is_over:
		var kind: String = _request()
		if kind == "step":
			_begin_step()
			return _action
		_serve(kind)
	return null


## Connects to tltlc, unless that is done, and answers its requests until it closes the connection.
## The game's method `step` plays a tick.
func play(game: Object) -> void:
	if _game == null and not begin(game):
		return
	while not _is_over:
		var kind: String = _request()
		if kind == "step":
			_begin_step()
			var now: Dictionary = game.call("step", _action)
			while _ticks_left > 1 and now.has("signals") and not now["ended"]:
				_ticks_left -= 1
				now = game.call("step", _action)
			_ticks_left = 0
			_answer_result(now)
		else:
			_serve(kind)


func _say_hello(game: Object, token: String) -> bool:
	_game = game
	_is_over = false
	_connection.set_no_delay(true)
	var declared: Dictionary = game.get("hello")
	var hello: Dictionary = declared.duplicate(true)
	hello["tltl"] = PROTOCOL
	if token != "":
		hello["token"] = token
	var words: Array = hello.get("capabilities", [])
	if game.has_method("snapshot") and game.has_method("restore") and not words.has("snapshot"):
		words.append("snapshot")
	if game.has_method("release_snapshot") and not words.has("release"):
		words.append("release")
	if game.has_method("screenshot") and not words.has("screenshot"):
		words.append("screenshot")
	if game.has_method("outline") and not words.has("outline"):
		words.append("outline")
	hello["capabilities"] = words
	_whole_actions = not ("box" in _types(hello["actions"]))
	_send(_text({"hello": hello}))
	return not _is_over


# Returns the types of the spaces in a space.
static func _types(space: Dictionary) -> Array:
	var types: Array = [space["type"]]
	var parts: Variant = space.get("spaces", [])
	var spaces: Array = parts.values() if parts is Dictionary else parts
	for part in spaces:
		types += _types(part)
	return types


# Returns why the game refuses the first message of tltlc; empty if it accepts it.
static func _why_not(message: Variant, token: String) -> String:
	if not (message is Dictionary and message.get("hello") is Dictionary):
		return "the first line must be a `hello`"
	var hello: Dictionary = message["hello"]
	if not _is_equal(hello.get("tltl"), float(PROTOCOL)):
		return "this game speaks version %d of the protocol" % PROTOCOL
	if token != "" and not _is_equal(hello.get("token"), token):
		return "the token is wrong: start tltlc with the variable TLTL_TOKEN of this game"
	return ""


# Whether two values have the same type and are equal: the engine compares no others.
static func _is_equal(one: Variant, other: Variant) -> bool:
	return typeof(one) == typeof(other) and one == other


func _begin_step() -> void:
	_action = _body["action"]
	if _whole_actions:
		_action = _whole(_action)
	_ticks_left = int(_body["repeat"]) if _body.has("repeat") else 1


# The engine reads all numbers of JSON as floats.
static func _whole(value: Variant) -> Variant:
	if value is float:
		return int(value)
	if value is Array:
		for place in range(value.size()):
			value[place] = _whole(value[place])
	elif value is Dictionary:
		for key in value:
			value[key] = _whole(value[key])
	return value


func _serve(kind: String) -> void:
	if _is_over:
		return
	if kind == "close":
		_end(0)
	elif kind == "reset":
		var chosen: Variant = _whole(_body.get("seed"))
		_answer_result(_game.call("reset", _body.get("scene"), _body.get("variant", "v0"), chosen))
	elif kind == "snapshot" and _game.has_method("snapshot"):
		var kept: Variant = _game.call("snapshot")
		var answer: Dictionary = {"snapshot": {"id": kept}}
		if kept is Dictionary:
			answer = kept
		_send(_text(answer))
	elif kind == "restore" and _game.has_method("restore"):
		_answer_result(_game.call("restore", _whole(_body["id"])))
	elif kind == "release" and _game.has_method("release_snapshot"):
		var id: Variant = _whole(_body["id"])
		var result: Variant = _game.call("release_snapshot", id)
		var released: Dictionary = {"release": {"id": id}}
		if result is Dictionary:
			released = result
		_send(_text(released))
	elif kind == "screenshot" and _game.has_method("screenshot"):
		_answer_part(kind, _game.call("screenshot"))
	elif kind == "outline" and _game.has_method("outline"):
		_answer_part(kind, _game.call("outline"))
	else:
		_send(_text(refusal("this game does not know the request `%s`" % kind)))


# Sends a picture or an outline, or the refusal of it.
func _answer_part(kind: String, result: Dictionary) -> void:
	var answer: Dictionary = {kind: result}
	if result.has("error"):
		answer = result
	_send(_text(answer))


func _answer_result(result: Dictionary) -> void:
	_send(_state_text(result) if result.has("signals") else _text(result))


# Waits for the next request; returns its kind, such as "step", and keeps its content.
func _request() -> String:
	var line: String = _line()
	if line == "":
		_end(0)
		return ""
	var message: Variant = JSON.parse_string(line)
	if not (message is Dictionary):
		_fail("tltlc sent a line that is no message")
		return ""
	if message.has("error"):
		var body: Variant = message["error"]
		_fail(str(body["message"]) if body is Dictionary and body.has("message") else str(body))
		return ""
	for kind in message:
		if kind in KINDS and message[kind] is Dictionary:
			_body = message[kind]
			return kind
	return "" if message.is_empty() else str(message.keys()[0])


# Returns the next line; empty once the connection has ended.
func _line() -> String:
	var searched: int = 0
	while searched <= LONGEST_LINE:
		var end: int = _received.find(10, searched)
		if end >= 0:
			var line: String = _received.slice(0, end).get_string_from_utf8()
			_received = _received.slice(end + 1)
			return line
		searched = _received.size()
		if not _receive(1):  # This waits,
			return ""
		var more: int = _connection.get_available_bytes()
		if more > 0 and not _receive(more):  # and this does not.
			return ""
	return ""


func _receive(count: int) -> bool:
	var result: Array = _connection.get_data(count)
	if result[0] != OK:
		return false
	var bytes: PackedByteArray = result[1]
	_received.append_array(bytes)
	return true


func _send(text: String) -> void:
	if _not_finite != "":
		text = _text(refusal(_not_finite + ", and numbers must be finite"))
		_not_finite = ""
	if _connection.put_data((text + "\n").to_utf8_buffer()) != OK:
		_end(0)


func _fail(reason: String) -> bool:
	problem = reason
	printerr(reason)
	_end(1)
	return false


func _end(status: int) -> void:
	if _is_over:
		return
	_is_over = true
	_connection.disconnect_from_host()
	if _game != null and _game.has_method("close"):
		_game.call("close")
	if status != 0 or not _listens:
		var tree: SceneTree = Engine.get_main_loop()
		tree.quit(status)


# --- text -----------------------------------------------------------------------------------------


# Returns the message of a state as JSON.
func _state_text(message: Dictionary) -> String:
	var text: String = '{"state":{"ended":true' if message["ended"] else '{"state":{"ended":false'
	var cause: Variant = message.get("cause")
	if cause is String and cause != "":
		text += ',"cause":' + _key(cause)
	else:
		text += ',"cause":null'
	var observation: Variant = message.get("observation")
	if observation != null:
		text += ',"observation":' + _text(observation)
	var positions: Variant = message.get("positions")
	if positions != null:
		text += ',"positions":' + _text(positions)
	var parts := PackedStringArray()
	var signals: Dictionary = message["signals"]
	for name in signals:
		var value: Variant = signals[name]
		if value is float and not is_finite(value):
			_not_finite = "the signal %s is %s" % [name, value]
		parts.append(_key(name) + ":" + _text(value))
	return text + ',"signals":{' + ",".join(parts) + "}}}"


# Returns a value as JSON.  Unlike the engine's, this text has all digits of a number.
func _text(value: Variant) -> String:
	match typeof(value):
		TYPE_NIL:
			return "null"
		TYPE_BOOL:
			return "true" if value else "false"
		TYPE_INT:
			return str(value)
		TYPE_FLOAT:
			if not is_finite(value) and _not_finite == "":
				_not_finite = "a number is %s" % value
			return Digits.text(value)
		TYPE_STRING, TYPE_STRING_NAME:
			return _quoted(str(value))
		TYPE_VECTOR2:
			return _text([value.x, -value.y])
		TYPE_VECTOR3:
			return _text([value.x, -value.z, value.y])
		TYPE_RECT2:
			var area: Rect2 = value
			return _text([[area.position.x, -area.end.y], [area.end.x, -area.position.y]])
		TYPE_AABB:
			var low: Vector3 = value.position
			var high: Vector3 = value.end
			return _text([[low.x, -high.z, low.y], [high.x, -low.z, high.y]])
		TYPE_PACKED_FLOAT32_ARRAY:
			return _text(array(value.to_byte_array(), "float32", [value.size()]))
		TYPE_PACKED_FLOAT64_ARRAY:
			return _text(array(value.to_byte_array(), "float64", [value.size()]))
		TYPE_DICTIONARY:
			var members := PackedStringArray()
			for key in value:
				members.append(_key(str(key)) + ":" + _text(value[key]))
			return "{" + ",".join(members) + "}"
	var items := PackedStringArray()
	for item in value:
		items.append(_text(item))
	return "[" + ",".join(items) + "]"


# Returns the text of a name, which is made only once.
func _key(name: String) -> String:
	if not _keys.has(name):
		_keys[name] = _quoted(name)
	return _keys[name]


static func _quoted(text: String) -> String:
	var escaped: String = text.replace("\\", "\\\\").replace('"', '\\"')
	for place in range(escaped.length() - 1, -1, -1):
		var code: int = escaped.unicode_at(place)
		if code < 32:
			escaped = escaped.substr(0, place) + "\\u%04x" % code + escaped.substr(place + 1)
	return '"' + escaped + '"'


## Writes numbers.
class Digits:
	## Returns a text whose value is exactly this number, or "null" if it is not finite.  The texts of
	## the engine have fewer digits.
	static func text(value: float) -> String:
		if not is_finite(value):
			return "null"
		var size: float = absf(value)
		if size < 1e15:
			if value == floorf(value):
				return str(int(value))
			if size >= 0.5:
				return String.num(value, 17)
			if size >= 1e-12:
				return String.num(value, 30)
		return odd(value)

	## Returns a value of JSON as a text whose numbers have all their digits.
	static func json(value: Variant) -> String:
		if value is float:
			return text(value)
		var parts := PackedStringArray()
		if value is Dictionary:
			for key in value:
				parts.append(JSON.stringify(str(key)) + ":" + json(value[key]))
			return "{" + ",".join(parts) + "}"
		if typeof(value) < TYPE_ARRAY:
			return JSON.stringify(value)
		for item in value:
			parts.append(json(item))
		return "[" + ",".join(parts) + "]"

	## Whether all numbers of a value of JSON are finite.
	static func are_finite(value: Variant) -> bool:
		if value is float and not is_finite(value):
			return false
		var items: Variant = value.values() if value is Dictionary else value
		if typeof(items) >= TYPE_ARRAY:
			for item in items:
				if not are_finite(item):
					return false
		return true

	## Returns the text of a number that is very small or very large: all its digits, and an exponent.
	static func odd(value: float) -> String:
		var factor: float = absf(value)
		var exponent: int = 0
		while factor != floorf(factor):
			factor *= 2.0
			exponent -= 1
		while factor >= 9007199254740992.0:
			factor /= 2.0
			exponent += 1
		# The value is `factor * 2^exponent`, or `factor * 5^-exponent * 10^exponent`.
		var base: int = 2 if exponent > 0 else 5
		var limbs: Array[int] = [int(factor)]  # nine digits each, the lowest first
		_carry(limbs)
		for _step in range(absi(exponent)):
			for place in range(limbs.size()):
				limbs[place] *= base
			_carry(limbs)
		var digits: String = str(limbs.back())
		for place in range(limbs.size() - 2, -1, -1):
			digits += "%09d" % limbs[place]
		return ("-" if value < 0.0 else "") + digits + ("e%d" % exponent if exponent < 0 else "")

	# Brings each limb below a thousand million.
	static func _carry(limbs: Array[int]) -> void:
		var carry: int = 0
		for place in range(limbs.size()):
			carry += limbs[place]
			limbs[place] = carry % 1000000000
			@warning_ignore("integer_division")
			carry = carry / 1000000000
		while carry > 0:
			limbs.append(carry % 1000000000)
			@warning_ignore("integer_division")
			carry = carry / 1000000000


# --- recording ------------------------------------------------------------------------------------


## Writes the play of a person as traces, which `tltlc monitor` can judge later; needs no connection.
## Each episode is a file in `folder`, such as "user://traces": `trace-0001.csv`, `trace-0002.csv` and
## so on; no file is overwritten.  `signals` are the names of the signals, as specs write them.  With
## `clock_hz`, the number of samples in a second, the files have a column `time`:
##
##     var recorder := Tltl.Recorder.new("user://traces", ["speed", "at_goal"], 60)
##     recorder.begin()
##     recorder.sample({"speed": 0.5, "at_goal": false})  # after each tick
##     recorder.end()
##
## With the actions of the person, as tltlc would send them, each episode is also a tape,
## `trace-0001.tape.jsonl`, with which the play can be repeated.  `game` is the name of the game:
##
##     recorder.begin("crypt", "v0", seed_)
##     recorder.sample({"speed": 0.5, "at_goal": false}, 2)
class Recorder:
	extends RefCounted

	## Why the last sample was refused.
	var problem: String = ""

	var _folder: String = ""
	var _signals: Array = []
	var _clock_hz: float = 0.0
	var _game: String = ""
	var _file: FileAccess = null
	var _tape: FileAccess = null
	var _are_bools: Array = []  # for each signal of the tape, which keeps the type of its first value
	var _tape_path: String = ""
	var _samples: int = 0
	var _played: Dictionary = {}  # empty if no trace has begun
	var _low: int = 1  # of the digest, Adler-32
	var _high: int = 0

	func _init(folder: String, signals: Array, clock_hz: float = 0.0, game: String = "game") -> void:
		_folder = folder
		_signals = signals
		_clock_hz = clock_hz
		_game = game

	## Begins a new trace, and ends the one before; returns the path of its file, which the first sample
	## makes.  A tape says which scene, variant and seed were played; without a
	## variant it is `v0`.
	func begin(scene: Variant = null, variant: Variant = null, seed_: Variant = null) -> String:
		end()
		_samples = 0
		_low = 1
		_high = 0
		_played = {"scene": scene, "variant": "v0" if variant == null else variant, "seed": seed_}
		return _path(_free_number())

	## Writes the values of all signals at one moment to the file at once; begins a trace if there is
	## none.  With `action`, what the person did in the tick before it, the step is written to the tape,
	## too.  Returns false, and writes nothing, if a number is not finite or a signal is missing, or if
	## some samples of an episode have an action and others have none.
	func sample(signals: Dictionary, action: Variant = null) -> bool:
		var cells := PackedStringArray()
		for name in _signals:
			if not signals.has(name):
				return _refuse("the signal %s is missing" % name)
			var value: Variant = signals[name]
			if value is float and not is_finite(value):
				return _refuse("the signal %s is %s, and numbers must be finite" % [name, value])
			cells.append(("true" if value else "false") if value is bool else Digits.text(float(value)))
		if not Digits.are_finite(action):
			return _refuse("the action is %s, and numbers must be finite" % str(action))
		if _played.is_empty():
			begin()
		if _file == null and not _make_trace():
			return false
		if _samples > 0 and (action != null) != (_tape != null):
			return _refuse("give the action of each sample of an episode, or of none")
		if action != null and not _write_step(action, signals):
			return false
		if _clock_hz > 0.0:
			cells.insert(0, Digits.text(_samples / _clock_hz))
		_samples += 1
		_write(_file, ",".join(cells))
		return true

	## Ends the trace and its tape, if there is one.
	func end() -> void:
		_file = null
		_tape = null
		_played = {}

	func _free_number() -> int:
		var number: int = 1
		while FileAccess.file_exists(_path(number)) or FileAccess.file_exists(_path(number, "tape.jsonl")):
			number += 1
		return number

	func _make_trace() -> bool:
		DirAccess.make_dir_recursive_absolute(_folder)
		var number: int = _free_number()
		_file = FileAccess.open(_path(number), FileAccess.WRITE)
		if _file == null:
			return _refuse("cannot write %s" % _path(number))
		_tape_path = _path(number, "tape.jsonl")
		var names := PackedStringArray()
		if _clock_hz > 0.0:
			names.append("time")
		for name in _signals:
			var is_plain: bool = not ("," in name) and not name.begins_with('"')
			names.append(name if is_plain else '"' + name.replace('"', '""') + '"')
		_write(_file, ",".join(names))
		return true

	# Writes a step to the tape, and before the first one the header.
	func _write_step(action: Variant, signals: Dictionary) -> bool:
		if _tape == null:
			_tape = FileAccess.open(_tape_path, FileAccess.WRITE)
			if _tape == null:
				return _refuse("cannot write %s" % _tape_path)
			_write(_tape, _header(signals))
		var members := PackedStringArray()
		var bytes := StreamPeerBuffer.new()
		for index in range(_signals.size()):
			var number: float = float(signals[_signals[index]]) + 0.0  # -0 counts as 0
			var text: String = Digits.text(number)
			if _are_bools[index]:
				text = "true" if number != 0.0 else "false"
				number = 1.0 if number != 0.0 else 0.0
			members.append(JSON.stringify(_signals[index]) + ":" + text)
			bytes.put_double(number)
		for byte in bytes.data_array:
			_low = (_low + byte) % 65521
			_high = (_high + _low) % 65521
		var digest: String = ',"digest":"%04x%04x"' % [_high, _low] if (_samples + 1) % 60 == 0 else ""
		_write(_tape, '{"action":' + Digits.json(action) + ',"signals":{' + ",".join(members) + "}" + digest + "}")
		return true

	func _header(signals: Dictionary) -> String:
		var types := PackedStringArray()
		_are_bools = []
		for name in _signals:
			_are_bools.append(signals[name] is bool)
			types.append(JSON.stringify(name) + ':{"type":"%s"}' % ("bool" if signals[name] is bool else "number"))
		var about: Dictionary = {"tape": 1, "game": _game, "spec": null}
		about["clock_hz"] = _clock_hz if _clock_hz > 0.0 else null
		about["versions"] = {"godot": Engine.get_version_info()["string"]}
		about.merge(_played)
		var text: String = Digits.json(about)
		return text.substr(0, text.length() - 1) + ',"signals":{' + ",".join(types) + "}}"

	func _path(number: int, ending: String = "csv") -> String:
		return _folder.path_join("trace-%04d.%s" % [number, ending])

	func _refuse(reason: String) -> bool:
		problem = reason
		push_error(reason)
		return false

	func _write(file: FileAccess, line: String) -> void:
		file.store_line(line)
		file.flush()
