-- parked: {{id, address, since, until} ...}, in milliseconds, or 'inf'.

local out = {}
for _, id in ipairs(call('HKEYS', p..'parked')) do
  local a = parked(id)
  out[#out+1] = {id, a.to, a.since, a.till}
end
return out
