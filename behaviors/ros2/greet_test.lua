-- The greeter, with a navigation that the test plays.

local function asked_for(t, place)
  t:load("greet.lrp")
  t:step()
  t:expect_active("greeter/waiting")
  t:input("robot.place", { data = place })
  t:step(3)
end

-- The latest thing that it said.
local function said(t)
  local text
  for _, record in ipairs(t:records("output")) do
    if record.name == "say" then text = record.value.data end
  end
  return text
end

-- The latest goal that was sent.
local function goal(t)
  local calls = t:records("call")
  return calls[#calls]
end

test("drives to the place that it is told, greets, and comes home", function(t)
  asked_for(t, "kitchen")
  t:expect_active("greeter/driving")
  t:expect(goal(t).arguments[1].pose.pose.position.x == 2.0, "the kitchen is where it goes")
  t:feedback("robot.go", { distance_remaining = 1.5 })
  t:step(2)
  t:expect(t:get("left") == 1.5, "it knows how far that is")
  t:reply("robot.go", {})
  t:step(2)
  t:expect_active("greeter/greeting")
  t:expect(said(t) == "Hello!", "it greets")
  t:advance(3100)
  t:expect_active("greeter/returning")
  t:expect(goal(t).arguments[1].pose.pose.position.x == 0.0, "home is where it goes")
  t:reply("robot.go", {})
  t:step(2)
  t:expect_active("greeter/waiting")
end)

test("says so where it doesn't know the place", function(t)
  asked_for(t, "moon")
  t:step(2)
  t:expect_active("greeter/waiting")
  t:expect(said(t) == "I don't know a place called moon", "it says so")
end)

test("tries three times, then says that it can't, and comes home", function(t)
  asked_for(t, "office")
  for try = 1, 3 do
    t:expect_active("greeter/driving")
    t:fail("robot.go", "blocked")
    t:step(2)
    if try < 3 then t:advance(2100) end
  end
  t:expect_active("greeter/giving_up")
  t:expect(said(t) == "I can't get to the office", "it says so")
  t:advance(1100)
  t:expect_active("greeter/returning")
end)
