-- unpark what id token [why]
-- What `claim`: this process, with that token, may send the agent to its host:
-- {to, text}. Then `release`: it has not; `done`: the agent is there; or `back`:
-- it returns to the host that it left, with the text of an error. {}: it is not
-- parked, or another process has claimed it.

local what, id, token = ARGV[2], ARGV[3], ARGV[4]
local a, claimed = parked(id), call('HGET', p..'claimed', id)
if not a or (claimed and claimed ~= token) then return {} end
if what == 'claim' then
  call('HSET', p..'claimed', id, token)
  call('ZREM', p..'due', id)
elseif what == 'release' then
  call('HDEL', p..'claimed', id)
  if a.till ~= 'inf' then call('ZADD', p..'due', a.till, id) end
elseif what == 'done' then
  forget_agent(id, a)
elseif a.to == a.from then
  call('HDEL', p..'claimed', id)
else
  send_back(id, a, ARGV[5])
end
return {a.to, call('HGET', p..'parcels', id) or ''}
