:- module(test_scripted_hops,
          [ with_scripted/2,            % +Way, :Goal
            scenario/2,                 % ?Scenario, -Links
            each_frame/5,               % +Scenario, +Program, +Link, +When,
                                        % +Action
            each_crash/6,               % +Scenario, +Program, +Link, +When,
                                        % +Peer, +Restart
            each_stop/5                 % +Scenario, +Program, +Link, +When,
                                        % +Act
          ]).

/** <module> Hops of agents with disturbed frames

Three processes a, b and c, each behind a proxy that knows frames. A scenario
is a sequence of actions of an agent that is created on a. Program is `known`,
`new`, if the processes do not have the program, or `forgotten`, if they have
discarded it.

  - there_and_back: it goes to b and comes back
  - ring: it goes to b, to c, and comes back
  - clone: it makes a clone on b
  - refused: it tries to move to a host of b that refuses it
  - follow: it goes to b, and ten messages are sent to it from a meanwhile
  - chase: it goes to b, and they are sent from c

Each agent leaves step(Tag, What) in the tuple space of the host it is on,
which reveals lost and repeated steps.

*Threading*: for the main thread of a test.
*/

:- use_module(common, [wait_until/2]).
:- use_module(frame_proxy, 
              [ frames_passed/2, go_on/0, happened/1, has_crashed/1,
                script/2, script_end/1 ]).
:- use_module(peers).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(gensym), [gensym/2]).
:- use_module(library(lists),
              [member/2, memberchk/2]).

:- meta_predicate with_scripted(+, 0).

%!  with_scripted(+Way, :Goal) is semidet.
%
%   Agents go the short way, if Way is `short`; they do not, as hosts have
%   options, if it is `long`; b alone has options, if it is `both`. The
%   processes notice within a second that a connection is mute, and keep one
%   program that none of their agents has.

with_scripted(Way, Goal) :-
    Settings = ( set_setting(typhon_reader:silence, 0.3),
                 set_setting(typhon_code:programs, 0) ),
    Options = [proxy(frames), setup(Settings)],
    findall(Peer-[host(HostOptions)|Options],
            ( member(Peer, [a, b, c]), way(Way, Peer, HostOptions) ),
            Specs),
    with_peers(Specs,
               ( prepare(b), meet, Goal )).

way(short, _, []).
way(long, _, [quota([messages(100000)])]).
way(both, Peer, Options) :-
    (   Peer == b
    ->  way(long, b, Options)
    ;   Options = []
    ).

prepare(b) :-
    !,
    peer_do(b, host_start(locked, [tokens([key])])).
prepare(_).

%   All processes know each other, and the program of walkers.

meet :-
    disturbed(ring, known, [], _),
    disturbed(ring, known, [], _).

%!  each_frame(+Scenario, +Program, +Link, +When, +Action) is det.
%!  each_crash(+Scenario, +Program, +Link, +When, +Peer, +Restart) is det.
%
%   Action, or the end of Peer, happens at frame 1 of Link, then at frame 2 and
%   so on, as long as there is such a frame. The action `cut_twice` is `cut` at
%   this and the next.
%
%   @error violated(What) see disturbed/4 and crashed/5.

%!  each_stop(+Scenario, +Program, +Link, +When, +Act) is det.
%
%   While frame 1 of Link waits, then while frame 2 does and so on, a queries
%   all properties of the agent, if Act is `look`, or disposes of it, if Act is
%   `dispose`.
%
%   @error violated(What) see stopped/5.

each_frame(Scenario, Program, Link, When, Action) :-
    each_number(Number, Happened,
                ( events(Action, Link, Number, When, Events),
                  disturbed(Scenario, Program, Events, Happened) )).

each_crash(Scenario, Program, Link, When, Peer, Restart) :-
    each_number(Number, Happened,
                crashed(Scenario, Program,
                        at(Link, Number, When, crash(Peer)),
                        Restart, Happened)).

each_stop(Scenario, Program, Link, When, Act) :-
    each_number(Number, Happened,
                stopped(Scenario, Program, at(Link, Number, When, stop), Act,
                        Happened)).

events(cut_twice, Link, Number, When,
       [at(Link, Number, When, cut), at(Link, Next, When, cut)]) :-
    !,
    Next is Number+1.
events(Action, Link, Number, When, [at(Link, Number, When, Action)]).

:- meta_predicate each_number(-, -, 0).

each_number(Number, Happened, Goal) :-
    between(1, inf, Number),
    (   catch(Goal, error(violated(What), _), violated(Goal, What))
    ->  Happened == []
    ;   violated(Goal, failed)
    ),
    !.

violated(_:Goal, What) :-
    throw(error(violated(What, Goal), _)).

:- multifile prolog:error_message//1.

prolog:error_message(violated(What, Goal)) -->
    [ 'Not as it should be: ~p'-[What], nl, 'after ~p'-[Goal] ].

		 /*******************************
		 *           SCENARIOS          *
		 *******************************/

%!  scenario(?Scenario, -Links) is nondet.
%
%   Scenario sends frames on Links.

scenario(there_and_back, [a-b, b-a]).
scenario(ring, [a-b, b-a, b-c, c-b, c-a, a-c]).
scenario(clone, [a-b, b-a]).
scenario(refused, [a-b, b-a]).
scenario(follow, [a-b, b-a]).
scenario(chase, [a-b, b-a, c-a, a-c, b-c, c-b]).

%   start(+Scenario, +Program, +Tag, +Patience, -Id): Id stays unbound if a has
%   died. Agents wait for messages for Patience seconds.

start(Scenario, Program, Tag, Patience, Id) :-
    program(Scenario, Program, Clauses),
    facts(Scenario, Tag, Patience, Facts),
    (   on(a, agent_create(clauses(Clauses), Id0,
                           [host(a), name(Tag), facts(Facts)]))
    ->  Id = Id0,
        forall(sender(Scenario, Sender),
               ( on(Sender, forall(between(1, 10, I), agent_send(Id, I)))
               ; true ))
    ;   true
    ).

sender(follow, a).
sender(chase, c).

%   As peer_do/2, but fails if Peer, or a process that Goal needs, has died.

on(Peer, Goal) :-
    catch(peer_do(Peer, Goal), error(Formal, _), peer_died(Formal)).

peer_died(Formal) :-
    (   crash_error(Formal)
    ->  fail
    ;   throw(error(Formal, _))
    ).

crash_error(system_error(peer_died(_))).
crash_error(io_error(_, _)).
crash_error(host_unreachable(_)).

facts(Scenario, Tag, Patience,
      [tag(Tag), patience(Patience), route(Hosts)]) :-
    route(Scenario, Peers),
    maplist(address, Peers, Hosts).

route(there_and_back, [b, a]).
route(ring, [b, c, a]).
route(clone, [b]).
route(refused, [locked]).
route(follow, [b]).
route(chase, [b]).

address(locked, Host) :-
    !,
    address(b, B),
    sub_atom(B, 1, _, 0, Endpoint),
    atom_concat(locked, Endpoint, Host).
address(Peer, Host) :-
    peer_host(Peer, Host).

program(Scenario, Program, Clauses) :-
    (   Program == new
    ->  gensym(program, Number)
    ;   Number = known
    ),
    kind(Scenario, Kind),
    findall(Clause, clause_of(Kind, Clause), Clauses0),
    Clauses = [ (:- agent(Kind, [state([tag/1, patience/1, route/1])])),
                made(Number)
              | Clauses0 ].

kind(there_and_back, walker).
kind(ring, walker).
kind(clone, parent).
kind(refused, refused).
kind(follow, reader).
kind(chase, reader).

clause_of(walker, (main :- route(Hosts), walk(0, Hosts))).
clause_of(walker, (walk(K, []) :- !, step(K))).
clause_of(walker, (walk(K, [Host|Hosts]) :- step(K), go(Host), K1 is K+1,
                                            walk(K1, Hosts))).
clause_of(parent, (main :- route([Host]),
                           catch(clone(Host, Branch), error(E, _), Branch = E),
                           Branch =.. [What|_], step(What))).
clause_of(refused, (main :- route([Host]),
                            catch(move(Host), error(E, _), true),
                            step(E))).
clause_of(reader, (main :- route([Host]), go(Host), note(10))).
clause_of(reader, (note(N) :- (   N > 0, patience(S), receive(_-I, S)
                              ->  step(I), N1 is N-1, note(N1)
                              ;   step(end(N)) ))).
clause_of(_, (go(Host) :- catch(( move(Host), E = none ), error(E, _), true),
                          went(E, Host))).
clause_of(_, (went(none, _) :- !)).
clause_of(_, (went(E, Host) :- step(E), sleep(0.01), go(Host))).
clause_of(_, (step(What) :- tag(Tag), leave(step(Tag, What)))).

		 /*******************************
		 *         DISTURBANCES         *
		 *******************************/

%   disturbed(+Scenario, +Program, +Events, -Happened) is det.
%
%   The result is the same as without Events, which kill no process.
%
%   Throws error(violated(What), _).

disturbed(Scenario, Program, Events, Happened) :-
    forget(Program),
    gensym(tag, Tag),
    script(Events, no_crash),
    start(Scenario, Program, Tag, 20, Id),
    peer_do(a, agent_join(Id, Outcome, 40)),
    demand(Outcome == done, outcome(Outcome)),
    resolved(Tag),
    script_end(Happened),
    steps(Tag, Steps),
    demand(as_without_events(Scenario, Steps), steps(Steps)).

forget(forgotten) :-
    !,
    disturbed(ring, new, [], _).
forget(_).

%   stopped(+Scenario, +Program, +Event, +Act, -Happened) is det.
%
%   The result is the same as without Event, or ends at some point.
%
%   Throws error(violated(What), _).

stopped(Scenario, Program, Event, Act, Happened) :-
    forget(Program),
    gensym(tag, Tag),
    script([Event], no_crash),
    start(Scenario, Program, Tag, 20, Id),
    wait_until(( happened([_]) ; peer_do(a, outcome_here(Id, _)) ), 40),
    script_end(Happened),
    act(Act, Id),
    go_on,
    peer_do(a, agent_join(Id, Outcome, 40)),
    resolved(Tag),
    steps(Tag, Steps),
    demand(ended_by(Act, Scenario, Outcome, Steps), steps(Outcome, Steps)).

%   Goals that need the held frame end later.

act(Act, Id) :-
    goal(Act, Id, Goal),
    peer_do(a, in_background(Goal)),
    catch(wait_until(peer_do(a, \+ background), 0.2),
          error(timeout_error(_, _), _),
          true).

goal(look, Id, forall(agent_property(Id, _), true)).
goal(dispose, Id, agent_dispose(Id)).

ended_by(look, Scenario, Outcome, Steps) :-
    Outcome == done,
    as_without_events(Scenario, Steps).
ended_by(dispose, Scenario, Outcome, Steps) :-
    (   Outcome == done
    ->  as_without_events(Scenario, Steps)
    ;   Outcome == disposed,
        findall(What, ( member(_-Whats, Steps), member(What, Whats) ), All),
        length(All, Count),
        sort(All, Set),
        length(Set, Count)
    ).

no_crash(Peer) :-
    throw(error(permission_error(crash, peer, Peer), _)).

%   as_without_events(+Scenario, +Steps)

as_without_events(there_and_back, [a-[0, 2], b-[1], c-[]]).
as_without_events(ring, [a-[0, 3], b-[1], c-[2]]).
as_without_events(clone, [a-[parent], b-[clone], c-[]]).
as_without_events(refused, [a-[move_refused(_, token)], b-[], c-[]]).
as_without_events(follow, [a-[], b-Steps, c-[]]) :-
    Steps == [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, end(0)].
as_without_events(chase, [a-[], b-Steps, c-[]]) :-
    msort(Steps, Sorted),
    Sorted == [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, end(0)].

%   steps(+Tag, -Steps): for each peer the facts left there, in order.

steps(Tag, Steps) :-
    findall(Peer-Whats,
            ( peer_host(Peer, _), peer_do(Peer, steps_here(Tag, Whats)) ),
            Steps).

%   No process has any data of the agent, not even in doubt.

resolved(Tag) :-
    wait_until(\+ ( peer_host(Peer, _),
                    peer_do(Peer, agent_named_here(Tag)) ), 40).

:- meta_predicate demand(0, +).

demand(Goal, What) :-
    (   call(Goal)
    ->  true
    ;   throw(error(violated(What), _))
    ).

		 /*******************************
		 *            CRASHES           *
		 *******************************/

%   crashed(+Scenario, +Program, +Event, +Restart, -Happened) is det.
%
%   Event crashes a process, which is restarted: at once if Restart is `now`;
%   if it is `later`, when an agent has found it dead, is in doubt or has
%   ended.
%
%   Throws error(violated(What), _).

crashed(Scenario, Program, Event, Restart, Happened) :-
    Event = at(_, _, _, crash(Peer)),
    forget(Program),
    gensym(tag, Tag),
    script([Event], peer_crash),
    start(Scenario, Program, Tag, 1, _),
    wait_until(( happened([_]) ; \+ on_any(has_agent(Tag)) ), 40),
    script_end(Happened),
    (   Happened == []
    ->  true
    ;   bring_back(Restart, Tag, Peer, Frames),
        resolved(Tag),
        steps(Tag, Steps),
        demand(agrees(Scenario, Peer, Frames, Steps), steps(Steps, Frames))
    ).

%   bring_back(+Restart, +Tag, +Peer, -Frames): Frames are those that other
%   processes had received from Peer, as Process-Count.

bring_back(Restart, Tag, Peer, Frames) :-
    wait_until(has_crashed(Peer), 30),
    peer_kill(Peer),
    findall(Other-Count,
            ( peer_host(Other, _), Other \== Peer,
              frames_passed(Peer-Other, Count) ),
            Frames),
    script([], no_crash),
    (   Restart == later
    ->  wait_until(( on_any(finds_it_gone(Tag)) ; on_any(is_in_doubt(Tag))
                   ; \+ on_any(has_agent(Tag)) ), 40)
    ;   true
    ),
    peer_restart(Peer),
    prepare(Peer).

:- meta_predicate on_any(1).

on_any(Goal) :-
    peer_host(Peer, _),
    call(Goal, Peer),
    !.

has_agent(Tag, Peer) :-
    on(Peer, agent_named_here(Tag)).

is_in_doubt(Tag, Peer) :-
    on(Peer, agent_named_here(Tag, in_doubt)).

finds_it_gone(Tag, Peer) :-
    on(Peer, steps_here(Tag, Steps)),
    member(Step, Steps),
    is_gone(Step).

is_gone(host_unreachable).
is_gone(host_unreachable(_)).

%   agrees(+Scenario, +Peer, +Frames, +Steps): the guarantees of doc/agents.md
%   when Peer dies. An agent that Peer had accepted, or whose arrival is
%   unknown, may be lost.

agrees(clone, Peer, _, [a-A, b-B, c-[]]) :-
    !,
    clone_agrees(Peer, A, B).
agrees(refused, Peer, _, [a-A, b-[], c-[]]) :-
    !,
    refused_agrees(Peer, A).
agrees(Scenario, Peer, Frames, Steps) :-
    findall(What, ( member(_-Whats, Steps), member(What, Whats),
                    \+ is_gone(What) ),
            All),
    msort(All, Sorted),
    sort(All, Sorted),                  % each step once
    (   ends(Scenario, Host, End),
        memberchk(Host-Ends, Steps),
        memberchk(End, Ends)
    ->  messages_agree(Scenario, Peer, Frames, All)
    ;   may_be_lost(Scenario, Peer, Frames, All)
    ).

clone_agrees(a, [], []) :-
    !.
clone_agrees(a, [], [clone]).
clone_agrees(b, [host_unreachable], []).
clone_agrees(b, [parent], []).
clone_agrees(b, [parent], [clone]).     % of the restarted process

refused_agrees(a, []).
refused_agrees(b, [host_unreachable(_)]).
refused_agrees(b, [move_refused(_, Why)]) :-
    memberchk(Why, [token, unknown_host]).  % that host starts a little later

ends(there_and_back, a, 2).
ends(ring, a, 3).
ends(follow, b, end(_)).
ends(chase, b, end(_)).

%   Messages are lost with a process that has received them.

messages_agree(Scenario, Peer, Frames, All) :-
    findall(I, ( member(I, All), integer(I) ), Numbers),
    (   Scenario == follow
    ->  msort(Numbers, Numbers)         % in order
    ;   true
    ),
    (   Scenario == follow,
        Peer == b,
        memberchk(a-0, Frames)          % a is not notified of the arrival
    ->  length(Numbers, 10)
    ;   true
    ).

%   may_be_lost(+Scenario, +Peer, +Frames, +All): a process that has not
%   released the agent still has it.

may_be_lost(_, a, _, []) :-             % the agent had not left
    !.
may_be_lost(Scenario, a, _, All) :-     % the agent may have returned
    !,
    memberchk(Scenario, [there_and_back, ring]),
    last_before_home(Scenario, Last),
    memberchk(Last, All).
may_be_lost(Scenario, Peer, Frames, _) :-
    notified(Scenario, Peer, Other),
    memberchk(Other-Count, Frames),
    Count > 0,
    !.

last_before_home(there_and_back, 1).
last_before_home(ring, 2).

%   notified(+Scenario, +Peer, -Other): Other is notified of the arrival at
%   Peer, which implies that the agent is lost with Peer.

notified(there_and_back, b, a).
notified(ring, b, a).
notified(ring, c, b).
notified(ring, c, a).                   % its home
notified(follow, b, a).
notified(chase, b, a).
