-- A search for the line is written while its robot stands beside the line: live programming from the first half of an
-- idea to a tuned value, in small steps, with the program running (but for one pause) all the while.

local beginning = [[
(bridge robot sim [ world = "worlds/bends.world" ])
(var lightlim := [128])
(var maxlook := [300])
(var forward := [0.1])
(var search := [1.0])

(machine follower
  (state moving
    (running [robot.move{ linear = { x = forward } }]))
  (on outofline moving -> looking tlooking)
  (on intheline looking -> moving tmoving)
  (event outofline [robot.light.data > lightlim + 10])
  (event intheline [robot.light.data < lightlim - 10])
  (state looking))

(spawn follower moving)
]]

-- Refers to `lookright`, which isn't there yet
local half_a_search = [[
(state looking
    (machine lookalgo
      (var time := [maxlook])
      (state lookleft
        (running [robot.move{ angular = { z = search } }]))
      (state returnleft
        (running [robot.move{ angular = { z = -search } }]))
      (ontime time lookleft -> returnleft treturnleft)
      (ontime time returnleft -> lookright tlookright))
    (onentry (spawn lookalgo lookleft)))]]

local the_other_half = [[

      (state lookright
        (running [robot.move{ angular = { z = -search } }]))
      (state returnright
        (running [robot.move{ angular = { z = search } }]))
      (ontime time lookright -> returnright treturnright)
      (ontime time returnright -> lookleft tlookleft))]]

local lookalgo = "follower/looking/lookalgo"

-- A replacement of plain text, once.
local function replace(text, old, new)
  local first, last = text:find(old, 1, true)
  return text:sub(1, first - 1) .. new .. text:sub(last + 1)
end

local function last(t, kind, name)
  local records = t:records(kind)
  for i = #records, 1, -1 do
    if not name or records[i].name == name then return records[i] end
  end
end

local function pose(t)
  local odom = last(t, "input", "odom").value
  return ("%.3f %.3f %.3f"):format(odom.x, odom.y, odom.theta)
end

-- Steps until something holds, for at most two minutes of program time.
local function until_holds(t, what, holds)
  for _ = 1, 1200 do
    if holds() then return end
    t:step()
  end
  t:expect(false, "in two minutes it never came to this: " .. what)
end

local function until_active(t, path)
  until_holds(t, path .. " active", function() return t:is_active(path) end)
end

-- How often a transition was taken since a moment.
local function count(t, name, since)
  local n = 0
  for _, taken in ipairs(t:records("transition")) do
    if taken.name == name and taken.t >= (since or 0) then n = n + 1 end
  end
  return n
end

-- Begins beside the line, which bends away to the left.
local function frozen(t)
  t:source(beginning, { bridge = "sim" })
  t:advance(500)
  t:expect_active("follower/moving")
  until_active(t, "follower/looking")
  t:advance(2000)
end

local function with_half_a_search(t)
  frozen(t)
  t:edit(function(text) return replace(text, "(state looking)", half_a_search) end)
end

-- It has left the line to the other side, where looking left is no help, and is turning away from where it came back to.
local function turning_for_ever(t)
  with_half_a_search(t)
  until_holds(t, "turning back for too long", function()
    if not t:is_active("follower/looking") then return false end
    until_holds(t, "the look to the left over", function() return t:active()[2] ~= lookalgo .. "/lookleft" end)
    t:advance(300)
    return t:active()[2] == lookalgo .. "/returnleft"
  end)
end

local function with_whole_search(t)
  turning_for_ever(t)
  t:pause()
  t:edit(function(text) return replace(text, "tlookright))", "tlookright)" .. the_other_half) end)
end

test("1: a state without actions leaves the robot where it is", function(t)
  frozen(t)
  t:expect_active("follower/looking")
  t:expect(#t:outputs("robot.move") == 0, "it is told nothing")
  local before = pose(t)
  t:advance(10000)
  t:expect(pose(t) == before, "it stands still")
end)

test("2: what is added to the active state begins the program again", function(t)
  with_half_a_search(t)
  local load = last(t, "load")
  t:expect(load.restarted and load.reason:find("looking"), "it says that looking changed")
  t:expect_active("follower/moving")
end)

test("3: a state that isn't there yet is an error that stops nothing", function(t)
  with_half_a_search(t)
  local errors = t:errors()
  t:expect(#errors == 1 and errors[1].code == "unknown-state", "one unknown state")
  t:expect(errors[1].message:find("lookright"), "it is named")
  t:step()
  t:expect_active(lookalgo .. "/lookleft")
end)

test("4: off the line it looks at once, without a move forward, and finds it on the left", function(t)
  with_half_a_search(t)
  local edited = last(t, "load").t
  t:step()
  t:expect_active(lookalgo .. "/lookleft")
  t:expect_output("robot.move", function(m) return m.angular.z > 0 end)
  until_active(t, "follower/moving")
  for _, output in ipairs(t:records("output")) do
    if output.t > edited and output.t < last(t, "transition").t then
      t:expect(output.value.linear.x == 0, "it only turns on the spot")
    end
  end
end)

test("5: with the line on its right it turns back and never stops", function(t)
  turning_for_ever(t)
  t:expect(count(t, "tmoving") > 5, "so far all went well")
  t:expect(count(t, "tlookright") == 0, "no transition leads on")
  t:expect_output("robot.move", function(m) return m.angular.z < 0 end)
end)

test("6: a pause stops the robot", function(t)
  turning_for_ever(t)
  t:pause()
  local before, records = pose(t), #t:records()
  t:advance(60000)
  t:expect(#t:records() == records, "nothing happens")
  t:resume()
  t:step()
  t:expect(pose(t) ~= before, "it goes on")
end)

test("7: adding the missing states while paused disturbs nothing", function(t)
  turning_for_ever(t)
  t:pause()
  local active, spawns = table.concat(t:active(), " "), #t:records("spawn")
  t:edit(function(text) return replace(text, "tlookright))", "tlookright)" .. the_other_half) end)
  t:expect(not last(t, "load").restarted, "no restart")
  t:expect(#t:errors() == 0, "the unknown state is known now")
  t:expect(table.concat(t:active(), " ") == active, "the same states are active")
  t:expect(#t:records("spawn") == spawns, "nothing is spawned again")
  t:expect(t:get(lookalgo .. "/time") == 300, "values are kept")
  t:resume()
  t:step()
  t:expect_active(lookalgo .. "/lookright")   -- the timer of returnleft had long run out
end)

test("8: resumed, it looks to the right and finds the line", function(t)
  with_whole_search(t)
  local before = count(t, "tlookleft")
  t:resume()
  t:step()
  t:expect_active(lookalgo .. "/lookright")
  t:expect_output("robot.move", function(m) return m.angular.z < 0 end)
  until_active(t, "follower/moving")
  t:expect(count(t, "tlookleft") == before, "in this very sweep")
end)

test("9: a wider look takes effect at once and finds a line that bends too much", function(t)
  with_whole_search(t)
  t:resume()
  until_active(t, "follower/moving")
  -- Faster it overshoots where the line bends
  t:edit(function(text) return replace(text, "forward := [0.1]", "forward := [0.2]") end)
  t:step()
  t:expect_output("robot.move", function(m) return m.linear.x == 0.2 end)
  until_holds(t, "four sweeps in vain", function() return count(t, "tlookleft", last(t, "transition", "tlooking").t) == 4 end)
  local active = table.concat(t:active(), " ")
  t:edit(function(text) return replace(text, "maxlook := [300]", "maxlook := [900]") end)
  t:expect(not last(t, "load").restarted, "no restart")
  t:expect(table.concat(t:active(), " ") == active, "the same states are active")
  t:expect(t:get(lookalgo .. "/time") == 900, "the search that is going on takes the new width")
  until_active(t, "follower/moving")
end)
