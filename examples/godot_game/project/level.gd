# A level of the game: what moves in it, and what it says about itself.
#
# The engine moves bodies and finds what they hit. Everything that moves is kinematic, so the state of
# a level is in the variables of this script.

extends Spatial

const VARIANTS = ["v0", "short_ferry", "swift_guard"]
const TICK_S = 0.1
const SPEED = 4.0
const GRAVITY = 10.0
const FERRY_SPEED = 1.5
const FERRY_WAIT = 20  # ticks at each end
const GUARD_SPEED = 1.5
const CHASE_SPEED = 2.0
const SIGHT = 3.0
const SIGHT_COSINE = 0.5
const FARTHEST = 25.0
const FALL = 2.5  # how far a player flies while falling
const HIDDEN = Vector3(5, 0, 5)

# The middle of the ferry's deck moves between these places, and the guard walks between the others.
export var ferry_west = Vector3(5.55, 0, 0)
export var ferry_east = Vector3(7.45, 0, 0)
export var guard_from = Vector3(-3, 0, -3.5)
export var guard_to = Vector3(-3, 0, 3.5)
export var start = Vector3(-6, 0, 3)

onready var player = $Player
onready var ferry = $Ferry
onready var beacon = $Beacon
onready var key = get_node_or_null("Key")
onready var door = get_node_or_null("Door")
onready var guard = get_node_or_null("Guard")

var has_key = false
var door_open = false
var seen = false
var fall_speed = 0.0
var ferry_end = Vector3()
var ferry_heading = 1  # 1 to the east, -1 to the west
var ferry_waits = 0
var guard_goal = Vector3()
var guard_ahead = Vector3()  # where the guard looks
var guard_speed = GUARD_SPEED
var is_put = false  # bodies were put somewhere, and no frame has passed since


# --- an episode -----------------------------------------------------------------------------------


func begin(variant: String, seed_: int) -> void:
	var random = RandomNumberGenerator.new()
	random.seed = seed_
	has_key = key == null
	door_open = door == null
	seen = false
	fall_speed = 0.0
	guard_speed = 2.0 * GUARD_SPEED if variant == "swift_guard" else GUARD_SPEED
	player.translation = start + Vector3(random.randf_range(-1, 1), 0, random.randf_range(-1, 1))
	ferry_end = ferry_east - Vector3(1.2, 0, 0) if variant == "short_ferry" else ferry_east
	ferry_heading = 1 if random.randi() % 2 == 0 else -1
	ferry_waits = 0
	ferry.translation = ferry_west.linear_interpolate(ferry_end, random.randf())
	if door != null:
		door.translation.y = 0
	if guard != null:
		guard.translation = guard_from.linear_interpolate(guard_to, random.randf())
		guard_goal = guard_to if random.randi() % 2 == 0 else guard_from
		guard_ahead = guard.translation.direction_to(guard_goal)
	update_bodies()


# Plays a tick. `east` and `north` are -1, 0 or 1.
func tick(east: int, north: int) -> void:
	move_ferry()
	var way = Vector3(east, 0, -north)
	if east != 0 and north != 0:
		way *= 0.7071
	slide(player, way * (SPEED * TICK_S))
	fall_speed += GRAVITY * TICK_S
	if player.move_and_collide(Vector3(0, -fall_speed * TICK_S, 0)) != null:
		fall_speed = 0.0
	var place = player.translation
	if not has_key and place.distance_to(key.translation) < 0.8:
		has_key = true
	if has_key and not door_open and place.distance_to(door.translation) < 1.2:
		door_open = true
		door.translation.y = 3
	if guard != null:
		move_guard()


func move_ferry() -> void:
	if ferry_waits > 0:
		ferry_waits -= 1
		return
	var goal = ferry_end if ferry_heading > 0 else ferry_west
	var before = ferry.translation
	ferry.translation = before.move_toward(goal, FERRY_SPEED * TICK_S)
	ferry.force_update_transform()
	if on_ferry():
		slide(player, ferry.translation - before)
	if ferry.translation == goal:
		ferry_heading = -ferry_heading
		ferry_waits = FERRY_WAIT


# The guard walks up and down, and runs after the player as long as it sees him.
func move_guard() -> void:
	var way = player.translation - guard.translation
	way.y = 0
	var distance = way.length()
	seen = false
	if distance < SIGHT and guard_ahead.dot(way) > SIGHT_COSINE * distance:
		var eyes = guard.translation + Vector3(0, 1.4, 0)
		var hit = get_world().direct_space_state.intersect_ray(eyes, player.translation + Vector3(0, 1, 0), [guard])
		seen = not hit.empty() and hit["collider"] == player
	if seen:
		guard_ahead = way / max(distance, 0.001)
		slide(guard, guard_ahead * (CHASE_SPEED * TICK_S))
		return
	if guard.translation.distance_to(guard_goal) < 0.1:
		guard_goal = guard_from if guard_goal == guard_to else guard_to
	guard_ahead = guard.translation.direction_to(guard_goal)
	slide(guard, guard_ahead * (guard_speed * TICK_S))


# Moves a body, and along what it hits.
func slide(body: KinematicBody, motion: Vector3) -> void:
	for _turn in range(3):
		if motion.length_squared() < 1e-8:
			return
		var hit = body.move_and_collide(motion)
		if hit == null:
			return
		motion = hit.remainder.slide(hit.normal)
		motion.y = 0


# Tells the physics where bodies were put. Rays hit them there after the next frame.
func update_bodies() -> void:
	is_put = true
	for body in [player, ferry, door, guard]:
		if body != null:
			body.force_update_transform()


# --- what the level says --------------------------------------------------------------------------


func on_ferry() -> bool:
	var offset = player.translation - ferry.translation
	return abs(offset.x) < 1.6 and abs(offset.z) < 1.3 and abs(offset.y) < 0.3


func is_over() -> bool:
	return cause() != null


# Who or what has ended the episode.
func cause():
	if player.translation.y < -2.0:
		return "chasm"
	if guard != null and player.translation.distance_to(guard.translation) < 0.9:
		return "guard_1"
	if player.translation.distance_to(beacon.translation) < 1.0:
		return "beacon"
	return null


func signals() -> Dictionary:
	var place = player.translation
	return {
		"has_key": has_key,
		"door_open": door_open,
		"on_ferry": on_ferry(),
		"seen": seen,
		"caught": guard != null and place.distance_to(guard.translation) < 0.9,
		"fallen": place.y < -2.0,
		"distance(key)": distance(key),
		"distance(door)": distance(door),
		"distance(ferry)": distance(ferry),
		"distance(beacon)": distance(beacon),
		"distance(guard_1)": distance(guard),
		"height": place.y,
	}


# The distance to something, which is 25 m if it is farther away or there is none. A door stays a place
# when it is open.
func distance(node) -> float:
	if node == null:
		return FARTHEST
	var place = node.translation
	if node == door:
		place.y = 0
	return min(player.translation.distance_to(place), FARTHEST)


# What the agent observes: places relative to the player in steps of 4 m, and what has happened.
func observation() -> PoolRealArray:
	var place = player.translation
	var key_way = Vector3() if has_key else (key.translation - place) / 4
	var door_way = Vector3() if door == null else (door.translation - place) / 4
	var guard_way = HIDDEN if guard == null else (guard.translation - place) / 4
	var ferry_way = (ferry.translation - place) / 4
	return PoolRealArray([
		place.x / 4, place.z / 4, place.y / 4,
		1 if has_key else 0, 1 if door_open else 0, 1 if on_ferry() else 0, 1 if seen else 0,
		key_way.x, key_way.z, door_way.x, door_way.z, ferry_way.x, ferry_way.z, ferry_heading, ferry_waits / 10.0,
		guard_way.x, guard_way.z, guard_ahead.x, guard_ahead.z, (beacon.translation.x - place.x) / 4,
	])


func positions() -> Dictionary:
	var places = {
		"player": player.translation, "ferry": ferry.translation, "beacon": beacon.translation,
	}
	if key != null and not has_key:
		places["key"] = key.translation
	if door != null:
		places["door"] = door.translation
	if guard != null:
		places["guard_1"] = guard.translation
	return places


# What maps show: walls and the crate, which stop the player; the door, which opens; the chasm around the far bank.
func outline() -> Dictionary:
	var boxes = {"wall": [], "crate": []}
	for body in get_children():
		if body is StaticBody and not (body.name in ["GroundWest", "GroundEast", "Door"]):
			boxes["crate" if body.name == "Crate" else "wall"].append(from_above(body))
	var near = from_above($GroundWest)
	var far = from_above($GroundEast)
	var north = near.position.y - FALL
	var south = near.end.y + FALL
	var areas = {"chasm": [
		Vector2(near.end.x, north), Vector2(far.end.x, north), Vector2(far.end.x, far.position.y), far.position,
		Vector2(far.position.x, far.end.y), far.end, Vector2(far.end.x, south), Vector2(near.end.x, south),
	]}
	if door != null:
		var gap = from_above(door)
		areas["door"] = [gap.position, Vector2(gap.end.x, gap.position.y), gap.end, Vector2(gap.position.x, gap.end.y)]
	# The last region surrounds the one before: the first that contains a place counts.
	var around = Rect2(near.end.x, north, far.end.x - near.end.x, south - north)
	return {"boxes": boxes, "polygons": areas, "regions": {"yard": near, "far_yard": far, "chasm": around}}


# The place of a body, seen from above: its x and z.
func from_above(body: PhysicsBody) -> Rect2:
	var shape = body.get_node("Shape")
	var place = shape.global_transform.origin
	var extents = shape.shape.extents
	return Rect2(place.x - extents.x, place.z - extents.z, 2 * extents.x, 2 * extents.z)


# --- snapshots ------------------------------------------------------------------------------------


func kept() -> Array:
	return [
		player.translation, ferry.translation, Vector3() if guard == null else guard.translation,
		has_key, door_open, seen, fall_speed, ferry_end, ferry_heading, ferry_waits, guard_goal, guard_ahead,
		guard_speed,
	]


func restore(values: Array) -> void:
	player.translation = values[0]
	ferry.translation = values[1]
	if guard != null:
		guard.translation = values[2]
	has_key = values[3]
	door_open = values[4]
	seen = values[5]
	fall_speed = values[6]
	ferry_end = values[7]
	ferry_heading = values[8]
	ferry_waits = values[9]
	guard_goal = values[10]
	guard_ahead = values[11]
	guard_speed = values[12]
	if door != null:
		door.translation.y = 3 if door_open else 0
	update_bodies()
