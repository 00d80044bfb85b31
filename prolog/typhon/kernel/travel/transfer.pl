:- module(typhon_transfer,
          [ transfer_traveller/3,       % +Transfer, -Id, -Hops
            transfer_image/5,           % +Transfer, +Held, +Mail, +Since,
                                        % -Image
            transfer_image/2,           % +Transfer, -Image
            transfer_image/3,           % +Transfer, -Image, -Held
            transfer_freeze/4,          % +Transfer, +Held, -Mail, +Since
            transfer_arrived/1,         % +Transfer
            transfer_stays/2,           % +Transfer, +Error
            transfer_unreachable/1,     % +Transfer
            transfer_parked/1,          % +Transfer
            transfer_unpark/1,          % +Transfer
            transfer_let_go/4,          % +Id, -Mail, -Orders, -Gone
            transfer_given_up/2,        % +Id, +Frozen
            transfer_held/2,            % +Frozen, -Held
            transfer_open/1,            % ?Transfer
            transfer_again/2,           % +Id, +Hops
            transfer_over/2,            % +Id, ?Hops
            hop_label/3,                % +Id, +Endpoint, -Label
            move_awaited/2,             % +Id, +Asker
            move_failed/2,              % +Id, +Formal
            move_over/2,                % +Id, +Answer
            resolve_in_doubt/1,         % +Transfer
            may_have_arrived/1,         % +Transfer
            in_doubt/1,                 % +Status
            out_of_touch/1              % +Status
          ]).

/** <module> Agents under way

A transfer is transfer(Id, Dest, Hops), with the id of the agent and the number
of the hop, or clone_transfer(Id, Dest, CloneId).  Dest is
dest(Address, Name, Endpoint). During the transfer the agent is frozen in this
process; the transfer ends when the agent has arrived, or stays.

The held goals are Hole-Goals, for a clone Hole-Goals-Role.  While the agent is
frozen its goals are hop(Held, Hops, Mail, Since) or
clone(Held, CloneId, Since).  In place of the hole there is `ordered` if the move
was an order, and wait(Hole, Until) if the agent may wait for a host that cannot
be reached; parked(Hole, Until) from the moment at which it is offered to the hook
parks/2 until the image is sent: so it is not in doubt.

A transfer is in doubt if the process to which the agent was sent is gone before
it has answered.  If the home of the agent knows of this hop or a later one, the
agent had left that process in time.  If not, the news may be under way, or the
home was restarted, or died together with that process: this process asks all
processes that it knows.  If none has seen the agent, it has not survived there,
and continues here.

If the other process keeps a journal, this process asks only that process, until
it is back: it knows the agents that it has admitted.  The same holds for a
process that is alive, if this process was restarted.

*Threading*: any thread; inside with_agent/2 where a comment says so.
resolve_in_doubt/1 in reader threads, which never wait; ask_peers/2 in a worker.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../agent',
              [ agent/5, agent_home_endpoint/2, agent_put/3, agent_ready/2,
                agent_remove/2, agent_status/3, image_clone/5, image_hop/6,
                life_hops/2, mail_all/2, mail_back/2, with_agent/2 ]).
:- use_module('../base/durable',
              [ crash_point/1, durable/5, durable_assertz/1, durable_drop/3,
                durable_on/0, enqueue_changes/0, unit_of_work/1 ]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../base/reports', [report/4]).
:- use_module('../host',
              [ address_parts/3, alarm_in/3, event/4, events_forget/1,
                host_departure/2, real_time/3, scheduler_call/1, time_now/1 ]).
:- use_module('../program', [answer_at/3]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_call/5, endpoint_gone/1,
                endpoint_lasting/1, endpoint_peer/2, endpoint_reply/2,
                endpoint_request/4 ]).
:- use_module(mail, [post_on/2]).
:- use_module(outcomes, [clone_unborn/2]).
:- use_module(whereabouts,
              [ agent_departed_to/4, agent_ended/4, agent_location/4,
                departure_noted/4, end_noted/4, hop_is_new/3 ]).

:- setting(typhon_in_doubt:shown_seconds, number, 3,
           "Seconds under way after which an agent is shown as in doubt").
:- setting(typhon_in_doubt:settle_seconds, number, 1,
           "Seconds until processes that did not answer are asked again").

:- dynamic
    again/2,                            % Id, Hops: may have arrived by an earlier
                                        % attempt
    given_up/2,                         % Id, Hops: disposed of while in doubt
    waits/2.                            % Id, Asker: for the end of an ordered move

:- multifile
    hop_begins/4,                       % Id, Hops, Endpoint, Sent: where changes are
                                        % durable, a hop begins at Sent
    hop_label/3,
    hop_over/2,                         % Id, Hops: the hop is over
    parks/2,                            % Transfer, Seconds: end it later, by
                                        % transfer_arrived/1 or transfer_stays/2
    forward_order/2,                    % Id, Order: Order follows Id, which has left
    answered/2,                         % Asker, Answer: of an ordered move
    typhon_runtime:ending/1,
    again/1,                            % Transfer: request it once more
    typhon_durable:go_on/0,
    typhon_endpoint:requested/4,
    typhon_scheduler:fire/2.

%!  transfer_traveller(+Transfer, -Id, -Hops) is det.
%
%   Id is the agent under way, on its hop number Hops.

transfer_traveller(transfer(Id, _, Hops), Id, Hops).
transfer_traveller(clone_transfer(_, _, CloneId), CloneId, 1).

%!  transfer_image(+Transfer, +Held, +Mail, +Since, -Image) is det.
%
%   Image is the image to send; binds the hole, and the number of the hop.

transfer_image(transfer(Id, _, Hops), Held, Mail, Since, Image) :-
    held_goals(Held, Hole-Goals),
    ignore(Hole = true),                % Hole is bound if the move was an order
    image_hop(Id, Hops, Goals, Mail, Since, Image).
transfer_image(clone_transfer(Id, _, CloneId), Hole-Goals-Role, _, Since,
               Image) :-
    Hole = (Role=clone(Id)),
    image_clone(Id, CloneId, Goals, Since, Image).

held_goals(Hole0-Goals, Hole-Goals) :-
    waits(Hole0, Hole, _),
    !.
held_goals(Held, Held).

waits(Hole0, _, _) :-
    var(Hole0),
    !,
    fail.
waits(wait(Hole, Until), Hole, Until).
waits(parked(Hole, Until), Hole, Until).

%!  transfer_image(+Transfer, -Image) is semidet.
%
%   The image once more, from the frozen record, in any thread.  Fails if the
%   agent was given up.  The mutex of the agent keeps an answer from removing
%   the module while it is read.

transfer_image(Transfer, Image) :-
    arg(1, Transfer, Id),
    with_agent(Id, ( frozen(Transfer, Held, Mail, Since),
                     transfer_image(Transfer, Held, Mail, Since, Image) )).

%!  transfer_image(+Transfer, -Image, -Held) is semidet.
%
%   As transfer_image/2, for a hop.  Held is Hole-Goals, if its hole is open.

transfer_image(Transfer, Image, Held) :-
    Transfer = transfer(Id, _, _),
    with_agent(Id, ( frozen(Transfer, Held0, Mail, Since),
                     held_goals(Held0, Held),
                     copy_term(Held, Going),
                     transfer_image(Transfer, Going, Mail, Since, Image) )).

frozen(transfer(Id, _, Hops), Held, Mail, Since) :-
    agent_status(Id, transit(_, _), hop(Held, Hops, Mail, Since)).
frozen(clone_transfer(Id, _, CloneId), Held, [], Since) :-
    agent_status(Id, cloning(_, _), clone(Held, CloneId, Since)).

%!  transfer_freeze(+Transfer, +Held, -Mail, +Since) is semidet.
%
%   Begin the transfer; inside with_agent/2.  Fails if the agent was ended.

transfer_freeze(transfer(Id, dest(Address, _, Endpoint), Hops), Held, Mail,
                Since) :-
    agent_status(Id, Status, _),
    ( Status == running -> true ; Status == obeying ),
    departs(Id, Hops, Endpoint, Sent),
    mail_all(Id, Mail),
    agent_put(Id, transit(Address, Sent), hop(Held, Hops, Mail, Since)),
    debug(typhon(hop), '~w hop ~D: leaves for ~w', [Id, Hops, Address]).
transfer_freeze(clone_transfer(Id, dest(Address, _, Endpoint), CloneId), Held,
                [],
                Since) :-
    departs(CloneId, 1, Endpoint, Sent),
    agent_put(Id, cloning(Address, Sent), clone(Held, CloneId, Since)),
    debug(typhon(hop), '~w hop 1: leaves for ~w', [CloneId, Address]).

departs(Id, Hops, Endpoint, Sent) :-
    (   durable_on
    ->  hop_begins(Id, Hops, Endpoint, Sent)
    ;   monotonic_time(Sent)
    ).

%!  transfer_over(+Id, ?Hops) is det.
%
%   Id has arrived by its hop number Hops, or stays.

transfer_over(Id, Hops) :-
    ( hop_over(Id, Hops) -> true ; true ),
    ( again(Id, Hops) -> retractall(again(Id, Hops)) ; true ).

%!  transfer_again(+Id, +Hops) is det.
%   transfer_repeated(+Id, +Hops): Id may have arrived by its hop number Hops
%   already when it is sent the next time.

transfer_again(Id, Hops) :-
    retractall(again(Id, Hops)),
    assertz(again(Id, Hops)).

transfer_repeated(Id, Hops) :-
    again(Id, Hops),
    !.

%!  hop_label(+Id, +Endpoint, -Label) is semidet.
%
%   Label identifies the hop of Id that is under way to Endpoint, also after a
%   restart of this process. An option defines this.

typhon_runtime:ending(after) :-
    retractall(again(_, _)).

                /*******************************
                *           ARRIVED            *
                *******************************/

%!  transfer_arrived(+Transfer) is det.
%
%   The receiver has the agent: end the transfer here.

transfer_arrived(Transfer) :-
    (   durable_on
    ->  crash_point(after_send),
        unit_of_work(arrived(Transfer))
    ;   arrived(Transfer)
    ).

arrived(transfer(Id, dest(Address, _, Endpoint), Hops)) :-
    (   with_agent(Id, departed(Id, Hops, Address, Endpoint, Orders, Gone))
    ->  debug(typhon(hop), '~w hop ~D: has gone', [Id, Hops]),
        call(Gone),
        forall(member(Order, Orders), follow(Id, Order))
    ;   retract(given_up(Id, Hops))
    ->  durable_drop(given_up, Id, Hops),
        transfer_over(Id, Hops),
        agent_departed_to(Id, Address, Hops, Endpoint),
        departure_noted(Id, Address, Hops, Endpoint),
        follow(Id, dispose)
    ;   true                            % it came back before the answer
    ).
arrived(clone_transfer(Id, dest(Address, _, Endpoint), CloneId)) :-
    debug(typhon(hop), '~w hop 1: has gone', [CloneId]),
    transfer_over(CloneId, 1),
    agent_departed_to(CloneId, Address, 1, Endpoint),
    departure_noted(CloneId, Address, 1, Endpoint),
    ignore(with_agent(Id, clone_back(Id, CloneId, parent(CloneId)))).

%   The destination is noted before the agent is removed, and mail that came
%   meanwhile is sent before any that comes later.

departed(Id, Hops, Address, Endpoint0, Orders, Gone) :-
    agent_status(Id, transit(_, _), hop(Hole-_, Hops, _, Since)),
    accepted_by(Hole, Endpoint0, Endpoint),
    agent_departed_to(Id, Address, Hops, Endpoint),
    let_go(Id, Since, Mail, Orders, Gone),
    transfer_over(Id, Hops),
    (   durable_on
    ->  departure_noted(Id, Address, Hops, Endpoint),
        post_on(Id, Mail),
        enqueue_changes
    ;   post_on(Id, Mail)
    ).

%   Which process will take over an agent that was parked is not known yet.

accepted_by(Hole, _, unknown) :-
    subsumes_term(parked(_, _), Hole),
    !.
accepted_by(_, Endpoint, Endpoint).

%!  transfer_let_go(+Id, -Mail, -Orders, :Gone) is semidet.
%
%   Remove Id, which is in transit; inside with_agent/2.  Call Gone after
%   leaving with_agent/2.

transfer_let_go(Id, Mail, Orders, Gone) :-
    agent_status(Id, transit(_, _), hop(_, _, _, Since)),
    let_go(Id, Since, Mail, Orders, Gone).

let_go(Id, Since, Mail, Orders,
       typhon_transfer:count_departure(Id, Host, Since)) :-
    agent(Id, Host, _, _, _),
    events_forget(Id),
    mail_all(Id, Mail),
    agent_remove(Id, Orders).

count_departure(Id, Host, Since) :-
    ignore(move_over(Id, answer(arrived))),
    host_departure(Host, Since).

follow(Id, Order) :-
    scheduler_call(forward_order(Id, Order)).

                /*******************************
                *            STAYS             *
                *******************************/

%!  transfer_stays(+Transfer, +Error) is det.
%
%   End the transfer of an agent that stays, and raise Error at its move.  A
%   move that was ordered from outside has no hole, see move_failed/2.

transfer_stays(Transfer, Error) :-
    transfer_traveller(Transfer, Agent, Hop),
    debug(typhon(hop), '~w hop ~D: stays, ~p', [Agent, Hop, Error]),
    unit_of_work(( transfer_over(Agent, Hop),
                   stays(Transfer, Error) )).

stays(transfer(Id, dest(Address, _, _), Hops), Error) :-
    (   retract(given_up(Id, Hops))
    ->  durable_drop(given_up, Id, Hops)
    ;   true
    ),
    (   agent(Id, Host, _, _, _)
    ->  event(hops, Host, Id, stayed(Address))
    ;   true
    ),
    ignore(with_agent(Id, back(Id, Hops, Address, Error))).
stays(clone_transfer(Id, dest(Address, _, _), CloneId), Error) :-
    clone_unborn(Id, CloneId),
    end_noted(CloneId, failed, 1, []),
    agent_ended(CloneId, failed, 1, []),
    ignore(with_agent(Id, clone_back(Id, CloneId, stays(Address, Error)))).

%!  transfer_unreachable(+Transfer) is det.
%
%   As transfer_stays/2, with the error host_unreachable(Address), unless the
%   agent waits and the hook parks/2 takes the transfer over.  The hook runs in any
%   thread, and must not wait.  It gets the real seconds that are left, or `inf`.
%   At 0 it should take only what it has already.

transfer_unreachable(Transfer) :-
    transfer_parks(Transfer),
    !.
transfer_unreachable(Transfer) :-
    arg(2, Transfer, dest(Address, _, _)),
    transfer_stays(Transfer, host_unreachable(Address)).

%   That it is parked is noted first: the hook may end the transfer at once.

transfer_parks(Transfer) :-
    Transfer = transfer(Id, _, _),
    '$get_predicate_attribute'(typhon_transfer:parks(_, _),
                               number_of_clauses, _),
    note_wait(Transfer, parked(_, Until)),
    agent(Id, Host, _, _, _),
    seconds_left(Until, Host, Seconds),
    parks(Transfer, Seconds).

note_wait(transfer(Id, _, Hops), Wait) :-
    unit_of_work(with_agent(Id, note_wait(Id, Hops, Wait))).

note_wait(Id, Hops, Wait) :-
    agent_status(Id, Status, hop(Hole-Goals, Hops, Mail, Since)),
    waits(Hole, Inner, Until),
    arg(1, Wait, Inner),
    arg(2, Wait, Until),
    agent_put(Id, Status, hop(Wait-Goals, Hops, Mail, Since)).

seconds_left(inf, _, inf) :-
    !.
seconds_left(Until, Host, Seconds) :-
    real_time(Host, Until, Stamp),
    time_now(Now),
    Seconds is max(0.0, Stamp-Now).

%!  transfer_parked(+Transfer) is semidet.
%
%   The agent was offered to parks/2, and was not sent since.

transfer_parked(transfer(Id, _, Hops)) :-
    agent_status(Id, transit(_, _), hop(Hole-_, Hops, _, _)),
    subsumes_term(parked(_, _), Hole).

%!  transfer_unpark(+Transfer) is det.
%
%   The agent is sent now, if it was parked.

transfer_unpark(Transfer) :-
    (   transfer_parked(Transfer)
    ->  ignore(note_wait(Transfer, wait(_, _)))
    ;   true
    ).

back(Id, Hops, Address, Error) :-
    agent_status(Id, transit(_, _), hop(Held, Hops, Mail, _)),
    held_goals(Held, Hole-Goals),
    mail_back(Id, Mail),
    (   Hole == ordered
    ->  move_failed(Id, Error)
    ;   answer_at(move(Address), throw(error(Error, _)), Hole)
    ),
    agent_ready(Id, Goals).

clone_back(Id, CloneId, Answer) :-
    agent_status(Id, cloning(_, _), clone(Hole-Goals-Role, CloneId, _)),
    (   Answer = stays(Address, Error)
    ->  answer_at(clone(Address, Role), throw(error(Error, _)), Hole)
    ;   Hole = (Role=Answer)
    ),
    agent_ready(Id, Goals).

%!  transfer_given_up(+Id, +Frozen) is det.
%
%   Record that Id was disposed of in doubt: if it turns out to have arrived,
%   the order follows it.

transfer_given_up(Id, hop(_, Hops, _, _)) :-
    durable_assertz(given_up(Id, Hops)).

%   The third argument is unused; older journals have a term there.

:- durable(given_up, Id, Hops, _, given_up(Id, Hops)).

%!  transfer_open(?Transfer) is nondet.
%
%   The agent of Transfer is under way, and there is no answer yet.

transfer_open(Transfer) :-
    agent_status(Id, Status, Frozen),
    open_transfer(Status, Id, Frozen, Transfer).

open_transfer(transit(Address, _), Id, hop(_, Hops, _, _),
              transfer(Id, dest(Address, Name, Endpoint), Hops)) :-
    address_parts(Address, Name, Endpoint).
open_transfer(cloning(Address, _), Id, clone(_, CloneId, _),
              clone_transfer(Id, dest(Address, Name, Endpoint), CloneId)) :-
    address_parts(Address, Name, Endpoint).

%!  transfer_held(+Frozen, -Held) is semidet.
%
%   Held is Hole-Goals of an agent that is under way, or is about to leave.

transfer_held(hop(Held0, _, _, _), Held) :-
    held_goals(Held0, Held).
transfer_held(hop(Held0, _), Held) :-
    held_goals(Held0, Held).
transfer_held(clone(Held-_, _, _), Held).

                /*******************************
                *         ORDERED MOVES         *
                *******************************/

%   A caller of agent_move/3 waits until the agent has arrived.  The process in
%   which the agent takes the order notifies it of the end of the next hop.

%!  move_awaited(+Id, +Asker) is det.
%
%   Record that Asker waits for the end of the move that Id is about to begin on
%   an order.

move_awaited(Id, Asker) :-
    assertz(waits(Id, Asker)).

%!  move_over(+Id, +Answer) is semidet.
%
%   Give Answer to all callers that wait for the move of Id, which is over:
%   answer(arrived), error(Formal), or `none` if Id has ended.  Fails if no
%   caller waits.

move_over(Id, Answer) :-
    retract(waits(Id, Asker)),          % one by one: others add to the table
    !,
    answered(Asker, Answer),
    ignore(move_over(Id, Answer)).

%!  move_failed(+Id, +Formal) is det.
%
%   Give error(Formal) to the callers that wait for the move of Id, which stays.
%   If none waits, print a warning.

move_failed(Id, Formal) :-
    (   move_over(Id, error(Formal))
    ->  true
    ;   report(warning, failed_orders, Id, typhon(order_failed(Id, Formal)))
    ).

                /*******************************
                *            DOUBT             *
                *******************************/

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
    setting(typhon_in_doubt:settle_seconds, Seconds),
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
           scheduler_call(typhon_transfer:goes_on(Transfer))).

%   What was parked, and is not any more, may be elsewhere.

goes_on(Transfer) :-
    transfer_parked(Transfer),
    (   transfer_parks(Transfer)
    ->  true
    ;   transfer_traveller(Transfer, Agent, Hops),
        transfer_again(Agent, Hops),
        fail
    ),
    !.
goes_on(Transfer) :-
    again(Transfer).

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
    setting(typhon_in_doubt:settle_seconds, Seconds),
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

%   An agent that leaves or ends meanwhile is noted before it is removed.

reached(Id, Hops, true) :-
    (   hops_here(Id, Hops0),
        Hops0 >= Hops
    ;   \+ hop_is_new(Id, Hops, _)
    ),
    !.
reached(Id, _, false) :-
    (   hops_here(Id, _)
    ;   agent_location(Id, _, _, _)
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
%   The answer is overdue and there is no connection.  An order to end the agent,
%   which follows the agent before that, is then carried out here.

out_of_touch(Status) :-
    overdue(Status),
    \+ connection(Status, up).

down(Status) :-
    connection(Status, down).

connection(Status, State) :-
    arg(1, Status, Address),
    address_parts(Address, _, Endpoint),
    endpoint_peer(Endpoint, state(State)),
    !.

overdue(Status) :-
    arg(2, Status, Sent),
    monotonic_time(Now),
    setting(typhon_in_doubt:shown_seconds, Limit),
    Now-Sent > Limit.
