-- work_put Q {n task ...}: add tasks that the queue never had. The stream work:Q
-- has those that are not done, results:Q one value for each: '' or its result.
-- Both end a week after the last use.

local q, r = p..'work:'..ARGV[2], p..'results:'..ARGV[2]
redis.pcall('XGROUP', 'CREATE', q, 'g', '0', 'MKSTREAM')
for i = 3, #ARGV, 2 do
  if call('HSETNX', r, ARGV[i], '') == 1 then
    call('XADD', q, '*', 'n', ARGV[i], 'task', ARGV[i+1])
  end
end
call('EXPIRE', q, 604800)
call('EXPIRE', r, 604800)
return 1
