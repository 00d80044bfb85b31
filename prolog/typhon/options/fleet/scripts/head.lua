-- Before each script. ARGV[1] is the prefix of all keys of the fleet.
-- Time is that of the engine, in milliseconds: hosts need no common clock.
--
--   lease     zset    endpoint -> when its lease lapses
--   p:E       hash    token, epoch, at, pid, journal, ttl: the process at E
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

local function each_tag(host, f)
  f('')
  local tags = call('HGET', p..'hosts', host) or ''
  for tag in string.gmatch(tags, '[^\n]+') do f(tag) end
end

local function forget_host(e, host)
  each_tag(host, function (tag) call('ZREM', p..'tag:'..tag, host) end)
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
