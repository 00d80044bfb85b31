-- where {id hops address}: the agents are there, unless later hops are known.

for i = 2, #ARGV, 3 do
  local id, hops, key = ARGV[i], tonumber(ARGV[i+1]), p..'agents:'..endpoint(ARGV[i])
  local known = call('HGET', key, id)
  if not known or tonumber(string.match(known, '^%d+')) <= hops then
    call('HSET', key, id, ARGV[i+1]..' '..ARGV[i+2])
  end
end
return 1
