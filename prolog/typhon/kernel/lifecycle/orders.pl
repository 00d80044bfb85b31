:- module(typhon_orders,
          [ order_take/2,               % +Id, +Order
            order_obey/3                % +Order, +Id, +Goals
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [domain_error/2, permission_error/3]).
:- use_module('../base/on_demand', [on_demand_call/3, on_demand_load/2]).
:- use_module('../host', [alarm_in/3, scheduler_call/1]).
:- use_module('../agent',
              [ agent/5, agent_order/2, agent_ready/2, agent_status/3,
                agent_wakes/2, fault_stamp/2, is_faulty/3, life_hops/2,
                with_agent/2 ]).
:- use_module('../travel',
              [ agent_resumed/3, move_awaited/2, move_failed/2, move_over/2,
                out_of_touch/1 ]).
:- use_module(creation, [agent_clone_here/3]).
:- use_module(effect, [effect_order/4]).
:- use_module(ending,
              [agent_end/2, agent_end/3, agent_stays/2, faulty_stirs/1]).
:- use_module(questions, [agent_ask/4, question_answered/2]).

/** <module> Orders are taken and obeyed

An order that has found its agent, see typhon_order_client, is noted in its
record. The agent takes it at its next effect. If a caller waits for the
result, the order is noted as asked(Order, Asker).

*Threading*: any thread takes orders, a reader thread those from another
process. The worker that has the agent obeys them.
*/

:- multifile
    carried_out/3,              % Order, Id, Result: an order of an option
    noted/1,                    % Id: an order waits for its next effect
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2,
    typhon_questions:here/3,
    typhon_transfer:forward_order/2.

                /*******************************
                *             TAKE             *
                *******************************/

typhon_questions:here(order(Order), Agent, Asker) :-
    (   at_once(Order)
    ->  catch(( order_take(Agent, Order),
                Answer = answer(ok)
              ),
              error(Formal, _),
              Answer = error(Formal)),
        question_answered(Asker, Answer)
    ;   catch(order_take(Agent, asked(Order, Asker)),
              error(Formal, _),
              question_answered(Asker, error(Formal)))
    ).

at_once(move(_)).
at_once(dispose).

%!  order_take(+Id, +Order) is semidet.
%
%   Take Order for Id.  Fails if Id is not in this process.  Besides the orders
%   of typhon_order_client there is evacuate(Host): end the agent if it is still
%   on Host, of this process.

order_take(Id, dispose) :-
    agent_end(Id, at_rest, disposed),
    !.
order_take(Id, asked(end, Asker)) :-
    agent_end(Id, at_rest, disposed),
    !,
    question_answered(Asker, answer(ended)).
order_take(Id, evacuate(Host)) :-
    agent_end(Id, rests_on(Host, Id), disposed),
    !.
order_take(Id, evacuate(Host)) :-
    !,
    with_agent(Id, ( agent(Id, Host, _, _, _),
                     note_order(Id, evacuate(Host)) )).
order_take(Id, Order) :-
    with_agent(Id, note_order(Id, Order)),
    (   Order == dispose
    ->  look_again_later(Id)
    ;   ignore(noted(Id))
    ).

%   The peer to which the agent is under way may soon be unreachable; then this
%   process can end the agent.

look_again_later(Id) :-
    (   under_way(Id)
    ->  alarm_in(1, Id, dispose)
    ;   true
    ).

under_way(Id) :-
    agent_status(Id, Status, _),
    ( Status = transit(_, _) ; Status = cloning(_, _) ),
    !.

typhon_scheduler:fire(Id, dispose) :-
    !,
    scheduler_call(typhon_orders:look_again(Id)).

typhon_scheduler:over(Id, dispose) :-
    \+ under_way(Id).

look_again(Id) :-
    (   under_way(Id),
        \+ agent_end(Id, at_rest, disposed)
    ->  look_again_later(Id)
    ;   true
    ).

at_rest(ready).
at_rest(sleeping(_)).
at_rest(waiting(_, _)).
at_rest(resident).
at_rest(held).
at_rest(resumed).
at_rest(leaving(_, _)).
at_rest(faulty(_)).
at_rest(transit(Host, Sent)) :-
    out_of_touch(transit(Host, Sent)).
at_rest(cloning(Host, Sent)) :-
    out_of_touch(cloning(Host, Sent)).

rests_on(Host, Id, Status) :-
    agent(Id, Host, _, _, _),
    at_rest(Status).

note_order(Id, Order) :-
    agent_status(Id, Status, Goals),
    may_obey(Status, Order, Id),
    agent_order(Id, Order),
    (   idle(Status)
    ->  agent_wakes(Id, Goals)
    ;   true
    ).

may_obey(faulty(_), _, Id) :-
    !,
    faulty_stirs(Id).
may_obey(Status, asked(resume, _), Id) :-
    idle(Status),
    !,
    permission_error(resume, agent, Id).
may_obey(_, _, _).

idle(faulty(_)).
idle(sleeping(_)).
idle(waiting(_, _)).
idle(resident).

%   Orders for an agent that has left meanwhile follow it, except those that are
%   only for agents that stay: to end with their host, or to come to rest.

typhon_transfer:forward_order(_, evacuate(_)) :-
    !.
typhon_transfer:forward_order(_, asked(question(rest), _)) :-
    !.
typhon_transfer:forward_order(Agent, Order) :-
    (   Order = asked(Order1, Asker)
    ->  forward(Agent, Order1, Answer),
        question_answered(Asker, Answer)
    ;   forward(Agent, Order, error(Formal))
    ->  move_failed(Agent, Formal)
    ;   true
    ).

forward(Agent, Order, Answer) :-
    (   Order = question(Question)
    ->  true
    ;   Question = order(Order)
    ),
    (   catch(agent_ask(Agent, Question, 10, Answer0), error(Formal, _),
              Answer0 = error(Formal))
    ->  Answer = Answer0
    ;   Answer = none
    ).

                /*******************************
                *             OBEY             *
                *******************************/

%!  order_obey(+Order, +Id, +Goals) is det.
%
%   Id, which is ready to run Goals, obeys Order.

order_obey(Order, Id, Goals) :-
    debug(typhon(agent), '~w: obeys ~W', [Id, Order, [max_depth(3)]]),
    obey(Order, Id, Goals).

obey(dispose, Id, _) :-
    ignore(agent_end(Id, disposed)).
obey(evacuate(Host), Id, Goals) :-
    (   agent(Id, Host, _, _, _)
    ->  ignore(agent_end(Id, disposed))
    ;   go_on(Id, Goals)
    ).
obey(move(Host), Id, Goals) :-
    (   agent(Id, Here, _, _, _)
    ->  catch(effect_order(Id, Here, Host, Goals),
              error(Formal, _),
              ( move_failed(Id, Formal),
                go_on(Id, Goals)
              ))
    ;   ignore(move_over(Id, none))     % it has ended meanwhile
    ).
obey(asked(arrive(Host), Asker), Id, Goals) :-
    !,
    move_awaited(Id, Asker),
    obey(move(Host), Id, Goals).
obey(asked(end, Asker), Id, _) :-
    !,
    ignore(agent_end(Id, disposed)),
    question_answered(Asker, answer(ended)).
obey(asked(resume, Asker), Id, Goals) :-
    (   is_faulty(Goals, Fault, Left),
        agent(Id, _, _, _, Life)
    ->  fault_stamp(Fault, Stamp),
        life_hops(Life, Hops),
        agent_resumed(Id, Stamp, Hops),
        answered(Asker, answer(resumed(Stamp, Hops))),
        go_on(Id, Left)
    ;   answered(Asker, error(permission_error(resume, agent, Id))),
        go_on(Id, Goals)
    ).
obey(asked(Order, Asker), Id, Goals) :-
    catch((   carry_out(Order, Id, Result)
          ->  Answer = answer(Result)
          ;   domain_error(agent_order, Order)
          ),
          error(Formal, _),
          Answer = error(Formal)),
    answered(Asker, Answer),
    go_on(Id, Goals).

%   An answer may be too long to be sent.

answered(Asker, Answer) :-
    catch(question_answered(Asker, Answer),
          error(Formal, _),
          question_answered(Asker, error(Formal))).

%   A host that stops and has waited long enough ends agents that still obey
%   orders.

go_on(Id, Goals) :-
    (   is_faulty(Goals, _, _)
    ->  agent_stays(Id, Goals)
    ;   ignore(with_agent(Id, agent_ready(Id, Goals)))
    ).

carry_out(attach(Payload), Agent, ok) :-
    on_demand_call(payload, any,
                   typhon_payloads:agent_attach(Agent, Payload)).
carry_out(detach(Name), Agent, ok) :-
    on_demand_call(payload, any, typhon_payloads:agent_detach(Agent, Name)).
carry_out(question(_), _, again).
carry_out(clone, Agent, CloneId) :-
    agent_status(Agent, _, Goals),
    agent_clone_here(Agent, Goals, CloneId).
carry_out(Order, Agent, Result) :-
    functor(Order, Kind, _),
    on_demand_load(order, Kind),
    carried_out(Order, Agent, Result).
