-- overview [address ...]: {{address, load, 'up' or 'away', since, parked, tag ...}
-- ...} of these hosts, or of all. `since` is a time in milliseconds or '',
-- `parked` the number of agents and messages that wait for its process.

local now, out = clock(), {}
local hosts = {unpack(ARGV, 2)}
if #ARGV == 1 then hosts = call('ZRANGE', p..'tag:', 0, -1) end
for _, h in ipairs(hosts) do
  local e, load = endpoint(h), call('ZSCORE', p..'tag:', h)
  if load then
    local up = lives(e, now)
    local since = up and call('HGET', p..'p:'..e, 'since')
                  or not up and (call('ZSCORE', p..'gone', e) or
                                 call('ZSCORE', p..'lease', e))
    local row = {h, load, up and 'up' or 'away', since or '',
                 call('XLEN', p..'park:'..e)}
    each_tag(call('HGET', p..'hosts', h), function (tag)
      if tag ~= '' then row[#row+1] = tag end
    end)
    out[#out+1] = row
  end
end
return out
