-- work_done Q entry n result: the first result of a task counts.

local q, r = p..'work:'..ARGV[2], p..'results:'..ARGV[2]
if call('HGET', r, ARGV[4]) == '' then call('HSET', r, ARGV[4], ARGV[5]) end
redis.pcall('XACK', q, 'g', ARGV[3])
call('XDEL', q, ARGV[3])
call('EXPIRE', q, 604800)
call('EXPIRE', r, 604800)
return 1
