-- The game of the conformance script in Lua; `tests/runtime/wire/conversation.py` describes it.
--
-- Usage: lua counter.lua [--listen PORT]

local folder = (arg[0]:match("^(.*)/") or ".")
package.path = folder .. "/../../../../runtime/tltl_runtime/wire/clients/?.lua;" .. package.path

local tltl_client = require("tltl_client")

local GOALS = {short = 5, long = 10}

local game = {
  goal = 5,
  has_trap = false,
  position = 1,
  moves = 0,
  snapshots = {},
  taken = 0,
  hello = {
    name = "counter",
    clock_hz = 10,
    signals = {position = {range = {0, 10}}, moves = {range = {0, tltl_client.null}}, at_goal = {type = "bool"}},
    params = {goal = 10},
    actions = {type = "discrete", n = 3},
    observation = {type = "box", low = 0, high = 10, shape = {1}, dtype = "float32"},
    scenes = {"short", "long"},
    capabilities = {"seed", "positions"},
  },
}

-- Begin at 1 + seed mod 4.
function game:reset(scene, variant, seed)
  if scene and not GOALS[scene] then error(tltl_client.Refusal("there is no scene `" .. scene .. "`")) end
  if variant ~= "v0" and variant ~= "trap" then
    error(tltl_client.Refusal("there is no variant `" .. variant .. "`"))
  end
  self.goal, self.has_trap = GOALS[scene or "short"], variant == "trap"
  self.position, self.moves = 1 + (seed or 0) % 4, 0
  return self:state()
end

-- Move left (0), stay (1) or move right (2).
function game:step(action)
  self.position = math.min(math.max(self.position + action - 1, 0), 10)
  self.moves = self.moves + 1
  return self:state()
end

-- Keep the state; the ids are 1, 2, 3 and so on.
function game:snapshot()
  self.taken = self.taken + 1
  self.snapshots[self.taken] =
    {goal = self.goal, has_trap = self.has_trap, position = self.position, moves = self.moves}
  return self.taken
end

local function kept(id)
  return game.snapshots[id] or error(tltl_client.Refusal("there is no snapshot " .. tostring(id)))
end

-- Forget a snapshot.
function game:release_snapshot(id)
  kept(id)
  self.snapshots[id] = nil
end

-- Return to a snapshot.
function game:restore(id)
  for name, value in pairs(kept(id)) do self[name] = value end
  return self:state()
end

-- Draw a row of 11 black pixels; that of the player is white.
function game:screenshot()
  local pixels = string.rep("\0\0\0", self.position) .. "\255\255\255" .. string.rep("\0\0\0", 10 - self.position)
  return tltl_client.array(pixels, "uint8", {1, 11, 3})
end

-- What maps show: the edges of the row, the goal, and the trap if there is one.
function game:outline()
  if self.has_trap and self.goal == GOALS.short then
    error(tltl_client.Refusal("there is no outline of the trap in `short`"))
  end
  return {
    bounds = {{-1, -2}, {11, 3}},
    boxes = {edge = {{{-1, -1}, {-0.5, 2}}, {{10.5, -1}, {11, 2}}}},
    polygons = self.has_trap and {trap = {{-0.5, -1}, {0.5, -1}, {0, 2}}} or {},
    regions = {goal = {{self.goal - 0.5, -1}, {10.5, 2}}},
    image = {pixels = tltl_client.array("\255\255\255", "uint8", {1, 1, 3}), extent = {-0.5, -1, 10.5, 2}},
  }
end

-- Return the message about the state.
function game:state()
  local at_goal, is_trapped = self.position >= self.goal, self.has_trap and self.position == 0
  return tltl_client.state({
    signals = {position = self.position, moves = self.moves, at_goal = at_goal},
    observation = {self.position},
    ended = at_goal or is_trapped,
    cause = at_goal and "goal" or is_trapped and "trap" or nil,
    positions = {player = {self.position, 0}},
  })
end

if arg[1] == "--listen" then
  while true do
    tltl_client.play(game, tltl_client.listen(tltl_client.game_hello(game), tonumber(arg[2])))
  end
end
tltl_client.play(game)
