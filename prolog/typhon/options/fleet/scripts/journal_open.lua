-- journal_open name token ttl about
-- Open the journal, or make it: {'ok', owner, number, taken}. The owner is
-- 'EPOCH token', `number` that of the last commit, `taken` 1 if another process
-- had not closed it, which takes its token away. {'busy'}: the lease of another process holds. {'other',
-- about}: its format is another. {'lost'}: an engine that came back empty was
-- not filled to the end.

local name, token, about = ARGV[2], ARGV[3], ARGV[5]
local items = p..'i:'..name

local function key(what) return p..'j:'..name..':'..what end

local owner = call('GET', key('owner'))
local had = owner and string.match(owner, ' (.*)') or ''
if had ~= '' and had ~= token and call('EXISTS', key('lease')) == 1 then
  return {'busy'}
end
local is = call('HGET', items, 'about')
if not is then
  if owner then return {'lost'} end
  call('HSET', items, 'about', about)
elseif is ~= about then
  return {'other', is}
end
if had ~= token then
  owner = (epoch_of(owner) + 1)..' '..token
  call('SET', key('owner'), owner)
end
call('SET', key('lease'), owner, 'PX', ARGV[4])
local taken = had ~= '' and had ~= token
return {'ok', owner, call('GET', key('number')) or '0', taken and 1 or 0}
