-- journal_part name owner ttl first {field value}
-- Keep items for the commit that follows; with first = 1 no others.

local name, owner = ARGV[2], ARGV[3]

local function key(what) return p..'j:'..name..':'..what end

local lost = not_owner(key('owner'), owner)
if lost then return lost end
call('SET', key('lease'), owner, 'PX', ARGV[4])
if ARGV[5] == '1' then call('UNLINK', key('parts')) end
for i = 6, #ARGV, 2 do call('HSET', key('parts'), ARGV[i], ARGV[i+1]) end
return 'ok'
