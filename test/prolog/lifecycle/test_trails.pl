:- module(test_trails, []).

% The trail of an agent, and hosts that tamper with it.

:- use_module('../../lib/common').
:- use_module('../../lib/authority').
:- use_module('../../lib/peers').
:- use_module(library(apply), [foldl/4]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, reverse/2]).
:- use_module(library(plunit)).
:- use_module(library(settings), [set_setting/2]).
:- use_module(library(typhon)).

:- needs([openssl]).

own(Authority, Name, Dir) :-
    directory_file_path(Authority, Name, Dir).

:- meta_predicate with_three(+, 0).

%   alpha is here, beta and gamma are processes; Setup is done in beta before
%   the agent comes.

with_three(Setup, Goal) :-
    with_authority([alpha, beta, gamma], [], with_three(Setup, Goal)).

:- meta_predicate with_three(+, 0, +).

with_three(Setup, Goal, Authority) :-
    own(Authority, alpha, Alpha),
    own(Authority, beta, Beta),
    own(Authority, gamma, Gamma),
    with_peers([beta-[host([tls(Beta)])], gamma-[host([tls(Gamma)])]],
               ( peer_do(beta, Setup),
                 setup_call_cleanup(
                     host_start(alpha, [tls(Alpha)]),
                     once(Goal),
                     host_stop(alpha)) )).

%   It goes to beta, gamma and home, enters something at each, and stays.

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

verdict(Trail, Signed, Verdict) :-
    Trail = trail(Steps, Verdict),
    findall(Name-What, ( member(step(_, Name, Event), Steps),
                         functor(Event, What, _) ), Signed).

:- begin_tests(trails).

test(who_had_it_is_told_in_order) :-
    with_three(true, test_trails:honest).
test(what_a_host_has_taken_away_is_missed) :-
    with_three(true, test_trails:taken_away).

test(of_a_long_way_the_end_is_known,
     [ cleanup(set_setting(typhon_trail:links, 32)) ]) :-
    set_setting(typhon_trail:links, 4),
    with_three(set_setting(typhon_trail:links, 4), test_trails:long_way).

:- end_tests(trails).

%   gamma keeps more than the others, who keep the newest four.

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

%   What hosts could do to an agent that they have: gamma changes what was
%   entered on beta, drops it, lies about the state it has received, and
%   passes the agent on under a trail of its own.

taken_away :-
    toured(Agent, trail(_, whole)),
    typhon_agents:agent(Agent, _, Module, _, _),
    Module:'$trail'(Next, Chain, Pems, Pending),
    typhon_chain:chain_links(Chain, Oldest),
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

chained(Link, Chain0, Chain) :-
    typhon_chain:chain_add(Link, 1-Chain0, 9, _-Chain).

%   forged(+Links, -Forged, -Verdict): newest first. Links are two of gamma, two
%   of beta, the older with what it received and what was entered, one of alpha.

forged(Links, Forged, unaccounted(alpha)) :-         % a result is changed
    changed(1, entered(was(_)), entered(was(nothing)), Links, Forged).
forged(Links, Forged, unaccounted(alpha)) :-         % it is taken away
    append(Before, [_, Link], Links),
    append(Before, [Link], Forged).
forged(Links, Forged, unaccounted(alpha)) :-         % beta has seen another state
    changed(1, received(At), received(At, another), Links, Forged).
forged(Links, Forged, since(3)) :-      % what was before beta is gone
    append(Forged, [_], Links).
forged(Links, Forged, unaccounted(nobody)) :-
    changed(0, handed(_, What), handed(another, What), Links, Forged).
forged(Links, Forged, unaccounted(beta)) :-          % not even a text
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
