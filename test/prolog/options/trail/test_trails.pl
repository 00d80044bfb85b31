:- module(test_trails, []).

% The trail of an agent, and hosts that tamper with it.

:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/peers').
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [append/3, member/2, reverse/2]).
:- use_module(library(plunit)).
:- use_module(library(random),
              [maybe/1, random_between/3, random_member/2]).
:- use_module(library(settings), [set_setting/2]).
:- use_module(library(typhon)).

:- needs([openssl]).

:- meta_predicate with_three(+, 0).

%   alpha is here, beta and gamma are processes; Setup is done in beta before
%   the agent comes.

with_three(Setup, Goal) :-
    with_authority([alpha, beta, gamma], [], with_three(Setup, Goal)).

:- meta_predicate with_three(+, 0, +).

with_three(Setup, Goal, Authority) :-
    keys_of(alpha, Authority, Alpha),
    keys_of(beta, Authority, Beta),
    keys_of(gamma, Authority, Gamma),
    with_peers([beta-[host([tls(Beta)])], gamma-[host([tls(Gamma)])]],
               ( peer_do(beta, Setup),
                 setup_call_cleanup(
                     host_start(alpha, [tls(Alpha)]),
                     once(Goal),
                     host_stop(alpha)) )).

%   The agent moves to beta, gamma and home, enters a result at each, and
%   stays.

tourist(clauses([ (:- agent(tourist, [state([to/1, seen/1])])),
                  (main :- forall(to(H), true), tour),
                  (tour :- retract(to(Host)), !, move(Host), here(H),
                           assertz(seen(H)), enter(was(H)), tour),
                  (tour :- home(Home), move(Home)),
                  (on_message(_, _) :- true) ])).

toured(Agent, Trail) :-
    tourist(Program),
    peer_host(beta, Beta),
    peer_host(gamma, Gamma),
    agent_create(Program, Agent, [facts([to(Beta), to(Gamma)])]),
    wait_until(agent_property(Agent, state(resident)), 20),
    agent_trail(Agent, Trail).

:- begin_tests(trails).

test(trail_lists_hosts_in_order) :-
    with_three(true, test_trails:honest).
test(removed_result_is_detected) :-
    with_three(true, test_trails:taken_away).
test(agent_with_a_broken_trail_is_admitted) :-
    with_three(true, test_trails:made_of_it).

test(long_trail_keeps_its_end,
     [ cleanup(set_setting(typhon_trail:links, 32)) ]) :-
    set_setting(typhon_trail:links, 4),
    with_three(set_setting(typhon_trail:links, 4), test_trails:long_way).

:- end_tests(trails).

%   gamma keeps more links than the others, which keep the newest four.

long_way :-
    toured(_, Trail),
    verdict(Trail, Signed, Verdict),
    assertion(Verdict = since(_)),
    assertion(append(_, [gamma-handed, alpha-received], Signed)).

honest :-
    toured(_, Trail),
    verdict(Trail, Signed, Verdict),
    assertion(Verdict == whole),
    assertion(Signed == [ alpha-handed, beta-received, beta-entered,
                          beta-handed, gamma-received, gamma-entered,
                          gamma-handed, alpha-received ]),
    Trail = trail(Steps, _),
    findall(R, member(step(_, _, entered(R)), Steps), Results),
    peer_host(beta, Beta),
    peer_host(gamma, Gamma),
    assertion(Results == [was(Beta), was(Gamma)]).

%   Changes that a host could make to an agent: gamma changes the result that
%   was entered on beta, removes it, lies about the state it has received, and
%   passes the agent on under its own trail.

taken_away :-
    toured(Agent, trail(_, whole)),
    typhon_agents:agent(Agent, _, Module, _, _),
    Module:'$trail'(Next, Chain, Pems, Pending),
    typhon_trail:chain_links(Chain, Oldest),
    reverse(Oldest, Links),
    findall(Forged-Expected, forged(Links, Forged, Expected), Cases),
    assertion(length(Cases, 7)),
    forall(member(Forged-Expected, Cases),
           ( reverse(Forged, OldestForged),
             foldl(chained, OldestForged, "", ForgedChain),
             typhon_trail_verified:trail_verified(Agent,
                 '$trail'(Next, ForgedChain, Pems, Pending),
                 trail(_, Verdict)),
             assertion(Verdict == Expected) )).

%   A trail that cannot be continued is detected, and hosts accept any such
%   trail; what the agent reports has happened.

made_of_it :-
    toured(Agent, trail(Steps, whole)),
    typhon_agents:agent(Agent, _, Module, _, _),
    Raw = '$trail'(At, Chain, Pems, Pending),
    call(Module:Raw),
    assertion(verdict_of(Agent, Raw, Steps, whole)),
    string_concat(Chain, "0000000xyz", Longer),
    forall(( member(Made, [ foo, _, at(7, 5, 5, none, none),
                            at(_, 5, 5, "", none), at(a, 5, 5, "", none),
                            at(0, 0, 0, none), at(7, 5, 99, "", none) ]),
             Broken = '$trail'(Made, Chain, Pems, Pending)
           ; Broken = '$trail'(At, Longer, Pems, Pending)
           ),
           assertion(verdict_of(Agent, Broken, _, unaccounted(gamma)))),
    Seed is random(1<<32),
    set_random(seed(Seed)),
    forall(between(1, 120, N),
           ( mutated(Raw, Mutant),
             assertion(goes_on(Agent, Mutant, Steps, Seed-N)) )).

goes_on(Agent, Mutant, Steps, _) :-
    verdict_of(Agent, Mutant, Told, Verdict),
    is_verdict(Verdict),
    forall(( member(Step, Told), \+ arg(2, Step, alpha) ),
           memberchk(Step, Steps)),
    forall(member(Event, [ handed('beta@127.0.0.1:1'),
                           received('alpha@127.0.0.1:1') ]),
           typhon_trail:trail_link(Event, of(alpha, Agent, hash, 3),
                                   state([], [s(1), Mutant]), [],
                                   state([], [_, _]))),
    typhon_trail:trail_enter(made, Agent, x).

verdict_of(Agent, Raw0, Steps, Verdict) :-
    dynamic(made:'$trail'/4),
    retractall(made:'$trail'(_, _, _, _)),
    assertz(made:Raw0),
    typhon_trail:trail_of(made, Agent, Raw),
    typhon_trail_verified:trail_verified(Agent, Raw, trail(Steps, Verdict)).

is_verdict(Verdict) :-
    ground(Verdict),
    memberchk(Verdict, [whole, since(_), unaccounted(_)]).

%   mutated(+Raw, -Mutant): one subterm is replaced.

mutated(Raw, Mutant) :-
    duplicate_term(Raw, Mutant),
    random_between(1, 4, I),
    arg(I, Raw, Arg0),
    another(Arg0, Arg),
    setarg(I, Mutant, Arg).

another(Term0, Term) :-
    compound(Term0),
    maybe(0.7),
    !,
    duplicate_term(Term0, Term),
    functor(Term0, _, Arity),
    random_between(1, Arity, I),
    arg(I, Term0, Arg0),
    another(Arg0, Arg),
    setarg(I, Term, Arg).
another(Text0, Text) :-
    string(Text0),
    maybe(0.7),
    !,
    string_length(Text0, Length),
    random_between(0, Length, Start),
    Most is min(Length-Start, 20),
    random_between(0, Most, Count),
    sub_string(Text0, 0, Start, _, Before),
    sub_string(Text0, Start, Count, _, Some),
    End is Start+Count,
    sub_string(Text0, End, _, 0, After),
    string_concat(Some, Some, Twice),
    random_member(Instead, ["", "0", " ", "-", "00000003a b", Twice]),
    atomics_to_string([Before, Instead, After], Text).
another(_, Term) :-
    random_member(Term,
                  [ _, none, foo, "", "00000000", [], [_|_], [pem(a, b, "")],
                    [pem(_, _, _)], 0, -1, 1.5, 7, 1000000000000000000000,
                    1+1, f(_), received(x), received(_), handed(x, y),
                    entered(z), at(0, 0, 0, none, none) ]).

chained(link(Text, Hex, C), Chain0, Chain) :-
    format(string(Link), '~w ~d ~s', [Hex, C, Text]),
    string_length(Link, Length),
    format(string(Framed), '~`0t~d~8|~s', [Length, Link]),
    string_concat(Chain0, Framed, Chain).

%   forged(+Links, -Forged, -Verdict): newest first. Links are two of gamma, two
%   of beta, the older with what it received and what was entered, one of alpha.

forged(Links, Forged, unaccounted(alpha)) :-         % a result is changed
    changed(1, entered(was(_)), entered(was(nothing)), Links, Forged).
forged(Links, Forged, unaccounted(alpha)) :-         % it is taken away
    append(Before, [_, Link], Links),
    append(Before, [Link], Forged).
forged(Links, Forged, unaccounted(alpha)) :-  % beta has received another state
    changed(1, received(At), received(At, another), Links, Forged).
forged(Links, Forged, since(3)) :-      % the links before beta are removed
    append(Forged, [_], Links).
forged(Links, Forged, unaccounted(nobody)) :-
    changed(0, handed(_, What), handed(another, What), Links, Forged).
forged(Links, Forged, unaccounted(beta)) :-          % not a text
    append(Before, [link(_, _, _)|After], Links),
    length(After, 3),
    append(Before, [link("0-[f(", x, 0)|After], Forged).
forged(Links, Forged, unaccounted(beta)) :-
    append(Before, [link(_, Hex, C)|After], Links),
    length(After, 3),
    append(Before, [link("3-[_]. halt. ", Hex, C)|After], Forged).

changed(N, Event, Instead, Links, Forged) :-
    append(Before, [link(Text, Hex, C)|After], Links),
    typhon_text:text_term(Text, N-Events),
    append(Some, [Event|Others], Events),
    append(Some, [Instead|Others], News),
    typhon_text:term_text(N-News, New),
    append(Before, [link(New, Hex, C)|After], Forged).
