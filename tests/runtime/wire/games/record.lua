-- Record two traces with the client in Lua: lua record.lua FOLDER [NUMBER], where the number is recorded as a sample of
-- its own.

local folder = (arg[0]:match("^(.*)/") or ".")
package.path = folder .. "/../../../../runtime/tltl_runtime/wire/clients/?.lua;" .. package.path

local tltl_client = require("tltl_client")

if arg[2] then
  local numbers = {nan = 0 / 0, inf = math.huge, ["-inf"] = -math.huge}
  local recorder = tltl_client.Recorder(arg[1], {"near(a, b)", "seen"})
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
