-- leave E token: the process at E gives its lease back, and its hosts leave.

local e = ARGV[2]
if call('HGET', p..'p:'..e, 'token') ~= ARGV[3] then return 0 end
for _, h in ipairs(hosts_of(e)) do
  forget_host(e, h)
  event('left', h)
end
call('ZREM', p..'lease', e)
call('ZREM', p..'orphans', e)
call('HDEL', p..'at', e)
call('HDEL', p..'p:'..e, 'at')
call('ZADD', p..'gone', clock(), e)
return 1
