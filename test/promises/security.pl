%   What doc/security.md promises, see ../promises.pl.

promise(first_matching_rule_applies, [access, arrivals],
        'prolog/typhon/options/access.pl',
        "    subsumes_term(Peer, Proof),\n    !,\n"-
        "    subsumes_term(Peer, Proof),\n").
promise(abort_cannot_be_caught, [guard, guard_escapes],
        'prolog/typhon/options/guard/guard_calls.pl',
        "ends_thread('$aborted').\n"-"").
