-- The EV3's line follower, with a brick that the test plays.

-- What the motors were told last, by the records: { function, first arguments } of each.
local function told(t)
  local motors = {}
  for _, record in ipairs(t:records("call")) do
    local motor, what = record.name:match("^motor(%u)%.(%w+)$")
    if motor then motors[motor] = what .. " " .. tostring(record.arguments[1]) end
    if record.name == "fullStop" then motors = {} end
  end
  return motors
end

local function sees(t, percent)
  t:input("robot.port3", { kind = "colour", mode = "reflected", value = percent, unit = "%" })
end

local function touches(t, pressed)
  t:input("robot.port1", { kind = "touch", mode = "pressed", pressed = pressed })
end

local function on_the_line(t)
  t:load("line_follower.lrp")
  sees(t, 10)
  touches(t, false)
  t:step(2)
  t:expect_active("follower/moving")
end

test("drives while it sees the line", function(t)
  on_the_line(t)
  t:expect(told(t).B == "start 40" and told(t).C == "start 40", "both wheels go forward")
end)

test("looks to the left first, and twice as long to the right", function(t)
  on_the_line(t)
  sees(t, 60)
  t:step()
  t:expect_active("follower/looking/sweep/lookleft")
  t:expect(told(t).B == "start -20" and told(t).C == "start 20", "it turns to the left")
  t:advance(300)
  t:expect_active("follower/looking/sweep/lookright")
  t:advance(500)
  t:expect_active("follower/looking/sweep/lookright")
  t:advance(100)
  t:expect_active("follower/looking/sweep/lookleft")
end)

test("motors are told once, on entry", function(t)
  on_the_line(t)
  local calls, errors = #t:records("call"), #t:records("error")
  t:advance(5000)
  t:expect(#t:records("call") == calls, "nothing is repeated")
  t:expect(#t:records("error") == errors, "a bumper that isn't pressed is false, not nil")
end)

test("the second bump is the end", function(t)
  on_the_line(t)
  touches(t, true)
  t:step()
  t:expect_active("follower/backing")
  t:expect(told(t).B == "moveWith C", "both wheels go back in step")
  touches(t, false)
  t:advance(3000)
  t:expect_active("follower/backing")
  t:reply("robot.motorB.moveWith")
  t:step()
  t:expect_active("follower/turning")
  t:reply("robot.motorB.moveWith")
  t:step()
  t:expect_active("follower/looking")
  touches(t, true)
  t:step(2)
  t:expect_active("follower/finished")
  t:expect(told(t).B == nil, "everything stands still")
end)

test("a pause stops the wheels, and going on turns them again", function(t)
  on_the_line(t)
  t:input("robot.portB", { speed = 40 })
  t:input("robot.portC", { speed = 40 })
  t:step()
  t:pause()
  t:step()
  t:expect(told(t).B == nil, "they are stopped")
  t:resume()
  t:step()
  t:expect(told(t).B == "start 40" and told(t).C == "start 40", "they go on")
end)
