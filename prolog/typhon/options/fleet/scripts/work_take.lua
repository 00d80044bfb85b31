-- work_take Q worker ms: {entry, n, task}, of a worker that was silent for ms or
-- new; or {number of tasks that others have}.

local q = p..'work:'..ARGV[2]
if call('EXISTS', q) == 0 then return {0} end
local entry =
  call('XAUTOCLAIM', q, 'g', ARGV[3], ARGV[4], '0', 'COUNT', 1)[2][1]
if not entry then
  local new = call('XREADGROUP', 'GROUP', 'g', ARGV[3], 'COUNT', 1,
                   'STREAMS', q, '>')
  if not new then return {call('XLEN', q)} end
  entry = new[1][2][1]
end
return {entry[1], entry[2][2], entry[2][4]}
