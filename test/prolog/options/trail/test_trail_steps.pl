:- module(test_trail_steps, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../../../prolog/typhon/options/trail', []).
:- use_module('../../../../prolog/typhon/options/trail/trail', []).
:- use_module('../../../../prolog/typhon/options/trail/trail_verified', []).

:- needs([openssl]).

/** <module> Which steps of a trail account for one another

The steps are signed in this process, with the keys of alpha, beta, gamma and
the author alice in turn.  The agent was born elsewhere, in a process of alpha.

*Threading*: one test at a time.
*/

id('x.abc-alpha.0@alpha@127.0.0.1:9').

:- meta_predicate acting(+, 0).

acting(Name, Goal) :-
    authority_keys(Name, Keys),
    setup_call_cleanup(
        assertz(typhon_keys:own_keys(Keys)),
        once(Goal),
        retractall(typhon_keys:own_keys(_))).

%   after(+Step, +Agent0, -Agent): Step is Name-Event; Agent is
%   agent(Id, Hops, State). The event changed(Fact) changes the state unsigned.

after(_-changed(Fact), agent(Id, Hops, state(E, Cs)),
      agent(Id, Hops, state(E, [Fact|Cs]))) :-
    !.
after(_-id(Id), agent(_, Hops, State), agent(Id, Hops, State)) :-
    !.
after(_-hops(Hops), agent(Id, _, State), agent(Id, Hops, State)) :-
    !.
after(Name-entered(Result), agent(Id, Hops, state(E, Cs0)),
      agent(Id, Hops, state(E, [Raw|Cs]))) :-
    !,
    typhon_trail:split_trail(Cs0, Raw0, Cs),
    acting(Name, ( typhon_trail:own_keys(Keys),
                   typhon_trail:add_event(entered(Result), Keys, Id, Raw0,
                                          Raw) )).
after(Name-Event, agent(Id, Hops, State0), agent(Id, Hops, State)) :-
    acting(Name, typhon_trail:trail_link(Event, of(h, Id, hash, Hops), State0,
                                         [g(X,X)], State)).

%   trail(+Steps, -Raw, -Told, -Verdict): seen by alpha.

trail(Steps, Signed, Verdict) :-
    id(Id),
    foldl(after, Steps, agent(Id, 1, state([], [s(1)])),
          agent(Last, _, state(_, Cs))),
    typhon_trail:split_trail(Cs, Raw, _),
    verified(Last, Raw, Signed, Verdict).

verified(Id, Raw, Signed, Verdict) :-
    acting(alpha, typhon_trail_verified:trail_verified(Id, Raw, Trail)),
    verdict(Trail, Signed, Verdict).

%   From alpha to beta, where it enters a result, and to gamma; the last step is
%   signed with the next.

honest([ alpha-handed('b@beta:1'), beta-received('b@beta:2'), beta-entered(r),
         beta-handed('c@gamma:1'), gamma-received('c@gamma:1'),
         gamma-entered(s) ]).

signed([ alpha-handed, beta-received, beta-entered, beta-handed,
         gamma-received, gamma-entered ]).

first(N, Signed) :-
    signed(All),
    length(Signed, N),
    append(Signed, _, All).

%   forged(-Steps, -Count, -Verdict): Count steps are valid.

forged([ alpha-handed('b@beta:1'), beta-received('b@beta:1'),
         beta-entered(r), gamma-entered(s) ], 3, unaccounted(beta)).
forged([ alpha-handed('b@beta:1'), beta-received('b@beta:1'),
         beta-entered(r), gamma-handed('b@beta:1') ], 3, unaccounted(beta)).
forged([ alpha-handed('b@beta:1'), beta-received('b@beta:1'),
         beta-entered(r), gamma-received('c@gamma:1'), gamma-entered(s) ],
       3, unaccounted(beta)).
forged([ alpha-handed('b@beta:1'), beta-received('b@beta:1'), beta-entered(r),
         beta-received('b@beta:1'), beta-entered(s) ], 3, unaccounted(beta)).
forged([ alpha-handed('b@beta:1'), beta-entered(r) ], 1, unaccounted(alpha)).
forged([ alpha-handed('b@beta:1'), beta-handed('c@gamma:1') ], 1,
       unaccounted(alpha)).
forged([ alpha-handed('b@beta:1'), alpha-entered(r) ], 1, unaccounted(alpha)).
forged([ alpha-handed('b@beta:1'), beta-changed(s(2)),
         beta-received('b@beta:1'), beta-entered(r) ], 1, unaccounted(alpha)).
forged([ alpha-handed('b@beta:1'), beta-hops(2), beta-received('b@beta:1'),
         beta-entered(r) ], 1, unaccounted(alpha)).
forged([ alpha-handed('b@beta:1'), gamma-received('c@gamma:1'),
         gamma-entered(r) ], 1, unaccounted(alpha)).
forged([ alpha-handed('b@beta:1'), beta-received('b@beta:1'),
         alice-entered(r) ],
       1, unaccounted(alpha)).
forged([ alpha-handed('b@beta:1'), beta-id('y.abc-alpha.0@alpha@127.0.0.1:9') ],
       0, unaccounted(nobody)).
forged([ beta-received('b@beta:1'), beta-entered(r) ], 0, unaccounted(nobody)).

:- begin_tests(trail_steps,
               [ setup(authority_begin([alpha,beta,gamma], [alice])),
                 cleanup(authority_end) ]).

test(steps_that_follow_are_whole, Signed-Verdict == All-whole) :-
    honest(Steps),
    signed(All),
    trail(Steps, Signed, Verdict).
test(no_steps_are_whole, Signed-Verdict == []-whole) :-
    trail([], Signed, Verdict).
test(steps_that_do_not_follow_are_unaccounted,
     [ forall(forged(Steps, Count, Expected)),
       Signed-Verdict == First-Expected ]) :-
    (   Steps = [beta-_|_]
    ->  First = []
    ;   first(Count, First)
    ),
    trail(Steps, Signed, Verdict).
test(state_may_change_while_a_host_has_the_agent, Verdict == whole) :-
    trail([ alpha-handed('b@beta:1'), beta-received('b@beta:1'),
            beta-changed(s(2)), beta-entered(r), beta-changed(s(3)),
            beta-handed('c@gamma:1'), gamma-received('c@gamma:1'),
            gamma-entered(s) ], _, Verdict).
test(host_signs_nothing_for_the_host_before,
     Signed-Verdict == [alpha-handed]-unaccounted(alpha)) :-
    trail([ alpha-handed('b@beta:1'), beta-received('b@beta:1'),
            gamma-received('c@gamma:1'), gamma-entered(s) ], Signed, Verdict).
test(links_that_are_taken_away_at_the_end_are_missed,
     Verdicts == [unaccounted(gamma),unaccounted(nobody),
                  unaccounted(nobody)]) :-
    honest(Steps),
    raw(Steps, Id, '$trail'(at(N, M, K, Hex, H), Chain, Pems, P)),
    N1 is N+1,
    findall(V, ( member(Raw, [ '$trail'(at(N1, M, K, Hex, H), Chain, Pems, P),
                               '$trail'(at(N, M, K, Hex, H), "", Pems, P),
                               '$trail'(at(N, M, K, Hex, H), Chain, [], P) ]),
                 verified(Id, Raw, _, V) ), Verdicts).
test(links_of_another_trail_are_unaccounted,
     Signed-Verdict == [alpha-entered]-unaccounted(alpha)) :-
    raw([alpha-entered(r), alpha-entered(s)], Id,
        '$trail'(At, Chain, Pems, P)),
    raw([alpha-entered(other)], _, '$trail'(_, Other, _, _)),
    typhon_trail:chain_links(Chain, [_,Second]),
    typhon_trail:chain_add(Second, 2-Other, 9, _-Mixed),
    verified(Id, '$trail'(At, Mixed, Pems, P), Signed, Verdict).
test(trail_that_is_none_is_unaccounted,
     [ forall(member(Raw, [ _, x, '$trail'(x), '$trail'(at(0, 0, 0, none, none),
                            x, [], none), '$trail'(at(0, 0, 0, none, none), "",
                            [_], none), '$trail'(at(0, 0, 0, none, none), "",
                            [x|y], none) ])),
       Signed-Verdict == []-unaccounted(nobody) ]) :-
    id(Id),
    verified(Id, Raw, Signed, Verdict).
test(no_more_links_are_kept_than_the_setting_says,
     Kept-Verdicts ==
     [1,2,3,3,3,3]-[whole,whole,whole,since(2),since(3),since(4)]) :-
    with_settings([typhon_trail:links=3],
                  findall(K-V, ( between(1, 6, N), entries(N, Steps),
                                 raw(Steps, Id, Raw),
                                 Raw = '$trail'(at(_, _, K, _, _), Chain, _, _),
                                 typhon_trail:chain_links(Chain, Links),
                                 assertion(length(Links, K)),
                                 verified(Id, Raw, _, V) ), Pairs)),
    findall(K, member(K-_, Pairs), Kept),
    findall(V, member(_-V, Pairs), Verdicts).
test(certificates_go_with_the_last_link_of_their_signer, Counts == [1,2,2,1]) :-
    with_settings([typhon_trail:links=2],
                  findall(C, ( member(Steps,
                                 [ [alpha-handed('b@beta:1')],
                                   [alpha-handed('b@beta:1'),beta-entered(r)],
                                   [alpha-entered(r),alpha-entered(r),
                                    beta-entered(r)],
                                   [alpha-entered(r),beta-entered(r),
                                    beta-entered(r)] ]),
                               raw(Steps, _, '$trail'(_, _, Pems, _)),
                               length(Pems, C) ), Counts)).
test(received_state_is_signed_with_the_next_link, Links == [1,1,2]) :-
    findall(K, ( member(Steps, [ [alpha-handed('b@beta:1')],
                                 [alpha-handed('b@beta:1'),
                                  beta-received('b@beta:1')],
                                 [alpha-handed('b@beta:1'),
                                  beta-received('b@beta:1'),
                                  beta-entered(r)] ]),
                 raw(Steps, _, '$trail'(at(_, _, K, _, _), _, _, _)) ), Links).
test(clones_begin_a_trail_of_their_own, Clauses == [s(1)]) :-
    raw([alpha-handed('b@beta:1')], _, Raw),
    typhon_trail:without_trail(h, x, state([], [Raw,s(1)]), state([], Clauses)).
test(host_without_trails_adds_no_step_but_signs_what_it_received,
     Kept == [0,1]) :-
    with_hosts([h-[trail(false)]],
               findall(K, ( member(Steps, [ [alpha-handed('b@beta:1')],
                                            [alpha-entered(r),
                                             alpha-handed('b@beta:1')] ]),
                            raw(Steps, _, '$trail'(at(_, _, K, _, _), _, _, _))
                          ), Kept)).
test(process_without_keys_adds_no_step, State == state([], [s(1)])) :-
    id(Id),
    typhon_trail:trail_link(handed(x), of(h, Id, hash, 1), state([], [s(1)]),
                            [],
                            State).
test(process_without_keys_verifies_nothing,
     error(existence_error(keys, here))) :-
    id(Id),
    typhon_trail_verified:trail_verified(Id, x, _).
test(trail_that_cannot_be_continued_stays,
     [ forall(member(Made, [ at(x, 0, 0, none, none), at(0, x, 0, none, none),
                             at(0, 0, x, none, none), at(0, 0, 0, f(x), none),
                             at(0, 0, 0, none, f(x)), at(0, 0, 0, none), _ ])),
       Clauses =@= [Raw,s(1)] ]) :-
    Raw = '$trail'(Made, "", [], none),
    id(Id),
    acting(alpha, typhon_trail:trail_link(handed(x), of(h, Id, hash, 1),
                                          state([], [Raw,s(1)]), [],
                                          state([], Clauses))).

:- end_tests(trail_steps).

raw(Steps, Id, Raw) :-
    id(Id0),
    foldl(after, Steps, agent(Id0, 1, state([], [s(1)])),
          agent(Id, _, state(_, Cs))),
    typhon_trail:split_trail(Cs, Raw, _).

entries(N, Steps) :-
    findall(alpha-entered(I), between(1, N, I), Steps).
