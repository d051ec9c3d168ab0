-- Connect a game in Lua to tltlc, and record the play of a person: copy this file into your game.
--
-- For Lua 5.1 to 5.4, LuaJIT and LÖVE 11. The connection needs LuaSocket, which LÖVE contains; elsewhere
-- `luarocks install luasocket`, or on Debian `apt-get install lua-socket`. The recorder needs nothing. The file sets
-- no globals. A game is a table with the field `hello` and some methods:
--
--     local tltl_client = require("tltl_client")
--
--     local game = {
--       position = 0,
--       hello = {
--         name = "counter",
--         clock_hz = 10,
--         signals = {position = {range = {0, 10}}, moves = {range = {0, tltl_client.null}}, at_goal = {type = "bool"}},
--         actions = {type = "discrete", n = 3},
--         observation = {type = "box", low = 0, high = 10, shape = {1}},
--         scenes = {"short", "long"},
--         capabilities = {"seed", "positions"},
--       },
--     }
--
--     function game:state()
--       return tltl_client.state({
--         signals = {position = self.position, moves = self.moves, at_goal = self.position == 10},
--         observation = {self.position},
--         ended = self.position == 10,
--         positions = {player = {self.position, 0}},
--       })
--     end
--
--     function game:reset(scene, variant, seed)          -- begin an episode, return its first state
--       if scene == "crypt" then error(tltl_client.Refusal("the scene `crypt` cannot be loaded")) end
--       self.position, self.moves = 0, 0
--       return self:state()
--     end
--
--     function game:step(action)                         -- play one tick, return the state
--       self.position = math.min(math.max(self.position + action - 1, 0), 10)
--       self.moves = self.moves + 1
--       return self:state()
--     end
--
--     -- Optional: game:snapshot() keeps the state of the game and returns an id, game:restore(id) returns to it and
--     -- returns the state, game:release_snapshot(id) forgets it, because there will be no return to it,
--     -- game:screenshot() returns a picture (see `array`), game:close() is called at the end.
--     -- game:outline() returns what maps of the current scene and variant show, in metres, for example
--     -- {boxes = {wall = {{{0, 0}, {8, 1}}, {{8, 0}, {9, 6}}}}, regions = {hall = {{0, 1}, {8, 6}}}}
--
--     tltl_client.play(game)
--
-- In LÖVE, tltlc plays in place of love.update and love.draw:
--
--     function love.load()
--       if os.getenv("TLTL_PORT") then
--         tltl_client.play(game)
--         love.event.quit()
--       end
--     end
--
-- `play` waits for requests. A game with a main loop of its own uses `Client` directly:
--
--     local client = tltl_client.Client(hello)
--     while true do
--       local kind, body = client:request()
--       ...
--       client:answer_state(state)
--     end
--
-- Lua has one type for lists and objects. An empty table is sent as an object; `list({})` is an empty list. `null` in
-- a list stands for the null of JSON. `docs/wire.md` of tltlc describes the protocol.

local PROTOCOL = 1
local LONGEST_FIRST_LINE = 65536
local DEEPEST = 100
local KINDS = {"reset", "step", "snapshot", "restore", "release", "screenshot", "outline", "close"}

local byte, char, find, format, gsub, match, sub =
  string.byte, string.char, string.find, string.format, string.gsub, string.match, string.sub
local abs, floor, huge = math.abs, math.floor, math.huge
local concat, unpack = table.concat, table.unpack or rawget(_G, "unpack")
local number_type = math.type or function() return "float" end

local tltl_client = {}

--- The null of JSON, where Lua has no place for nil: in lists.
tltl_client.null = setmetatable({}, {__tostring = function() return "null" end})
local null = tltl_client.null

local List = {}

--- Mark a table as a list, so that it is one even if it is empty; return it.
function tltl_client.list(values)
  return setmetatable(values, List)
end

local list = tltl_client.list

local function is_finite(value)
  return value == value and value ~= huge and value ~= -huge
end

-- Have a function interpreted: builds of LuaJIT 2.1 leave members out in compiled loops over `pairs`.
local function interpreted(loop)
  local jit = rawget(_G, "jit")
  if jit then jit.off(loop) end
  return loop
end

local copy = interpreted(function(values)
  local result = {}
  for key, value in pairs(values) do result[key] = value end
  return result
end)

-- JSON, written ------------------------------------------------------------------------------------------------------

-- Return the shortest text of a finite number that has its value, whatever the locale is.
local function number_text(value)
  if number_type(value) == "integer" then return format("%d", value) end
  if floor(value) == value and abs(value) < 2 ^ 53 then
    return value == 0 and 1 / value < 0 and "-0.0" or format("%.0f", value)
  end
  local text = format("%.15g", value)
  if tonumber(text) ~= value then text = format("%.16g", value) end
  if tonumber(text) ~= value then text = format("%.17g", value) end
  return (gsub(text, "[^%de+-]+", "."))
end

-- The texts "nan", "inf" and "-inf", for messages; C libraries write them in several ways.
local function odd_number_text(value)
  return value ~= value and "nan" or value > 0 and "inf" or "-inf"
end

local ESCAPES = {['"'] = '\\"', ["\\"] = "\\\\", ["\n"] = "\\n", ["\r"] = "\\r", ["\t"] = "\\t"}

local function quoted(text)
  return '"' .. gsub(text, '[%z\1-\31"\\]', function(letter)
    return ESCAPES[letter] or format("\\u%04x", byte(letter))
  end) .. '"'
end

local write

local function write_list(parts, values, length, depth)
  parts[#parts + 1] = "["
  for index = 1, length do
    if index > 1 then parts[#parts + 1] = "," end
    write(parts, values[index], depth)
  end
  parts[#parts + 1] = "]"
end

local write_object = interpreted(function(parts, values, depth)
  local mark = "{"
  for key, value in pairs(values) do
    if type(key) ~= "string" then
      error("a table that is sent is either a list without gaps, or has texts as keys", 0)
    end
    parts[#parts + 1] = mark
    parts[#parts + 1] = quoted(key)
    parts[#parts + 1] = ":"
    write(parts, value, depth)
    mark = ","
  end
  parts[#parts + 1] = mark == "{" and "{}" or "}"
end)

-- Return the length of a list; nil if the table is an object.
local list_length = interpreted(function(values)
  local length = #values
  if length == 0 then return getmetatable(values) == List and 0 or nil end
  local count = 0
  for _ in pairs(values) do count = count + 1 end
  return count == length and length or nil
end)

-- Add the pieces of a JSON text to the list `parts`.
function write(parts, value, depth)
  local kind = type(value)
  if kind == "number" then
    if not is_finite(value) then
      error("the number " .. odd_number_text(value) .. " cannot be sent: numbers must be finite", 0)
    end
    parts[#parts + 1] = number_text(value)
  elseif kind == "boolean" then
    parts[#parts + 1] = value and "true" or "false"
  elseif kind == "string" then
    parts[#parts + 1] = quoted(value)
  elseif value == null then
    parts[#parts + 1] = "null"
  elseif kind == "table" then
    if depth >= DEEPEST then error("a table that is sent nests too deep", 0) end
    local length = list_length(value)
    if length then
      write_list(parts, value, length, depth + 1)
    else
      write_object(parts, value, depth + 1)
    end
  else
    error("a value of the type " .. kind .. " cannot be sent", 0)
  end
end

--- Return a value as JSON. Raises an error if a number is not finite, or a value is of another type.
function tltl_client.encode(value)
  local parts = {}
  write(parts, value, 0)
  return concat(parts)
end

-- JSON, read ---------------------------------------------------------------------------------------------------------

local function wrong(at)
  error("the line is not JSON: see its byte " .. at, 0)
end

local function skip_blanks(text, at)
  return find(text, "[^ \t\r\n]", at) or #text + 1
end

-- Return the bytes of a character in UTF-8; half a surrogate pair becomes the replacement character.
local function utf8_text(code)
  if code >= 0xD800 and code <= 0xDFFF then code = 0xFFFD end
  if code < 0x80 then return char(code) end
  if code < 0x800 then return char(0xC0 + floor(code / 64), 0x80 + code % 64) end
  if code < 0x10000 then return char(0xE0 + floor(code / 4096), 0x80 + floor(code / 64) % 64, 0x80 + code % 64) end
  return char(
    0xF0 + floor(code / 262144), 0x80 + floor(code / 4096) % 64, 0x80 + floor(code / 64) % 64, 0x80 + code % 64
  )
end

local UNESCAPED = {
  ['"'] = '"', ["\\"] = "\\", ["/"] = "/", b = "\b", f = "\f", n = "\n", r = "\r", t = "\t",
}

-- Return the text of an escape whose backslash is at `at`, and the place after it.
local function read_escape(text, at)
  local letter = sub(text, at + 1, at + 1)
  if UNESCAPED[letter] then return UNESCAPED[letter], at + 2 end
  local digits = match(text, "^u(%x%x%x%x)", at + 1) or wrong(at)
  local code = tonumber(digits, 16)
  if code >= 0xD800 and code < 0xDC00 then
    local low = tonumber(match(text, "^\\u(%x%x%x%x)", at + 6) or "0", 16)
    if low >= 0xDC00 and low <= 0xDFFF then
      return utf8_text(0x10000 + (code - 0xD800) * 1024 + low - 0xDC00), at + 12
    end
  end
  return utf8_text(code), at + 6
end

-- Return the text whose first quote is at `at`, and the place after it.
local function read_string(text, at)
  local parts, from = nil, at + 1
  while true do
    local stop = find(text, '["\\%z\1-\31]', from) or wrong(at)
    local mark = byte(text, stop)
    if mark == 34 then
      local rest = sub(text, from, stop - 1)
      if not parts then return rest, stop + 1 end
      parts[#parts + 1] = rest
      return concat(parts), stop + 1
    elseif mark ~= 92 then
      wrong(stop)
    end
    parts = parts or {}
    parts[#parts + 1] = sub(text, from, stop - 1)
    parts[#parts + 1], from = read_escape(text, stop)
  end
end

-- Return the number of a text with a point, also where the locale has a comma.
local function number_of(text)
  return tonumber(text) or tonumber((gsub(text, "%.", sub(format("%.1f", 0.5), 2, -2))))
end

local function read_number(text, at)
  local whole = match(text, "^-?%d+", at) or wrong(at)
  if find(whole, "^-?0%d") then wrong(at) end
  local after = at + #whole
  local fraction = match(text, "^%.%d+", after) or ""
  after = after + #fraction
  local exponent = match(text, "^[eE][+-]?%d+", after) or ""
  local value = number_of(whole .. fraction .. exponent)
  if not value and sub(exponent, 2, 2) == "-" then value = 0 end  -- LuaJIT refuses exponents of many digits.
  if not value or not is_finite(value) then wrong(at) end
  return value, after + #exponent
end

local read

local function read_list(text, at, depth)
  local values, length = list({}), 0
  at = skip_blanks(text, at + 1)
  if byte(text, at) == 93 then return values, at + 1 end
  while true do
    local value
    value, at = read(text, at, depth)
    length = length + 1
    values[length] = value
    at = skip_blanks(text, at)
    local mark = byte(text, at)
    if mark == 93 then return values, at + 1 end
    if mark ~= 44 then wrong(at) end
    at = at + 1
  end
end

local function read_object(text, at, depth)
  local values = {}
  at = skip_blanks(text, at + 1)
  if byte(text, at) == 125 then return values, at + 1 end
  while true do
    at = skip_blanks(text, at)
    if byte(text, at) ~= 34 then wrong(at) end
    local key, value
    key, at = read_string(text, at)
    at = skip_blanks(text, at)
    if byte(text, at) ~= 58 then wrong(at) end
    value, at = read(text, at + 1, depth)
    if value == null then value = nil end
    values[key] = value
    at = skip_blanks(text, at)
    local mark = byte(text, at)
    if mark == 125 then return values, at + 1 end
    if mark ~= 44 then wrong(at) end
    at = at + 1
  end
end

-- Return the value that begins at `at`, and the place after it.
function read(text, at, depth)
  at = skip_blanks(text, at)
  local mark = byte(text, at)
  if mark == 123 or mark == 91 then
    if depth >= DEEPEST then error("the line nests too deep", 0) end
    return (mark == 123 and read_object or read_list)(text, at, depth + 1)
  end
  if mark == 34 then return read_string(text, at) end
  if find(text, "^true", at) then return true, at + 4 end
  if find(text, "^false", at) then return false, at + 5 end
  if find(text, "^null", at) then return null, at + 4 end
  return read_number(text, at)
end

--- Return the value of a JSON text. The null of JSON is nil in an object, and otherwise `null`. Raises an error if
--- the text is not JSON.
function tltl_client.decode(text)
  local value, at = read(text, 1, 0)
  at = skip_blanks(text, at)
  if at <= #text then wrong(at) end
  return value
end

local encode, decode = tltl_client.encode, tltl_client.decode

-- Messages -----------------------------------------------------------------------------------------------------------

local function text_of(self)
  return self.message
end

local Refusal = {__tostring = text_of}
local Disconnected = {__tostring = text_of}

--- Raise this in a method of the game, `error(tltl_client.Refusal(reason))`, if a request cannot be met. tltlc shows
--- the reason.
function tltl_client.Refusal(reason)
  return setmetatable({message = reason}, Refusal)
end

local function disconnected(reason)
  error(setmetatable({message = reason or ""}, Disconnected), 0)
end

--- Whether an error says that tltlc has closed the connection, or refuses this game. Its field `message` says why, or
--- is empty if that is not known.
function tltl_client.is_disconnected(failure)
  return getmetatable(failure) == Disconnected
end

--- Return the state of the game as a table for a message. Its fields are:
---
--- * `signals`: numbers in SI units and booleans, by name
--- * `observation`: a value of the declared space
--- * `ended`: whether the episode has ended, by default false
--- * `cause`: who or what ended it, by default unknown
--- * `positions`: lists of two or three coordinates in metres, by the name of the entity; the player is `player`
function tltl_client.state(fields)
  return {
    signals = fields.signals,
    observation = fields.observation,
    ended = fields.ended and true or false,
    cause = fields.cause or null,
    positions = fields.positions,
  }
end

local ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"

local function sextet(number, place)
  local index = floor(number / place) % 64 + 1
  return sub(ALPHABET, index, index)
end

local function base64(data)
  return (gsub(data, "..?.?", function(bytes)
    local first, second, third = byte(bytes, 1, 3)
    local number = first * 65536 + (second or 0) * 256 + (third or 0)
    return sextet(number, 262144) .. sextet(number, 4096)
      .. (second and sextet(number, 64) or "=") .. (third and sextet(number, 1) or "=")
  end))
end

--- Return a large array, such as a picture, as a table for a message. `data` is a string with the bytes of the array,
--- little-endian; the last index changes fastest. `dtype` is a word such as `uint8`, and `shape` a list such as
--- `{84, 84, 3}`.
function tltl_client.array(data, dtype, shape)
  return {base64 = base64(data), dtype = dtype, shape = list(shape)}
end

--- Return the `hello` of a game, with the capabilities `snapshot`, `release`, `screenshot` and `outline` if it has the
--- methods.
function tltl_client.game_hello(game)
  local hello, has = copy(game.hello), {}
  for _, word in ipairs(hello.capabilities or {}) do has[word] = true end
  if game.snapshot and game.restore then has.snapshot = true end
  if game.release_snapshot then has.release = true end
  if game.screenshot then has.screenshot = true end
  if game.outline then has.outline = true end
  hello.capabilities = {}
  for word in pairs(has) do hello.capabilities[#hello.capabilities + 1] = word end
  table.sort(hello.capabilities)
  return hello
end

-- The connection -----------------------------------------------------------------------------------------------------

local function sockets()
  local found, library = pcall(require, "socket")
  if not found then
    disconnected("the library LuaSocket is missing: `luarocks install luasocket`, or use LÖVE, which contains it")
  end
  return library
end

local function connected(port)
  if not port or port == "" then
    disconnected("tltlc must start this game: the variable TLTL_PORT is not set")
  end
  local connection, reason = sockets().connect("127.0.0.1", tonumber(port) or 0)
  if not connection then disconnected("cannot connect to tltlc at port " .. port .. ": " .. reason) end
  return connection
end

local Client = {}
Client.__index = Client

--- Connect to tltlc, and send `hello`, the declaration of the game, without version and token. By default, the port
--- and the token come from the environment variables TLTL_PORT and TLTL_TOKEN. `connection` is a socket that is
--- connected already; then no port is needed. Raises an error (see `is_disconnected`) if no tltlc can be reached.
function tltl_client.Client(hello, port, token, connection)
  token = token or os.getenv("TLTL_TOKEN") or ""
  local self = setmetatable({}, Client)
  self._socket = connection or connected(port or os.getenv("TLTL_PORT"))
  self._socket:setoption("tcp-nodelay", true)
  local message = copy(hello)
  message.tltl = PROTOCOL
  if token ~= "" then message.token = token end
  if message.scenes then message.scenes = list(copy(message.scenes)) end
  if message.capabilities then message.capabilities = list(copy(message.capabilities)) end
  self:answer({hello = message})
  return self
end

--- Wait for the next request; return its kind, such as `step`, and its content, a table. Raises an error (see
--- `is_disconnected`) if tltlc has closed the connection, or refuses this game.
function Client:request()
  local message = self:_read()
  if message.error ~= nil then
    local body = message.error
    disconnected(tostring(type(body) == "table" and body.message or body))
  end
  for _, kind in ipairs(KINDS) do
    if message[kind] ~= nil then
      return kind, type(message[kind]) == "table" and message[kind] or {}
    end
  end
  return next(message) or "", {}
end

--- Answer a `reset`, a `step` or a `restore` with the result of `state`.
function Client:answer_state(state)
  self:answer({state = state})
end

--- Answer that the request cannot be met.
function Client:refuse(reason)
  self:answer({error = {message = reason}})
end

--- Send a message. Raises an error if a number in it is not finite, and another one (see `is_disconnected`) if tltlc
--- has closed the connection.
function Client:answer(message)
  if not self._socket:send(encode(message) .. "\n") then disconnected(self:_last_words()) end
end

--- Close the connection.
function Client:close()
  self._socket:close()
end

function Client:_read()
  local line = self._socket:receive("*l")
  if not line then disconnected() end
  local message = decode(line)
  if type(message) ~= "table" then error("tltlc sent a line that is no object", 0) end
  return message
end

-- Return why tltlc closed the connection, if it said so.
function Client:_last_words()
  local was_read, message = pcall(self._read, self)
  local body = was_read and message.error
  return type(body) == "table" and tostring(body.message or "") or ""
end

-- Return the socket of the first program that connects.
local function accepted(port)
  local library = sockets()
  local server = (library.tcp4 or library.tcp)()
  if sub(package.config, 1, 1) ~= "\\" then server:setoption("reuseaddr", true) end
  local bound, reason = server:bind("127.0.0.1", port)
  if bound then bound, reason = server:listen(1) end
  if not bound then
    server:close()
    disconnected("cannot listen on port " .. port .. ": " .. reason .. "; does this game run twice?")
  end
  local connection
  repeat connection = server:accept() until connection
  server:close()
  return connection
end

-- Return the first line; nil if it does not come, or is too long.
local function first_line(connection)
  local letters = {}
  for length = 1, LONGEST_FIRST_LINE do
    local letter = connection:receive(1)
    if not letter then return nil end
    if letter == "\n" then return concat(letters) end
    letters[length] = letter
  end
  return nil
end

-- Return why the game refuses the first message of tltlc; nil if it accepts the message.
local function refusal(line, token)
  local is_json, message = pcall(decode, line or "")
  local hello = is_json and type(message) == "table" and message.hello
  if type(hello) ~= "table" then return "the first line must be a `hello`" end
  if hello.tltl ~= PROTOCOL then return "this game speaks version " .. PROTOCOL .. " of the protocol" end
  if token ~= "" and hello.token ~= token then
    return "the token is wrong: start tltlc with the variable TLTL_TOKEN of this game"
  end
  return nil
end

--- Wait on a port of 127.0.0.1 until tltlc connects; return the Client. Use this if the game file has
--- `connect = "127.0.0.1:PORT"`. The default of `token` is the environment variable TLTL_TOKEN. If the token is not
--- empty, tltlc must send the same one. While one tltlc plays, no other can connect. Raises an error (see
--- `is_disconnected`) if another program uses the port.
function tltl_client.listen(hello, port, token)
  token = token or os.getenv("TLTL_TOKEN") or ""
  while true do
    local connection = accepted(port)
    local reason = refusal(first_line(connection), token)
    if not reason then return tltl_client.Client(hello, nil, "", connection) end
    connection:send(encode({error = {message = reason}}) .. "\n")
    connection:close()
  end
end

-- Play ---------------------------------------------------------------------------------------------------------------

local function answer(game, client, kind, body)
  if kind == "reset" then
    client:answer_state(game:reset(body.scene, body.variant or "v0", body.seed))
  elseif kind == "step" then
    local state = game:step(body.action)
    for _ = 2, body["repeat"] or 1 do
      if state.ended then break end
      state = game:step(body.action)
    end
    client:answer_state(state)
  elseif kind == "snapshot" and game.snapshot then
    client:answer({snapshot = {id = game:snapshot()}})
  elseif kind == "restore" and game.restore then
    client:answer_state(game:restore(body.id))
  elseif kind == "release" and game.release_snapshot then
    game:release_snapshot(body.id)
    client:answer({release = {id = body.id}})
  elseif kind == "screenshot" and game.screenshot then
    client:answer({screenshot = game:screenshot()})
  elseif kind == "outline" and game.outline then
    client:answer({outline = game:outline()})
  else
    error(tltl_client.Refusal("this game does not know the request `" .. kind .. "`"), 0)
  end
end

-- Keep the place of an error in the game.
local function traced(failure)
  return type(failure) == "string" and debug.traceback(failure, 2) or failure
end

local function serve(game, client)
  while true do
    local kind, body = client:request()
    if kind == "close" then return end
    local is_met, failure = xpcall(function() answer(game, client, kind, body) end, traced)
    if not is_met then
      if getmetatable(failure) ~= Refusal then error(failure, 0) end
      client:refuse(failure.message)
    end
  end
end

--- Connect to tltlc and answer its requests, until it closes the connection. If tltlc refuses the game, or has not
--- started it, the process ends with a message. If the game is started first and tltlc connects to it, pass a
--- `client`, and play again after each connection. The method `close` of the game is called at the end of each:
---
---     while true do
---       tltl_client.play(game, tltl_client.listen(tltl_client.game_hello(game), 5000))
---     end
function tltl_client.play(game, client)
  local went_well, failure = xpcall(function()
    client = client or tltl_client.Client(tltl_client.game_hello(game))
    serve(game, client)
  end, traced)
  if client then client:close() end
  if game.close then game:close() end
  if went_well then return end
  if not tltl_client.is_disconnected(failure) then error(failure, 0) end
  if failure.message ~= "" then
    io.stderr:write(failure.message, "\n")
    os.exit(1)
  end
end

-- The recorder -------------------------------------------------------------------------------------------------------

-- Files are in LÖVE in the folder for what players save; elsewhere, the library of Lua reads and makes them.
local function exists(path)
  local love = rawget(_G, "love")
  if love and love.filesystem then return love.filesystem.getInfo(path) ~= nil end
  local there = io.open(path, "rb")
  if there then there:close() end
  return there ~= nil
end

local function open_new(path)
  local love = rawget(_G, "love")
  if love and love.filesystem then
    local made, reason = love.filesystem.newFile(path, "w")
    if not made then error("cannot write " .. path .. ": " .. tostring(reason), 0) end
    return made
  end
  -- Appending empties no file, even if one could not be read or was made in this moment.
  local made, reason = io.open(path, "ab")
  if not made then error("cannot write a trace: " .. reason .. "; is the folder there?", 0) end
  return made
end

-- Return the bytes of a number as a double, the lowest first; those of -0 are those of 0.
local function double_bytes(value)
  if value == 0 then return 0, 0, 0, 0, 0, 0, 0, 0 end
  if string.pack then return byte(string.pack("<d", value), 1, 8) end
  local fraction, exponent = math.frexp(abs(value))
  local high = exponent + 1022  -- the bits of the exponent; 0 in the smallest numbers
  local rest = high > 0 and (fraction * 2 - 1) * 2 ^ 52 or fraction * 2 ^ (exponent + 1074)
  if high < 0 then high = 0 end
  local bytes = {}
  for place = 1, 6 do
    bytes[place] = rest % 256
    rest = floor(rest / 256)
  end
  bytes[7], bytes[8] = high % 16 * 16 + rest, (value < 0 and 128 or 0) + floor(high / 16)
  return unpack(bytes)
end

local function cell(name)
  local needs_quotes = find(name, ",", 1, true) or sub(name, 1, 1) == '"'
  return needs_quotes and '"' .. gsub(name, '"', '""') .. '"' or name
end

local function value_text(name, value)
  if type(value) == "boolean" then return value and "true" or "false" end
  if type(value) ~= "number" then
    error("the signal " .. name .. " is missing, or neither a number nor a boolean", 0)
  end
  if not is_finite(value) then
    error("the signal " .. name .. " is " .. odd_number_text(value) .. ", and numbers must be finite", 0)
  end
  return number_text(value)
end

local Recorder = {}
Recorder.__index = Recorder

--- Return a recorder, which writes the play of a person as traces, which `tltlc monitor` can judge later; it needs no
--- connection. Each episode is a file in `folder`: `trace-0001.csv`, `trace-0002.csv` and so on; no file is
--- overwritten. The folder must exist; but in LÖVE, it is made in the folder of what players save
--- (`love.filesystem.getSaveDirectory()`). `signals` are the names of the signals, as specs write them. With
--- `clock_hz`, the number of samples in a second, the files have a column `time`:
---
---     local recorder = tltl_client.Recorder("traces", {"position", "at_goal"}, 10)
---     recorder:begin()
---     recorder:sample({position = 1, at_goal = false})    -- after each tick
---     recorder:finish()
---
--- With the actions of the person, as tltlc would send them, each episode is also a tape, `trace-0001.tape.jsonl`, with
--- which the play can be repeated. `game` is the name of the game:
---
---     recorder:begin("short", "v0", 7)
---     recorder:sample({position = 1, at_goal = false}, 2)
---
--- `sample` raises an error if a number is not finite, or a signal is missing, or if some samples of an episode have an
--- action and others have none.
function tltl_client.Recorder(folder, signals, clock_hz, game)
  local recorder = {_folder = folder, _signals = signals, _clock_hz = clock_hz, _game = game or "game"}
  return setmetatable(recorder, Recorder)
end

--- Begin a new trace, and end the one before; return the path of its file, which the first sample makes. A tape says
--- which scene, variant and seed were played; without a variant it is `v0`.
function Recorder:begin(scene, variant, seed)
  self:finish()
  self._samples, self._low, self._high = 0, 1, 0
  self._played = {scene = scene or null, variant = variant or "v0", seed = seed or null}
  local love = rawget(_G, "love")
  local root = love and love.filesystem and love.filesystem.getSaveDirectory() .. "/" or ""
  return root .. self:_free_path() .. ".csv"
end

--- Write the values of all signals at one moment to the file at once; begin a trace if there is none. With `action`,
--- what the person did in the tick before it, the step is written to the tape, too.
function Recorder:sample(signals, action)
  local texts = {}
  for index, name in ipairs(self._signals) do texts[index] = value_text(name, signals[name]) end
  local action_text = action ~= nil and encode(action) or nil
  if not self._played then self:begin() end
  if not self._file then self:_make_trace() end
  if self._samples > 0 and (action == nil) ~= (self._tape == nil) then
    error("give the action of each sample of an episode, or of none", 0)
  end
  if action_text then self:_write_step(action_text, texts, signals) end
  if self._clock_hz then table.insert(texts, 1, number_text(self._samples / self._clock_hz)) end
  self:_write(texts)
  self._samples = self._samples + 1
end

--- End the trace and its tape, if there is one.
function Recorder:finish()
  if self._file then self._file:close() end
  if self._tape then self._tape:close() end
  self._file, self._tape, self._played = nil, nil, nil
end

-- Return the path of the next trace and its tape, without an ending.
function Recorder:_free_path()
  local number, path = 0, nil
  repeat
    number = number + 1
    path = self._folder .. "/" .. format("trace-%04d", number)
  until not exists(path .. ".csv") and not exists(path .. ".tape.jsonl")
  return path
end

local function write_line(file, line)
  local written, reason = file:write(line .. "\n")
  if written then written, reason = file:flush() end
  if not written then error("cannot write the trace: " .. tostring(reason), 0) end
end

function Recorder:_write(cells)
  write_line(self._file, concat(cells, ","))
end

function Recorder:_make_trace()
  local love = rawget(_G, "love")
  if love and love.filesystem then love.filesystem.createDirectory(self._folder) end
  local path = self:_free_path()
  self._file, self._tape_path = open_new(path .. ".csv"), path .. ".tape.jsonl"
  local names = self._clock_hz and {"time"} or {}
  for _, name in ipairs(self._signals) do names[#names + 1] = cell(name) end
  self:_write(names)
end

-- Write a step to the tape, and before the first one the header.
function Recorder:_write_step(action, texts, signals)
  if not self._tape then
    self._tape = open_new(self._tape_path)
    write_line(self._tape, self:_header(signals))
  end
  local members = {}
  for index, name in ipairs(self._signals) do
    local text, value = texts[index], signals[name]
    local number = value == true and 1 or value or 0
    if self._are_bools[index] then
      number = number ~= 0 and 1 or 0
      text = number == 1 and "true" or "false"
    elseif type(value) == "boolean" then
      text = number_text(number)
    end
    members[index] = quoted(name) .. ":" .. text
    for _, part in ipairs({double_bytes(number)}) do
      self._low = (self._low + part) % 65521
      self._high = (self._high + self._low) % 65521
    end
  end
  local digest = (self._samples + 1) % 60 == 0 and format(',"digest":"%04x%04x"', self._high, self._low) or ""
  write_line(self._tape, '{"action":' .. action .. ',"signals":{' .. concat(members, ",") .. "}" .. digest .. "}")
end

function Recorder:_header(signals)
  local types, about = {}, self._played
  self._are_bools = {}  -- A signal keeps the type of its first value.
  for index, name in ipairs(self._signals) do
    self._are_bools[index] = type(signals[name]) == "boolean"
    types[index] = quoted(name) .. ':{"type":"' .. (self._are_bools[index] and "bool" or "number") .. '"}'
  end
  about.tape, about.game, about.spec, about.clock_hz = 1, self._game, null, self._clock_hz or null
  about.versions = {lua = _VERSION}
  return sub(encode(about), 1, -2) .. ',"signals":{' .. concat(types, ",") .. "}}"
end

return tltl_client
