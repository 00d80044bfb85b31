-- mail E id name most most_bytes text
-- The process at E has a letter for the agent, which it cannot send on: keep it
-- where the agent is parked, or was last. With text = '' this is a question. It
-- answers 'ok', also if the letter has come before; 'none': the agent is not
-- known, or has ended, or should be at E; or 'full'.

local own, id, letter, text = ARGV[2], ARGV[3], p..'letter:'..ARGV[4], ARGV[7]
local a, home = parked(id), endpoint(id)

if call('EXISTS', letter) == 1 then return 'ok' end
local e = a and a.e
if not e then
  local at = call('HGET', p..'agents:'..home, id)
  if at then e = endpoint(at) end
  if e == own or call('HEXISTS', p..'ends:'..home, id) == 1 then e = nil end
end
if not e then return 'none' end
if is_full(e, ARGV[5], ARGV[6], #text) then return 'full' end
if text ~= '' then
  call('SET', letter, 1, 'EX', 3600)
  put_letter(e, ARGV[4], id, text)
end
return 'ok'
