-- Read each line of a file as JSON, and print `0`, or `1` and the value written again: lua read_lines.lua FILE [LOCALE]

local folder = (arg[0]:match("^(.*)/") or ".")
package.path = folder .. "/../../../../runtime/tltl_runtime/wire/clients/?.lua;" .. package.path

local tltl_client = require("tltl_client")

if arg[2] then assert(os.setlocale(arg[2]), "there is no such locale") end
local file = assert(io.open(arg[1], "rb"))
for line in file:read("*a"):gmatch("([^\n]*)\n") do
  local is_json, text = pcall(function() return tltl_client.encode(tltl_client.decode(line)) end)
  print(is_json and "1" .. text or "0")
end
file:close()
