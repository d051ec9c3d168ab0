-- Navigation: near(s1), then near(s2), then near(exit); judged at the goal, 300 steps.

local common = require("common")
local is_finite, near, advance = common.is_finite, common.near, common.advance

local ATOMS = { [0] = "near(s1)", "near(s2)", "near(exit)" }
local LABELS = {
  [0] = "F(near(s1) & X F(near(s2) & X F near(exit)))",
  "F(near(s2) & X F near(exit))",
  "F near(exit)",
  "true",
}
local ENGLISH = {
  [0] = "Reach near(s1), then near(s2), then near(exit).",
  "Reach near(s2), then near(exit).",
  "Reach near(exit).",
  "Nothing remains to be done.",
}
local GOAL, LIMIT = 3, 300

-- The state is the number of marks that were reached in order.
local Monitor = common.class()

-- Take one sample, into `result` or a new table.  Returns nil and a message, and the state stays, where a signal is
-- missing or not finite.
function Monitor:step(signals, result)
  local s1, s2, exit = signals["distance(s1)"], signals["distance(s2)"], signals["distance(exit)"]
  if not is_finite(s1) then return nil, "no finite number for distance(s1)" end
  if not is_finite(s2) then return nil, "no finite number for distance(s2)" end
  if not is_finite(exit) then return nil, "no finite number for distance(exit)" end

  local state = self.state
  local robustness, progress, limiting = 1.0, 1.0, nil
  if state < GOAL then
    local closeness = near(state == 0 and s1 or state == 1 and s2 or exit, self.level_size)
    if closeness > 0.0 then
      state = state + 1
      robustness = closeness
      progress = state / 3.0
    else
      robustness = -closeness
      progress = (state + 1.0 + closeness) / 3.0
      limiting = ATOMS[state]
    end
  end

  local accepting = state == GOAL
  self.state = state
  result = result or {}
  result.reward = advance(self, progress, false, accepting, LIMIT)
  result.state = state
  result.label = LABELS[state]
  result.label_english = ENGLISH[state]
  result.verdict = accepting and "satisfied" or "pending"
  result.accepting = accepting
  result.done = self.done
  result.progress = self.progress
  result.robustness = robustness
  result.limiting = limiting
  return result
end

return Monitor
