-- park E to id hops ttl from ticket known most most_bytes text
-- Keep the agent for the process at E: 'ok', also if that has taken it. Or
-- 'stranger': with known = 0, E is in no fleet; 'late'; 'full'. Then the same
-- ticket is never accepted, because this may be executed long after it was sent.

local e, to, id, hops = ARGV[2], ARGV[3], ARGV[4], tonumber(ARGV[5])
local ttl, from, ticket, text = ARGV[6], ARGV[7], p..'not:'..ARGV[8], ARGV[12]
local now, a = clock(), parked(id)

if tonumber(call('GET', p..'had:'..id) or '-1') >= hops then return 'ok' end
if a and a.hops >= hops then return 'ok' end

local function refused(why)
  call('SET', ticket, 1, 'EX', 3600)
  return why
end

if call('EXISTS', ticket) == 1 then return 'late' end
if ARGV[9] == '0' and call('EXISTS', p..'p:'..e) == 0 then
  return refused('stranger')
end
if ttl ~= 'inf' and tonumber(ttl) <= 0 then return refused('late') end
if is_full(e, ARGV[10], ARGV[11], #text) then return refused('full') end
if a then forget_agent(id, a) end
local till = ttl == 'inf' and ttl or string.format('%.0f', now + ttl)
call('HSET', p..'parcels', id, text)
put_agent(id, {hops = hops, e = e, till = till, from = from, to = to,
               since = string.format('%.0f', now)}, '')
if ttl ~= 'inf' then call('ZADD', p..'due', till, id) end
call('HSET', p..'agents:'..endpoint(id), id, ARGV[5]..' '..to)
return 'ok'
