-- beat E token ttl first at pid journal journal_token recover
--      {address load count tag ...}
-- Renew the lease of the process at E, and set its hosts. With first = 1 it is
-- a process that has just begun: it gets E even if another one has it.
-- Answers: {'fenced'} another process has E, {'usurped'} or its journal;
-- {'ok' or 'new', parked, {{endpoint, journal} ...}}: `new` if E was not
-- known, the number of what is parked for E, and journals to be opened.

local e, token, ttl = ARGV[2], ARGV[3], tonumber(ARGV[4])
local at, pid, journal = ARGV[6], ARGV[7], ARGV[8]
local now, process, status = clock(), p..'p:'..e, 'ok'

local function key(what) return p..'j:'..journal..':'..what end

local was = call('HMGET', process, 'token', 'at', 'journal')
if was[1] and was[1] ~= token and ARGV[5] ~= '1' then return {'fenced'} end
if journal ~= '' then
  local lost = not_owner(key('owner'), ARGV[9])
  if lost == 'fenced' then return {'usurped'} end
  if not lost then call('SET', key('lease'), ARGV[9], 'PX', ttl) end
end
if was[1] ~= token then
  status = 'new'
  call('HSET', process, 'token', token, 'epoch', call('INCR', p..'epoch'),
       'pid', pid, 'ttl', ttl)
end
if status == 'new' or was[2] ~= at or was[3] ~= journal then
  call('HSET', process, 'at', at, 'journal', journal)
  if at == e then call('HDEL', p..'at', e) else call('HSET', p..'at', e, at) end
end
local back = call('ZADD', p..'lease', now + ttl, e) == 1
if back or status == 'new' then call('HSET', process, 'since', now) end
if back then
  call('ZREM', p..'orphans', e)
  call('ZREM', p..'gone', e)
end

-- its hosts: most beats bring nothing new, and then write nothing here

local had = {}
for _, h in ipairs(hosts_of(e)) do had[h] = true end
local i = 11
while i <= #ARGV do
  local h, load, n = ARGV[i], ARGV[i+1], tonumber(ARGV[i+2])
  local tags = table.concat(ARGV, '\n', i + 3, i + 2 + n)
  local known = call('HGET', p..'hosts', h)
  if not had[h] then
    call('SADD', p..'on:'..e, h)
    event('joined', h)
  elseif back then
    event('back', h)
  end
  had[h] = nil
  if known ~= tags then
    each_tag(known, function (tag) call('ZREM', p..'tag:'..tag, h) end)
    call('HSET', p..'hosts', h, tags)
    if n > 0 then call('SADD', p..'tags', unpack(ARGV, i + 3, i + 2 + n)) end
  end
  if call('ZSCORE', p..'tag:', h) ~= load then
    each_tag(tags, function (tag) call('ZADD', p..'tag:'..tag, load, h) end)
  end
  i = i + 3 + n
end
for h in pairs(had) do
  forget_host(e, h)
  event('left', h)
end

-- others, twenty times in a lease: with a thousand processes each of its beats
-- need not look. If nobody came for a whole lease it was the engine that was out.

local times = call('MGET', p..'last', p..'grace')
local last, grace = tonumber(times[1] or '0'), tonumber(times[2] or '0')
local looks = now > last + ttl / 20 or now < last
if looks then call('SET', p..'last', now) end
if now > last + ttl then
  grace = now + ttl
  call('SET', p..'grace', grace)
end

local function goes_away(d)
  call('ZREM', p..'lease', d)
  call('ZADD', p..'gone', now, d)
  for _, h in ipairs(hosts_of(d)) do event('away', h) end
  local of = call('HMGET', p..'p:'..d, 'journal', 'ttl')
  if of[1] and of[1] ~= '' then call('ZADD', p..'orphans', now + of[2], d) end
end

local function before(set, time, most)
  return call('ZRANGEBYSCORE', p..set, '-inf', time, 'LIMIT', 0, most)
end

if looks and now > grace then
  for _, d in ipairs(before('lease', now, 20)) do goes_away(d) end
end

-- agents that have waited long enough

for _, id in ipairs(looks and before('due', now, 20) or {}) do
  local a = parked(id)
  if a then send_back(id, a, 'expired') else call('ZREM', p..'due', id) end
end

-- what was away for a week, and has nothing parked and no journal, is forgotten

for _, d in ipairs(looks and before('gone', now - 604800000, 4) or {}) do
  local of = call('HGET', p..'p:'..d, 'journal')
  if (not of or of == '') and call('EXISTS', p..'park:'..d) == 0 then
    for _, h in ipairs(hosts_of(d)) do
      forget_host(d, h)
      event('left', h)
    end
    for _, name in ipairs({'p:', 'agents:', 'ends:', 'order:'}) do
      call('DEL', p..name..d)
    end
    call('ZREM', p..'gone', d)
    call('HDEL', p..'at', d)
  else
    call('ZADD', p..'gone', now, d)
  end
end

local orphans = {}
if ARGV[10] == '1' then
  for _, d in ipairs(before('orphans', now, 4)) do
    call('ZADD', p..'orphans', now + 10000, d)
    orphans[#orphans+1] = {d, call('HGET', p..'p:'..d, 'journal')}
  end
end
return {status, call('XLEN', p..'park:'..e), orphans}
