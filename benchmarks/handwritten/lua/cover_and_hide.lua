-- Cover and Hide: near(s1), then near(s2), then near(exit), alive throughout; judged at the goal, 400 steps.  The three
-- places exclude each other.

local common = require("common")
local is_finite, near, advance = common.is_finite, common.near, common.advance
local min, max = math.min, math.max

local ATOMS = { [0] = "near(s1)", "near(s2)", "near(exit)" }
local LABELS = {
  [0] = "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive",
  "F(near(s2) & X F near(exit)) & G alive",
  "false",
  "F near(exit) & G alive",
  "G alive",
}
local ENGLISH = {
  [0] = "Reach near(s1), then near(s2), then near(exit), and keep alive throughout.",
  "Reach near(s2), then near(exit), and keep alive throughout.",
  "The spec is violated.",
  "Reach near(exit), and keep alive throughout.",
  "Keep alive throughout.",
}
local VERDICTS = { [0] = "pending", "pending", "violated", "pending", "holding" }
local PLACE = { [0] = 0, [1] = 1, [3] = 2 }
local NEXT = { [0] = 1, [1] = 3, [3] = 4 }
local TRAP, GOAL, LIMIT = 2, 4, 400

-- States 0, 1 and 3 wait for a place, 4 is the goal, 2 is the trap.
local Monitor = common.class()

-- Take one sample, into `result` or a new table.  Returns nil and a message, and the state stays, where a signal is
-- missing or not finite, or two places are near at once.
function Monitor:step(signals, result)
  local s1, s2, exit = signals["distance(s1)"], signals["distance(s2)"], signals["distance(exit)"]
  local health = signals.health
  if not is_finite(s1) then return nil, "no finite number for distance(s1)" end
  if not is_finite(s2) then return nil, "no finite number for distance(s2)" end
  if not is_finite(exit) then return nil, "no finite number for distance(exit)" end
  if not is_finite(health) then return nil, "no finite number for health" end

  local level_size = self.level_size
  local near_s1, near_s2, near_exit = near(s1, level_size), near(s2, level_size), near(exit, level_size)
  local alive = min(max(health, 0.0), 1.0)
  if near_s1 > 0.0 and (near_s2 > 0.0 or near_exit > 0.0) or near_s2 > 0.0 and near_exit > 0.0 then
    return nil, "only one of near(s1), near(s2), near(exit) may hold at a time"
  end

  local state = self.state
  local robustness, progress, limiting = 0.0, 0.0, nil
  if state == TRAP then
    robustness = 1.0
  elseif alive <= 0.0 then
    state = TRAP
  elseif state == GOAL then
    robustness = alive
    progress = 1.0
  else
    local place = PLACE[state]
    local here, elsewhere
    if place == 0 then
      here, elsewhere = near_s1, max(near_s2, near_exit)
    elseif place == 1 then
      here, elsewhere = near_s2, max(near_s1, near_exit)
    else
      here, elsewhere = near_exit, max(near_s1, near_s2)
    end
    if here > 0.0 then
      state = NEXT[state]
      robustness = min(here, alive)
      progress = (place + 1) / 3.0
    else
      -- At another place the player is certainly not here, because the places exclude each other.
      robustness = min(max(-here, elsewhere), alive)
      progress = (place + 1.0 + here) / 3.0
      limiting = ATOMS[place]
    end
  end

  self.state = state
  result = result or {}
  result.reward = advance(self, progress, state == TRAP, state == TRAP or state == GOAL, LIMIT)
  result.state = state
  result.label = LABELS[state]
  result.label_english = ENGLISH[state]
  result.verdict = VERDICTS[state]
  result.accepting = state == GOAL
  result.done = self.done
  result.progress = self.progress
  result.robustness = robustness
  result.limiting = limiting
  result.failed_clause = state == TRAP and "keep alive" or nil
  result.failed_atom = state == TRAP and "alive" or nil
  result.failed_step = self.failed_step
  return result
end

return Monitor
