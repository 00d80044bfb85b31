-- known kind id: what is stored of the agent: 'hops address' for the kind
-- `agents`, its outcome for `ends`.

return call('HGET', p..ARGV[2]..':'..endpoint(ARGV[3]), ARGV[3])
