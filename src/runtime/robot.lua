-- One robot as blocks see it: fields for its inputs and outputs. Called once for each robot with what it offers;
-- gives the object for the blocks and the functions by which the engine feeds it.
local name, offer, now, nearest = ...

local latest = {}   -- input -> its last message
local came = {}     -- input -> program time in ms at which that came
local asked         -- the last input that a block asked for while it had no message
local outbox = {}   -- { output, message } in the order sent
local heard = {}    -- input -> true once a message came, though it may have been forgotten since
local senders = {}  -- output -> the function that sends it

local function names(ports)
  local list = {}
  for port in pairs(ports) do list[#list + 1] = port end
  table.sort(list)
  return table.concat(list, ", ")
end

local function suggestion(wanted, ports)
  local near = nearest(wanted, ports)
  return near and ("; did you mean `" .. near .. "`?") or ""
end

-- A copy of a message type's defaults, with what the program gave; a field that the type hasn't is an error.
local function filled(output, defaults, given, path)
  local message = {}
  for field, default in pairs(defaults) do
    local value = given[field]
    if value == nil then
      message[field] = type(default) == "table" and filled(output, default, {}, path) or default
    elseif type(default) == "table" and next(default) ~= nil then
      if type(value) ~= "table" then
        error(("`%s.%s` needs a table for `%s`, not %s"):format(name, output, path .. field, type(value)), 0)
      end
      message[field] = filled(output, default, value, path .. field .. ".")
    elseif type(value) ~= type(default) and type(default) ~= "table" then
      error(("`%s.%s` needs a %s for `%s`, not %s"):format(name, output, type(default), path .. field, type(value)), 0)
    else
      message[field] = value
    end
  end
  for field in pairs(given) do
    if defaults[field] == nil then
      error(("`%s.%s` has no field `%s%s`; it has %s"):format(name, output, path, tostring(field), names(defaults)), 0)
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

local function sender(output)
  local defaults = offer.outputs[output]
  return function(given)
    local message = given
    if type(given) == "function" then
      message = defaults and filled(output, defaults, {}, "") or {}
      given(message)
    end
    if defaults then
      if type(message) ~= "table" then
        positioned(("`%s.%s` takes a table or a function, not %s"):format(name, output, type(given)), 2)
      end
      local fine, result = pcall(filled, output, defaults, message, "")
      if not fine then positioned(result, 2) end
      message = result
    end
    local fine, result = pcall(copied, message, 16)
    if not fine then positioned(("`%s.%s`: %s"):format(name, output, result), 2) end
    message = result
    outbox[#outbox + 1] = { output, message }
  end
end

local function fresh(input)
  local time = came[input]
  if time and offer.stale and now() - time > offer.stale then return nil end
  return latest[input]
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
  senders[key] = senders[key] or sender(key)
  return senders[key]
end

local robot = setmetatable({}, {
  __name = "robot",
  __metatable = "robot",
  __tostring = function() return name end,
  __index = function(_, key)
    if key == "age" then return age end
    if is_input(key) then
      local message = fresh(key)
      if message == nil then asked = key end
      return message
    end
    if offer.outputs[key] ~= nil or offer.open then return send(key) end
    error(("`%s` has no input or output `%s`; inputs: %s; outputs: %s%s"):format(
      name, tostring(key), names(offer.inputs), names(offer.outputs), suggestion(key, offer)), 2)
  end,
  __newindex = function(_, key, value)
    if not is_input(key) then
      error(("`%s` has no input `%s`%s"):format(name, tostring(key), suggestion(key, offer)), 2)
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
