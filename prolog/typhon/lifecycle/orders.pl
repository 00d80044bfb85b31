:- module(typhon_orders,
          [ agent_move/2,               % +Agent, +Host
            agent_clone/2,              % +Agent, -Clone
            agent_dispose/1,            % +Agent
            payload_attach/2,           % +Agent, +Payload
            payload_detach/2,           % +Agent, +Name
            agent_resume/1,             % +Agent
            agent_change/2,             % +Agent, +Change
            order_give/3,               % +Agent, +Order, -Result
            order_take/2,               % +Id, +Order
            order_obey/3                % +Order, +Id, +Goals
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [ domain_error/2, existence_error/2, must_be/2,
                permission_error/3 ]).
:- use_module('../program', [code_sent/2, payload_load/2]).
:- use_module('../wire', [mobile_term/1]).
:- use_module('../host', [alarm_in/3, host_address/2, scheduler_call/1]).
:- use_module('../agent',
              [ agent/5, agent_attach/2, agent_detach/2, agent_home/2,
                agent_name/3, agent_order/2, agent_ready/2, agent_state/2,
                agent_status/3, fault_stamp/2, is_faulty/3, life_hops/2,
                mail_list/2, with_agent/2 ]).
:- use_module('../travel',
              [agent_resumed/3, agent_resumed_from/3, out_of_touch/1]).
:- use_module(change, [change_made/2, change_order/2]).
:- use_module(creation, [agent_clone_here/3]).
:- use_module(effect, [effect_order/4]).
:- use_module(ending, [agent_end/2, agent_end/3, agent_stays/2]).
:- use_module(faulty, [faulty_stirs/1]).
:- use_module(questions, [agent_ask/4, question_answered/2]).

/** <module> Orders from outside

An order is put as a question, see typhon_questions, so that it finds the
agent, and noted in its record.  The agent takes it at its next effect.  Who
waits for what comes of it is noted with it: asked(Order, Asker).

*Threading*: any thread gives orders; they are taken in any thread, in the
reader threads if they come from another process, and obeyed by the worker
that has the agent.
*/

:- multifile
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2,
    typhon_questions:here/3,
    typhon_transfer:forward_order/2.

                /*******************************
                *             GIVE             *
                *******************************/

%!  agent_move(+Agent, +Host) is det.
%!  agent_clone(+Agent, -Clone) is det.
%!  agent_dispose(+Agent) is det.
%!  payload_attach(+Agent, +Payload) is det.
%!  payload_detach(+Agent, +Name) is det.
%
%   Orders from outside.  An agent that runs takes them at its next effect.
%   agent_move/2 and agent_dispose/1 do not wait for that, the others do,
%   for 10 seconds at the most.  An agent that is refused at Host stays
%   where it is, which is reported there.
%
%   An agent that is faulty obeys as others do, and is faulty still.
%
%   @error existence_error(agent, Agent), existence_error(host, Host)
%   @error timeout_error(order, Agent)

agent_move(Agent, Host) :-
    host_address(Host, Address),
    order_give(Agent, move(Address), _).

agent_clone(Agent, Clone) :-
    order_give(Agent, clone, Clone0),
    Clone = Clone0.

agent_dispose(Agent) :-
    order_give(Agent, dispose, _).

payload_attach(Agent, Spec) :-
    payload_load(Spec, Payload),
    order_give(Agent, attach(Payload), _).

payload_detach(Agent, Name) :-
    must_be(atom, Name),
    order_give(Agent, detach(Name), _).

%!  agent_resume(+Agent) is det.
%
%   Let Agent, which is faulty, try again: it goes on with the goal that
%   failed or raised an error, and is no longer faulty.  It counts on its host
%   then, even where that is full.
%
%   @error permission_error(resume, agent, Agent) if it is not faulty
%   @error existence_error(agent, Agent)
%   @error timeout_error(order, Agent)

agent_resume(Agent) :-
    order_give(Agent, resume, resumed(Stamp, Hops)),
    agent_resumed_from(Agent, Stamp, Hops).

%!  agent_change(+Agent, +Change) is det.
%
%   Change Agent, faulty or not, at its next effect:
%
%     - facts(+Clauses): are added to its state
%     - program(+Spec): is its program from now on, see agent_create/2.  Its
%       state stays as it is, and so do the goals that it has left: what is
%       left of a clause is left of the old one.
%
%   @error domain_error(agent_change, Change)
%   @error permission_error(attach, procedure, PI) for a fact of a predicate
%          of the program, and a program that has one of the state
%   @error any problem of the program
%   @error existence_error(agent, Agent)
%   @error timeout_error(order, Agent)

agent_change(Agent, Change) :-
    must_be(nonvar, Change),
    change_order(Change, Order),
    order_give(Agent, change(Order), _).

%!  order_give(+Agent, +Order, -Result) is det.
%
%   @arg Order is move(Host), `dispose`, `clone`, attach(Payload),
%        detach(Name), `image`, `resume` or change(Change), see typhon_change

order_give(Agent, Order, Result) :-
    must_be(atom, Agent),
    (   agent_home(Agent, _),
        agent_ask(Agent, order(Order), 10, Answer)
    ->  ordered(Answer, Result)
    ;   existence_error(agent, Agent)
    ).

ordered(answer(Result), Result).
ordered(error(Formal), _) :-
    throw(error(Formal, _)).

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
%   Order comes to Id.  Fails if there is no such agent in this process.
%   Besides those of order_give/3 there is evacuate(Host): it ends who stands
%   on Host, of this process, and nobody who has left it meanwhile.

order_take(Id, dispose) :-
    agent_end(Id, at_rest, disposed),
    !.
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
    ;   true
    ).

%   Who is under way may be out of touch before long.

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
    (   Status = faulty(_)
    ->  faulty_stirs(Id)
    ;   idle(Status),
        Order = asked(resume, _)
    ->  not_faulty(Id)
    ;   true
    ),
    agent_order(Id, Order),
    (   idle(Status)
    ->  agent_ready(Id, Goals)
    ;   true
    ).

not_faulty(Id) :-
    permission_error(resume, agent, Id).

idle(faulty(_)).
idle(sleeping(_)).
idle(waiting(_, _)).
idle(resident).

%   Orders to an agent that left in the meantime follow it, but for what was
%   meant for those who stay.

typhon_transfer:forward_order(_, evacuate(_)) :-
    !.
typhon_transfer:forward_order(Agent, Order) :-
    (   Order = asked(Order1, Asker)
    ->  forward(Agent, Order1, Answer),
        question_answered(Asker, Answer)
    ;   forward(Agent, Order, error(Formal))
    ->  failed(Agent, Formal)
    ;   true
    ).

forward(Agent, Order, Answer) :-
    (   catch(agent_ask(Agent, order(Order), 10, Answer0), error(Formal, _),
              Answer0 = error(Formal))
    ->  Answer = Answer0
    ;   Answer = none
    ).

                /*******************************
                *             OBEY             *
                *******************************/

%!  order_obey(+Order, +Id, +Goals) is det.
%
%   Id, which is ready to do Goals, takes an order.

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
    agent(Id, Here, _, _, _),
    catch(effect_order(Id, Here, Host, Goals),
          error(Formal, _),
          ( failed(Id, Formal),
            go_on(Id, Goals)
          )).
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
    catch((   carried_out(Order, Id, Result)
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

go_on(Id, Goals) :-
    (   is_faulty(Goals, _, _)
    ->  agent_stays(Id, Goals)
    ;   with_agent(Id, agent_ready(Id, Goals))
    ).

failed(Id, Formal) :-
    print_message(warning, typhon(order_failed(Id, Formal))).

carried_out(attach(Payload), Agent, ok) :-
    agent_attach(Agent, Payload).
carried_out(detach(Name), Agent, ok) :-
    agent_detach(Agent, Name).
carried_out(clone, Agent, CloneId) :-
    agent_status(Agent, _, Goals),
    agent_clone_here(Agent, Goals, CloneId).
carried_out(change(Change), Agent, ok) :-
    change_made(Change, Agent).
carried_out(image, Agent,
            image(Name, Program, Life, State, Goals, Mail)) :-
    agent(Agent, _, Module, Hash, Life),
    agent_status(Agent, _, Goals),
    code_sent(Hash, Program),
    agent_name(Agent, Name, _),
    agent_state(Module, State),
    mail_list(Agent, Mail),
    mobile_term(State-Goals).
