-- ends most {id outcome}: the agents have ended; each home has at most `most`.

for i = 3, #ARGV, 2 do
  local id, e = ARGV[i], endpoint(ARGV[i])
  call('HDEL', p..'agents:'..e, id)
  if call('HSETNX', p..'ends:'..e, id, ARGV[i+1]) == 1
     and call('RPUSH', p..'order:'..e, id) > tonumber(ARGV[2]) then
    call('HDEL', p..'ends:'..e, call('LPOP', p..'order:'..e))
  end
end
return 1
