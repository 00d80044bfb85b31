:- module(typhon_watched_agents,
          [ watched_add/2,              % +Agent, +Asker
            orphans_end/1,              % +Agents
            others_ask/2                % +Question, -Results
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(ordsets), [ord_subtract/3, ord_union/2]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_ask_all/6, endpoint_gone/1,
                endpoint_peer/2, endpoint_reply/2 ]).
:- use_module('../../kernel/host',
              [address_parts/3, alarm_in/3, peer_may/3, scheduler_call/1]).
:- use_module('../../kernel/lifecycle', [agent_ask_here/4]).
:- use_module('../../kernel/agent', [agent_on/2]).
:- use_module(failed_processes, [process_suspect/1]).
:- use_module('../../kernel/travel',
              [agent_outcome/2, home_knows/4, outcome_wait/3]).

/** <module> Agents that are monitored, at their home

The home of an agent gets its outcome when it ends.  If a process is gone, all
known processes get a request for the monitored agents that are not at home,
twice, a second apart.  An agent that no process has, and of which the home
received no news meanwhile, is lost, and is ended if it reappears.  While
processes live this costs nothing: hops of agents, monitored or not, take the
same time.

*Threading*: a worker sends the requests to all processes.
*/

:- multifile
    typhon_failed_processes:detection_needed/0,
    typhon_failed_processes:process_failed/1,
    typhon_endpoint:requested/4,
    typhon_identity:ids_anew/0,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- dynamic
    asker/3,                    % Agent, N, Asker: waits for its end
    looks_again/0.              % an alarm is set for another round

typhon_identity:ids_anew :-
    forget.

typhon_runtime:ending(after) :-
    forget.

forget :-
    retractall(asker(_, _, _)),
    retractall(looks_again).

pause(1).                       % seconds between two rounds
patience(5).                    % seconds for the answers

%!  watched_add(+Agent, +Asker) is det.
%
%   Send Asker once the outcome of Agent, whose home is here, as of
%   outcome_wait/3, or lost(Host).
%
%   @arg Asker is reply(ReplyTo) or call(Closure)

watched_add(Agent, Asker) :-
    flag(typhon_watched_agent, N, N+1),
    assertz(asker(Agent, N, Asker)),
    outcome_wait(Agent, inf, call(typhon_watched_agents:over(Agent, N))),
    ( asker(Agent, N, _) -> went_to(Agent) ; true ).

%   A connection that is already down will not report that it breaks.

went_to(Agent) :-
    home_knows(Agent, Address, _, Process),
    Process \== here,
    !,
    address_parts(Address, _, Endpoint),
    (   endpoint_peer(Endpoint, process(Process)),
        endpoint_peer(Endpoint, state(up))
    ->  true
    ;   is_gone(Address, Process)
    ->  scheduler_call(typhon_watched_agents:look_for_all)
    ;   process_suspect(Endpoint)
    ).
went_to(_).

:- public over/3.

over(Agent, N, Outcome) :-
    (   retract(asker(Agent, N, Asker))
    ->  answer(Asker, Outcome)
    ;   true
    ).

answer(call(Closure), Outcome) :-
    call(Closure, Outcome).
answer(reply(ReplyTo), Outcome) :-
    endpoint_reply(ReplyTo, Outcome).

typhon_endpoint:requested(monitor, watch(Agent), _, ReplyTo) :-
    must_be(atom, Agent),
    watched_add(Agent, reply(ReplyTo)).

                /*******************************
                *      PROCESSES THAT END      *
                *******************************/

typhon_failed_processes:detection_needed :-
    asker(_, _, _),
    !.

typhon_failed_processes:process_failed(_) :-
    look_for_all.

look_for_all :-
    absent(Absent),
    (   Absent == []
    ->  true
    ;   missing(Absent, Missing),
        pause(Seconds),
        alarm_in(Seconds, watched, missing(Missing))
    ).

typhon_scheduler:fire(_, missing(Missing)) :-
    !,
    scheduler_call(typhon_watched_agents:look_again(Missing)).

:- public look_for_all/0, look_again/1.

look_again(Before) :-
    absent(Now),
    findall(One, ( member(One, Before), memberchk(One, Now) ), Still),
    missing(Still, Lost),
    all_lost(Lost),
    look_later.

%   An agent may have been in transit during the first round.

all_lost([]) :-
    !.
all_lost(Lost) :-
    findall(Agent, member(at(Agent, _, _, _), Lost), Agents),
    orphans_end(Agents),
    forall(member(at(Agent, Address, _, _), Lost),
           lost(Agent, Address)).

%   An agent that moves to a process that dies is there according to its home,
%   while its source keeps it in doubt: the search continues until its home has
%   other news.

look_later :-
    absent(Absent),
    (   \+ looks_again,
        member(at(_, Address, _, Process), Absent),
        is_gone(Address, Process)
    ->  assertz(looks_again),
        pause(Seconds),
        alarm_in(Seconds, watched, look)
    ;   true
    ).

typhon_scheduler:fire(_, look) :-
    !,
    retractall(looks_again),
    scheduler_call(typhon_watched_agents:look_for_all).

is_gone(Address, Process) :-
    address_parts(Address, _, Endpoint),
    (   endpoint_gone(Endpoint)
    ->  true
    ;   Process \== unknown,
        endpoint_peer(Endpoint, process(Now)),
        Now \== Process
    ).

lost(Agent, Address) :-
    (   retract(asker(Agent, _, Asker))
    ->  answer(Asker, lost(Address)),
        lost(Agent, Address)
    ;   true
    ).

%   absent(-Absent): at(Agent, Address, Hops, Process) for monitored agents that
%   are not in this process, with their last known place.

absent(Absent) :-
    findall(at(Agent, Address, Hops, Process),
            ( asker(Agent, _, _),
              \+ agent_on(Agent, _),
              \+ agent_outcome(Agent, _),
              home_knows(Agent, Address, Hops, Process) ),
            Absent0),
    sort(Absent0, Absent).

%   missing(+Absent, -Missing): no process has them, and their last processes
%   are gone, or have answered.

missing([], []) :-
    !.
missing(Absent, Missing) :-
    findall(Agent, member(at(Agent, _, _, _), Absent), Agents),
    others_ask(have(Agents), Results),
    exclude(may_be_found(Results), Absent, Missing).

%!  others_ask(+Question, -Results:list) is det.
%
%   Ask all known processes, and wait: Results are as of endpoint_ask_all/6.

others_ask(Question, Results) :-
    others(Peers),
    ask(Peers, Question, Results).

ask(Peers, Question, Results) :-
    patience(Seconds),
    endpoint_ask_all(Peers, monitor, Question, typhon_watched_agents:none,
                     Seconds, Results).

:- public none/2.

none(_, []).

%   others(-Peers:ordset): known processes that are not gone.

others(Peers) :-
    findall(Peer,
            ( endpoint_peer(Peer, process(_)),
              \+ endpoint_address(Peer),
              \+ endpoint_gone(Peer) ),
            Peers0),
    sort(Peers0, Peers).

may_be_found(Results, at(Agent, _, _, _)) :-
    member(_-answer(Agents), Results),
    is_list(Agents),
    memberchk(Agent, Agents),
    !.
may_be_found(Results, at(_, Address, _, _)) :-
    address_parts(Address, _, Endpoint),
    \+ memberchk(Endpoint-answer(_), Results),
    \+ endpoint_gone(Endpoint).

typhon_endpoint:requested(monitor, have(Agents), _, ReplyTo) :-
    must_be(list(atom), Agents),
    findall(Agent, ( member(Agent, Agents), agent_on(Agent, _) ), Here),
    endpoint_reply(ReplyTo, Here).

                /*******************************
                *            ORPHANS           *
                *******************************/

%!  orphans_end(+Agents) is det.
%
%   Agents, whose home is gone, are disposed of in all reachable processes, each
%   of which asks the processes that it knows.  This is repeated after 1, 2, 4
%   and more seconds, since an agent may be in transit.  Waits for the answers.

orphans_end(Agents) :-
    end_everywhere(Agents, []),
    pause(Seconds),
    alarm_in(Seconds, watched, orphans(Agents, Seconds)).

last_pause(64).

typhon_scheduler:fire(_, orphans(Agents, Seconds)) :-
    !,
    scheduler_call(typhon_watched_agents:end_everywhere(Agents, [])),
    Next is 2*Seconds,
    last_pause(Last),
    (   Next =< Last
    ->  alarm_in(Next, watched, orphans(Agents, Next))
    ;   true
    ).

:- public end_everywhere/2, end_asked/4.

%   end_everywhere(+Agents, +Asked): the processes Asked have been asked.

end_everywhere(Agents, Asked) :-
    forall(member(Agent, Agents), end_here(Agent)),
    others(Peers0),
    ord_subtract(Peers0, Asked, Peers),
    endpoint_address(Me),
    ord_union([[Me], Peers, Asked], All),
    ask(Peers, end(Agents, All), _).

typhon_endpoint:requested(monitor, end(Agents, Asked), Peer, ReplyTo) :-
    must_be(list(atom), Agents),
    must_be(list(atom), Asked),
    scheduler_call(typhon_watched_agents:end_asked(Agents, Asked, Peer,
                                                   ReplyTo)).

end_asked(Agents0, Asked0, Peer, ReplyTo) :-
    exclude(may_not_end(Peer), Agents0, Agents),
    sort(Asked0, Asked),
    end_everywhere(Agents, Asked),
    endpoint_reply(ReplyTo, ok).

may_not_end(Peer, Agent) :-
    agent_on(Agent, Host),
    \+ peer_may(Peer, Host, orders).

end_here(Agent) :-
    patience(Seconds),
    catch(ignore(agent_ask_here(Agent, dispose, Seconds, _)), error(_, _),
          true).
