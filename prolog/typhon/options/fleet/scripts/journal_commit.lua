-- journal_commit name owner last number ttl how puts {field value} {field}
-- Set and delete items, in one step; `last` is the number of the last commit
-- that was answered. With `how` = 'parts' the items of journal_part are set
-- before; with 'all' they are all items. Answers 'ok'; 'fenced'; or 'lost': the
-- engine does not know this process, or its last commit.

local name, owner = ARGV[2], ARGV[3]
local last, number, how = tonumber(ARGV[4]), tonumber(ARGV[5]), ARGV[7]
local items = p..'i:'..name

local function key(what) return p..'j:'..name..':'..what end

local lost = not_owner(key('owner'), owner)
if lost then return lost end
local stored = tonumber(call('GET', key('number')) or '0')
if stored >= number then return 'ok' end   -- it was asked before
if stored < last and how ~= 'all' then return 'lost' end
call('SET', key('number'), number)
call('SET', key('lease'), owner, 'PX', ARGV[6])
if how == 'all' then
  call('UNLINK', items)
  call('RENAME', key('parts'), items)
elseif how == 'parts' then
  local all = call('HGETALL', key('parts'))
  for i = 1, #all, 2 do call('HSET', items, all[i], all[i+1]) end
  call('UNLINK', key('parts'))
end
local drops = 9 + 2 * tonumber(ARGV[8])
for i = 9, drops - 1, 2 do call('HSET', items, ARGV[i], ARGV[i+1]) end
for i = drops, #ARGV do call('HDEL', items, ARGV[i]) end
return 'ok'
