-- One robot as blocks see it: fields for its inputs, functions for its outputs and calls, objects for its devices. Called
-- once for each robot with what it offers; gives the object for the blocks and the functions by which the engine feeds it. `mark`:
-- under this key a device's metatable has its name, for those who show it.
local name, offer, now, nearest, mark = ...

local latest = {}   -- input -> its last message
local came = {}     -- input -> program time in ms at which that came
local asked         -- the last input that a block asked for while it had no message
local outbox = {}   -- { output, message } or { call, arguments, id } or { cancelled = id } in the order sent
local heard = {}    -- input -> true once a message came, though it may have been forgotten since
local senders = {}  -- output or call -> the function that sends it
local devices = {}  -- device -> its object, the same one as long as the robot is
local calls = setmetatable({}, { __mode = "v" }) -- id -> what the block got for it
local last_call = 0

local function names(...)
  local list = {}
  for _, ports in ipairs({ ... }) do
    for port in pairs(ports) do list[#list + 1] = port end
  end
  table.sort(list)
  return #list > 0 and table.concat(list, ", ") or "none"
end

local function suggestion(wanted, ...)
  local near = nearest(wanted, { ... })
  return near and ("; did you mean `" .. near .. "`?") or ""
end

-- A copy of a message type's defaults, with what the program gave; a field that the type hasn't is an error. A default of
-- no Lua type stands for anything.
local function filled(target, defaults, given, path)
  local message = {}
  for field, default in pairs(defaults) do
    local value = given[field]
    if type(default) == "userdata" then
      message[field] = value
    elseif value == nil then
      message[field] = type(default) == "table" and filled(target, default, {}, path) or default
    elseif type(default) == "table" and next(default) ~= nil and #default == 0 then
      if type(value) ~= "table" then
        error(("`%s.%s` needs a table for `%s`, not %s"):format(name, target, path .. field, type(value)), 0)
      end
      message[field] = filled(target, default, value, path .. field .. ".")
    elseif type(value) ~= type(default) and type(default) ~= "table" then
      error(("`%s.%s` needs a %s for `%s`, not %s"):format(name, target, type(default), path .. field, type(value)), 0)
    else
      message[field] = value
    end
  end
  -- A shape without fields takes anything; a list's elements are the bridge's to check.
  if next(defaults) == nil or #defaults > 0 then return next(given) == nil and defaults or given end
  for field in pairs(given) do
    if defaults[field] == nil then
      error(("`%s.%s` has no field `%s%s`; it has %s"):format(name, target, path, tostring(field), names(defaults)), 0)
    end
  end
  return message
end

-- A message is what it was when it was sent, whatever becomes of its table.
local function copied(value, depth)
  if type(value) ~= "table" then return value end
  if depth == 0 then error("a message can't be nested so deeply", 0) end
  local copy = {}
  for key, inner in pairs(value) do copy[key] = copied(inner, depth - 1) end
  return copy
end

local function positioned(problem, level)
  error(problem, level + 1)
end

-- What a block gave as a message, held against its type's defaults (nothing: it isn't known), as it is now.
local function message_of(target, defaults, given, level)
  local message = given
  if type(given) == "function" then
    message = defaults and filled(target, defaults, {}, "") or {}
    given(message)
  end
  if defaults then
    if type(message) ~= "table" then
      positioned(("`%s.%s` takes a table or a function, not %s"):format(name, target, type(given)), level + 1)
    end
    local fine, result = pcall(filled, target, defaults, message, "")
    if not fine then positioned(result, level + 1) end
    message = result
  end
  local fine, result = pcall(copied, message, 16)
  if not fine then positioned(("`%s.%s`: %s"):format(name, target, result), level + 1) end
  return result
end

local function sender(output)
  local defaults = offer.outputs[output]
  if type(defaults) ~= "table" then defaults = nil end
  return function(given)
    outbox[#outbox + 1] = { output, message_of(output, defaults, given, 2) }
  end
end

-- The arguments of a call, defaults filled in; a list, in which what isn't given is false.
local function arguments_of(target, wanted, given, count, level)
  if not wanted then return copied(given, 16) end
  if count > #wanted then
    positioned(("`%s.%s` takes %s, not %d arguments"):format(name, target, #wanted == 0 and "no arguments" or ("at most %d"):format(#wanted), count), level + 1)
  end
  local arguments = {}
  for index, argument in ipairs(wanted) do
    local value = given[index]
    if value == nil then
      value = argument.default
      if value == nil and argument.message then value = message_of(target, argument.message, {}, level + 1) end
      if value == nil and not argument.optional then
        positioned(("`%s.%s` needs `%s`"):format(name, target, argument.name), level + 1)
      end
    elseif argument.message then
      value = message_of(target, argument.message, value, level + 1)
    end
    arguments[index] = copied(value, 16)
  end
  arguments.n = #wanted
  return arguments
end

local handle = {
  __name = "call",
  __metatable = "call",
  __index = function(call, key)
    if key == "cancel" then
      return function()
        if not rawget(call, "done") then outbox[#outbox + 1] = { cancelled = rawget(call, "id") } end
      end
    end
    if key == "ok" or key == "value" or key == "error" or key == "feedback" then return nil end
    error(("a call has no `%s`; it has cancel, done, error, feedback, ok, value"):format(tostring(key)), 2)
  end,
}

local function begin(target, wanted, level, ...)
  local arguments = arguments_of(target, wanted, { ... }, select("#", ...), level + 1)
  last_call = last_call + 1
  local call = setmetatable({ id = last_call, done = false }, handle)
  calls[last_call] = call
  outbox[#outbox + 1] = { target, arguments, last_call, n = arguments.n or select("#", ...) }
  return call
end

local function caller(target)
  local wanted = offer.calls[target]
  return function(...)
    local call = begin(target, wanted, 2, ...)
    return call
  end
end

local function fresh(input)
  local time = came[input]
  if time and offer.stale and now() - time > offer.stale then return nil end
  return latest[input]
end

-- What a device's function reads: an input, or a field within it.
local function read(path)
  local value
  for part in path:gmatch("[^.]+") do
    if value == nil then
      value = fresh(part)
      if value == nil then asked = part return nil end
    else
      if type(value) ~= "table" then return nil end
      value = rawget(value, math.tointeger(tonumber(part)) or part)
      if value == nil then return nil end
    end
  end
  return value
end

local function device(key)
  if devices[key] then return devices[key] end
  local methods = {}
  local object = setmetatable({}, {
    __name = "device",
    __metatable = "device",
    [mark] = name .. "." .. key,
    __tostring = function() return name .. "." .. key end,
    __index = function(_, wanted)
      local functions = offer.devices[key]
      if not functions then error(("`%s` has no device `%s` now; it has %s"):format(name, key, names(offer.devices)), 2) end
      local offered = functions[wanted]
      if not offered then
        error(("`%s.%s` has no function `%s`; it has %s%s"):format(name, key, tostring(wanted), names(functions), suggestion(wanted, functions)), 2)
      end
      local known = methods[wanted]
      if known and known.offered == offered then return known.call end
      local target = key .. "." .. wanted
      local call = function(object, ...)
        if object ~= devices[key] then error(("call it with a colon: `%s.%s:%s(..)`"):format(name, key, wanted), 2) end
        if offered.reads then return read(offered.reads) end
        local begun = begin(target, offered.arguments, 2, ...)
        return begun
      end
      methods[wanted] = { offered = offered, call = call }
      return call
    end,
    __newindex = function(_, wanted)
      error(("`%s.%s` is a device: `%s` can't be assigned"):format(name, key, tostring(wanted)), 2)
    end,
  })
  devices[key] = object
  return object
end

local function is_input(key)
  return offer.inputs[key] ~= nil or heard[key] ~= nil
end

local function age(_, input)
  if type(input) ~= "string" or (not is_input(input) and not offer.open) then
    error(("`%s` has no input `%s`; it has %s"):format(name, tostring(input), names(offer.inputs)), 2)
  end
  return came[input] and now() - came[input]
end

local function send(key)
  senders[key] = senders[key] or (offer.calls[key] and caller or sender)(key)
  return senders[key]
end

local robot = setmetatable({}, {
  __name = "robot",
  __metatable = "robot",
  __tostring = function() return name end,
  __index = function(_, key)
    if key == "age" then return age end
    if offer.devices[key] then return device(key) end
    if is_input(key) then
      local message = fresh(key)
      if message == nil then asked = key end
      return message
    end
    if offer.outputs[key] ~= nil or offer.calls[key] or offer.open then return send(key) end
    local more = next(offer.calls) and "; calls: " .. names(offer.calls) or ""
    if next(offer.devices) then more = more .. "; devices: " .. names(offer.devices) end
    error(("`%s` has no input or output `%s`; inputs: %s; outputs: %s%s%s"):format(
      name, tostring(key), names(offer.inputs), names(offer.outputs), more,
      suggestion(key, offer.inputs, offer.outputs, offer.calls, offer.devices)), 2)
  end,
  __newindex = function(_, key, value)
    if not is_input(key) then
      error(("`%s` has no input `%s`%s"):format(name, tostring(key), suggestion(key, offer.inputs)), 2)
    end
    if value ~= nil then
      error(("an input can only be forgotten: `%s.%s = nil`; to send, call an output: `%s.NAME{ .. }`"):format(name, key, name), 2)
    end
    latest[key], came[key] = nil, nil
  end,
})

-- A field that a message hasn't is an error, not a nil that drives on.
local function strict(message, defaults, path)
  if type(message) ~= "table" or type(defaults) ~= "table" or next(defaults) == nil or #defaults > 0 then return message end
  for field, default in pairs(defaults) do strict(message[field], default, path .. "." .. field) end
  return setmetatable(message, {
    __index = function(_, field)
      if defaults[field] ~= nil then return nil end
      error(("`%s` has no field `%s`; it has %s"):format(path, tostring(field), names(defaults)), 2)
    end,
  })
end

local engine = {
  receive = function(input, message, time)
    latest[input] = strict(message, offer.inputs[input], name .. "." .. input)
    came[input], heard[input] = time, true
  end,
  take = function()
    if #outbox == 0 then return nil end
    local sent = outbox
    outbox = {}
    return sent
  end,
  -- How far a call has come, or how it ended.
  answer = function(id, done, value, problem)
    local call = calls[id]
    if not call or rawget(call, "done") then return end
    if not done then call.feedback = value return end
    call.done, call.ok, call.value, call.error = true, problem == nil, value, problem
    calls[id] = nil
  end,
  -- The input that a block asked for last, and why that is in vain; nothing where it isn't.
  missed = function()
    if asked == nil or fresh(asked) ~= nil then return nil end
    if came[asked] then return asked, "has had no message lately" end
    if heard[asked] then return asked, "was forgotten and has had no message since" end
    return asked, "has had no message yet"
  end,
  offer = function(changed) offer = changed; senders = {} end,
}

return robot, engine
