:- module(typhon_effect,
          [ effect/5,                   % +Control, +Hole, +Goals, +Where, -Next
            effect_depart/6,            % +Id, +Where, +Hole, +Goals, +Since,
                                        % -Next
            effect_order/4              % +Id, +Here, +Host, +Goals
          ]).
:- use_module(library(error),
              [domain_error/2, must_be/2, permission_error/3, type_error/2]).
:- use_module(library(option), [option/2]).
:- use_module('../base/options', [check_options/2]).
:- use_module('../base/prng',
              [chance_hash/2, chance_seed/2, chance_uniform/5]).
:- use_module('../program', [answer_at/3]).
:- use_module('../host',
              [ alarm_set/3, event/4, event_subscribed/1, host_address/2,
                host_option/2, host_resolve/2, host_time/2, parts_call/3,
                real_time/3, schedule/2, time_apart/2, time_kind/1 ]).
:- use_module('../agent',
              [ agent/5, agent_here/5, agent_name/3, agent_note/3,
                agent_put/3, agent_ready/2, agent_rest/3, agent_rests/3,
                agent_status/3, agent_wakes/2, fault_error/2, life_hops/2,
                life_may_move/2, mail_take/2, with_agent/2 ]).
:- use_module('../travel',
              [ hand_over/5, hop/6, hop_at_once/6, hop_clone/6, move_failed/2,
                move_over/2 ]).
:- use_module(creation, [agent_clone_here/3, clone_id/2]).
:- use_module(ending, [agent_end/2, agent_stays/2]).

/** <module> The effects of control predicates

The machine stops an agent at a control predicate; this module carries the
predicate out: the agent goes on at once, waits, travels or ends.

*Threading*: effects happen in the worker that has the agent, alarms in the
timer.
*/

:- multifile
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2,
    typhon_scheduler:kind/2.

%!  effect(+Control, +Hole, +Goals, +Where, -Next) is det.
%
%   @arg Where is Id-Host
%   @arg Next is go(Goals) if the agent goes on at once, elsewhere(Name, Module,
%        Goals) if it does so on the host Name, with its state in Module, else
%        `stop`
%   @error an error to be raised at the control predicate

effect(move(Host), Hole, Goals, Id-Here, Next) :-
    hop_at_once(Id, Here, Host, Hole, Goals, Next),
    !.
effect(move(Host), Hole, Goals, Id-Here, Next) :-
    destination(Host, Dest),
    (   Dest == local(Here)
    ->  Hole = true,
        Next = go(Goals)
    ;   hand_over(Id, Here, Dest, Hole, Goals)
    ->  Next = stop
    ;   parts_call(acts, Here, [Id, move]),
        set_out(Dest, Hole, Goals, Id-Here, Next)
    ).
effect(move(Host, Options), Hole, Goals, Id-Here, Next) :-
    check_options(move_option, Options),
    destination(Host, Dest),
    (   may_be_away(Dest, Here),
        option(wait(Seconds), Options)
    ->  parts_call(acts, Here, [Id, move]),
        wait_until(Seconds, Here, Until),
        set_out(Dest, wait(Hole, Until), Goals, Id-Here, Next)
    ;   arg(1, Dest, To),
        effect(move(To), Hole, Goals, Id-Here, Next)
    ).
effect(clone(Role), Hole, Goals, Id-Here, go(Goals)) :-
    parts_call(acts, Here, [Id, clone]),
    can_be_kept(Goals),
    copy_term(Hole-Goals-Role, (Role1=clone(Id))-Going-Role1),
    clone_id(Id, CloneId),
    noted_with(CloneId, Hole-Goals-Role, Id),
    agent_clone_here(Id, Going, CloneId),
    Hole = (Role=parent(CloneId)).
effect(clone(Host, Role), Hole, Goals, Id-Here, Next) :-
    destination(Host, Dest),
    (   Dest == local(Here)
    ->  effect(clone(Role), Hole, Goals, Id-Here, Next)
    ;   parts_call(acts, Here, [Id, clone]),
        clone_id(Id, CloneId),
        event(hops, Here, Id, cloned(CloneId)),
        hop_clone(Id, Dest, CloneId, Role, Hole, Goals),
        Next = stop
    ).
effect(sleep(Seconds), sleep(inf), Goals, Id-_, stop) :-
    infinite(Seconds),
    !,
    can_be_kept(Goals),
    with_agent(Id, agent_rest(Id, sleeping(inf), Goals)).
effect(sleep(Seconds), Hole, Goals, Id-Here, Next) :-
    must_be(number, Seconds),
    wait_until(Seconds, Here, Until),
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
        wait_until(Seconds, Here, Until),
        effect(receive_until(Message, Until, Seconds), Hole, Goals, Id-Here,
               Next)
    ).
effect(receive_until(Message, Until, Seconds), Hole, Goals, Id-Here, Next) :-
    receive(Message, Until, receive_until(Message, Until, Seconds), Hole,
            Goals, Id-Here, Next).
effect(receive_until(Message, Until), Hole, Goals, Where, Next) :-
    effect(receive_until(Message, Until, 0), Hole, Goals, Where, Next).
effect(dispose, _, _, Id-_, stop) :-
    ignore(agent_end(Id, disposed)).
effect('$fault'(Fault), '$fault'(Fault), Goals, Id-_, stop) :-
    (   fault_error(Fault, _)
    ->  agent_stays(Id, Goals)
    ;   domain_error(fault, Fault)      % the program has made it up
    ).

%   The parent has the id of its clone from the moment the clone exists.

noted_with(CloneId, Hole-Goals-Role, Id) :-
    \+ \+ ( Hole = (Role=parent(CloneId)),
            agent_note(Id, ready, Goals) ).

%   Goals that wait are stored in clauses, which cannot hold attributes of
%   variables.

can_be_kept(Goals) :-
    (   term_attvars(Goals, [Var|_])
    ->  type_error(mobile_term, Var)
    ;   true
    ).

%   wait_until(+Seconds, +Here, -Until): in host time.

wait_until(Seconds, _, inf) :-
    infinite(Seconds),
    !.
wait_until(Seconds, Here, Until) :-
    host_time(Here, Now),
    Until is Now+Seconds.

infinite(Seconds) :- Seconds == inf.
infinite(Seconds) :- Seconds == infinite.
infinite(Seconds) :- float(Seconds), Seconds =:= inf.

%   receive(+Message, +Until, +Again, ...): take a message or wait for it;
%   Again is the goal that repeats this when the agent is woken.

receive(Message, Until, Again, Hole, Goals, Id-Here, Next) :-
    with_agent(Id, take_or_wait(Message, Until, Again, Hole, Goals,
                                Id-Here, Stamp, Next)),
    (   Next \== stop
    ->  report_received(Hole, Message, Id-Here)
    ;   number(Stamp)
    ->  alarm_set(Stamp, Id, until(Until))
    ;   true
    ).

report_received(true, From-Message, Id-Here) :-
    !,
    event(messages, Here, Id, received(From, Message)).
report_received(_, _, _).               % timeout

take_or_wait(Message, _, _, true, Goals, Id-_, _, go(Goals)) :-
    mail_take(Id, Message),
    !.
take_or_wait(Message, Until, Again, Hole, Goals, _-Here, _, go(Goals)) :-
    number(Until),
    host_time(Here, Now),
    Now >= Until,
    !,
    Again = receive_until(Message, _, Seconds),
    answer_at(receive(Message, Seconds), fail, Hole).
take_or_wait(Message, Until, Again, Again, Goals, Id-Here, Stamp, stop) :-
    can_be_kept(Goals),
    (   number(Until)
    ->  real_time(Here, Until, Stamp)
    ;   true
    ),
    agent_rest(Id, waiting(Message, Until), Goals).

%   As soon as the agent rests another thread may end it, and stop the host
%   with its clock: so the stamp is computed before.

wait(Id, Host, Status, Until, Goals) :-
    can_be_kept(Goals),
    real_time(Host, Until, Stamp),
    with_agent(Id, agent_rest(Id, Status, Goals)),
    alarm_set(Stamp, Id, until(Until)).

typhon_scheduler:fire(Id, until(Until)) :-
    !,
    ignore(with_agent(Id, rouse(Id, Until))).
typhon_scheduler:fire(Id, leave) :-
    !,
    (   agent(Id, Host, _, _, _)
    ->  schedule(Host, Id)
    ;   true
    ).

rouse(Id, Until) :-
    rests(Id, Until, Goals),
    !,
    agent_wakes(Id, Goals).

rests(Id, Until, Goals) :-
    agent_rests(Id, Status, Goals),
    (   Status = sleeping(Until)
    ;   Status = waiting(_, Until)
    ).

typhon_scheduler:over(Id, until(Until)) :-
    \+ rests(Id, Until, _).
typhon_scheduler:over(Id, leave) :-
    \+ agent_status(Id, leaving(_, _), _).

%   Agents of one program tend to block alike.

typhon_scheduler:kind(Id, Program) :-
    agent_here(Id, _, _, Program, _).

                /*******************************
                *        MOVE AND CLONE        *
                *******************************/

set_out(Dest, Hole, Goals, Id-Here, Next) :-
    agent(Id, _, _, _, Life),
    life_may_move(Life, May),
    set_out(May, Life, Dest, Hole, Goals, Id-Here, Next).

set_out(static, _, _, _, _, Id-_, _) :-
    permission_error(move, static_agent, Id).
set_out(end, _, _, _, _, Id-_, stop) :-
    ignore(agent_end(Id, disposed)).
set_out(go, Life, Dest, Hole, Goals, Id-Here, Next) :-
    host_time(Here, Now),
    report_leaving(Dest, Id, Here),
    (   host_option(Here, hop_time(uniform(Min, Max)))
    ->  hop_delay(Id, Here, Life, Min, Max, Delay),
        At is Now+Delay,
        real_time(Here, At, Stamp),
        with_agent(Id, agent_put(Id, leaving(Dest, At),
                                 hop(Hole-Goals, Now))),
        alarm_set(Stamp, Id, leave),
        Next = stop
    ;   hop(Id, Dest, Hole, Goals, Now, Next)
    ).

report_leaving(Dest, Id, Here) :-
    (   event_subscribed(hops)
    ->  dest_address(Dest, Address),
        event(hops, Here, Id, left(Address))
    ;   true
    ).

dest_address(local(Name), Address) :-
    host_address(Name, Address).
dest_address(remote(Address, _, _), Address).

%   On a host with a seed the delay follows from the seed, the agent and the
%   number of its hops.

hop_delay(Id, Here, Life, Min, Max, Delay) :-
    host_option(Here, seed(Seed0)),
    !,
    life_hops(Life, Hops),
    agent_name(Id, Name, Number),
    chance_hash(hop(Seed0, Name, Number, Hops), Seed),
    chance_seed(Seed, Chance),
    chance_uniform(Min, Max, Delay, Chance, _).
hop_delay(_, _, _, Min, Max, Delay) :-
    Delay is Min+random_float*(Max-Min).

%   may_be_away(+Dest, +Here): also while the agent is on its way out.

may_be_away(remote(_, _, _), _).
may_be_away(local(Name), Here) :-
    Name \== Here,
    time_kind(Kind),
    time_apart(Kind, _).

%   A name that no host has is handled like a host that another process lacks.

destination(Host, Dest) :-
    catch(host_resolve(Host, Dest),
          error(existence_error(host, _), Context),
          throw(error(move_refused(Host, unknown_host), Context))).

%!  effect_depart(+Id, +Where, +Hole, +Goals, +Since, -Next) is det.
%
%   The delay of the hop is over: send the agent.  Errors for terms that cannot
%   be sent are raised at this point.

effect_depart(Id, Dest, Hole, Goals, Since, Next) :-
    catch(hop(Id, Dest, Hole, Goals, Since, Next),
          error(Formal, Where),
          ( cannot_depart(Hole, Id, Dest, error(Formal, Where)),
            with_agent(Id, agent_ready(Id, Goals)),
            Next = stop
          )).

cannot_depart(Hole, _, Dest, Error) :-
    var(Hole),                          % it is a variable of Goals
    !,
    arg(1, Dest, Host),
    answer_at(move(Host), throw(Error), Hole).
cannot_depart(wait(Hole, _), Id, Dest, Error) :-
    cannot_depart(Hole, Id, Dest, Error).
cannot_depart(ordered, Id, _, error(Formal, _)) :-
    move_failed(Id, Formal).

%!  effect_order(+Id, +Here, +Host, +Goals) is det.
%
%   Id, which is on Here and has Goals left, takes the order to move to Host.

effect_order(Id, Here, Host, Goals) :-
    host_resolve(Host, Dest),
    (   Dest == local(Here)
    ->  ignore(move_over(Id, answer(arrived))),
        with_agent(Id, agent_ready(Id, Goals))
    ;   set_out(Dest, ordered, Goals, Id-Here, _)
    ).
