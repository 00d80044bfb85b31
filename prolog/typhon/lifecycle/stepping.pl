:- module(typhon_stepping,
          [ agent_step/1,               % +Agent
            is_probed/3,                % +Host, +Life, +Hash
            probed_goal/6,              % +Id, +Host, +Probe, +Goal, +Goals,
                                        % -Next
            probe_rests/1               % +Id
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../host', [event/4, event_heard/1, host/3, quota_any/1]).
:- use_module('../agent',
              [ agent/5, agent_order/2, agent_status/3, in_words/2,
                life_traces/2,
                with_agent/2 ]).
:- use_module(on_hold, [held_on/2, held_parts/3, held_put/4, held_seen/2]).
:- use_module(join, [agent_join/3]).
:- use_module(properties, [agent_property/2]).
:- use_module(giving, [agent_answer/3, order_give/3]).
:- use_module(questions, [question_answered/2]).
:- use_module(spying, [spied/3, spied_program/1]).
:- use_module(traced, [traced_change/2]).

/** <module> Agents that are held before each goal

An agent that is stepped, or whose goals are traced, runs in a probe, see
typhon_probe.  Who is stepped is held before each goal, see
typhon_on_hold.

*Threading*: any thread asks; the worker that has the agent runs its probe.
*/

:- multifile
    typhon_questions:here/3.

:- dynamic asker/2.             % Id, Asker: waits until it is held or stops

                /*******************************
                *             ASK              *
                *******************************/

%!  agent_step(+Agent) is det.
%
%   Agent runs its next goal, and is held before the one after it, wherever
%   that is; this goal is printed.  One that is not held yet is held at its
%   next goal, which it comes to after its next effect if it runs now.  Where
%   it stops otherwise, waits for a message or ends, that is printed.
%   agent_notrace/1 lets it go on.
%
%   @error existence_error(agent, Agent)
%   @error timeout_error(order, Agent): it came to no goal within 10 seconds
%   @error permission_error(step, agent, Agent) where there are quotas

agent_step(Agent) :-
    agent_answer(Agent, step, Answer),
    where(Answer, Agent, What),
    print_message(help, typhon(stepped(Agent, What))).

where(not_held, Agent, What) :-
    !,
    order_give(Agent, watched(step), _),
    agent_answer(Agent, step, Answer),
    where(Answer, Agent, What).
where(again, Agent, What) :-
    !,
    agent_answer(Agent, step, Answer),
    where(Answer, Agent, What).
where(bounded, Agent, _) :-
    !,
    permission_error(step, agent, Agent).
where(gone, Agent, What) :-
    !,
    (   agent_property(Agent, host(_))
    ->  where(again, Agent, What)
    ;   agent_join(Agent, Outcome, 5)
    ->  What = ended(Outcome)
    ;   existence_error(agent, Agent)
    ).
where(What, _, What).

typhon_questions:here(step, Agent, Asker) :-
    with_agent(Agent, step(Agent, Asker, Answer)),
    (   Answer == later
    ->  true
    ;   question_answered(Asker, answer(Answer))
    ).

step(Id, Asker, Answer) :-
    agent(Id, Host, _, _, Life),
    once(agent_status(Id, Status, Goals)),
    (   quota_any(Host)
    ->  Answer = bounded
    ;   \+ is_stepped(Life)
    ->  Answer = not_held
    ;   step(Status, Goals, Id-Host, Asker, Answer)
    ).

step(held, Held, Id-Host, Asker, Answer) =>
    held_parts(Held, Goals, Seen),
    (   Seen == true
    ->  assertz(asker(Id, Asker)),
        held_on(Id, Held),
        Answer = later
    ;   held_seen(Id, Held),
        next_goal(Host, Goals, Answer)
    ).
step(Status, _, Id-_, Asker, Answer), runs(Status) =>
    assertz(asker(Id, Asker)),
    Answer = later.
step(Status, _, Id-_, Asker, Answer), under_way(Status) =>
    agent_order(Id, asked(question(step), Asker)),
    Answer = later.
step(Status, _, _, _, Answer) =>
    rests(Status, Answer).

runs(ready).
runs(running).
runs(resumed).
runs(obeying).
runs(arriving).

%   The question follows it.

under_way(leaving(_, _)).
under_way(transit(_, _)).
under_way(cloning(_, _)).

next_goal(Host, [Goal|_], held(Address, Goal)) :-
    host(Host, Address, _).

                /*******************************
                *             RUN              *
                *******************************/

%!  is_probed(+Host, +Life, +Hash) is semidet.
%
%   Somebody wants to see the goals of an agent with this Life and program, and
%   may on Host: nobody could end in time who uses too much in a probe, and a
%   Life says what who has sent the agent likes.

is_probed(Host, Life, Hash) :-
    wanted(Life, Hash),
    \+ quota_any(Host).

wanted(Life, _) :-
    life_traces(Life, Traces),
    Traces \== [],
    wants_goals(Traces),
    !.
wanted(_, Hash) :-
    spied_program(Hash).

wants_goals(Traces) :-
    member(Trace, Traces),
    (   Trace == step
    ;   Trace = trace(_, Kinds),
        memberchk(goals, Kinds)
    ),
    !.

is_stepped(Life) :-
    life_traces(Life, Traces),
    memberchk(step, Traces).

%!  probed_goal(+Id, +Host, +Probe, +Goal, +Goals, -Next) is det.
%
%   Probe stops before Goal; Next is `on`, or `stop` if Id is held there.

probed_goal(Id, Host, Probe, Goal, Goals, Next) :-
    (   event_heard(goals)
    ->  in_words(Goal, Portable),
        event(goals, Host, Id, goal(Portable))
    ;   true
    ),
    spied_goal(Id, Host, Goal),
    (   agent(Id, _, _, _, Life),
        is_stepped(Life)
    ->  maplist(in_words, [Goal|Goals], Shown),
        with_agent(Id, hold(Id, Host, Probe, Shown, Askers, Answer)),
        answer(Askers, Answer),
        Next = stop
    ;   Next = on
    ).

spied_goal(Id, Host, Goal) :-
    agent(Id, _, _, Hash, _),
    spied(Hash, Goal, Action),
    !,
    in_words(Goal, Portable),
    host(Host, Address, _),
    (   Action == hold
    ->  traced_change(Id, step),
        print_message(help, typhon(spied(Id, Address, Portable)))
    ;   print_message(help, typhon(traced(Id, Address, goal(Portable))))
    ).
spied_goal(_, _, _).

hold(Id, Host, Probe, Goals, Askers, Answer) :-
    askers(Id, Askers),
    (   Askers == []
    ->  Seen = false
    ;   Seen = true
    ),
    held_put(Id, Probe, Goals, Seen),
    next_goal(Host, Goals, Answer).

askers(Id, Askers) :-
    (   retract(asker(Id, Asker))
    ->  Askers = [Asker|More],
        askers(Id, More)
    ;   Askers = []
    ).

answer(Askers, Answer) :-
    forall(member(Asker, Askers), question_answered(Asker, answer(Answer))).

%!  probe_rests(+Id) is det.
%
%   Id has come to an effect that its worker does not go on from: those who
%   wait for its next goal are told so.

probe_rests(Id) :-
    (   asker(Id, _)
    ->  with_agent(Id, stopped(Id, Askers, Answer)),
        answer(Askers, Answer)
    ;   true
    ).

stopped(Id, Askers, Answer) :-
    (   agent_status(Id, Status, _)
    ->  (   runs(Status)                % it comes to a goal yet
        ->  Askers = []
        ;   askers(Id, Askers),
            rests(Status, Answer)
        )
    ;   askers(Id, Askers),
        Answer = gone
    ).

rests(Status, again) :-
    under_way(Status),
    !.
rests(Status, rests(State)) :-
    functor(Status, State, _).
