-- A file that tests nothing.

local x = 1
