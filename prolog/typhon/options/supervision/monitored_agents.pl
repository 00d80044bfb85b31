:- module(typhon_monitored_agents,
          [ monitored_add/2,            % +Agent, +Request
            orphans_end/1,              % +Agents
            peers_ask/2                 % +Question, -Results
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(ordsets), [ord_subtract/3, ord_union/2]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_ask_all/6, endpoint_gone/1,
                endpoint_peer/2, endpoint_reply/2 ]).
:- use_module('../../kernel/host',
              [address_parts/3, alarm_in/3, scheduler_call/1]).
:- use_module('../../kernel/lifecycle', [agent_ask_here/4]).
:- use_module('../../kernel/agent', [agent_on/2]).
:- use_module(failed_processes, [process_suspect/1]).
:- use_module('../../kernel/travel',
              [agent_outcome/2, home_knows/4, outcome_wait/3]).

/** <module> Agents that are monitored, at their home

The home of an agent gets its outcome when it ends.  If a process is gone, the
home asks all known processes, twice, a second apart, which of the monitored
agents that are not at home they have.  An agent that no process has, and of
which the home received no news meanwhile, is reported as lost, and is disposed
of if it reappears.  While processes live this costs nothing: hops of agents,
monitored or not, take the same time.

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
    outcome_request/3,          % Agent, N, Request
    search_set/0.               % an alarm is set for another search

typhon_identity:ids_anew :-
    forget.

typhon_runtime:ending(after) :-
    forget.

forget :-
    retractall(outcome_request(_, _, _)),
    retractall(search_set).

pause(1).                       % seconds between two rounds
patience(5).                    % seconds for the answers

%!  monitored_add(+Agent, +Request) is det.
%
%   Answer Request once with the outcome of Agent, whose home is here: that of
%   outcome_wait/3, or lost(Host).
%
%   @arg Request is reply(ReplyTo) or call(Closure)

monitored_add(Agent, Request) :-
    flag(typhon_monitored_agent, N, N+1),
    assertz(outcome_request(Agent, N, Request)),
    outcome_wait(Agent, inf,
                 call(typhon_monitored_agents:agent_down(Agent, N))),
    ( outcome_request(Agent, N, _) -> check_process(Agent) ; true ).

%   A connection that has broken before will not be reported, so it is checked.

check_process(Agent) :-
    home_knows(Agent, Address, _, Process),
    Process \== here,
    !,
    address_parts(Address, _, Endpoint),
    (   endpoint_peer(Endpoint, process(Process)),
        endpoint_peer(Endpoint, state(up))
    ->  true
    ;   has_failed(Address, Process)
    ->  scheduler_call(typhon_monitored_agents:search_missing)
    ;   process_suspect(Endpoint)
    ).
check_process(_).

:- public agent_down/3.

agent_down(Agent, N, Outcome) :-
    (   retract(outcome_request(Agent, N, Request))
    ->  send_outcome(Request, Outcome)
    ;   true
    ).

send_outcome(call(Closure), Outcome) :-
    call(Closure, Outcome).
send_outcome(reply(ReplyTo), Outcome) :-
    endpoint_reply(ReplyTo, Outcome).

typhon_endpoint:requested(monitor, watch(Agent), _, ReplyTo) :-
    monitored_add(Agent, reply(ReplyTo)).

                /*******************************
                *      PROCESSES THAT END      *
                *******************************/

typhon_failed_processes:detection_needed :-
    outcome_request(_, _, _),
    !.

typhon_failed_processes:process_failed(_) :-
    search_missing.

search_missing :-
    absent(Absent),
    (   Absent == []
    ->  true
    ;   missing(Absent, Missing),
        pause(Seconds),
        alarm_in(Seconds, monitored, missing(Missing))
    ).

typhon_scheduler:fire(_, missing(Missing)) :-
    !,
    scheduler_call(typhon_monitored_agents:search_again(Missing)).

:- public search_missing/0, search_again/1.

search_again(Before) :-
    absent(Now),
    findall(One, ( member(One, Before), memberchk(One, Now) ), Still),
    missing(Still, Lost),
    report_all_lost(Lost),
    search_later.

%   An agent may have been in transit during the first round, so only an agent
%   that is missing in both rounds is reported as lost.

report_all_lost([]) :-
    !.
report_all_lost(Lost) :-
    findall(Agent, member(at(Agent, _, _, _), Lost), Agents),
    orphans_end(Agents),
    forall(member(at(Agent, Address, _, _), Lost),
           report_lost(Agent, Address)).

%   If an agent was moving to a process that died, its home takes it to be in
%   that process, while its source has it in doubt and answers that it has it.
%   So the search is repeated until the home has other news.

search_later :-
    absent(Absent),
    (   \+ search_set,
        member(at(_, Address, _, Process), Absent),
        has_failed(Address, Process)
    ->  assertz(search_set),
        pause(Seconds),
        alarm_in(Seconds, monitored, search)
    ;   true
    ).

typhon_scheduler:fire(_, search) :-
    !,
    retractall(search_set),
    scheduler_call(typhon_monitored_agents:search_missing).

has_failed(Address, Process) :-
    address_parts(Address, _, Endpoint),
    (   endpoint_gone(Endpoint)
    ->  true
    ;   Process \== unknown,
        endpoint_peer(Endpoint, process(Now)),
        Now \== Process
    ).

report_lost(Agent, Address) :-
    (   retract(outcome_request(Agent, _, Request))
    ->  send_outcome(Request, lost(Address)),
        report_lost(Agent, Address)
    ;   true
    ).

%   absent(-Absent): Absent are at(Agent, Address, Hops, Process) for monitored
%   agents that are not in this process, with their last known location.

absent(Absent) :-
    findall(at(Agent, Address, Hops, Process),
            ( outcome_request(Agent, _, _),
              \+ agent_on(Agent, _),
              \+ agent_outcome(Agent, _),
              home_knows(Agent, Address, Hops, Process) ),
            Absent0),
    sort(Absent0, Absent).

%   missing(+Absent, -Missing): Missing are the agents of Absent that no process
%   has, and whose last known processes are gone, or have answered.

missing([], []) :-
    !.
missing(Absent, Missing) :-
    findall(Agent, member(at(Agent, _, _, _), Absent), Agents),
    peers_ask(have(Agents), Results),
    exclude(may_be_found(Results), Absent, Missing).

%!  peers_ask(+Question, -Results:list) is det.
%
%   Send Question to all known processes, and wait: Results are those of
%   endpoint_ask_all/6.

peers_ask(Question, Results) :-
    other_processes(Peers),
    ask(Peers, Question, Results).

ask(Peers, Question, Results) :-
    patience(Seconds),
    endpoint_ask_all(Peers, monitor, Question,
                     typhon_monitored_agents:no_forward, Seconds, Results).

:- public no_forward/2.

no_forward(_, []).

%   other_processes(-Peers:ordset): Peers are the known processes that are not
%   gone.

other_processes(Peers) :-
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
    findall(Agent, ( member(Agent, Agents), agent_on(Agent, _) ), Here),
    endpoint_reply(ReplyTo, Here).

                /*******************************
                *            ORPHANS           *
                *******************************/

%!  orphans_end(+Agents) is det.
%
%   Dispose of Agents, whose home is gone, in all reachable processes, each of
%   which forwards the request to the processes that it knows.  This is repeated
%   after 1, 2, 4 and more seconds, since an agent may be in transit.  Waits for
%   the answers.

orphans_end(Agents) :-
    end_everywhere(Agents, []),
    pause(Seconds),
    alarm_in(Seconds, monitored, orphans(Agents, Seconds)).

last_pause(64).

typhon_scheduler:fire(_, orphans(Agents, Seconds)) :-
    !,
    scheduler_call(typhon_monitored_agents:end_everywhere(Agents, [])),
    Next is 2*Seconds,
    last_pause(Last),
    (   Next =< Last
    ->  alarm_in(Next, monitored, orphans(Agents, Next))
    ;   true
    ).

:- public end_everywhere/2, end_asked/3.

%   end_everywhere(+Agents, +Asked): dispose of Agents here and in all known
%   processes, except in Asked, which have got the request.

end_everywhere(Agents, Asked) :-
    forall(member(Agent, Agents), end_here(Agent)),
    other_processes(Peers0),
    ord_subtract(Peers0, Asked, Peers),
    endpoint_address(Me),
    ord_union([[Me], Peers, Asked], All),
    ask(Peers, end(Agents, All), _).

typhon_endpoint:requested(monitor, end(Agents, Asked), _, ReplyTo) :-
    scheduler_call(typhon_monitored_agents:end_asked(Agents, Asked, ReplyTo)).

end_asked(Agents, Asked0, ReplyTo) :-
    sort(Asked0, Asked),
    end_everywhere(Agents, Asked),
    endpoint_reply(ReplyTo, ok).

end_here(Agent) :-
    patience(Seconds),
    catch(ignore(agent_ask_here(Agent, dispose, Seconds, _)), error(_, _),
          true).
