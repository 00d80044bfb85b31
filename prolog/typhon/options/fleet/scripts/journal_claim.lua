-- journal_claim name owner ttl
-- Own a journal that the engine has lost, or of which it has lost the last
-- commits: 'ok'. 'fenced': a later process has it. 'wait': the engine is empty,
-- and a later process may still claim it, within its lease.

local name, owner, ttl = ARGV[2], ARGV[3], ARGV[4]

local function key(what) return p..'j:'..name..':'..what end

local lost = not_owner(key('owner'), owner)
if lost == 'fenced' then return lost end
if lost then
  if not call('GET', key('owner')) then
    call('SET', key('grace'), 1, 'PX', ttl)
  end
  call('SET', key('owner'), owner)
end
call('SET', key('lease'), owner, 'PX', ttl)
if call('EXISTS', key('grace')) == 1 then return 'wait' end
return 'ok'
