-- A behaviour with a module: both files, by themselves and edited while they run.

local function bright(t, ms) t:input("robot.light", { data = 200 }) t:advance(ms) end
local function dark(t, ms) t:input("robot.light", { data = 50 }) t:advance(ms) end

test("it looks for the line where it loses it", function(t)
  t:load("line_keeper.lrp")
  dark(t, 500)
  t:expect_active("keeper/moving")
  bright(t, 100)
  t:expect_active("sweep/left")
  t:expect_output("robot.move", function(m) return m.angular.z > 0 end)
  t:advance(200)
  t:expect_active("sweep/left_back")
  dark(t, 100)
  t:expect_active("keeper/moving")
  t:expect(#t:active() == 1, "the sweep is over")
end)

test("the importer's value counts, and is live", function(t)
  t:load("line_keeper.lrp")
  bright(t, 100)
  t:expect(t:get("maxlook") == 150 and t:get("sweep/time") == 150)
  t:edit(function(text) return text:gsub("%[150%]", "[1000]") end)
  t:expect(t:get("sweep/time") == 1000, "a wider look widens the sweep at once")
  t:advance(900)
  t:expect_active("sweep/left")
end)

test("the module is edited while it runs", function(t)
  t:load("line_keeper.lrp")
  bright(t, 100)
  t:write("lib/sweep.lrp", [[
    (var maxlook := [100])
    (export sweep)
    (machine sweep
      (var time := [maxlook])
      (state left)
      (state waiting)
      (ontime time left -> waiting))]])
  t:expect_active("keeper/moving")
  t:expect(t:records("restart")[1].reason:find("sweep/left"), "its actions changed while it was active")
  bright(t, 400)
  t:expect_active("sweep/waiting")
  t:expect(#t:errors() == 0)
end)

test("the module can be tried by itself", function(t)
  t:load("lib/sweep.lrp")
  t:advance(600)
  t:expect_active("sweep/left_back")
  t:expect(t:get("sweep/time") == 200)
end)

test("it keeps to a line in the simulator", function(t)
  t:load("line_keeper.lrp", { bridge = "sim" })
  t:advance(20000)
  local found = 0
  for _, taken in ipairs(t:records("transition")) do
    if taken.to == "keeper/moving" or taken.to == "moving" then found = found + 1 end
  end
  t:expect(found > 3, found)
end)
