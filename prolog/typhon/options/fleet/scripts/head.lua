-- Before each script. ARGV[1] is the prefix of all keys of the fleet.
-- Time is that of the engine, in milliseconds: hosts need no common clock.
--
--   lease     zset    endpoint -> when its lease lapses
--   p:E       hash    token, epoch, at, pid, journal, ttl, since: the process at E
--   on:E      set     addresses of the hosts of E
--   hosts     hash    address -> tags, separated by newlines
--   tag:T     zset    address -> load; tag: has all hosts
--   tags      set
--   at        hash    endpoint -> where the process that stands in listens
--   orphans   zset    endpoint -> when its journal may be opened elsewhere
--   gone      zset    endpoint -> since when its process is away or has left
--   agents:E  hash    id -> 'hops address', of agents born at E
--   ends:E    hash    id -> outcome; order:E list of these ids, oldest first
--   events    stream  what, address; the last 10,000
--   park:E    stream  agents and letters that wait for the process at E:
--                     agent address id I why W, or mail name id I text T
--   parked    hash    id -> hops, E, entry in its stream, when it goes back,
--                     the address that it left, where it is to go, since when
--   parcels   hash    id -> text of a parked agent
--   due       zset    id -> when it goes back
--   claimed   hash    id -> token of a process that may have let it in
--   bytes     hash    E -> bytes of what is parked for E
--   had:I, not:T, letter:L: for an hour, the hops of an agent that was parked
--                     and taken, an attempt that was refused, a parked letter
--   epoch, last, grace: counter of starts; last beat; nobody lapses until then

local p = ARGV[1]
local call = redis.call

local function clock()
  local t = call('TIME')
  return t[1] * 1000 + math.floor(t[2] / 1000)
end

local function event(what, host)
  call('XADD', p..'events', 'MAXLEN', '~', 10000, '*', what, host)
end

local function hosts_of(e)
  return call('SMEMBERS', p..'on:'..e)
end

-- A process is up until a beat of another one finds its lease lapsed, which is an
-- event; where no process beats any more, for one more lease.

local function lives(e, now)
  local lapses = call('ZSCORE', p..'lease', e)
  return lapses and now < lapses + (call('HGET', p..'p:'..e, 'ttl') or 0)
end

local function each_tag(tags, f)
  f('')
  for tag in string.gmatch(tags or '', '[^\n]+') do f(tag) end
end

local function forget_host(e, host)
  each_tag(call('HGET', p..'hosts', host),
           function (tag) call('ZREM', p..'tag:'..tag, host) end)
  call('HDEL', p..'hosts', host)
  call('SREM', p..'on:'..e, host)
end

-- an id ends with the endpoint of its home, an address with that of its process
local function endpoint(name)
  return string.match(name, '[^@]*$')
end


-- The owner of a journal is 'EPOCH token', or 'EPOCH ' when it is closed. An
-- engine that has lost its last second, or all, may know an earlier one, or none.

local function epoch_of(owner)
  return tonumber(string.match(owner or '0', '^%d+'))
end

local function not_owner(key, owner)
  local is = call('GET', key)
  if is == owner then return nil end
  return epoch_of(is or nil) < epoch_of(owner) and 'lost' or 'fenced'
end

-- agents and letters that are parked

local function parked(id)
  local value = call('HGET', p..'parked', id)
  if not value then return nil end
  local hops, e, entry, till, from, to, since = string.match(value,
    '^(.-)\n(.-)\n(.-)\n(.-)\n(.-)\n(.-)\n(.*)$')
  return {hops = tonumber(hops), e = e, entry = entry, till = till,
          from = from, to = to, since = since}
end

local function is_full(e, most, most_bytes, more)
  return call('XLEN', p..'park:'..e) >= tonumber(most)
    or tonumber(call('HGET', p..'bytes', e) or '0') + more > tonumber(most_bytes)
end

local function put_agent(id, a, why)
  a.entry = call('XADD', p..'park:'..a.e, '*', 'agent', a.to, 'id', id,
                 'why', why)
  call('HSET', p..'parked', id, table.concat(
    {a.hops, a.e, a.entry, a.till, a.from, a.to, a.since}, '\n'))
  call('HINCRBY', p..'bytes', a.e, call('HSTRLEN', p..'parcels', id))
end

local function drop_entry(e, entry, bytes)
  if call('XDEL', p..'park:'..e, entry) == 1
     and call('HINCRBY', p..'bytes', e, 0 - bytes) <= 0
     and call('XLEN', p..'park:'..e) == 0 then
    call('HDEL', p..'bytes', e)
    call('DEL', p..'park:'..e)
  end
end

local function drop_agent(id, a)
  drop_entry(a.e, a.entry, call('HSTRLEN', p..'parcels', id))
  call('HDEL', p..'claimed', id)
  call('ZREM', p..'due', id)
end

-- it was taken, and is not parked any more

local function forget_agent(id, a)
  drop_agent(id, a)
  call('HDEL', p..'parked', id)
  call('HDEL', p..'parcels', id)
  call('SET', p..'had:'..id, a.hops, 'EX', 3600)
end

local function put_letter(e, name, id, text)
  call('XADD', p..'park:'..e, '*', 'mail', name, 'id', id, 'text', text)
  call('HINCRBY', p..'bytes', e, #text)
end

-- its letters go with it, and later ones; its return is a hop

local function send_back(id, a, why)
  local old = a.e
  drop_agent(id, a)
  a.e, a.to, a.till = endpoint(a.from), a.from, 'inf'
  put_agent(id, a, why)
  call('HSET', p..'agents:'..endpoint(id), id,
       string.format('%.0f', a.hops + 1)..' '..a.to)
  if old == a.e then return end
  for _, row in ipairs(call('XRANGE', p..'park:'..old, '-', '+')) do
    local f = row[2]
    if f[1] == 'mail' and f[4] == id then
      put_letter(a.e, f[2], id, f[6])
      drop_entry(old, row[1], #f[6])
    end
  end
end
