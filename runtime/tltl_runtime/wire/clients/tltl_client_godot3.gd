# Connect a game in Godot 3 (3.2 or newer) to tltlc, and record the play of a person.
#
# Copy this file into your project. A game is a node with the variable `hello` and some methods:
#
#     extends Spatial
#
#     const Tltl = preload("res://tltl_client_godot3.gd")
#
#     var hello = {
#         "name": "ice",
#         "clock_hz": 60,
#         "signals": {"speed": {"range": [0, 100]}, "at_goal": {"type": "bool"}},
#         "actions": {"type": "discrete", "n": 3},
#         "observation": {"type": "box", "low": -100, "high": 100, "shape": [2]},
#         "capabilities": ["seed", "positions"],
#     }
#     var tltl = Tltl.new()
#     var speed = 0.0
#     onready var player = $Player  # a KinematicBody
#
#     func _ready():
#         tltl.begin(self)
#
#     func _physics_process(delta):
#         var action = tltl.next_action()  # answers for the last tick, and waits for the next one
#         if action == null:
#             return  # tltlc has closed the connection, and the game ends
#         speed = player.move_and_slide(Vector3(20.0 * (action - 1), 0, 0)).length()
#
#     func reset(scene, variant, seed_):  # begin an episode, return its first state
#         player.translation = Vector3(seed_ % 4, 0, 0)
#         speed = 0.0
#         return state()
#
#     func state():  # the state after a tick
#         var at_goal = player.translation.x > 10.0
#         return Tltl.state(
#             {"speed": speed, "at_goal": at_goal}, [player.translation.x, speed], at_goal,
#             "goal" if at_goal else null, {"player": player.translation})
#
#     # Optional methods:
#     # func snapshot():      keep the state of the game, return an id
#     # func restore(id):     return to it, return the state
#     # func release_snapshot(id):  forget it: there will be no return to it
#     # func screenshot():    return a picture, see `array`
#     # func outline():       return what maps of the current scene and variant show, such as
#     #     {"boxes": {"wall": [AABB(…), AABB(…)]}, "regions": {"hall": AABB(…)}}
#     # func close():         called at the end
#
# A method returns `Tltl.refusal("there is no scene `crypt`")` where a request cannot be met.
# `seed_` is null if the game does not declare the capability `seed`. Run the game as fast as the machine
# allows, and without a window; 60 is the number of physics frames in a second of the project:
#
#     godot3-server --path project --fixed-fps 60 --disable-render-loop
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
# a Rect2 or an AABB. A PoolRealArray as an observation is sent fastest.
# `docs/wire.md` of tltlc describes the protocol.

extends Reference

const PROTOCOL = 1
const LONGEST_LINE = 33554432
const KINDS = ["step", "reset", "snapshot", "restore", "release", "screenshot", "outline", "close"]

# Why the connection has ended or could not be made; empty if tltlc has closed it.
var problem = ""

var _game = null
var _connection = StreamPeerTCP.new()
var _rest = PoolByteArray()  # bytes that were received but belong to the next line
var _body = {}  # the content of the last request
var _whole_actions = false
var _action = null
var _ticks_left = 0  # of the step that is being played
var _names = {}  # the text that stands before the value of a signal or an entity, by name
var _true = {}  # the text of a signal that is true, by name
var _false = {}
var _places = {}  # the last position of each entity, by name
var _place_texts = {}
var _not_finite = ""  # what was wrong with a number of the message that is being written
var _listens = false
var _is_over = false


# --- messages -------------------------------------------------------------------------------------


# Returns the state of the game for a message.  `signals` are numbers in SI units and bools, by name.
# `ended` says whether the episode has ended, and `cause` who or what ended it.  `positions` are
# vectors, or lists of two or three coordinates in metres, by the name of the entity; the player's
# name is `player`.
static func state(signals: Dictionary, observation = null, ended: bool = false, cause = null, positions = null) -> Dictionary:
	return {
		"signals": signals, "observation": observation, "ended": ended, "cause": cause, "positions": positions
	}


# Returns a large array, such as a picture, for a message.  `data` are the bytes of the array,
# little-endian; the last index changes fastest.  `dtype` is a word such as "uint8", and `shape` a
# list such as [84, 84, 3].
static func array(data: PoolByteArray, dtype: String, shape: Array) -> Dictionary:
	return {"base64": Marshalls.raw_to_base64(data), "dtype": dtype, "shape": shape}


# Returns what a method of the game returns if a request cannot be met.  tltlc shows the text.
static func refusal(reason: String) -> Dictionary:
	return {"error": {"message": reason}}


# --- the connection -------------------------------------------------------------------------------


# Connects to tltlc, and sends `hello`.  Port and token come from the environment variables
# TLTL_PORT and TLTL_TOKEN.  Returns false, and ends the game, if no tltlc can be reached.
func begin(game) -> bool:
	var port = OS.get_environment("TLTL_PORT")
	if port == "":
		return _fail("tltlc must start this game: the variable TLTL_PORT is not set")
	if _connection.connect_to_host("127.0.0.1", int(port)) == OK:
		while _connection.get_status() == StreamPeerTCP.STATUS_CONNECTING:
			OS.delay_msec(1)
	if _connection.get_status() != StreamPeerTCP.STATUS_CONNECTED:
		return _fail("cannot connect to tltlc at port %s" % port)
	return _say_hello(game, OS.get_environment("TLTL_TOKEN"))


# Waits on a port of 127.0.0.1 until tltlc connects, and answers it with `hello`.  Use this if the
# game file has `connect = "127.0.0.1:PORT"`.  If the variable TLTL_TOKEN is not empty, tltlc must
# send the same one.  While one tltlc plays, no other can connect.  Returns false, and ends the game,
# if another program uses the port.  Once this tltlc has ended, call it again.
func listen(game, port: int) -> bool:
	_listens = true
	_is_over = false
	while true:
		var server = TCP_Server.new()
		if server.listen(port, "127.0.0.1") != OK:
			return _fail("cannot listen on port %d; does this game run twice?" % port)
		while not server.is_connection_available():
			OS.delay_msec(5)
		_connection = server.take_connection()
		server.stop()
		_rest = PoolByteArray()
		var line = _line()
		var reason = _why_not(null if line == null else parse_json(line), OS.get_environment("TLTL_TOKEN"))
		if reason == "":
			return _say_hello(game, "")
		_send(_text(refusal(reason)))
		_connection.disconnect_from_host()
	return false


# Answers the requests of tltlc, until one asks for a step; then returns its action.  Call this at
# the beginning of each physics frame.  It first sends the state after the frame before, which the
# game's method `state` gives.  Returns null once the connection has ended; the engine then ends, too.
func next_action():
	if _ticks_left > 0:
		var now = _game.state()
		_ticks_left -= 1
		if _ticks_left > 0 and not now["ended"]:
			return _action
		_ticks_left = 0
		_answer_result(now)
	while not _is_over:
		var kind = _request()
		if kind == "step":
			_begin_step()
			return _action
		_serve(kind)
	return null


# Connects to tltlc, unless that is done, and answers its requests until it closes the connection.
# The game's method `step` plays a tick.
func play(game) -> void:
	if _game == null and not begin(game):
		return
	while not _is_over:
		var kind = _request()
		if kind == "step":
			_begin_step()
			var now = game.step(_action)
			while _ticks_left > 1 and now.has("signals") and not now["ended"]:
				_ticks_left -= 1
				now = game.step(_action)
			_ticks_left = 0
			_answer_result(now)
		else:
			_serve(kind)


func _say_hello(game, token: String) -> bool:
	_game = game
	_is_over = false
	_connection.set_no_delay(true)
	var hello = game.hello.duplicate(true)
	hello["tltl"] = PROTOCOL
	if token != "":
		hello["token"] = token
	var words = hello.get("capabilities", []).duplicate()
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
	var types = [space["type"]]
	var parts = space.get("spaces", [])
	for part in (parts.values() if parts is Dictionary else parts):
		types += _types(part)
	return types


# Returns why the game refuses the first message of tltlc; empty if it accepts it.
static func _why_not(message, token: String) -> String:
	if not (message is Dictionary) or not (message.get("hello") is Dictionary):
		return "the first line must be a `hello`"
	if message["hello"].get("tltl") != PROTOCOL:
		return "this game speaks version %d of the protocol" % PROTOCOL
	if token != "" and message["hello"].get("token") != token:
		return "the token is wrong: start tltlc with the variable TLTL_TOKEN of this game"
	return ""


func _begin_step() -> void:
	_action = _body["action"]
	if _whole_actions:
		_action = _whole(_action)
	_ticks_left = int(_body["repeat"]) if _body.has("repeat") else 1


# The engine reads all numbers of JSON as floats.
static func _whole(value):
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
		var seed_ = _body.get("seed")
		_answer_result(
			_game.reset(_body.get("scene"), _body.get("variant", "v0"), null if seed_ == null else int(seed_))
		)
	elif kind == "snapshot" and _game.has_method("snapshot"):
		var id = _game.snapshot()
		_send(_text(id if id is Dictionary else {"snapshot": {"id": id}}))
	elif kind == "restore" and _game.has_method("restore"):
		_answer_result(_game.restore(_whole(_body["id"])))
	elif kind == "release" and _game.has_method("release_snapshot"):
		var id = _whole(_body["id"])
		var result = _game.release_snapshot(id)
		_send(_text(result if result is Dictionary else {"release": {"id": id}}))
	elif kind == "screenshot" and _game.has_method("screenshot"):
		_answer_part(kind, _game.screenshot())
	elif kind == "outline" and _game.has_method("outline"):
		_answer_part(kind, _game.outline())
	else:
		_send(_text(refusal("this game does not know the request `%s`" % kind)))


# Sends a picture or an outline, or the refusal of it.
func _answer_part(kind: String, result: Dictionary) -> void:
	_send(_text(result if result.has("error") else {kind: result}))


func _answer_result(result: Dictionary) -> void:
	_send(_state_text(result) if result.has("signals") else _text(result))


# Waits for the next request; returns its kind, such as "step", and keeps its content.
func _request() -> String:
	var line = _line()
	if line == null:
		_end(0)
		return ""
	var message = parse_json(line)
	if not (message is Dictionary):
		_fail("tltlc sent a line that is no message")
		return ""
	if message.has("error"):
		var body = message["error"]
		_fail(str(body.get("message") if body is Dictionary else body))
		return ""
	for kind in KINDS:
		if message.has(kind):
			_body = message[kind]
			return kind
	return "" if message.empty() else message.keys()[0]


# Returns the next line; null once the connection has ended.
func _line():
	while _rest.size() == 0:
		var first = _connection.get_u8()  # waits
		if not _connection.is_connected_to_host():
			return null
		var count = _connection.get_available_bytes()
		if count > 0:
			var bytes = _connection.get_data(count)[1]
			if bytes[count - 1] == 10:
				var text = char(first) + bytes.get_string_from_utf8()
				if first < 128 and text.find("\n") == text.length() - 1:
					return text  # Usually, a message comes in one piece.
			_rest.append(first)
			_rest.append_array(bytes)
		else:
			_rest.append(first)
	return _long_line()


func _long_line():
	var data = _rest
	var from = 0
	while true:
		for place in range(from, data.size()):
			if data[place] == 10:
				_rest = data.subarray(place + 1, data.size() - 1) if place + 1 < data.size() else PoolByteArray()
				return data.subarray(0, place).get_string_from_utf8()
		from = data.size()
		data.append(_connection.get_u8())
		if not _connection.is_connected_to_host() or from > LONGEST_LINE:
			return null
		var count = _connection.get_available_bytes()
		if count > 0:
			data.append_array(_connection.get_data(count)[1])
	return null


func _send(text: String) -> void:
	if _not_finite != "":
		text = _text(refusal(_not_finite + ", and numbers must be finite"))
		_not_finite = ""
	if _connection.put_data((text + "\n").to_utf8()) != OK:
		# tltlc may have said why it closed the connection.
		if not _is_over:
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
		_game.close()
	if status != 0 or not _listens:
		Engine.get_main_loop().quit(status)


# --- text -----------------------------------------------------------------------------------------


# Returns the message of a state as JSON.  Most of the time of the client is spent here, so there are
# few calls, and what was sent before is not written anew.
func _state_text(message: Dictionary) -> String:
	var text = '{"state":{"ended":true' if message["ended"] else '{"state":{"ended":false'
	var cause = message.get("cause")
	text += ',"cause":null' if cause == null else ',"cause":' + _quoted(cause)
	var observation = message.get("observation")
	if observation is PoolRealArray:
		# Its bytes follow the eight bytes of a header.
		var bytes = var2bytes(observation)
		text += ',"observation":{"base64":"' + Marshalls.raw_to_base64(bytes.subarray(8, bytes.size() - 1))
		text += '","dtype":"float32","shape":[' + str(observation.size()) + "]}"
	elif observation != null:
		text += ',"observation":' + _text(observation)
	var positions = message.get("positions")
	if positions != null:
		text += ',"positions":{' + _positions_text(positions) + "}"
	var signals = message["signals"]
	var parts = ""
	for name in signals:
		var value = signals[name]
		if not (name in _names):
			_learn(name)
		if value is bool:
			parts += _true[name] if value else _false[name]
		elif value is float:
			parts += _names[name]
			if value >= 0.5 and value < 1e15:
				parts += "%.16f" % value  # As Digits.text does.
			else:
				if is_nan(value) or is_inf(value):
					_not_finite = "the signal %s is %s" % [name, value]
				parts += Digits.text(value)
		else:
			parts += _names[name]
			parts += _text(value)
	return text + ',"signals":{' + parts.substr(1, parts.length()) + "}}}"


# Makes the texts of a signal, or of an entity.
func _learn(name: String) -> void:
	_names[name] = "," + _quoted(name) + ":"
	_true[name] = _names[name] + "true"
	_false[name] = _names[name] + "false"


# Positions have six decimals: these are the engine's own texts of numbers, which are the fastest.
func _positions_text(positions: Dictionary) -> String:
	var parts = ""
	for name in positions:
		var place = positions[name]
		if typeof(_places.get(name)) != typeof(place) or _places[name] != place:
			if not _names.has(name):
				_learn(name)
			_places[name] = place
			if place is Vector3:
				_check_finite(name, place.x + place.y + place.z)
				_place_texts[name] = "%s[%s,%s,%s]" % [_names[name], place.x, -place.z, place.y]
			elif place is Vector2:
				_check_finite(name, place.x + place.y)
				_place_texts[name] = "%s[%s,%s]" % [_names[name], place.x, -place.y]
			else:
				_place_texts[name] = _names[name] + _text(place)
				_places.erase(name)  # A list may change.
		parts += _place_texts[name]
	return parts.substr(1, parts.length())


func _check_finite(name: String, sum: float) -> void:
	if is_nan(sum) or is_inf(sum):
		_not_finite = "the position of %s is not finite" % name


# Returns a value as JSON.  Unlike the engine's, this text has all digits of a number.
func _text(value) -> String:
	match typeof(value):
		TYPE_NIL:
			return "null"
		TYPE_BOOL:
			return "true" if value else "false"
		TYPE_INT:
			return str(value)
		TYPE_REAL:
			if is_nan(value) or is_inf(value):
				_not_finite = "a number is %s" % value
			return Digits.text(value)
		TYPE_STRING:
			return _quoted(value)
		TYPE_VECTOR2:
			return _text([value.x, -value.y])
		TYPE_VECTOR3:
			return _text([value.x, -value.z, value.y])
		TYPE_RECT2, TYPE_AABB:
			return _text(_corners(value.position, value.end))
		TYPE_DICTIONARY:
			var members = PoolStringArray()
			for key in value:
				members.append(_quoted(key) + ":" + _text(value[key]))
			return "{" + members.join(",") + "}"
	var items = PoolStringArray()
	for item in value:
		items.append(_text(item))
	return "[" + items.join(",") + "]"


# Returns the two corners of a box with the axes of tltlc: first the western, southern and lower one.
static func _corners(low, high) -> Array:
	if low is Vector2:
		return [[low.x, -high.y], [high.x, -low.y]]
	return [[low.x, -high.z, low.y], [high.x, -low.z, high.y]]


static func _quoted(text: String) -> String:
	var escaped = text.replace("\\", "\\\\").replace('"', '\\"')
	for place in range(escaped.length() - 1, -1, -1):
		if escaped.ord_at(place) < 32:
			escaped = escaped.substr(0, place) + "\\u%04x" % escaped.ord_at(place) + escaped.substr(place + 1, escaped.length())
	return '"' + escaped + '"'


# Writes numbers.
class Digits:
	# Returns a text whose value is exactly this number, or "null" if it is not finite.  The texts of the
	# engine have six decimals.
	static func text(value: float) -> String:
		if value == floor(value) and value < 1e15 and value > -1e15:
			return str(int(value))
		var size = abs(value)
		if size >= 0.5 and size < 1e15:
			return "%.16f" % value
		if size < 0.5 and size > 1e-6:
			# The eight decimals of `high`, which has 26 binary places, need no rounding.  The rest has so few
			# digits that its rounding is of no account.
			var high = floor(size * 67108864.0) / 67108864.0
			var scaled = high * 1e8
			var whole = floor(scaled)
			var rest = scaled - whole + (size - high) * 1e8
			if rest >= 1.0:
				whole += floor(rest)
				rest -= floor(rest)
			return ("-0.%08d%s" if value < 0.0 else "0.%08d%s") % [int(whole), ("%.16f" % rest).substr(2, 16)]
		return odd(value)

	# Returns a value of JSON as a text whose numbers have all their digits.
	static func json(value) -> String:
		if value is float:
			return text(value)
		var parts = PoolStringArray()
		if value is Dictionary:
			for key in value:
				parts.append(to_json(str(key)) + ":" + json(value[key]))
			return "{" + parts.join(",") + "}"
		if typeof(value) < TYPE_ARRAY:
			return to_json(value)
		for item in value:
			parts.append(json(item))
		return "[" + parts.join(",") + "]"

	# Whether all numbers of a value of JSON are finite.
	static func are_finite(value) -> bool:
		if value is float:
			return not (is_nan(value) or is_inf(value))
		var items = value.values() if value is Dictionary else value
		if typeof(items) >= TYPE_ARRAY:
			for item in items:
				if not are_finite(item):
					return false
		return true

	# Returns the text of a number that is very small or very large: all its digits, and an exponent.
	static func odd(value: float) -> String:
		if is_nan(value) or is_inf(value):
			return "null"
		var factor = abs(value)
		var exponent = 0
		while factor != floor(factor):
			factor *= 2.0
			exponent -= 1
		while factor >= 9007199254740992.0:
			factor /= 2.0
			exponent += 1
		# The value is `factor * 2^exponent`, or `factor * 5^-exponent * 10^exponent`.
		var base = 2 if exponent > 0 else 5
		var limbs = [int(factor)]  # nine digits each, the lowest first
		for _step in range(int(abs(exponent)) + 1):
			var carry = 0
			for place in range(limbs.size()):
				carry += limbs[place]
				limbs[place] = carry % 1000000000
				carry = carry / 1000000000
			while carry > 0:
				limbs.append(carry % 1000000000)
				carry = carry / 1000000000
			if _step < abs(exponent):
				for place in range(limbs.size()):
					limbs[place] *= base
		var text = str(limbs.back())
		for place in range(limbs.size() - 2, -1, -1):
			text += "%09d" % limbs[place]
		return ("-" if value < 0.0 else "") + text + ("e%d" % exponent if exponent < 0 else "")


# --- recording ------------------------------------------------------------------------------------


# Writes the play of a person as traces, which `tltlc monitor` can judge later; needs no connection.
# Each episode is a file in `folder`, such as "user://traces": `trace-0001.csv`, `trace-0002.csv` and
# so on; no file is overwritten.  `signals` are the names of the signals, as specs write them.  With
# `clock_hz`, the number of samples in a second, the files have a column `time`:
#
#     var recorder = Tltl.Recorder.new("user://traces", ["speed", "at_goal"], 60)
#     recorder.begin()
#     recorder.sample({"speed": 0.5, "at_goal": false})  # after each tick
#     recorder.end()
#
# With the actions of the person, as tltlc would send them, each episode is also a tape,
# `trace-0001.tape.jsonl`, with which the play can be repeated.  `game` is the name of the game:
#
#     recorder.begin("crypt", "v0", seed_)
#     recorder.sample({"speed": 0.5, "at_goal": false}, 2)
class Recorder:
	extends Reference

	# Why the last sample was refused.
	var problem = ""

	var _folder = ""
	var _signals = []
	var _clock_hz = null
	var _game = ""
	var _path = ""  # of the trace that is written; "" before its first sample
	var _samples = 0
	var _played = {}  # empty if no trace has begun
	var _has_tape = false
	var _are_bools = []  # for each signal of the tape, which keeps the type of its first value
	var _low = 1  # of the digest, Adler-32
	var _high = 0

	func _init(folder: String, signals: Array, clock_hz = null, game: String = "game") -> void:
		_folder = folder
		_signals = signals
		_clock_hz = clock_hz
		_game = game

	# Begins a new trace, and ends the one before; returns the path of its file, which the first sample
	# makes.  A tape says which scene, variant and seed were played; without a
	# variant it is `v0`.
	func begin(scene = null, variant = null, seed_ = null) -> String:
		end()
		_samples = 0
		_has_tape = false
		_low = 1
		_high = 0
		_played = {"scene": scene, "variant": "v0" if variant == null else variant, "seed": seed_}
		return _free_path()

	# Writes the values of all signals at one moment to the file at once; begins a trace if there is
	# none.  With `action`, what the person did in the tick before it, the step is written to the tape,
	# too.  Returns false, and writes nothing, if a number is not finite or a signal is missing, or if
	# some samples of an episode have an action and others have none.
	func sample(signals: Dictionary, action = null) -> bool:
		var cells = []
		for name in _signals:
			if not signals.has(name):
				return _refuse("the signal %s is missing" % name)
			var value = signals[name]
			if value is float and (is_nan(value) or is_inf(value)):
				return _refuse("the signal %s is %s, and numbers must be finite" % [name, value])
			cells.append(("true" if value else "false") if value is bool else Digits.text(float(value)))
		if not Digits.are_finite(action):
			return _refuse("the action is %s, and numbers must be finite" % str(action))
		if _played.empty():
			begin()
		if _path == "" and not _make_trace():
			return false
		if _samples > 0 and (action != null) != _has_tape:
			return _refuse("give the action of each sample of an episode, or of none")
		if action != null and not _write_step(action, signals):
			return false
		if _clock_hz:
			cells.push_front(Digits.text(_samples / float(_clock_hz)))
		_samples += 1
		return _write(_path, PoolStringArray(cells).join(","), File.READ_WRITE)

	# Ends the trace and its tape, if there is one.
	func end() -> void:
		_path = ""
		_played = {}

	func _refuse(reason: String) -> bool:
		problem = reason
		push_error(reason)
		return false

	func _free_path() -> String:
		var number = 1
		var path = _folder.plus_file("trace-0001.csv")
		while File.new().file_exists(path) or File.new().file_exists(_tape_path(path)):
			number += 1
			path = _folder.plus_file("trace-%04d.csv" % number)
		return path

	func _make_trace() -> bool:
		Directory.new().make_dir_recursive(_folder)
		var path = _free_path()
		var names = ["time"] if _clock_hz else []
		for name in _signals:
			var is_plain = not ("," in name) and not name.begins_with('"')
			names.append(name if is_plain else '"' + name.replace('"', '""') + '"')
		if not _write(path, PoolStringArray(names).join(","), File.WRITE):
			return false
		_path = path
		return true

	# Writes a step to the tape, and before the first one the header.
	func _write_step(action, signals: Dictionary) -> bool:
		if not _has_tape and not _write(_tape_path(_path), _header(signals), File.WRITE):
			return false
		_has_tape = true
		var members = PoolStringArray()
		var bytes = StreamPeerBuffer.new()
		for index in range(_signals.size()):
			var number = float(signals[_signals[index]]) + 0.0  # -0 counts as 0
			var text = Digits.text(number)
			if _are_bools[index]:
				text = "true" if number != 0.0 else "false"
				number = 1.0 if number != 0.0 else 0.0
			members.append(to_json(_signals[index]) + ":" + text)
			bytes.put_double(number)
		for byte in bytes.data_array:
			_low = (_low + byte) % 65521
			_high = (_high + _low) % 65521
		var digest = ',"digest":"%04x%04x"' % [_high, _low] if (_samples + 1) % 60 == 0 else ""
		var line = '{"action":' + Digits.json(action) + ',"signals":{' + members.join(",") + "}" + digest + "}"
		return _write(_tape_path(_path), line, File.READ_WRITE)

	func _header(signals: Dictionary) -> String:
		var types = PoolStringArray()
		_are_bools = []
		for name in _signals:
			_are_bools.append(signals[name] is bool)
			types.append(to_json(name) + ':{"type":"%s"}' % ("bool" if signals[name] is bool else "number"))
		var about = {"tape": 1, "game": _game, "spec": null, "clock_hz": _clock_hz}
		about["versions"] = {"godot": Engine.get_version_info()["string"]}
		for key in _played:
			about[key] = _played[key]
		var text = Digits.json(about)
		return text.substr(0, text.length() - 1) + ',"signals":{' + types.join(",") + "}}"

	func _tape_path(path: String) -> String:
		return path.get_basename() + ".tape.jsonl"

	func _write(path: String, line: String, mode: int) -> bool:
		var file = File.new()
		if file.open(path, mode) != OK:
			return _refuse("cannot write %s" % path)
		file.seek_end()
		file.store_line(line)
		file.close()
		return true
