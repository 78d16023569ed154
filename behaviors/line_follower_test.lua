-- The line follower: in the simulator from end to end, and state by state with a robot that the test plays.

-- The program time at which it has finished, in seconds; nil if it hasn't within so many.
local function finished(t, seconds)
  for second = 1, seconds do
    t:advance(1000)
    if t:is_active("follower/finished") then return second end
  end
end

local function entered(t, state)
  local times = {}
  for _, record in ipairs(t:records("enter")) do
    if record.state == state then times[#times + 1] = record.t end
  end
  return times
end

-- A robot on the line that has touched nothing, played by the test.
local function on_the_line(t)
  t:load("line_follower.lrp")
  t:input("robot.light", { data = 20 })
  t:input("robot.bumper", { data = 0 })
  t:step()
  t:expect_active("follower/moving")
end

local function press(t, steps)
  t:input("robot.bumper", { data = 1 })
  t:step(steps)
end

local function release(t)
  t:input("robot.bumper", { data = 0 })
  t:step()
end

test("completes its course in three minutes, with a bump at each end", function(t)
  t:load("line_follower.lrp", { bridge = "sim" })
  t:expect(finished(t, 180), "it hasn't finished")
  t:expect(#entered(t, "follower/bumpback") == 1, "one bump turns it round")
  t:expect(#t:errors() == 0, "nothing goes wrong")
end)

test("completes the hard course as well", function(t)
  t:load("line_follower.lrp", { bridge = "sim", world = "worlds/bends.world" })
  t:expect(finished(t, 400), "it hasn't finished")
  t:expect(#entered(t, "follower/bumpback") == 1, "one bump turns it round")
end)

for seed = 1, 3 do
  test(("completes its course with a noisy light sensor, seed %d"):format(seed), function(t)
    t:load("line_follower.lrp", { bridge = "sim", seed = seed })
    t:edit(function(text) return text:gsub('"worlds/curve.world"', '%0, noise = { light = 15 }') end)
    t:expect(finished(t, 240), "it hasn't finished")
  end)
end

test("doesn't complete it without its lookright state", function(t)
  t:load("line_follower.lrp", { bridge = "sim" })
  t:edit(function(text) return text:gsub("%s+%(state lookright.-%]%)%)", "") end)
  t:expect(not finished(t, 400), "it has finished without looking to the right")
end)

test("doesn't complete it when it returns to the left instead", function(t)
  t:load("line_follower.lrp", { bridge = "sim" })
  t:edit(function(text)
    return text
      :gsub("%s+%(state lookright.-%]%)%)", "")
      :gsub("%s+%(ontime time lookright .-%)", "")
      :gsub("returnleft %-> lookright tlookright", "returnleft -> returnright treturnright")
  end)
  t:expect(#t:errors() == 0, "what is left is a whole program")
  t:expect(not finished(t, 180), "it has finished without looking to the right")
end)

test("drives on along the line", function(t)
  on_the_line(t)
  t:expect_output("robot.move", function(m) return m.linear.x > 0 and m.angular.z == 0 end)
end)

test("searches when it leaves the line", function(t)
  on_the_line(t)
  t:input("robot.light", { data = 200 })
  t:step()
  t:expect_active("follower/looking/lookalgo/lookleft")
  t:expect_output("robot.move", function(m) return m.angular.z > 0 and m.linear.x == 0 end)
end)

test("looks left, right, and then twice as far", function(t)
  on_the_line(t)
  t:input("robot.light", { data = 200 })
  t:step()
  for _, time in ipairs { 100, 200, 400, 800 } do
    for _, state in ipairs { "lookleft", "returnleft", "lookright", "returnright" } do
      t:expect_active("follower/looking/lookalgo/" .. state)
      t:advance(time)
    end
  end
end)

test("follows the line again as soon as it sees it", function(t)
  on_the_line(t)
  t:input("robot.light", { data = 200 })
  t:advance(1000)
  t:input("robot.light", { data = 50 })
  t:step()
  t:expect_active("follower/moving")
end)

test("takes neither side of the threshold for a change", function(t)
  on_the_line(t)
  t:input("robot.light", { data = t:get("lightlim") + 10 })
  t:advance(1000)
  t:expect_active("follower/moving")
  t:input("robot.light", { data = 200 })
  t:step()
  t:input("robot.light", { data = t:get("lightlim") - 10 })
  t:advance(1000)
  t:expect(t:is_active("follower/looking"), "just below the threshold is not on the line yet")
end)

test("backs off, turns and searches after a bump", function(t)
  on_the_line(t)
  press(t, 1)
  t:expect_active("follower/bumpback")
  t:expect_output("robot.move", function(m) return m.linear.x < 0 end)
  release(t)
  t:advance(900)
  t:expect_active("follower/bumpturn")
  t:input("robot.light", { data = 200 })
  t:advance(3100)
  t:expect_active("follower/looking/lookalgo/lookleft")
end)

for _, steps in ipairs { 1, 20, 100 } do
  test(("counts a bump once, with the bumper down for %d steps"):format(steps), function(t)
    on_the_line(t)
    press(t, steps)
    release(t)
    t:advance(10000)
    t:expect(#entered(t, "follower/bumpback") == 1 and #entered(t, "follower/finished") == 0, "the press counts once")
    press(t, 1)
    t:expect_active("follower/finished")
  end)
end

test("ends at the second bump", function(t)
  on_the_line(t)
  press(t, 1)
  release(t)
  t:advance(4100)
  t:expect_active("follower/moving")
  press(t, 1)
  t:expect_active("follower/finished")
  t:expect(#t:outputs("robot.move") == 0, "it is told nothing more")
  t:advance(60000)
  t:expect(#entered(t, "follower/finished") == 1, "the end is reached once")
end)

test("turns about half way round", function(t)
  t:load("line_follower.lrp", { bridge = "sim" })
  local function heading()
    local inputs = t:records("input")
    for i = #inputs, 1, -1 do
      if inputs[i].name == "odom" then return math.deg(inputs[i].value.theta) end
    end
  end
  while not t:is_active("follower/bumpturn") do t:step() end
  local before = heading()
  while t:is_active("follower/bumpturn") do t:step() end
  local turned = (heading() - before) % 360
  t:expect(turned > 165 and turned < 195, ("it turned by %.0f degrees"):format(turned))
end)
