-- work_keep Q worker entry: the worker still has it, unless another one took it.

local q = p..'work:'..ARGV[2]
local has = redis.pcall('XPENDING', q, 'g', ARGV[4], ARGV[4], 1, ARGV[3])
if has.err or #has == 0 then return 0 end
call('XCLAIM', q, 'g', ARGV[3], 0, ARGV[4], 'JUSTID')
return 1
