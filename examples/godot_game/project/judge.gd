# The monitor inside the game: it says to a person what remains to be done, and what the verdict is.
#
# `fetch_monitor.gd` and `ride_monitor.gd` are made by `tltlc compile keep.tltl --target gdscript3`. With
# `log=FILE` among the words of the command line, each step of the monitor is a line of the file.

extends Reference

const Tltl = preload("res://tltl_client_godot3.gd")
const Fetch = preload("res://fetch_monitor.gd")
const Ride = preload("res://ride_monitor.gd")
const WORDS = ["satisfied", "holding", "pending", "violated"]

var monitor = null
var sample = null
var file = null


func _init(words: Array) -> void:
	for word in words:
		if word.begins_with("log="):
			file = File.new()
			file.open(word.substr(4, word.length()), File.WRITE)


func begin(scene: String) -> void:
	var kind = Fetch if scene == "courtyard" else Ride
	if not (monitor is kind):
		monitor = kind.new()
		sample = kind.Sample.new()
	monitor.reset()
	if file != null:
		file.store_line("begin,%s" % scene)


# Gives the monitor the signals after a tick; returns whether the episode ends here.
func step(signals: Dictionary) -> bool:
	sample.distance_ferry = signals["distance(ferry)"]
	sample.distance_beacon = signals["distance(beacon)"]
	sample.fallen = signals["fallen"]
	if monitor is Fetch:
		sample.distance_key = signals["distance(key)"]
		sample.distance_door = signals["distance(door)"]
		sample.caught = signals["caught"]
	if not monitor.step(sample):
		push_error(monitor.message())
	if file != null:
		var numbers = [monitor.state, monitor.progress, monitor.reward, monitor.robustness]
		for place in range(numbers.size()):
			numbers[place] = Tltl.Digits.text(numbers[place])
		file.store_line(PoolStringArray(numbers).join(",") + "," + verdict())
	return monitor.done


func verdict() -> String:
	return WORDS[monitor.verdict]


func close() -> void:
	if file != null:
		file.close()


# --- snapshots ------------------------------------------------------------------------------------


func kept() -> Array:
	return [
		monitor, sample, monitor.state, monitor.verdict, monitor.accepting, monitor.done, monitor.progress,
		monitor.steps, monitor.failed_step, monitor.failure
	]


func restore(values: Array) -> void:
	monitor = values[0]
	sample = values[1]
	monitor.reset()
	monitor.state = values[2]
	monitor.verdict = values[3]
	monitor.accepting = values[4]
	monitor.done = values[5]
	monitor.progress = values[6]
	monitor.steps = values[7]
	monitor.failed_step = values[8]
	monitor.failure = values[9]
