:- module(typhon_running,
          [ agent_do/2                  % +Id, +Order
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module('../program', [code_module/2, machine_run/3]).
:- use_module('../host', [context_clear/0, context_set/3]).
:- use_module('../agent',
              [ agent/5, agent_departs/3, agent_handles/2, agent_next_order/2,
                agent_order/2, agent_ordered/1, agent_put/3, agent_ready/2,
                agent_status/3, agent_take/2, mail_take/2, with_agent/2 ]).
:- use_module('../travel', [agent_ended/3, hop_out_of_touch/1]).
:- use_module(creation, [agent_clone_here/5, agent_end/2, agent_end/3]).
:- use_module(effect, [effect/5, effect_depart/5, effect_order/4]).

/** <module> The life of an agent on a host

A worker of the scheduler runs an agent from one effect of the machine to
the next, see typhon_effect.  Orders from outside are taken in between.

*Threading*: run/1 in workers.  While its status is `running` an agent
belongs to one worker.
*/

:- multifile typhon_scheduler:run/1.

                /*******************************
                *            RUNNING           *
                *******************************/

typhon_scheduler:run(Id) :-
    (   with_agent(Id, take(Id, Task))
    ->  perform(Task, Id)
    ;   true                            % has ended
    ).

take(Id, Task) :-
    agent_take(Id, Goals),
    !,
    (   agent_next_order(Id, Order)
    ->  agent_put(Id, obeying, Goals),
        Task = order(Order, Goals)
    ;   Task = run(Goals)
    ).
take(Id, leave(Dest, Hole, Goals, Since)) :-
    agent_departs(Id, Dest, hop(Hole-Goals, Since)).

perform(order(Order, Goals), Id) :-
    obey(Order, Id, Goals).
perform(leave(Dest, Hole, Goals, Since), Id) :-
    effect_depart(Id, Dest, Hole, Goals, Since).
perform(run(Goals), Id) :-
    agent(Id, Host, Module, Hash, _),
    code_module(Hash, Program),
    context_set(Host, Id, Module),
    setup_call_catcher_cleanup(
        true,
        live(Goals, Id, Host, context(Program, Module)),
        Catcher,
        left(Catcher, Id)).

%   A worker that is interrupted leaves an agent in the middle of a goal:
%   it cannot go on.

left(Catcher, Id) :-
    context_clear,
    (   Catcher = exception(_)
    ->  ignore(agent_end(Id, disposed))
    ;   true
    ).

live(Goals0, Id, Host, Context) :-
    machine_run(Context, Goals0, Outcome),
    conclude(Outcome, Id, Host, Context, Next),
    (   Next = go(Goals)
    ->  live(Goals, Id, Host, Context)
    ;   true
    ).

%   conclude(+Outcome, +Id, +Host, +Context, -Next): Next is go(Goals) if
%   the agent goes on at once.

conclude(done, Id, _, Context, Next) :-
    finish(Id, Context, Next).
conclude(failed, Id, _, _, stop) :-
    ignore(agent_end(Id, failed)).
conclude(raised(Error), Id, _, _, stop) :-
    ignore(agent_end(Id, raised(Error))).
conclude(effect(Control, Hole, Goals), Id, Host, _, Next) :-
    (   agent_ordered(Id)
    ->  Hole = Control,
        with_agent(Id, agent_ready(Id, Goals)),
        Next = stop
    ;   catch(effect(Control, Hole, Goals, Id-Host, Next),
              error(Formal, Where),
              ( Hole = throw(error(Formal, Where)),
                Next = go(Goals)
              ))
    ).

%   No goals are left: take the next message, or stay resident, or end.  A
%   message that on_message/2 does not want is no reason to end.

finish(Id, context(_, Module), Next) :-
    agent(Id, _, Module, Hash, _),
    agent_handles(Module, Hash),
    !,
    with_agent(Id, next_message(Id, Next)).
finish(Id, _, stop) :-
    ignore(agent_end(Id, done)).

next_message(Id, Next) :-
    (   agent_ordered(Id)
    ->  agent_ready(Id, []),
        Next = stop
    ;   mail_take(Id, From-Message)
    ->  Next = go([( on_message(From, Message)
                   ->  true
                   ;   message_failed(From, Message)
                   )])
    ;   agent_put(Id, resident, []),
        Next = stop
    ).

                /*******************************
                *            ORDERS            *
                *******************************/

%!  agent_do(+Id, +Order) is semidet.
%
%   Order from outside: `dispose`, move(Dest), clone(CloneId),
%   attach(Payload) or detach(Name).  An agent that runs takes it at its
%   next effect.  Fails if there is no such agent in this process.

agent_do(Id, dispose) :-
    agent_end(Id, at_rest, disposed),
    !.
agent_do(Id, Order) :-
    with_agent(Id, order(Id, Order)).

at_rest(ready).
at_rest(sleeping(_)).
at_rest(waiting(_, _)).
at_rest(resident).
at_rest(leaving(_, _)).
at_rest(faulty(_)).
at_rest(transit(Host, Sent)) :-
    hop_out_of_touch(transit(Host, Sent)).
at_rest(cloning(Host, Sent)) :-
    hop_out_of_touch(cloning(Host, Sent)).

order(Id, Order) :-
    agent_status(Id, Status, Goals),
    not_faulty(Status, Id),
    agent_order(Id, Order),
    (   idle(Status)
    ->  agent_ready(Id, Goals)
    ;   true
    ).

not_faulty(Status, Id) :-
    (   Status = faulty(_)
    ->  permission_error(order, faulty_agent, Id)
    ;   true
    ).

idle(sleeping(_)).
idle(waiting(_, _)).
idle(resident).

%   obey(+Order, +Id, +Goals): the agent, which is ready to do Goals, takes
%   an order.

obey(dispose, Id, _) :-
    ignore(agent_end(Id, disposed)).
obey(move(Host), Id, Goals) :-
    agent(Id, Here, _, _, _),
    catch(effect_order(Id, Here, Host, Goals),
          error(Formal, _),
          disobey(Id, Formal, Goals)).
obey(clone(CloneId), Id, Goals) :-
    agent(Id, Here, _, _, _),
    agent_clone_here(Id, CloneId, Here, Goals, Answer),
    (   Answer = refused(Reason)
    ->  agent_ended(CloneId, failed, 0),
        print_message(warning, typhon(order_failed(Id, refused(Reason))))
    ;   true
    ),
    with_agent(Id, agent_ready(Id, Goals)).
obey(call(Goal), Id, Goals) :-
    catch(Goal, error(Formal, _),
          print_message(warning, typhon(order_failed(Id, Formal)))),
    with_agent(Id, agent_ready(Id, Goals)).

disobey(Id, Formal, Goals) :-
    print_message(warning, typhon(order_failed(Id, Formal))),
    with_agent(Id, agent_ready(Id, Goals)).
