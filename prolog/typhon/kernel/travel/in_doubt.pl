:- module(typhon_in_doubt,
          [ resolve_in_doubt/1,         % +Transfer
            may_have_arrived/1,         % +Transfer
            in_doubt/1,                 % +Status
            out_of_touch/1              % +Status
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_call/5, endpoint_gone/1,
                endpoint_lasting/1, endpoint_peer/2, endpoint_reply/2,
                endpoint_request/4 ]).
:- use_module('../host', [address_parts/3, alarm_in/3, scheduler_call/1]).
:- use_module('../agent', [agent/5, agent_home_endpoint/2, life_hops/2]).
:- use_module(transfer,
              [ transfer_again/2, transfer_arrived/1, transfer_image/2,
                transfer_open/1, transfer_repeated/2, transfer_stays/2,
                transfer_traveller/3, transfer_unreachable/1 ]).
:- use_module(whereabouts,
              [agent_heard_of/2, agent_last_seen/2, agent_outcome/2]).

/** <module> Transfers in doubt

A transfer is in doubt if the process to which the agent was sent is gone before
it has answered.  If the home of the agent knows of this hop or a later one, the
agent had left that process in time.  If not, the news may be under way, or the
home was restarted, or died together with that process: this process asks all
processes that it knows.  If none has seen the agent, it has not survived there,
and continues here.

If the other process keeps a journal, this process asks only that process, until
it is back: it knows the agents that it has admitted.  The same holds for a
process that is alive, if this process was restarted.

*Threading*: resolve_in_doubt/1 in reader threads, which never wait;
ask_peers/2 in a worker.
*/

:- setting(shown_seconds, number, 3,
           "Seconds under way after which an agent is shown as in doubt").
:- setting(settle_seconds, number, 1,
           "Seconds until processes that did not answer are asked again").

:- multifile
    again/1,                    % Transfer: request it once more
    typhon_durable:go_on/0,
    typhon_endpoint:requested/4,
    typhon_scheduler:fire/2.

%!  resolve_in_doubt(+Transfer) is det.
%
%   Start to find out whether the agent has arrived.

resolve_in_doubt(Transfer) :-
    transfer_traveller(Transfer, Agent, Hops),
    lasts(Transfer),
    !,
    debug(typhon(hop), '~w hop ~D: in doubt, is sent again', [Agent, Hops]),
    transfer_again(Agent, Hops),
    arg(1, Transfer, Id),
    setting(settle_seconds, Seconds),
    alarm_in(Seconds, Id, again(Transfer)).
resolve_in_doubt(_) :-
    \+ endpoint_address(_),             % this process ends: nothing to ask
    !.
resolve_in_doubt(Transfer) :-
    transfer_traveller(Transfer, Id, Hops),
    debug(typhon(hop), '~w hop ~D: in doubt', [Id, Hops]),
    setting(typhon_news:news_pause, Pause),
    Seconds is 4*Pause,                 % news for the home may pause, too
    alarm_in(Seconds, Id, doubted(Transfer)).

typhon_scheduler:fire(_, doubted(Transfer)) :-
    !,
    transfer_traveller(Transfer, Id, Hops),
    agent_reached(Id, Hops, home_answered(Transfer)).

%   The receiver keeps a journal, or is alive: only it can answer, and it will.

lasts(Transfer) :-
    arg(2, Transfer, dest(_, _, Endpoint)),
    endpoint_lasting(Endpoint),
    !.
lasts(Transfer) :-
    arg(2, Transfer, dest(_, _, Endpoint)),
    may_have_arrived(Transfer),
    \+ endpoint_gone(Endpoint).

typhon_scheduler:fire(_, again(Transfer)) :-
    !,
    scheduler_call(again(Transfer)).

%!  may_have_arrived(+Transfer) is semidet.
%
%   The agent may have arrived, though the connection failed this time.

may_have_arrived(Transfer) :-
    transfer_traveller(Transfer, Agent, Hops),
    transfer_repeated(Agent, Hops).

typhon_durable:go_on :-
    findall(Transfer, transfer_open(Transfer), Transfers),
    forall(member(Transfer, Transfers),
           scheduler_call(typhon_in_doubt:again(Transfer))).

home_answered(Transfer, answer(true)) :-
    !,
    transfer_arrived(Transfer).
home_answered(Transfer, answer(Answer)) :-
    !,
    ( Answer == false -> Reached = false ; Reached = unknown ),
    scheduler_call(ask_peers(Transfer, Reached)).
home_answered(Transfer, _) :-
    transfer_traveller(Transfer, Id, _),
    agent_home_endpoint(Id, Endpoint),
    (   endpoint_gone(Endpoint)
    ->  scheduler_call(ask_peers(Transfer, unknown))
    ;   settle_later(Transfer)
    ).

settle_later(Transfer) :-
    setting(settle_seconds, Seconds),
    arg(1, Transfer, Id),
    alarm_in(Seconds, Id, settle(Transfer)).

typhon_scheduler:fire(_, settle(Transfer)) :-
    !,
    (   transfer_image(Transfer, _)
    ->  resolve_in_doubt(Transfer)
    ;   transfer_stays(Transfer, given_up)
    ).

%   ask_peers(+Transfer, +HomeAnswer): in a worker.  If the home has run all the
%   time and does not know the hop, processes that do not answer do not matter;
%   if not, they might have the agent.

ask_peers(Transfer, HomeAnswer) :-
    transfer_traveller(Transfer, Id, Hops),
    findall(Answer,
            ( endpoint_peer(Peer, process(_)),
              ask_peer(Peer, Id, Hops, Answer)
            ),
            All),
    (   memberchk(true, All)
    ->  transfer_arrived(Transfer)
    ;   HomeAnswer == unknown,
        memberchk(nothing, All)
    ->  settle_later(Transfer)
    ;   transfer_unreachable(Transfer)
    ).

ask_peer(Peer, Id, Hops, Answer) :-
    catch(endpoint_call(Peer, whereabouts, reached(Id, Hops),
                        answer(Answer0), 5),
          error(_, _),
          no_answer(Peer, Answer0)),
    ( Answer0 = not_permitted(_) -> Answer = unknown ; Answer = Answer0 ).

no_answer(Peer, Answer) :-
    (   endpoint_gone(Peer)
    ->  Answer = false
    ;   Answer = nothing
    ).

                /*******************************
                *         HAS IT ARRIVED?      *
                *******************************/

%   agent_reached(+Id, +Hops, :OnAnswer)
%
%   Ask the home of Id.  Call OnAnswer with answer(Reached): `true` or `false`,
%   whether Id has made Hops hops as far as its home knows, or `unknown` if the
%   home was started after Id was born there; or with the result of
%   endpoint_request/4 if the home does not answer.

agent_reached(Id, Hops, OnAnswer) :-
    agent_home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  reached(Id, Hops, Reached),
        call(OnAnswer, answer(Reached))
    ;   endpoint_request(Home, whereabouts, reached(Id, Hops), OnAnswer)
    ).

typhon_endpoint:requested(whereabouts, reached(Id, Hops), _, ReplyTo) :-
    reached(Id, Hops, Reached),
    endpoint_reply(ReplyTo, Reached).

%   The tables are read in this order because an agent that leaves or ends
%   meanwhile is noted in the later ones before it is removed from the first.

reached(Id, Hops, true) :-
    (   hops_here(Id, Hops0)
    ;   agent_heard_of(Id, Hops0)
    ),
    Hops0 >= Hops,
    !.
reached(Id, _, true) :-
    agent_outcome(Id, _),
    !.
reached(Id, _, false) :-
    (   hops_here(Id, _)
    ;   agent_last_seen(Id, _)
    ),
    !.
reached(_, _, unknown).

hops_here(Id, Hops) :-
    agent(Id, _, _, _, Life),
    life_hops(Life, Hops).

                /*******************************
                *           OVERDUE            *
                *******************************/

%!  in_doubt(+Status) is semidet.
%
%   The answer is overdue, or the connection on which it should come is broken.
%
%   @arg Status is transit(Address, Sent) or cloning(Address, Sent)

in_doubt(Status) :-
    (   down(Status)
    ;   overdue(Status)
    ),
    !.

%!  out_of_touch(+Status) is semidet.
%
%   The answer is overdue and the connection is broken.  An order to end the
%   agent, which follows the agent before that, is then carried out here.

out_of_touch(Status) :-
    overdue(Status),
    down(Status).

down(Status) :-
    arg(1, Status, Address),
    address_parts(Address, _, Endpoint),
    endpoint_peer(Endpoint, state(down)),
    !.

overdue(Status) :-
    arg(2, Status, Sent),
    monotonic_time(Now),
    setting(typhon_in_doubt:shown_seconds, Limit),
    Now-Sent > Limit.
