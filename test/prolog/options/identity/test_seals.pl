:- module(test_seals, []).

% Data that agents seal for one host.

:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(typhon)).

:- needs([openssl]).

:- meta_predicate with_home(0, +).

with_home(Goal, Authority) :-
    keys_of(alpha, Authority, Alpha),
    keys_of(beta, Authority, Beta),
    with_peers([beta-[host([tls(Beta)])]],
               setup_call_cleanup(
                   host_start(alpha, [tls(Alpha)]),
                   once(Goal),
                   host_stop(alpha))).

%   The agent finds data on beta, and seals them there for its home.

collector(clauses([ (:- agent(collector, [state([to/1])])),
                    (main :- to(Beta), home(Home), move(Beta),
                             seal(found(Beta, "ä", X-X, 1.5), Home, Sealed),
                             tried_there(Sealed, There),
                             move(Home),
                             unseal(Sealed, Found),
                             changed(Sealed, Other),
                             tried_there(Other, Here),
                             result(got(Found, There, Here))),
                    (tried_there(Sealed, What) :-
                         catch(( unseal(Sealed, T), What = read(T) ),
                               error(permission_error(unseal, term, _), _),
                               What = refused)),
                    (changed(sealed(K, N, T, Text0), sealed(K, N, T, Text)) :-
                         string_codes(Text0, [C0|Cs]),
                         ( C0 =:= 0'0 -> C = 0'1 ; C = 0'0 ),
                         string_codes(Text, [C|Cs])) ])).

:- begin_tests(seals).

test(sealed_state_is_read_at_home_and_only_if_unchanged) :-
    with_authority([alpha, beta], [], with_home(home_reads)).

home_reads :-
    collector(Program),
    peer_host(beta, Beta),
    agent_create(Program, Agent, [facts([to(Beta)])]),
    agent_result(Agent, Result, 30),
    Result = got(Found, There, Here),
    assertion(Found =@= found(Beta, "ä", X-X, 1.5)),
    assertion(There == refused),
    assertion(Here == refused).

test(seals_need_keys) :-
    setup_call_cleanup(
        host_start(alpha),
        ( agent_create(clauses([ (:- agent(s, [])),
                                 (main :- here(H),
                                          catch(seal(x, H, _),
                                                error(E, _), result(E))) ]),
                       Agent),
          agent_result(Agent, Result, 10) ),
        host_stop(alpha)),
    assertion(Result == existence_error(keys, here)).

:- end_tests(seals).
