:- module(test_travellers,
          [ travel/3,                   % +Peer, +Route, +Hops
            travel/4,                   % +Peer, +Route, +Hops, +Options
            set_out/4,                  % +Peer, +Route, +Hops, -Id
            set_out/5,                  % +Peer, +Route, +Hops, -Id, +Options
            heavy/5,                    % +Peer, +Route, +Hops, +Facts, -Id
            ended/3,                    % +Peer, +Id, +Outcome
            ended_done/3,               % +Peer, +Id, +Hops
            steps/2,                    % +Id, -Steps
            step_on/3,                  % +Peer, +Id, ?Step
            cloner/3,                   % +Peer, +Host, -Id
            swapper/4,                  % +Peer, +Hosts, +Rounds, -Id
            collector/4,                % +Peer, +Route, +Count, -Id
            collected/3,                % +Peer, +Id, -CountSum
            reader/4,                   % +Peer, +Host, +Count, -Id
            other_program/3             % +Peer, +Host, +Number
          ]).

/** <module> Agents for the tests of hops

*Threading*: for the main thread of a test.
*/

:- use_module(library(lists), [append/3, member/2, numlist/3]).
:- use_module(peers).

%!  travel(+Peer, +Route, +Hops) is semidet.
%!  travel(+Peer, +Route, +Hops, +Options) is semidet.
%
%   An agent that is created on Peer goes round Route for Hops hops, and leaves
%   step(Id, K) at every step: true if it makes each step once and ends.

travel(Peer, Route, Hops) :-
    travel(Peer, Route, Hops, []).

travel(Peer, Route, Hops, Options) :-
    set_out(Peer, Route, Hops, Id, Options),
    ended_done(Peer, Id, Hops).

%!  set_out(+Peer, +Route, +Hops, -Id) is det.
%!  set_out(+Peer, +Route, +Hops, -Id, +Options) is det.
%
%   Make that agent.  A stop `sit` of its route is not a host: it waits there
%   for a message.  It retries failed moves: a connection that is cut during
%   its handshake counts as none.

set_out(Peer, Route, Hops, Id) :-
    set_out(Peer, Route, Hops, Id, []).

set_out(Peer, Route, Hops, Id, Options) :-
    walker(Clauses),
    peer_do(Peer, agent_create(clauses(Clauses), Id,
                               [ host(Peer), facts([plan(Hops, Route)])
                               | Options ])).

%!  heavy(+Peer, +Route, +Hops, +Facts, -Id) is det.
%
%   As set_out/4; the agent carries so many facts.

heavy(Peer, Route, Hops, Facts, Id) :-
    walker([_, _|Clauses]),
    Heavy =
    [ (:- agent(heavy, [state([plan/2, facts/1, load/2])])),
      (main :- facts(Count),
           forall(between(1, Count, I), assertz(load(I, some(load)))),
           plan(All, Stops), walk(0, All, Stops))
    | Clauses ],
    peer_agent(Peer, Heavy, [plan(Hops, Route), facts(Facts)], Id).

walker([ (:- agent(walker, [state([plan/2])])),
         (main :- plan(Hops, Route), walk(0, Hops, Route)),
         (walk(K, Hops, _) :- K >= Hops, !, note(K)),
         (walk(K, Hops, [Stop|Stops]) :-
              note(K),
              go(Stop),
              append(Stops, [Stop], Route),
              K1 is K+1,
              walk(K1, Hops, Route)),
         (go(sit) :- !, receive(_-go)),
         (go(Host) :- catch(( move(Host), Gone = true ),
                            error(_, _),
                            Gone = sleep(0.01)),
                      arrive(Gone, Host)),
         arrive(true, _),
         (arrive(sleep(Seconds), Host) :- sleep(Seconds), go(Host)),
         (note(K) :- self(Id), leave(step(Id, K)))
       ]).

%!  ended(+Peer, +Id, +Outcome) is semidet.
%!  ended_done(+Peer, +Id, +Hops) is semidet.

ended(Peer, Id, Outcome) :-
    peer_do(Peer, agent_join(Id, Outcome0, 50)),
    call_or_print(Outcome0 == Outcome, outcome(Id, Outcome0)).

ended_done(Peer, Id, Hops) :-
    ended(Peer, Id, done),
    numlist(0, Hops, Expected),
    steps(Id, Steps),
    call_or_print(Steps == Expected, steps(Id, Steps)).

:- meta_predicate call_or_print(0, +).

call_or_print(Goal, Otherwise) :-
    (   call(Goal)
    ->  true
    ;   print_message(error, format("~p", [Otherwise])),
        fail
    ).

%!  steps(+Id, -Steps:list) is det.
%
%   The steps that Id has left anywhere, in order.

steps(Id, Steps) :-
    findall(K, ( peer_host(Peer, _), steps_on(Peer, Id, Ks), member(K, Ks) ),
            Steps0),
    msort(Steps0, Steps).

steps_on(Peer, Id, Steps) :-
    peer_do(Peer, steps_here(Id, Steps)).

step_on(Peer, Id, Step) :-
    steps_on(Peer, Id, Steps),
    memberchk(Step, Steps).

%!  swapper(+Peer, +Hosts, +Rounds, -Id) is det.
%
%   An agent that goes from the first to the second host and back, and
%   when it is refused tries again from the third.

swapper(Peer, [Here, There, Aside], Rounds, Id) :-
    Clauses =
    [ (:- agent(swapper, [state([hosts/3, rounds/1])])),
      (main :- receive(_-go),
               hosts(Here1, There1, Aside1), rounds(N),
               swap(N, Here1, There1, Aside1)),
      (swap(0, _, _, _) :- !),
      (swap(N, X, Y, Z) :- go(Y, Z), N1 is N-1, swap(N1, Y, X, Z)),
      (go(Y, Z) :- catch(( move(Y), Went = yes ),
                         error(move_refused(Y, capacity), _),
                         Went = no),
                   again(Went, Y, Z)),
      again(yes, _, _),
      (again(no, Y, Z) :- move(Z), sleep(0.001), go(Y, Z))
    ],
    peer_agent(Peer, Clauses, [hosts(Here, There, Aside), rounds(Rounds)], Id).

%!  reader(+Peer, +Host, +Count, -Id) is det.
%
%   An agent that goes to Host and there leaves I of each of the next Count
%   messages I-Text.

reader(Peer, Host, Count, Id) :-
    Clauses =
    [ (:- agent(reader, [])),
      (main :- move(Host), note(Count)),
      note(0),
      (note(N) :- N > 0, receive(_-(I-_)), leave(noted(I)), N1 is N-1,
                  note(N1))
    ],
    peer_agent(Peer, Clauses, [], Id).

%!  collector(+Peer, +Route, +Count, -Id) is det.
%!  collected(+Peer, +Id, -CountSum) is semidet.
%
%   An agent that hops until it has got Count messages n(I), and then leaves
%   their number and their sum.

collector(Peer, Route, Count, Id) :-
    Clauses =
    [ (:- agent(collector, [state([route/1, wanted/1, got/2])])),
      (main :- route(Route1), wanted(N), collect(N, Route1)),
      (collect(N, _) :- got(N, _), !, sleep(0.2), drain,
                        got(Count1, Sum), self(Self),
                        leave(got(Self, Count1, Sum))),
      (collect(N, [Host|Hosts]) :-
           drain,
           append(Hosts, [Host], Route2),
           move(Host),
           collect(N, Route2)),
      (drain :- (   receive(_-n(I), 0)
                ->  retract(got(Count2, Sum2)),
                    Count3 is Count2+1,
                    Sum3 is Sum2+I,
                    assertz(got(Count3, Sum3)),
                    drain
                ;   true
                ))
    ],
    peer_agent(Peer, Clauses, [route(Route), wanted(Count), got(0, 0)], Id).

collected(Peer, Id, Count-Sum) :-
    peer_do(Peer, remote(Peer, sense(got(Id, Count, Sum)))).

%!  cloner(+Peer, +Host, -Id) is det.
%
%   An agent that makes a clone on Host, which waits for `go`, and leaves
%   parent_of(Id, Clone).

cloner(Peer, Host, Id) :-
    Clauses =
    [ (:- agent(cloner, [state([there/1])])),
      (main :- there(There), clone(There, Branch), branch(Branch)),
      (branch(parent(Clone)) :- self(Self), leave(parent_of(Self, Clone))),
      (branch(clone(_)) :- receive(_-go))
    ],
    peer_agent(Peer, Clauses, [there(Host)], Id).

%!  other_program(+Peer, +Host, +Number) is semidet.
%
%   An agent of another program goes to Host and ends there.

other_program(Peer, Host, Number) :-
    Clauses = [ (:- agent(other, [state([to/1])])),
                (main :- to(Host1), move(Host1), seen(_)),
                seen(Number) ],
    peer_agent(Peer, Clauses, [to(Host)], Id),
    ended(Peer, Id, done).
