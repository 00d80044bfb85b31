-- take E token after hosts {host} {entry}
-- The process at E has let in what is in these entries. Then what waits for its
-- hosts, after the entry `after`: {last, {{entry, 'agent', id, to, why, text} or
-- {entry, 'mail', id, name, text} ...}}; `last` is the entry to go on after, or
-- ''. A letter waits until its agent was taken. {}: another process has E.

local e, token, hosts = ARGV[2], ARGV[3], {}
if call('HGET', p..'p:'..e, 'token') ~= token then return {} end
local first = 6 + tonumber(ARGV[5])
for i = 6, first - 1 do hosts[ARGV[i]] = true end

for i = first, #ARGV do
  local row = call('XRANGE', p..'park:'..e, ARGV[i], ARGV[i])[1]
  if row and row[2][1] == 'mail' then
    drop_entry(e, row[1], #row[2][6])
  elseif row then
    local id = row[2][4]
    local a = parked(id)
    if a and a.entry == row[1] then forget_agent(id, a) end
  end
end

local out, last, bytes = {}, '', 0
local rows = call('XRANGE', p..'park:'..e, '('..ARGV[4], '+', 'COUNT', 32)
for _, row in ipairs(rows) do
  local f = row[2]
  local id, text = f[4], f[6]
  local a = parked(id)
  last = row[1]
  if f[1] == 'mail' then
    if not (a and a.e == e and call('HEXISTS', p..'claimed', id) == 0) then
      out[#out+1] = {row[1], 'mail', id, f[2], text}
    end
  elseif hosts[f[2]] then
    text = call('HGET', p..'parcels', id) or ''
    call('HSET', p..'claimed', id, token)
    call('ZREM', p..'due', id)
    out[#out+1] = {row[1], 'agent', id, f[2], f[6], text}
  end
  bytes = bytes + #text
  if bytes > 1000000 then break end
end
return {last, out}
