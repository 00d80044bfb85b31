:- module(test_agent, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(readutil)).
:- use_module(library(time)).
:- use_module(library(typhon)).

/** <module> Tests of the lives of agents, from birth to end

Agents on hosts of this process. An agent with on_message/2 remains for
inspection when its goals are done.
*/

%   lives(+Hosts, +Options, +Clauses, -Facts): of an agent that has no goals
%   left.

lives(Hosts, Options, Clauses, Facts) :-
    with_hosts(Hosts, ( resident(Clauses, Options, Agent),
                        facts(Agent, Facts) )).

resident(Clauses, Options, Agent) :-
    create([on_message(_, _)|Clauses], Agent, Options),
    wait_state(Agent, resident).

raised_in_life(Hosts, Options, Goal, Error) :-
    lives(Hosts, Options,
          [ (main :- catch(Goal, error(E, _), true), note(E)),
            (note(E) :- subsumes_term(type_error(mobile_term, _), E)
                      -> assertz(s(mobile_term))
                       ; assertz(s(E))) ], Facts),
    memberchk(s(Error), Facts).

%   ends(+Clauses, -Outcome, -Messages)

ends(Clauses, Outcome, Messages) :-
    with_hosts([alpha,beta],
               capturing(( create(Clauses, Agent),
                           joined(Agent, Outcome) ), Messages)).

gone(Agent) :-
    \+ agent_property(Agent, state(_)).

name_of(Address, Name) :-
    once(sub_atom(Address, Length, _, _, @)),
    sub_atom(Address, 0, Length, _, Name).

tools(payload(tools, [p/1,q/1], [p(1),p(2),(q(X):-p(X),X>1)])).

terms_of_all_kinds(Terms) :-
    Big is 7**77, Neg is -(3**80), Inf is inf, Nan is nan, Tiny is 2.0** -1074,
    MZero is -0.0,
    findall(s(T), member(T, [ Big, Neg, Inf, Nan, Tiny, MZero, 0.1, 1r3,
                              "a \"string\"\n", 'an atom\\', [], '[]', {},
                              (:-), {a,b}, f(x:y, "", `codes`), 'γεια', - 1,
                              -(1), 1-2, -(-(1)), [a|b], \+a, (a:-b,c;d->e),
                              'hello world'(1), '$VAR'(1), "", '' ]), Terms).

                /*******************************
                *             LIVES            *
                *******************************/

%   life(-Behaviour, -Hosts, -Options, -Clauses, -Facts): Facts are the final
%   state of an agent of Clauses.

life(Behaviour, [alpha,beta], [], Clauses, Facts) :-
    life(Behaviour, Clauses, Facts).
life(facts_are_added, [alpha], [facts([s(1), (r(2) :- s(1))])], [s(0)],
     [(r(2) :- s(1)), s(0), s(1)]).
life(token_admits, [alpha,beta-[tokens([red])]], [tokens([red])],
     [(main :- move(beta), assertz(s(there)))], [s(there)]).
life(lifetime_without_end, [alpha,beta], [lifetime(inf)],
     [(main :- move(beta), move(alpha), move(beta), move(alpha), hops(N),
               assertz(s(N)))], [s(4)]).
life(refused_agent_stays, [alpha,beta-[tokens([red])]], [tokens([blue])],
     [(main :- catch(move(beta), error(E, _), assertz(s(E))),
               assertz(s(here)))],
     [s(move_refused(_, token)), s(here)]).
life(terms_of_all_kinds_travel, [alpha,beta], [facts(Terms)],
     [(main :- move(beta), move(alpha))], Terms) :-
    terms_of_all_kinds(Terms).
life(provided_but_undefined_is_empty, [alpha],
     [payloads([payload(x, [p/1], [])])],
     [(main :- ( p(_) -> true ; assertz(s(none)) ))], [s(none)]).
life(payload_may_move_the_agent, [alpha,beta],
     [payloads([payload(trip, [trip/0], [(trip :- move(beta))])])],
     [(main :- trip, here(A), assertz(s(A)), detach(trip))], [s(beta)]).
life(attached_payload_may_move_the_agent, [alpha,beta],
     [facts([r(payload(trip, [trip/0], [(trip :- move(beta))]))])],
     [(main :- r(P), attach(P), trip, here(A), assertz(s(A)), detach(trip),
               retract(r(_)))], [s(beta)]).

life(without_main, [], []).
life(move_and_continue,
     [(main :- assertz(s(1)), move(beta), assertz(s(2)), move(alpha),
               assertz(s(3)))], [s(1), s(2), s(3)]).
life(move_to_the_current_host,
     [(main :- move(alpha), hops(N), assertz(s(N)))], [s(0)]).
life(argument_of_an_unreachable_move_is_kept,
     [ (main :- to('gamma@127.0.0.1:1')),
       (to(X) :- catch(move(X), error(E, _), assertz(s(E))), assertz(s(X))) ],
     [s(host_unreachable(X)), s(X)]).
life(agent_stays_whose_goal_cannot_travel,
     [(main :- current_output(S),
               catch(( move(beta), write(S, x) ), error(type_error(E, _), _),
                     assertz(s(E))),
               here(A), assertz(s(A)))], [s(mobile_term), s(alpha)]).
life(unused_attributed_variable_is_ignored,
     [ (main :- two(X), sleep(0.01), assertz(s(X))),
       (two(X) :- freeze(X, true), freeze(_, true), X = 2) ], [s(2)]).
life(timeout_fails,
     [(main :- receive(_, 0.05) -> assertz(s(got)) ; assertz(s(late)))],
     [s(late)]).

:- begin_tests(lives).

test(life, [ forall(life(_, Hosts, Options, Clauses, Expected)),
             true(subsumes_term(Expected, Facts)) ]) :-
    lives(Hosts, Options, Clauses, Facts0),
    maplist(by_name, Facts0, Facts).

by_name(s(Address), s(Name)) :-
    atom(Address),
    name_of(Address, Name),
    memberchk(Name, [alpha,beta]),
    !.
by_name(Fact, Fact).

test(variables_stay_shared, true(F =@= [(r(Y):-s(Y)),s(f(X,X,_))])) :-
    lives([alpha,beta], [facts([(r(Y) :- s(Y))])],
          [(main :- X = f(A,A,_), move(beta), assertz(s(X)))], F).

%   raises(-Hosts, -Options, -Goal, -Error): Goal of an agent raises Error.

raises([alpha,beta], [], Goal, Error) :-
    raises(Goal, Error).
raises([alpha,beta-[capacity(0)]], [], Goal, move_refused(_, capacity)) :-
    member(Goal, [move(beta), clone(beta, _)]).
raises([alpha-[capacity(1)]], [], clone(_), move_refused(_, capacity)).
raises([alpha,beta], [static(true)], move(beta),
       permission_error(move, static_agent, _)).
%   State that was changed, also after a hop, and cannot travel.
raises([alpha,beta], [facts([r(0)])],
       ( First, current_output(S), assertz(r(S)), move(To) ), mobile_term) :-
    member(First-To, [true-beta, move(beta)-alpha]).

raises(move(nowhere), move_refused(nowhere, unknown_host)).
raises(move(_), instantiation_error).
raises(send(_, x), instantiation_error).
raises(send(at(_, alpha), x), instantiation_error).
raises(clone('gamma@127.0.0.1:1', _), host_unreachable(_)).
raises(attach(payload(x, [main/0], [main])),
       permission_error(attach, procedure, main/0)).
raises(( P = payload(x, [p/1], [p(1)]), attach(P), attach(P) ),
       permission_error(attach, procedure, p/1)).
raises(Goal, Error) :-
    member(Name, [detach,deliver,undeliver]),
    member(X-Error, [ x-existence_error(payload, x), _-instantiation_error ]),
    Goal =.. [Name,X].
%   Stored goals would keep the variable and lose its attribute.
raises(( freeze(X, true), Stop, X = 1 ), mobile_term) :-
    member(Stop, [sleep(1), receive(_), receive(_, 1), clone(_)]).
%   No agent stops inside a native goal.
raises(( G = Goal, findall(x, G, _) ),
       permission_error(call, control_predicate, Name/Arity)) :-
    member(Goal, [ move(beta), clone(_), clone(beta, _), sleep(0.1),
                   receive(_), receive(_, 0), dispose ]),
    functor(Goal, Name, Arity).

test(raises, [ forall(raises(Hosts, Options, Goal, Error)),
               true(subsumes_term(Error, Raised)) ]) :-
    raised_in_life(Hosts, Options, Goal, Raised).

%   outcome(-Clauses, -Outcome, -Messages)

outcome([main], done, []).
outcome([(main :- fail)], failed, [warning-typhon(agent_failed(_, _))]).
outcome([(main :- dispose, throw(never))], disposed, []).
outcome([(main :- sleep(0), sleep(-1))], done, []).
outcome([(main :- move(beta), sleep(0.05))], done, []).
outcome([(main :- Goal)], raised(error(Error, _)),
        [error-typhon(faulty(_, _, _))]) :-
    member(Goal-Error, [ sleep(soon)-type_error(_, soon),
                         sleep(_)-instantiation_error,
                         receive(_, soon)-type_error(_, soon),
                         (_ is foo+1)-type_error(evaluable, _) ]).
outcome([(main :- current_output(S), throw(S))], raised(_), [_]).

test(outcome, [ forall(outcome(Clauses, Outcome, Messages)),
                true(subsumes_term(Outcome-Messages, O-M)) ]) :-
    ends(Clauses, O, M).

:- end_tests(lives).

:- begin_tests(birth).

test(agent_without_main_is_resident_from_birth, States == [resident]) :-
    with_hosts([alpha],
               ( findall(S, ( between(1, 300, _),
                              create([on_message(_, _)], A),
                              agent_property(A, state(S)) ),
                         All),
                 sort(All, States) )).
test(handler_in_the_state_only, O == disposed) :-
    with_hosts([alpha],
               ( agent_create(clauses([(:- agent(t, [state([on_message/2])])),
                                       main,
                                       (on_message(_, stop) :- dispose)]), A),
                 wait_state(A, resident),
                 agent_send(A, stop),
                 joined(A, O) )).
test(id_has_the_name_and_the_home,
     [ forall(member(Options-Name, [[]-test, [name(scout)]-scout])),
       true(Start-End == Name-Home) ]) :-
    with_hosts([alpha],
               ( create([main], A, Options), joined(A, _),
                 address(alpha, Home) )),
    atomic_list_concat([Start|_], '.', A),
    once(( sub_atom(A, _, _, 0, End), End == Home )).
test(host_of_birth, [ forall(member(Options-Host, [ []-alpha,
                                                    [host(beta)]-beta,
                                                    [host(B)]-beta ])),
                      true(H == Address) ]) :-
    with_hosts([alpha,beta],
               ( address(beta, B), address(Host, Address),
                 create([on_message(_, _)], Agent, Options),
                 agent_property(Agent, host(H)) )).

%   creation_error(-Hosts, -Clauses, -Options, -Error)

creation_error([], [main], [], existence_error(host, here)).
creation_error([alpha], [main], Options, Error) :-
    creation_error(Options, Error).
creation_error([alpha], [main,p(1)], [facts([p(2)])],
               permission_error(attach, procedure, p/1)).
creation_error([alpha-[capacity(0)]], [main], [], move_refused(_, capacity)).
creation_error([alpha-[tokens([red])]], [main], [tokens([Token])],
               move_refused(_, token)) :-
    member(Token, [blue, _]).

creation_error([name(Name)], domain_error(agent_name, Name)) :-
    member(Name, ['', 'a@b', 'a\e[31mb', 'a\nb', 'a\u202eb']).
creation_error([host(nowhere)], existence_error(host, nowhere)).
creation_error([colour(red)], domain_error(agent_option, colour(red))).
creation_error([static(1)], type_error(boolean, 1)).
creation_error(host(alpha), type_error(list, host(alpha))).
creation_error([lifetime(-1)], type_error(nonneg, -1)).
creation_error([facts([s(S)])], type_error(mobile_term, _)) :-
    current_output(S).
creation_error([facts([3])], type_error(callable, 3)).
creation_error([payloads([nothing])],
               existence_error(source_sink, nothing)).
creation_error([payloads([payload(x, [p/1], [p(1)]),
                          payload(x, [q/1], [q(1)])])],
               permission_error(attach, payload, x)).
creation_error([payloads([payload(x, [PI], []), payload(y, [PI], [])])],
               permission_error(attach, procedure, PI)) :-
    member(PI, [p/1, s/1]).

test(creation_error, [ forall(creation_error(Hosts, Clauses, Options, Error)),
                       error(Error) ]) :-
    with_hosts(Hosts, create(Clauses, _, Options)).
test(unknown_host_of_this_process, error(existence_error(host, _))) :-
    with_hosts([alpha],
               ( address(alpha, A),
                 atom_concat(alpha, Endpoint, A),
                 atom_concat(nowhere, Endpoint, Nowhere),
                 create([main], _, [host(Nowhere)]) )).
test(ids_are_unique, N == 400) :-
    with_hosts([alpha,beta],
               ( concurrent_maplist(plunit_birth:create_100,
                                    [alpha,alpha,beta,beta], Ids),
                 append(Ids, All),
                 maplist(joined, All, _) )),
    sort(All, Set),
    length(Set, N).

create_100(Host, Agents) :-
    findall(A, ( between(1, 100, _), create([main], A, [host(Host)]) ),
            Agents).

test(vocabulary, true(F == [s(Id,A,A,0,[B],1)])) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta), address(alpha, A), address(beta, B),
                 agent_create(clauses([(:- agent(t, [state([s/6])])),
                                       on_message(_, _),
                                       (main :- self(I), here(H), home(O),
                                                hops(N), neighbours(L),
                                                host_load(W), \+ parent(_),
                                                now(T), float(T),
                                                assertz(s(I,H,O,N,L,W)))]),
                              Id),
                 wait_state(Id, resident),
                 agent_property(Id, facts(F)) )).
test(vocabulary_after_a_move, true(F == [s(B-A-1)])) :-
    with_hosts([alpha,beta],
               ( address(alpha, A), address(beta, B),
                 resident([(main :- move(beta), here(H), home(O), hops(N),
                                    assertz(s(H-O-N)))], [], Id),
                 facts(Id, F) )).

:- end_tests(birth).

:- begin_tests(moves).

test(lifetime, true(O-H == disposed-2)) :-
    with_hosts([alpha,beta],
               ( create([(main :- tour),
                         (tour :- move(beta), mark, move(alpha), mark, tour),
                         (mark :- hops(N), leave(hops(N)))], A, [lifetime(2)]),
                 joined(A, O),
                 findall(N, ( member(Host, [alpha,beta]),
                              remote(Host, findall(N0, sense(hops(N0)), Ns)),
                              member(N, Ns) ), All),
                 max_list(All, H) )).
test(hop_time_is_measured, true((C1-C2 == 1-1, M >= 0.05))) :-
    with_hosts([alpha-[hop_time(uniform(0.05, 0.06))],beta],
               ( create([(main :- move(beta))], A), joined(A, done),
                 host_property(alpha, hop_time(out, stats(C1,_,_,_))),
                 host_property(beta, hop_time(in, stats(C2,M,_,_))) )).
test(hosts_are_empty_afterwards) :-
    with_hosts([alpha,beta],
               ( findall(A, ( between(1, 50, _),
                              create([(main :- move(beta), move(alpha),
                                               move(beta))], A) ), As),
                 forall(member(A, As), joined(A, done)),
                 wait_until(( host_property(alpha, load(0)),
                              host_property(beta, load(0)) ), 5) )).
test(thousand_round_trips_without_pause, O == done) :-
    with_hosts([alpha,beta],
               ( create([ (main :- s(0), !),
                          (main :- move(beta), move(alpha), retract(s(N)),
                                   N1 is N-1, assertz(s(N1)), main),
                          s(1000) ], A),
                 joined(A, O) )).

:- end_tests(moves).

:- begin_tests(clones).

%   twins(-Behaviour, -Hosts, -Options, -Clauses, -Parent, -Clone, -Properties):
%   both have these properties when they have no goals left.

twins(fork, [alpha], [], [(main :- clone(W), assertz(s(W)))], P, C,
      [ P-facts([s(parent(C))]), C-facts([s(clone(P))]) ]).
twins(fork_elsewhere, [alpha,beta], [],
      [(main :- clone(beta, W), assertz(s(W)),
                ( parent(P0) -> assertz(s(P0)) ; true ))], P, C,
      [ P-facts([s(parent(C))]), C-facts([s(clone(P)), s(P)]),
        P-host(alpha), C-host(beta) ]).
twins(clone_has_its_own_state, [alpha], [],
      [s(1), (main :- clone(W), functor(W, N, 1), assertz(s(N)))], P, C,
      [ P-facts([s(1), s(parent)]), C-facts([s(1), s(clone)]) ]).
twins(bindings_are_not_shared, [alpha], [],
      [(main :- clone(W), bind(W, X), assertz(s(X))), bind(parent(_), x),
       bind(clone(_), y)], P, C,
      [ P-facts([s(x)]), C-facts([s(y)]) ]).
twins(clone_has_the_tokens_of_its_parent, [alpha,beta-[tokens([red])]],
      [tokens([red])], [(main :- Clone, move(beta))], P, C,
      [ P-host(beta), C-host(beta) ]) :-
    member(Clone, [clone(_), clone(beta, _)]).
twins(clone_is_born_on_the_host_of_its_parent, [alpha,beta], [],
      [(main :- move(beta), clone(_))], P, C, [P-home(alpha), C-home(beta)]).
twins(payloads_are_cloned, [alpha], [payloads([payload(seven, [p/1], [p(7)])])],
      [(main :- clone(_), p(X), assertz(s(X)), detach(seven))], P, C,
      [ P-facts([s(7)]), C-facts([s(7)]) ]).

test(twins, [ forall(twins(_, Hosts, Options, Clauses, P, C, Properties)),
              true(Wrong == []) ]) :-
    with_hosts(Hosts,
               ( create([on_message(_, _)|Clauses], P, Options),
                 wait_until(two_residents(P, C), 10),
                 findall(A-Property, ( member(A-Property, Properties),
                                       \+ agent_property(A, Property) ),
                         Wrong) )).

two_residents(P, C) :-
    agent_property(P, state(resident)),
    agent_property(C, state(resident)),
    C \== P,
    !.

test(clone_has_the_name_of_its_parent, true(sub_atom(C, 0, _, _, 'v1.2.'))) :-
    with_hosts([alpha], ( create([on_message(_, _), (main :- clone(_))], P,
                                 [name('v1.2')]),
                          wait_until(two_residents(P, C), 10) )).
test(mail_is_not_cloned, F == [s(none)]) :-
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- receive(_-go), clone(W), mail(W)),
                         mail(parent(_)),
                         (mail(clone(_)) :- receive(_, 0) -> assertz(s(mail))
                                          ; assertz(s(none)))], P),
                 wait_state(P, waiting),
                 maplist(agent_send(P), [other,go]),
                 wait_until(two_residents(P, C), 10),
                 agent_property(C, facts(F)) )).
test(clone_order_from_outside, true(F1-F2 == [s(1)]-[s(1)])) :-
    with_hosts([alpha],
               ( create([on_message(_, _), s(1)], A),
                 agent_clone(A, C),
                 wait_state(C, resident),
                 facts(A, F1),
                 facts(C, F2) )).
test(clone_order_is_refused, error(move_refused(_, capacity))) :-
    with_hosts([alpha-[capacity(1)]],
               ( create([on_message(_, _)], A), agent_clone(A, _) )).

:- end_tests(clones).

:- begin_tests(waiting).

test(sleep_is_in_host_seconds,
     [ forall(member(Options-Sleep, [[]-0.1, [clock(0, 10 000)]-1000])),
       true((S >= 0.1, soon(S, 5))) ]) :-
    with_hosts([alpha-Options],
               elapsed(( create([(main :- sleep(Sleep))], A),
                         joined(A, done) ), S)).
test(sleepers_wake_in_order, F == [1,2,3,4,5]) :-
    with_hosts([alpha-[concurrency(1), clock(virtual)]],
               ( remote(alpha, now(T0)),
                 T is T0+1,
                 findall(A, ( member(N, [3,1,5,2,4]),
                              Until is T+N*0.01,
                              create([(main :- s(U), now(Now), D is U-Now,
                                               sleep(D), r(N), leave(up(N)))],
                                     A, [facts([s(Until),r(N)])]) ), As),
                 maplist(joined, As, _),
                 remote(alpha, findall(N, sense(up(N)), F)) )).
test(sleep_without_end, Count-O == 2-timeout) :-
    with_hosts([alpha],
               ( create([(main :- sleep(inf))], A),
                 create([(main :- X is inf, sleep(X))], B),
                 wait_state(A, sleeping),
                 wait_state(B, sleeping),
                 with_output_to(string(Table), agents),
                 findall(x, sub_string(Table, _, _, _, "sleeping  "), Xs),
                 length(Xs, Count),
                 agent_join(A, O, 0) )).

%   mailed(-Behaviour, -Clauses, -Messages, -Facts): of an agent that has been
%   sent Messages and has no goals left.

mailed(oldest_message_is_received,
       [(main :- receive(_-go), get, get, get),
        (get :- receive(_-X), assertz(s(X)))], [1,2,3,go], [s(1),s(2),s(3)]).
mailed(receive_selects,
       [(main :- receive(_-go), get(b(_)), get(_), get(_)),
        (get(X) :- receive(_-X), assertz(s(X)))], [a(1),b(2),c(3),go],
       [s(b(2)),s(a(1)),s(c(3))]).
mailed(other_messages_are_kept_for_on_message,
       [(main :- receive(_-go), assertz(s(got(go)))),
        (on_message(_, X) :- assertz(s(heard(X))))], [1,2,go],
       [s(got(go)),s(heard(1)),s(heard(2))]).
mailed(bindings_of_a_message,
       [(main :- receive(From-add(X, 3)), Y is X+3, assertz(s(Y-From)))],
       [add(4,3)], [s(7-user)]).
mailed(zero_timeout_polls,
       [(main :- receive(_-go), get, get),
        (get :- receive(_-X, 0) -> assertz(s(X)) ; assertz(s(none)))],
       [1,go], [s(1),s(none)]).
mailed(receive_without_a_timeout,
       [(main :- r(T), receive(_-X, T), assertz(s(X)), retract(r(T))), r(T)],
       [x], [s(x)]) :-
    member(T, [inf,infinite,1.0Inf,1000]).
mailed(handler_is_called_once_per_message,
       [(on_message(_, X) :- member(_, [a,b]), assertz(s(X)))], [1,2],
       [s(1),s(2)]).
mailed(handler_that_waits,
       [(on_message(_, a) :- receive(_-c), assertz(s(1))),
        (on_message(_, b) :- assertz(s(2)))], [a,b,c], [s(1),s(2)]).

test(mailed, [ forall(mailed(_, Clauses, Messages, Expected)),
               F-M == Expected-[] ]) :-
    mailed_capturing([alpha], Clauses, Messages, F, M).
test(failing_handler,
     [ forall(member(Bad-Message,
                     [ []-message_failed(_, user, bad),
                       [(on_message(_, bad) :- fail)]
                       -message_undone(_, user, bad, _),
                       [(on_message(_, bad) :- move(beta), fail)]
                       -message_undone(_, user, bad, _) ])),
       true(F-M = [s(good)]-[warning-typhon(Message)]) ]) :-
    append(Bad, [(on_message(_, good) :- assertz(s(good)))], Clauses),
    mailed_capturing([alpha,beta], Clauses, [bad,good], F, M).

mailed_capturing(Hosts, Clauses, Messages, Facts, Printed) :-
    (   member((on_message(_, _):-_), Clauses)
    ->  All = Clauses
    ;   All = [on_message(_, _)|Clauses]
    ),
    with_hosts(Hosts, capturing(mailed(All, Messages, Facts), Printed)).

mailed(Clauses, Messages, Facts) :-
    create(Clauses, Agent),
    wait_until(( state_of(Agent, S), memberchk(S, [waiting,resident]) ), 10),
    maplist(agent_send(Agent), Messages),
    wait_until(( state_of(Agent, resident),
                 agent_property(Agent, mailbox([])) ), 10),
    facts(Agent, Facts).

test(unmatched_message_does_not_wake, S == waiting) :-
    with_hosts([alpha],
               ( create([(main :- receive(_-a))], A),
                 wait_state(A, waiting),
                 agent_send(A, b),
                 agent_property(A, state(S)) )).
test(timeout_takes_its_time, true(S >= 0.1)) :-
    with_hosts([alpha],
               elapsed(( create([(main :- receive(_, 0.1) -> true ; true)], A),
                         joined(A, done) ), S)).
test(expired_timeout_does_not_affect_later_receives, F == [s(late),s(x)]) :-
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- ( receive(_-no, 0.05) -> true
                                  ; assertz(s(late)) ),
                                  receive(_-X), assertz(s(X)))], A),
                 wait_until(( fact_of(A, s(late)), state_of(A, waiting) ), 10),
                 agent_send(A, x),
                 wait_state(A, resident),
                 agent_property(A, facts(F)) )).
test(handler_ends_the_agent, [ forall(member(Goal-Outcome,
                                             [ throw(oops)-raised(oops),
                                               dispose-disposed ])),
                               O == Outcome ]) :-
    with_hosts([alpha],
               capturing(( create([(on_message(_, _) :- Goal)], A),
                           agent_send(A, hello),
                           joined(A, O) ), _)).

:- end_tests(waiting).

:- begin_tests(end).

test(faulty_agent_keeps_its_state_and_takes_no_capacity,
     true(O-S-M = raised(oops)-faulty(oops)
          -[error-typhon(faulty(A, oops, _))])) :-
    with_hosts([alpha],
               capturing(( create([s(1), (main :- throw(oops))], A),
                           joined(A, O),
                           host_property(alpha, load(0)),
                           agent_property(A, state(S)),
                           agent_property(A, facts([s(1)])) ), M)).
test(faulty_agents_are_bounded) :-
    with_settings([typhon_creation:faulty=3],
        with_hosts([alpha],
                   capturing(( findall(A, ( between(1, 10, _),
                                            create([(main :- throw(x))], A) ),
                                       As),
                               maplist(joined, As, _),
                               wait_until(aggregate_all(
                                              count,
                                              agent_property(
                                                  _, state(faulty(_))), 3),
                                          5) ), _))).
test(outcome_of_a_discarded_agent, O == done) :-
    with_hosts([alpha],
               ( create([main], A), wait_until(gone(A), 10), joined(A, O) )).
test(join_times_out, [ forall(member(Timeout, [0, 0.1])),
                       true((O == timeout, S >= Timeout)) ]) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 elapsed(agent_join(A, O, Timeout), S) )).

%   Two threads join the agent, one of them without a timeout.

test(joins_of_several_threads,
     [ forall(member(Goal-Outcome, [ agent_dispose(A)-disposed,
                                     agent_send(A, go)-done,
                                     host_stop(alpha)-disposed ])),
       Os == [Outcome,Outcome] ]) :-
    with_hosts([alpha],
               ( create([(main :- receive(_))], A),
                 wait_state(A, waiting),
                 findall(T, ( member(Timeout, [inf,10]),
                              thread_create(( agent_join(A, O, Timeout),
                                              thread_exit(O) ), T) ), Ts),
                 call(Goal),
                 findall(O, ( member(T, Ts), thread_join(T, exited(O)) ),
                         Os) )).
test(join_unknown_agent, true(Unknown == Id)) :-
    with_hosts([alpha],
               ( address(alpha, Address),
                 atom_concat('x.1@', Address, Id),
                 catch(agent_join(Id, _, 10),
                       error(existence_error(agent, Unknown), _), true) )).

invalid_join(agent_join(foo, _, 10), existence_error(agent, foo)).
invalid_join(agent_join(_, _, 10), instantiation_error).
invalid_join(Goal, type_error(number, soon)) :-
    member(Goal, [ agent_join(foo, _, soon), agent_join(family(foo), _, soon),
                   agent_result(foo, _, soon) ]).

test(invalid_join, [forall(invalid_join(Goal, Error)), error(Error)]) :-
    with_hosts([alpha], Goal).
test(join_for_an_infinite_float, O == disposed) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 agent_dispose(A),
                 Timeout is inf,
                 agent_join(A, O, Timeout) )).
test(join_after_the_host_stopped, O == disposed) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A), host_stop(alpha) )),
    agent_join(A, O, 10).

:- end_tests(end).

                /*******************************
                *      ORDERS FROM OUTSIDE     *
                *******************************/

%   An agent in each state, and the goal that brings it there.

in_state(running, [(main :- receive(_-go), busy(200 000), receive(_-stop)),
                   (busy(N) :- N =< 0, !),
                   (busy(N) :- N1 is N-1, busy(N1))], go).
in_state(looping, [(main :- ( receive(_-stop, 0) -> true ; main ))], none).
in_state(sleeping, [(main :- sleep(1000))], none).
in_state(waiting, [(main :- receive(_-stop))], none).
in_state(waiting, [(main :- receive(_-stop, 1000))], none).
in_state(resident, [(on_message(_, stop) :- dispose)], none).

ready_for_orders(State, Agent) :-
    in_state(State, Clauses, First),
    create(Clauses, Agent),
    (   memberchk(State, [sleeping,waiting,resident])
    ->  wait_state(Agent, State)
    ;   State == running
    ->  wait_state(Agent, waiting),
        agent_send(Agent, First)
    ;   true
    ).

:- begin_tests(orders).

test(dispose, [forall(in_state(State, _, _)), O == disposed]) :-
    with_hosts([alpha],
               ( ready_for_orders(State, A),
                 agent_dispose(A),
                 joined(A, O),
                 gone(A),
                 wait_until(host_property(alpha, load(0)), 5) )).
test(late_answer_leaves_no_message, Left == 0) :-
    with_hosts([alpha],
               ( create([(main :- leave(begun), shell('sleep 0.5')),
                         on_message(_, _)], A),
                 wait_until(remote(alpha, sense(begun)), 5),
                 catch(call_with_time_limit(0.1, agent_clone(A, _)),
                       time_limit_exceeded, true),
                 wait_until(host_property(alpha, load(2)), 5),
                 wait_until(forall(agent_property(_, state(S)),
                                   S == resident), 5),
                 thread_self(Me),
                 message_queue_property(Me, size(Left)) )).
test(dispose_in_flight, O == disposed) :-
    with_hosts([alpha-[hop_time(uniform(1000, 1001))],beta],
               ( create([(main :- move(beta))], A),
                 wait_state(A, in_transit),
                 agent_dispose(A),
                 joined(A, O) )).
test(move, [forall(in_state(State, _, _))]) :-
    with_hosts([alpha,beta],
               ( ready_for_orders(State, A),
                 agent_move(A, beta),
                 wait_until(agent_property(A, host(beta)), 10),
                 wait_until(host_property(alpha, load(0)), 5) )).
test(clone, [forall(in_state(State, _, _)), true(Os == [disposed,disposed])]) :-
    with_hosts([alpha],
               ( ready_for_orders(State, A),
                 agent_clone(A, C),
                 maplist(agent_dispose, [A,C]),
                 maplist(joined, [A,C], Os) )).
test(attach_and_detach, [forall(in_state(State, _, _)), P1-P2 == [seven]-[]]) :-
    with_hosts([alpha],
               ( ready_for_orders(State, A),
                 payload_attach(A, payload(seven, [p/1], [p(7)])),
                 agent_property(A, payloads(P1)),
                 payload_detach(A, seven),
                 agent_property(A, payloads(P2)) )).
test(agent_continues_after_a_move_order,
     [forall(member(State, [looping,waiting])), O == done]) :-
    with_hosts([alpha,beta],
               ( ready_for_orders(State, A),
                 agent_move(A, beta),
                 agent_send(A, stop),
                 joined(A, O) )).
test(sleep_continues_after_a_move_order, O-T == done-200.0) :-
    with_hosts([alpha-[clock(virtual)], beta-[clock(virtual)]],
               ( create([(main :- sleep(200))], A),
                 agent_join(A, timeout, 100),
                 agent_move(A, beta),
                 agent_join(A, O, 1000),
                 remote(beta, now(T)) )).
test(failed_order_is_reported,
     [ forall(member(Capacity-Static-Error,
                     [ 1-true-permission_error(move, _, _),
                       0-false-move_refused(_, capacity) ])),
       true(M = [warning-typhon(order_failed(_, Error))]) ]) :-
    with_hosts([alpha,beta-[capacity(Capacity)]],
               capturing(( create([on_message(_, _)], A, [static(Static)]),
                           agent_move(A, beta),
                           payload_attach(A, payload(x, [], [])),
                           wait_state(A, resident) ), M)).

%   invalid_order(-Agent, -Order, -Error): Agent is resident.

invalid_order(_, Order, existence_error(agent, foo)) :-
    member(Order, [ agent_dispose(foo), agent_clone(foo, _),
                    agent_move(foo, alpha), agent_save(foo, '/nowhere/x'),
                    payload_detach(foo, x), payload_attach(foo, no_file) ]).
invalid_order(_, Order, instantiation_error) :-
    member(Order, [agent_dispose(_), payload_attach(_, no_file)]).
invalid_order(_, payload_attach(1, no_file), type_error(atom, 1)).
invalid_order(A, agent_move(A, nowhere), existence_error(host, nowhere)).
invalid_order(A, payload_detach(A, y), existence_error(payload, y)).
invalid_order(A, payload_attach(A, Payload), Error) :-
    member(Payload-Error,
           [ payload(x, [q/1], [])-permission_error(attach, payload, x),
             payload(y, [s/1], [])-permission_error(attach, procedure, s/1),
             payload(y, _, [])-instantiation_error,
             payload(y, p, [])-type_error(list, p),
             payload(y, [p], [])-type_error(predicate_indicator, p),
             payload(y, [], p)-type_error(list, p),
             clauses([ (:- payload(y, [provides(p)])) ])
             -domain_error(payload_declaration, provides(p)) ]).

test(invalid_order, [ forall(invalid_order(A, Order, Error)),
                      error(Error) ]) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A,
                        [payloads([payload(x, [p/1], [p(1)])])]),
                 Order )).
test(order_to_an_ended_agent, error(existence_error(agent, _))) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, done), agent_dispose(A) )).
test(orders_are_executed_in_sequence, Ps == [p5,p4,p3,p2,p1]) :-
    with_hosts([alpha],
               ( ready_for_orders(looping, A),
                 forall(member(P, [p1,p2,p3,p4,p5]),
                        payload_attach(A, payload(P, [], []))),
                 agent_property(A, payloads(Ps)) )).
test(hopping_agent_takes_orders, O == disposed) :-
    with_hosts([alpha,beta],
               ( create([(main :- move(beta), move(alpha), main)], A),
                 forall(between(1, 20, N),
                        ( atom_concat(p, N, P),
                          payload_attach(A, payload(P, [], [])),
                          payload_detach(A, P) )),
                 agent_dispose(A),
                 joined(A, O) )).
test(order_is_taken_before_a_message, true(H == B)) :-
    setup_call_cleanup(
        message_queue_create(Queue, [alias(test_agent)]),
        with_hosts([alpha,beta],
                   ( address(beta, B),
                     create([ (on_message(_, wait) :-
                                   thread_send_message(test_agent, begun),
                                   thread_get_message(test_agent, go)),
                              (on_message(_, ask) :- here(X), assertz(s(X))) ],
                            A, [host(alpha)]),
                     maplist(agent_send(A), [wait,ask]),
                     thread_get_message(Queue, begun),
                     agent_move(A, beta),
                     thread_send_message(Queue, go),
                     wait_until(fact_of(A, s(H)), 10) )),
        message_queue_destroy(Queue)).

:- end_tests(orders).

:- begin_tests(agent_property).

test(all, true(Ps =@= [ facts([s(1)]), goals([receive(_-go),foo]), home(A),
                       hops(1), host(B), mailbox([]), payloads([x]),
                       program(test), state(waiting) ])) :-
    with_hosts([alpha,beta],
               ( address(alpha, A), address(beta, B),
                 create([s(1), foo, (main :- move(beta), receive(_-go), foo)],
                        Agent, [payloads([payload(x, [], [])])]),
                 wait_state(Agent, waiting),
                 findall(P, agent_property(Agent, P), Ps0),
                 sort(Ps0, Ps) )).
test(agents_by_property, true(Found == [[A], Both, Both])) :-
    with_hosts([alpha,beta],
               ( create([on_message(_, _)], A),
                 create([on_message(_, _)], B),
                 agent_move(B, beta),
                 wait_until(agent_property(B, host(beta)), 10),
                 findall(Set, ( member(P, [ host(alpha), home(alpha),
                                            program(test) ]),
                                findall(X, agent_property(X, P), Xs),
                                sort(Xs, Set) ), Found),
                 sort([A,B], Both) )).
test(unknown, [fail]) :-
    with_hosts([alpha],
               ( address(alpha, Address),
                 atom_concat('x.1@', Address, A),
                 agent_property(A, _) )).
test(invalid_agent, [ forall(member(A-Error,
                                    [ 'x.1@alpha@127.0.0.1:1'
                                      -host_unreachable('127.0.0.1:1'),
                                      foo-existence_error(agent, foo),
                                      12-type_error(atom, 12) ])),
                      error(Error) ]) :-
    with_hosts([alpha], agent_property(A, _)).
test(ended, [fail]) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, _), agent_property(A, _) )).
test(in_flight, S-G == in_transit-[foo]) :-
    with_hosts([alpha-[hop_time(uniform(1000,1001))],beta],
               ( create([foo, (main :- move(beta), foo)], A),
                 wait_state(A, in_transit),
                 agent_property(A, state(S)),
                 agent_property(A, goals(G)) )).
test(running, S == running) :-
    with_hosts([alpha],
               ( create([(main :- take(stop), !), (main :- main)], A),
                 agent_property(A, state(S)),
                 remote(alpha, leave(stop)),
                 joined(A, done) )).
test(hopping_agent_always_has_a_host, N == 2000) :-
    with_hosts([alpha,beta],
               ( create([(main :- move(beta), move(alpha), main)], A),
                 aggregate_all(count,
                               ( between(1, 2000, _),
                                 once(agent_property(A, host(_))) ), N),
                 agent_dispose(A),
                 joined(A, disposed) )).

:- end_tests(agent_property).

                /*******************************
                *           PAYLOADS           *
                *******************************/

%   with_payload(-File, :Goal): File is that of a payload.

:- meta_predicate with_payload(-, 0).

with_payload(File, Goal) :-
    with_tmp_dir(Dir,
                 ( directory_file_path(Dir, 'tools.pl', File),
                   write_file(File, ':- payload(tools, [provides([p/1])]).~n\c
                                     p(1).~np(2).~nq(X) :- p(X), X > 1.~n',
                              []),
                   call(Goal) )).

:- begin_tests(payloads).

test(payloads_at_creation, F-Ps == [s(2)]-[tools]) :-
    with_payload(File,
        with_hosts([alpha],
                   ( resident([(main :- q(X), assertz(s(X)))],
                              [payloads([File])], A),
                     agent_property(A, payloads(Ps)),
                     findall(s(X), fact_of(A, s(X)), F) ))).
test(attached_by_the_agent, F-Ps == [s(2)]-[]) :-
    with_payload(File,
        with_hosts([alpha,beta],
                   ( resident([(main :- r(File0), attach(File0), move(beta),
                                        q(X), assertz(s(X)), detach(tools),
                                        catch(q(_),
                                              error(existence_error(_, _), _),
                                              true))], [facts([r(File)])], A),
                     agent_property(A, payloads(Ps)),
                     findall(s(X), fact_of(A, s(X)), F) ))).
test(deliver, F-R == [s(2)]-2) :-
    tools(P),
    with_hosts([alpha,beta],
               ( resident([(main :- move(beta), deliver(tools))],
                          [payloads([P])], _),
                 resident([(main :- q(X), assertz(s(X)))], [host(beta)], B),
                 agent_property(B, facts(F)),
                 remote(beta, q(R)) )).
test(undeliver, error(existence_error(procedure, _))) :-
    tools(P),
    with_hosts([alpha], ( resident([(main :- deliver(tools), undeliver(tools))],
                                   [payloads([P])], _),
                          remote(alpha, q(_)) )).

delivered(Payload) :-
    Payload = payload(Name, _, _),
    create([(main :- deliver(Name))], A, [payloads([Payload])]),
    joined(A, done).

test(deliver_again, X == 9) :-
    with_hosts([alpha],
               ( forall(member(N, [1,9]),
                        delivered(payload(x, [p/1], [p(N)]))),
                 remote(alpha, findall(Y, p(Y), [X])) )).
test(deliver_over_another_payload,
     true(E = permission_error(deliver, procedure, p/1))) :-
    with_hosts([alpha],
               ( delivered(payload(x, [p/1], [p(1)])),
                 resident([(main :- catch(deliver(y), error(E0, _),
                                          assertz(s(E0))))],
                          [payloads([payload(y, [p/1], [p(2)])])], B),
                 fact_of(B, s(E)) )).
test(goal_in_a_place_cannot_move_agents,
     true(F = [s(permission_error(call, control_predicate, move/1))])) :-
    with_hosts([alpha,beta],
               ( delivered(payload(x, [trip/0], [(trip :- move(beta))])),
                 resident([(main :- catch(trip, error(E, _), assertz(s(E))))],
                          [], A),
                 facts(A, F) )).

:- end_tests(payloads).

                /*******************************
                *        RESTORE POINTS        *
                *******************************/

%   with_point(-File, :Goal)

:- meta_predicate with_point(-, 0).

with_point(File, Goal) :-
    with_tmp_dir(Dir, ( directory_file_path(Dir, point, File), call(Goal) )).

%   saved(+Clauses, +Options, -Facts): Facts of the agent that is loaded
%   from the restore point of a waiting agent, after it has got `go`.

saved(Clauses, Options, Facts) :-
    with_point(File, ( with_hosts([alpha,beta],
                                  ( create([on_message(_, _)|Clauses], A,
                                           Options),
                                    wait_state(A, waiting),
                                    agent_save(A, File),
                                    agent_dispose(A) )),
                       with_hosts([gamma],
                                  ( agent_load(File, B),
                                    agent_send(B, go),
                                    wait_state(B, resident),
                                    facts(B, Facts) )) )).

restored(continues_at_its_goal,
         [(main :- assertz(s(1)), receive(_-go), assertz(s(2)))], [],
         [s(1),s(2)]).
restored(bindings_of_the_goals,
         [(main :- Y = f(A,A,"a string"), receive(_-go), assertz(s(Y)))], [],
         [s(f(X,X,"a string"))]).
restored(terms_of_all_kinds, [(main :- receive(_-go))], [facts(Terms)],
         Terms) :-
    terms_of_all_kinds(Terms).
restored(payloads, [(main :- receive(_-go), p(X), assertz(s(X)),
                             detach(seven))],
         [payloads([payload(seven, [p/1], [p(7)])])], [s(7)]).

%   mail(-Options, -Wait, -Wake): an agent that waits in Wait has mail. It is
%   restored on a host with Options, where Wake wakes it. On a host with that
%   clock it wakes at once.

mail([], receive(_-go), go).
mail([clock(-2000, 1)], sleep(1000), none).

:- begin_tests(restore_points).

test(restored, [ forall(restored(_, Clauses, Options, Expected)),
                 true(F =@= Expected) ]) :-
    saved(Clauses, Options, F).
test(operators_do_not_affect_the_file, F == [s(likes(a,b))]) :-
    setup_call_cleanup(
        op(700, xfx, user:likes),
        saved([(main :- receive(_-go))], [facts([s(likes(a,b))])], F),
        op(0, xfx, user:likes)).
test(mail_is_restored_before_the_agent_runs,
     [forall(mail(Options, Wait, Wake)), F == [s(early)]]) :-
    with_point(File,
        with_hosts([alpha, beta-Options],
                   ( create([on_message(_, _),
                             (main :- Wait,
                                      ( receive(_-X, 0) -> assertz(s(X))
                                      ; assertz(s(none)) ))], A),
                     wait_until(( state_of(A, S),
                                  memberchk(S, [waiting,sleeping]) ), 10),
                     agent_send(A, early),
                     agent_save(A, File),
                     agent_load(File, B, [host(beta)]),
                     ( Wake == go -> agent_send(B, go) ; true ),
                     wait_state(B, resident),
                     facts(B, F) ))).
test(restored_agent_has_a_new_id, true((A \== B, N == test))) :-
    with_point(File, with_hosts([alpha],
                                ( create([on_message(_, _)], A),
                                  agent_save(A, File),
                                  agent_load(File, B) ))),
    atomic_list_concat([N|_], '.', B).
test(restore_point_is_readable_text,
     true(( memberchk(goals(Goals), Terms),
            Goals =@= [receive(_-go),foo] ))) :-
    with_point(File, ( with_hosts([alpha],
                                  ( create([foo, (main :- receive(_-go), foo)],
                                           A),
                                    wait_state(A, waiting),
                                    agent_save(A, File) )),
                       read_file_to_terms(File, Terms, []) )).
test(foreign_file, error(domain_error(restore_point, _))) :-
    with_point(File, ( write_file(File, 'foo.~n', []),
                       with_hosts([alpha], agent_load(File, _)) )).
test(no_file, error(existence_error(source_sink, _))) :-
    with_hosts([alpha], agent_load('/nowhere/at/all', _)).
test(state_that_cannot_be_saved, error(type_error(mobile_term, _))) :-
    with_point(File, with_hosts([alpha],
                                ( create([(main :- current_output(S),
                                                   receive(_-go),
                                                   write(S, x))], A),
                                  wait_state(A, waiting),
                                  agent_save(A, File) ))).

:- end_tests(restore_points).
