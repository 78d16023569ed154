-- What of every block's library is best said in Lua. Given: the environment, the interpreter's own functions, and whether the order of keys is fixed.
local env, own, order = ...
local error, next, type, load, select = error, next, type, load, select
local floor, sort, concat = math.floor, table.sort, table.concat

-- Program time, UTC: the same in every run and every time zone.
local function days(year, month, day)
  month = month - 1
  year, month = year + month // 12, month % 12 + 1
  if month <= 2 then year, month = year - 1, month + 12 end
  return 365 * year + year // 4 - year // 100 + year // 400 + (153 * (month - 3) + 2) // 5 + day - 719469
end

local function field(t, name, default)
  local value = t[name] or default
  local whole = math.tointeger(value)
  if not whole then error("field '" .. name .. "' " .. (value == nil and "missing in date table" or "is not an integer"), 4) end
  return whole
end

local function time(t)
  if t == nil then return floor(own.now() / 1000) end
  if type(t) ~= "table" then error("bad argument #1 to 'time' (table expected)", 3) end
  return days(field(t, "year"), field(t, "month"), field(t, "day")) * 86400
    + field(t, "hour", 12) * 3600 + field(t, "min", 0) * 60 + field(t, "sec", 0)
end

local date = own.date
env.os.time = function(t) local seconds = time(t) return seconds end
env.os.clock = function() return own.now() / 1000 end
env.os.date = function(format, seconds)
  format = format == nil and "%c" or format
  if type(format) == "string" and format:sub(1, 1) ~= "!" then format = "!" .. format end
  return date(format, seconds or floor(own.now() / 1000))
end

-- Without a seed, that of the program: Lua would take the time.
local randomseed = math.randomseed
function env.math.randomseed(...)
  if select("#", ...) == 0 then return randomseed(own.seed) end
  return randomseed(...)
end
randomseed(own.seed)

-- Modules are read once; a module that fails is read again the next time.
local loading = {}
function env.require(name)
  if type(name) ~= "string" then error("bad argument #1 to 'require' (string expected)", 2) end
  local module = own.loaded[name]
  if module ~= nil then return module end
  if loading[name] then error("module '" .. name .. "' requires itself", 2) end
  local text, why = own.find(name)
  if not text then error(why, 2) end
  local chunk, mistake = load(text, "=" .. name:gsub("%.", "/") .. ".lua")
  if not chunk then error(mistake, 0) end
  loading[name] = true
  local ok, result = own.pcall(chunk, name)
  loading[name] = nil
  if not ok then error(result, 0) end
  if result == nil then result = true end
  own.loaded[name] = result
  return result
end

-- Comparators in Lua, so that a sort that takes too long can be stopped.
function own.less(a, b) return a < b end
function own.compare(f) return function(a, b) return f(a, b) end end

-- What one block did to a library would hold for all others, and outlive a restart.
for _, name in ipairs { "coroutine", "log", "math", "os", "string", "table", "utf8" } do
  local library = env[name]
  if library then
    env[name] = setmetatable({}, {
      __index = library,
      __newindex = function(_, key) error("'" .. name .. "." .. tostring(key) .. "' can't be assigned: libraries stay as they are", 2) end,
      __pairs = function() return next, library end,
      __metatable = "library",
    })
  end
end

if order == "by key" then
  local rank = { number = 1, string = 2, boolean = 3 }
  local function before(a, b)
    local x, y = rank[type(a)] or 4, rank[type(b)] or 4
    if x ~= y then return x < y end
    if x > 2 then return x == 3 and b and not a end
    return a < b
  end
  env.pairs = function(t)
    local metatable = own.getmetatable(t)
    local override = type(metatable) == "table" and metatable.__pairs
    if override then
      local f, s, k = override(t)
      return f, s, k
    end
    local keys, count = {}, 0
    for key in next, t do
      count = count + 1
      keys[count] = key
    end
    sort(keys, before)
    local at = 0
    return function()
      while at < count do
        at = at + 1
        local value = own.rawget(t, keys[at])
        if value ~= nil then return keys[at], value end
      end
    end, t, nil
  end
end
