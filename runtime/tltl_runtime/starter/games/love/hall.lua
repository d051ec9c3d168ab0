-- The hall: fetch the key, then leave by the door. Spikes end the game.
--
-- A level is a text: `#` is a wall, `K` the key, `D` the door, `^` spikes. The player begins on a dot.

local tltl_client = require("tltl_client")

local MOVES = {{0, 1}, {0, -1}, {-1, 0}, {1, 0}} -- up, down, left, right
local THINGS = {K = "key", D = "door", ["^"] = "spikes"}

local hall = {
  hello = {
    name = "hall",
    clock_hz = 10,
    signals = {has_key = {type = "bool"}, at_door = {type = "bool"}, on_spikes = {type = "bool"}},
    actions = {type = "discrete", n = #MOVES},
    observation = {type = "multi_discrete", nvec = {9, 6}}, -- the size of each level, in cells
    scenes = {"hall"},
    capabilities = {"seed", "positions"},
  },
}

--- Begin an episode, and return its first state. `hall.read` returns the text of a level, by its name.
function hall:reset(scene, variant, seed)
  if scene and scene ~= "hall" then error(tltl_client.Refusal("there is no scene `" .. scene .. "`")) end
  if variant ~= "v0" then error(tltl_client.Refusal("there is no variant `" .. variant .. "`")) end
  self.rows, self.starts, self.things = {}, {}, {}
  for row in self.read(scene or "hall"):gmatch("%S+") do table.insert(self.rows, 1, row) end -- y points up
  for y, row in ipairs(self.rows) do
    for x = 1, #row do
      local mark = row:sub(x, x)
      if mark == "." then table.insert(self.starts, {x - 1, y - 1}) end
      if THINGS[mark] then self.things[THINGS[mark]] = {x - 0.5, y - 0.5} end
    end
  end
  self.player = self.starts[(seed or 0) % #self.starts + 1]
  self.has_key = false
  return self:state()
end

--- Play one tick, and return the state.
function hall:step(action)
  local move = MOVES[action + 1]
  local following = {self.player[1] + move[1], self.player[2] + move[2]}
  if self:mark(following) ~= "#" then self.player = following end
  self.has_key = self.has_key or self:mark(self.player) == "K"
  return self:state()
end

function hall:state()
  local here = self:mark(self.player)
  local positions = {player = {self.player[1] + 0.5, self.player[2] + 0.5}}
  for name, place in pairs(self.things) do positions[name] = place end
  return tltl_client.state({
    signals = {has_key = self.has_key, at_door = here == "D", on_spikes = here == "^"},
    observation = self.player,
    ended = here == "^",
    cause = here == "^" and "spikes" or nil,
    positions = positions,
  })
end

--- Return what is in a cell.
function hall:mark(cell)
  local row = self.rows[cell[2] + 1]
  return row:sub(cell[1] + 1, cell[1] + 1)
end

return hall
