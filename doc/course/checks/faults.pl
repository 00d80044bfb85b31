:- module(course_faults, []).

% Lesson 6: faults, and agents that tolerate them.

:- use_module(course).
:- use_module('../../../prolog/typhon').
:- use_module(library(lists), [member/2, memberchk/2]).

:- multifile course:criterion/3.

                /*******************************
                *            PATROL            *
                *******************************/

course:criterion(patrol, 'visits all hosts that let it in',
                 course_faults:patrols([n3])).
course:criterion(patrol, 'ends if no host lets it in',
                 course_faults:patrols([n2, n3, n4])).
course:criterion(patrol, 'skips nothing where nothing is the matter',
                 course_faults:patrols([])).

patrols(Closed, File) :-
    in_network(star(4), [], patrol(File, Closed)).

%   A stopped host refuses agents: it does not exist any more.

patrol(File, Closed, [Home|Hosts]) :-
    findall(Host, ( member(Host, Hosts), is_among(Host, Closed) ), Shut),
    findall(Host, ( member(Host, Hosts), \+ is_among(Host, Closed) ), Open),
    forall(member(Host, Shut), host_stop(Host)),
    on_host(File, Home, [todo(Hosts)], Agent),
    ended(Agent, Result),
    expect('the result', Result, patrol(Open, Shut)),
    findall(Fact, ( member(Host, [Home|Open]),
                    facts_on(Host, patrolled, Facts),
                    member(Fact, Facts) ), Found),
    length(Open, N),
    length(Found, Count),
    expect('the number of hosts with a mark', Count, N).

is_among(Host, Names) :-
    atomic_list_concat([Name|_], @, Host),
    memberchk(Name, Names).

                /*******************************
                *            PATIENT           *
                *******************************/

course:criterion(patient, 'gets in when the host is there at last',
                 course_faults:gets_in).
course:criterion(patient, 'waits longer each time',
                 course_faults:waits_longer).
course:criterion(patient, 'gives up in the end',
                 course_faults:gives_up).

gets_in(File) :-
    in_network(line(2), [], opens(File)).

opens(File, [Home|_]) :-
    on_host(File, Home, [goal('vault@virtual:0')], Agent),
    time_passes(Home, 20),
    setup_call_cleanup(
        host_start(vault, [clock(virtual), policy(guarded)]),
        ( time_passes(Home, 40),
          facts_on(vault, here, Found),
          expect('what it leaves on the host', Found, [here]),
          ended(Agent, Result),
          expect('the result', Result, got_in) ),
        host_stop(vault)).

%   It leaves tried(Time) at home each time.

waits_longer(File) :-
    in_network(line(2), [], waits(File)).

waits(File, [Home|_]) :-
    on_host(File, Home, [goal('vault@virtual:0')], Agent),
    ended(Agent, _),
    facts_on(Home, tried(_), Tried),
    findall(T, member(tried(T), Tried), Times),
    (   Times = [_, _, _, _|_],
        longer(Times)
    ->  true
    ;   expect('when it tried', Times, [0, 1, 3, 7])
    ).

longer([A, B, C|Times]) :-
    !,
    C-B > 1.5*(B-A),
    longer([B, C|Times]).
longer(_).

gives_up(File) :-
    in_network(line(2), [], never(File)).

never(File, [Home|_]) :-
    on_host(File, Home, [goal('vault@virtual:0')], Agent),
    ended_between(Agent, Home, 127, 135, Result),   % 1+2+4+...+64 s
    expect('the result', Result, gave_up).

                /*******************************
                *             GUARD            *
                *******************************/

course:criterion(guard, 'says what the worker has found',
                 course_faults:guards(finds, done(42))).
course:criterion(guard, 'takes over from a worker that is silent',
                 course_faults:guards(dies, took_over(3))).
course:criterion(guard, 'takes over from one that never began',
                 course_faults:guards(never, took_over(0))).
course:criterion(guard, 'is patient with a worker that is slow',
                 course_faults:guards(slow, done(42))).

guards(Kind, Expected, File) :-
    in_network(line(2), [], guard(File, Kind, Expected)).

%   When the guard knows: five seconds after the last beat, or at the end.

known_at(finds, 2).
known_at(dies, 8).
known_at(never, 5).
known_at(slow, 8).

guard(File, Kind, Expected, [Home, Host|_]) :-
    on_host(File, Home, Guard),
    agent_create(clauses([ (:- agent(worker, [state([kind/1])])),
                           (main :- kind(K), work(K)),
                           (work(finds) :- beat(1), beat(2),
                                           send(Guard, done(42))),
                           (work(dies) :- beat(1), beat(2), beat(3)),
                           work(never),
                           (work(slow) :- beat(1), sleep(3), beat(2), sleep(3),
                                          send(Guard, done(42))),
                           (beat(N) :- sleep(1), send(Guard, beat(N)))
                         ]),
                 _, [host(Host), facts([kind(Kind)])]),
    known_at(Kind, Time),
    Most is Time+1.5,
    ended_between(Guard, Home, Time, Most, Result),
    expect('the result', Result, Expected).
