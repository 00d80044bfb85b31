:- module(typhon_life,
          [ agent_start/4,              % +Id, +Host, +Spec, -Answer
            agent_end/2,                % +Id, +Outcome
            agent_do/2,                 % +Id, +Order
            agent_clone_here/5          % +Id, +CloneId, +Who, +Goals, -Answer
          ]).
:- use_module(library(error), [must_be/2, permission_error/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(agent).
:- use_module(clock, [host_time/2, real_time/3]).
:- use_module(code, [code_module/2]).
:- use_module(context, [context_set/3, context_clear/0]).
:- use_module(arrival, []).
:- use_module(hop, [hop/5, hop_clone/6, hop_state/2, hop_given_up/2]).
:- use_module(host,
              [ host/3, host_enter/3, host_leave/1, host_option/2,
                host_resolve/2, host_log/3 ]).
:- use_module(machine, [machine_run/3]).
:- use_module(scheduler, [alarm_set/3, alarm_clear/3]).
:- use_module(whereabouts, [agent_born/2, agent_ended/3]).

/** <module> The life of an agent on a host

A worker of the scheduler runs an agent from one effect of the machine to
the next.  What each control predicate means is said here, one clause of
effect/5 each.

*Threading*: run/1 in workers, fire/2 in the timer.  While its status is
`running` an agent belongs to one worker.
*/

:- setting(faulty, nonneg, 100, "Faulty agents kept for inspection").

:- multifile
    typhon_scheduler:run/1,
    typhon_scheduler:fire/2.

                /*******************************
                *         BIRTH AND END        *
                *******************************/

%!  agent_start(+Id, +Host, +Spec, -Answer) is det.
%
%   Let an agent begin on Host, a host of this process.
%
%   @arg Spec is start(Hash, Life, State, Goals, Mail)
%   @arg Answer is `ok` or refused(Reason)

agent_start(Id, Host, start(Hash, Life, State, Goals, Mail), Answer) :-
    arg(4, Life, Tokens),
    host_enter(Host, Tokens, Answer),
    (   Answer == ok
    ->  host(Host, Address, Place),
        catch(with_agent(Id, born(Id, Host, Place, Hash, Life, State, Mail)),
              Ball,
              ( host_leave(Host), throw(Ball) )),
        agent_born(Id, Address),
        host_log(Host, Id, created),
        with_agent(Id, agent_ready(Id, Goals))
    ;   true
    ).

born(Id, Host, Place, Hash, Life, State, Mail) :-
    agent_install(Id, Host, Place, Hash, Life, State),
    agent_put(Id, arriving, []),
    forall(member(Message, Mail), agent_mail(Id, Message)).

%!  agent_end(+Id, +Outcome) is semidet.
%
%   Id ends.  An agent that raised is kept as faulty(Error).

agent_end(Id, raised(Error)) :-
    !,
    with_agent(Id, make_faulty(Id, Error, Host, Hops)),
    host_leave(Host),
    portable(Error, Portable),
    host_log(Host, Id, faulty(Portable)),
    print_message(error, typhon(faulty(Id, Error))),
    agent_ended(Id, raised(Portable), Hops),
    forget_faulty.
agent_end(Id, Outcome) :-
    with_agent(Id, remove(Id, Last)),
    removed(Last, Id, Outcome).

remove(Id, last(Host, Hops, Status)) :-
    agent(Id, Host, _, _, Life),
    arg(2, Life, Hops),
    once(agent_status(Id, Status, Goals)),
    (   Status = transit(_, _)
    ->  hop_given_up(Id, Goals)
    ;   true
    ),
    agent_remove(Id).

removed(last(_, _, faulty(_)), _, _) :-
    !.
removed(last(Host, Hops, _), Id, Outcome) :-
    host_leave(Host),
    host_log(Host, Id, ended(Outcome)),
    (   Outcome == failed
    ->  print_message(warning, typhon(agent_failed(Id)))
    ;   true
    ),
    agent_ended(Id, Outcome, Hops).

make_faulty(Id, Error, Host, Hops) :-
    agent(Id, Host, _, _, Life),
    arg(2, Life, Hops),
    agent_put(Id, faulty(Error), []).

portable(Error, Portable) :-
    catch(( typhon_frame:mobile_term(Error), Portable = Error ),
          error(_, _),
          term_to_atom(Error, Portable)).

%   The oldest faulty agents go when there are too many.

forget_faulty :-
    setting(faulty, Max),
    findall(Id, agent_status(Id, faulty(_), _), Ids),
    length(Ids, Count),
    Excess is Count-Max,
    forall(( nth1(N, Ids, Oldest), N =< Excess ),
           ignore(agent_end(Oldest, disposed))).

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
    agent_status(Id, leaving(Dest, _), hop(Hole-Goals, Since)).

perform(order(Order, Goals), Id) :-
    obey(Order, Id, Goals).
perform(leave(Dest, Hole, Goals, Since), Id) :-
    depart(Id, Dest, Hole, Goals, Since).
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
    ;   agent_take_mail(Id, From-Message)
    ->  Next = go([( on_message(From, Message)
                   ->  true
                   ;   message_failed(From, Message)
                   )])
    ;   agent_put(Id, resident, []),
        Next = stop
    ).

                /*******************************
                *            EFFECTS           *
                *******************************/

%   effect(+Control, +Hole, +Goals, +Where, -Next) is det.

effect(move(Host), Hole, Goals, Id-Here, Next) :-
    destination(Host, Dest),
    (   Dest == local(Here)
    ->  Hole = true,
        Next = go(Goals)
    ;   agent(Id, _, _, _, Life),
        may_move(Life, Id, May),
        set_out(May, Dest, Hole, Goals, Id-Here),
        Next = stop
    ).
effect(clone(Who), Hole, Goals, Id-Here, go(Goals)) :-
    clone_id(Id, Here, CloneId),
    copy_term(Hole-Goals-Who, (Who1=clone(Id))-Going-Who1),
    agent_clone_here(Id, CloneId, Here, Going, Answer),
    (   Answer = refused(Reason)
    ->  host(Here, Address, _),
        Hole = throw(error(move_refused(Address, Reason), _))
    ;   Hole = (Who=parent(CloneId))
    ).
effect(clone(Host, Who), Hole, Goals, Id-Here, Next) :-
    destination(Host, Dest),
    (   Dest == local(Here)
    ->  effect(clone(Who), Hole, Goals, Id-Here, Next)
    ;   clone_id(Id, Here, CloneId),
        hop_clone(Id, Dest, CloneId, Who, Hole, Goals),
        Next = stop
    ).
effect(sleep(Seconds), Hole, Goals, Id-Here, Next) :-
    must_be(number, Seconds),
    host_time(Here, Now),
    Until is Now+Seconds,
    effect(sleep_until(Until), Hole, Goals, Id-Here, Next).
effect(sleep_until(Until), Hole, Goals, Id-Here, Next) :-
    host_time(Here, Now),
    (   Now >= Until
    ->  Hole = true,
        Next = go(Goals)
    ;   Hole = sleep_until(Until),
        wait(Id, Here, sleeping(Until), Until, Goals),
        Next = stop
    ).
effect(receive(Message), Hole, Goals, Id-Here, Next) :-
    receive(Message, inf, receive(Message), Hole, Goals, Id-Here, Next).
effect(receive(Message, Seconds), Hole, Goals, Id-Here, Next) :-
    (   infinite(Seconds)
    ->  effect(receive(Message), Hole, Goals, Id-Here, Next)
    ;   must_be(number, Seconds),
        host_time(Here, Now),
        Until is Now+Seconds,
        effect(receive_until(Message, Until), Hole, Goals, Id-Here, Next)
    ).
effect(receive_until(Message, Until), Hole, Goals, Id-Here, Next) :-
    receive(Message, Until, receive_until(Message, Until), Hole, Goals,
            Id-Here, Next).
effect(dispose, _, _, Id-_, stop) :-
    ignore(agent_end(Id, disposed)).

infinite(Seconds) :- Seconds == inf.
infinite(Seconds) :- Seconds == infinite.
infinite(Seconds) :- float(Seconds), Seconds =:= inf.

%   receive(+Message, +Until, +Again, ...): take a message or wait for it;
%   Again is the goal that does it when the agent is woken.

receive(Message, Until, Again, Hole, Goals, Id-Here, Next) :-
    with_agent(Id, take_or_wait(Message, Until, Again, Hole, Goals,
                                Id-Here, Next)),
    (   Next == stop,
        number(Until)
    ->  real_time(Here, Until, Stamp),
        alarm_set(Stamp, Id, until(Until))
    ;   true
    ).

take_or_wait(Message, _, _, true, Goals, Id-_, go(Goals)) :-
    agent_take_mail(Id, Message),
    !.
take_or_wait(_, Until, _, fail, Goals, _-Here, go(Goals)) :-
    number(Until),
    host_time(Here, Now),
    Now >= Until,
    !.
take_or_wait(Message, Until, Again, Again, Goals, Id-_, stop) :-
    agent_put(Id, waiting(Message, Until), Goals),
    rouse_if_ordered(Id).

wait(Id, Host, Status, Until, Goals) :-
    with_agent(Id, ( agent_put(Id, Status, Goals),
                     rouse_if_ordered(Id)
                   )),
    real_time(Host, Until, Stamp),
    alarm_set(Stamp, Id, until(Until)).

%   An order may have come while the agent was running.

rouse_if_ordered(Id) :-
    (   agent_ordered(Id)
    ->  agent_status(Id, _, Goals),
        agent_ready(Id, Goals)
    ;   true
    ).

typhon_scheduler:fire(Id, until(Until)) :-
    !,
    ignore(with_agent(Id, rouse(Id, Until))).
typhon_scheduler:fire(Id, leave) :-
    !,
    (   agent(Id, Host, _, _, _)
    ->  typhon_scheduler:schedule(Host, Id)
    ;   true
    ).

rouse(Id, Until) :-
    agent_status(Id, Status, Goals),
    (   Status = sleeping(Until)
    ;   Status = waiting(_, Until)
    ),
    !,
    agent_ready(Id, Goals).

                /*******************************
                *        MOVE AND CLONE        *
                *******************************/

may_move(life(_, _, _, _, _, true), Id, _) :-
    permission_error(move, static_agent, Id).
may_move(life(_, Hops, Lifetime, _, _, _), _, end) :-
    integer(Lifetime),
    Hops >= Lifetime,
    !.
may_move(_, _, go).

set_out(end, _, _, _, Id-_) :-
    ignore(agent_end(Id, disposed)).
set_out(go, Dest, Hole, Goals, Id-Here) :-
    host_time(Here, Now),
    (   host_option(Here, hop_time(uniform(Min, Max)))
    ->  At is Now+Min+random_float*(Max-Min),
        with_agent(Id, agent_put(Id, leaving(Dest, At),
                                 hop(Hole-Goals, Now))),
        real_time(Here, At, Stamp),
        alarm_set(Stamp, Id, leave)
    ;   hop(Id, Dest, Hole, Goals, Now)
    ).

%   A name that no host has is like one that the other process lacks.

destination(Host, Dest) :-
    catch(host_resolve(Host, Dest),
          error(existence_error(host, _), _),
          throw(error(move_refused(Host, unknown_host), _))).

%   What cannot travel is found when the agent departs.

depart(Id, Dest, Hole, Goals, Since) :-
    catch(hop(Id, Dest, Hole, Goals, Since),
          error(Formal, Where),
          ( Hole = throw(error(Formal, Where)),
            with_agent(Id, agent_ready(Id, Goals))
          )).

clone_id(Id, Here, CloneId) :-
    sub_atom(Id, B, _, _, '.'),
    !,
    sub_atom(Id, 0, B, _, Name),
    host(Here, Address, _),
    agent_id(Name, Address, CloneId).

%!  agent_clone_here(+Id, +CloneId, +Host, +Goals, -Answer) is det.
%
%   Make a clone of Id beside it, with Goals to do.

agent_clone_here(Id, CloneId, Host, Goals, Answer) :-
    agent(Id, Host, Module, Hash, Life0),
    agent_state(Module, State),
    Life0 = life(_, _, Lifetime, Tokens, Payloads, Static),
    Life = life(Id, 0, Lifetime, Tokens, Payloads, Static),
    agent_start(CloneId, Host, start(Hash, Life, State, Goals, []), Answer).

                /*******************************
                *            ORDERS            *
                *******************************/

%!  agent_do(+Id, +Order) is semidet.
%
%   Order from outside: `dispose`, move(Dest), clone(CloneId),
%   attach(Payload) or detach(Name).  An agent that runs takes it at its
%   next effect.  Fails if there is no such agent in this process.

agent_do(Id, dispose) :-
    with_agent(Id, ( agent_status(Id, Status, _),
                     at_rest(Status),
                     remove(Id, Last)
                   )),
    !,
    removed(Last, Id, disposed).
agent_do(Id, Order) :-
    with_agent(Id, order(Id, Order)).

at_rest(ready).
at_rest(sleeping(_)).
at_rest(waiting(_, _)).
at_rest(resident).
at_rest(leaving(_, _)).
at_rest(faulty(_)).
at_rest(transit(Host, Sent)) :-
    hop_state(transit(Host, Sent), in_doubt).
at_rest(cloning(Host, Sent)) :-
    hop_state(cloning(Host, Sent), in_doubt).

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
    agent(Id, Here, _, _, Life),
    catch(( host_resolve(Host, Dest),
            (   Dest == local(Here)
            ->  with_agent(Id, agent_ready(Id, Goals))
            ;   may_move(Life, Id, May),
                set_out(May, Dest, ordered, Goals, Id-Here)
            )
          ),
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
