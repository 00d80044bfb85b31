-- hosts [tag ...]: {{address, load, 'up' or 'away'} ...} of the hosts that have
-- all these tags; {'unknown', tag, known} if no host ever had one of them, with
-- the list of all tags.

local now, out = clock(), {}
for i = 2, #ARGV do
  if call('SISMEMBER', p..'tags', ARGV[i]) == 0 then
    return {'unknown', ARGV[i], call('SMEMBERS', p..'tags')}
  end
end
local rows = call('ZRANGE', p..'tag:'..(ARGV[2] or ''), 0, -1, 'WITHSCORES')
for i = 1, #rows, 2 do
  local h, has = rows[i], true
  for k = 3, #ARGV do
    has = has and call('ZSCORE', p..'tag:'..ARGV[k], h)
  end
  if has then
    out[#out+1] = {h, rows[i+1], lives(endpoint(h), now) and 'up' or 'away'}
  end
end
return out
