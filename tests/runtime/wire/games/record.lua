-- Record two traces with the client in Lua: lua record.lua FOLDER [NUMBER], where the number is recorded as a sample of
-- its own, or lua record.lua FOLDER tape, which records the tape of the play of all clients.

local folder = (arg[0]:match("^(.*)/") or ".")
package.path = folder .. "/../../../../runtime/tltl_runtime/wire/clients/?.lua;" .. package.path

local tltl_client = require("tltl_client")

if arg[2] == "tape" then
  local sizes = {[0] = 5e-324, -0.0, 1e-300, 1e22, -123456.789, 0.1}
  local recorder = tltl_client.Recorder(arg[1], {"near(a, b)", "size", "seen"}, 60, "walk")
  recorder:begin("crypt", "v1", 7)
  pcall(recorder.sample, recorder, {["near(a, b)"] = 0 / 0, size = 2, seen = false}, 0)
  for step = 1, 130 do
    local signals = {["near(a, b)"] = step / 3, size = sizes[step % 6], seen = step == 130}
    if step == 3 then signals["near(a, b)"] = true end
    if step > 128 then signals.seen = step - 129 end
    recorder:sample(signals, {step % 3, 1})
  end
  recorder:begin()
  recorder:sample({["near(a, b)"] = 1, size = 2, seen = false})
  print(select(2, pcall(recorder.sample, recorder, {["near(a, b)"] = 1, size = 2, seen = false}, 1)))
  recorder:begin("crypt", nil, 7)
  recorder:sample({["near(a, b)"] = 1, size = 2, seen = false}, 1)
  recorder:finish()
elseif arg[2] then
  local numbers = {nan = 0 / 0, inf = math.huge, ["-inf"] = -math.huge}
  local recorder = tltl_client.Recorder(arg[1], {"near(a, b)", "seen"})
  recorder:begin()
  recorder:sample({["near(a, b)"] = numbers[arg[2]] or tonumber(arg[2]), seen = true})
  recorder:finish()
else
  local recorder, path = tltl_client.Recorder(arg[1], {"near(a, b)", "seen"}, 60), nil
  for _, last in ipairs({true, false}) do
    path = recorder:begin()
    for step = 0, 3 do recorder:sample({["near(a, b)"] = step / 3, seen = last and step == 3, unused = 1}) end
  end
  recorder:finish()
  print(path)
end
