-- journal_renew name owner ttl: renew the lease of the owner; with ttl = 0 it
-- closes the journal.

local function key(what) return p..'j:'..ARGV[2]..':'..what end

if not_owner(key('owner'), ARGV[3]) then return 0 end
if ARGV[4] == '0' then
  call('SET', key('owner'), epoch_of(ARGV[3])..' ')
  return call('DEL', key('lease'), key('parts'))
end
call('SET', key('lease'), ARGV[3], 'PX', ARGV[4])
return 1
