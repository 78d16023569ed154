-- A mistake outside any test.

local function helper()
  tset("misspelt", function() end)
end

helper()
