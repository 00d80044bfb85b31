:- module(typhon_traced,
          [ traced_change/2,            % +Id, +Change
            traced_held/1               % +Id
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module('../agent',
              [ agent/5, agent_put_life/2, agent_status/3, agent_unorder/2,
                life_traces/2, set_traces_of_life/3, with_agent/2 ]).
:- use_module(on_hold, [held_on/2]).
:- use_module(questions, [question_answered/2]).

/** <module> Tracers of an agent, and their end

The traces of an agent, see typhon_traces, are changed by the order
watched(Change), where Change is trace(To, Kinds), `step` or none(To).

*Threading*: whoever has the agent.
*/

%!  traced_change(+Id, +Change) is det.
%
%   Id, which belongs to the caller or is held, obeys watched(Change).

traced_change(Id, Change) :-
    with_agent(Id, change(Id, Change)).

change(Id, Change) :-
    agent(Id, _, _, _, Life0),
    !,
    life_traces(Life0, Traces0),
    changed(Change, Traces0, Traces),
    set_traces_of_life(Traces, Life0, Life),
    agent_put_life(Id, Life),
    release(Traces, Id).

changed(trace(To, Kinds), Traces0, [trace(To, Kinds)|Traces]) :-
    exclude(is_of(To), Traces0, Traces).
changed(step, Traces0, [step|Traces]) :-
    exclude(==(step), Traces0, Traces).
changed(none(To), Traces0, Traces) :-
    exclude(is_of(To), Traces0, Traces1),
    exclude(==(step), Traces1, Traces).

is_of(To, trace(To, _)).

%   An agent that is held, and need not be any more, goes on.

release(Traces, Id) :-
    (   \+ memberchk(step, Traces),
        agent_status(Id, held, Held)
    ->  held_on(Id, Held)
    ;   true
    ).

%!  traced_held(+Id) is det.
%
%   Other orders wait for an effect; if Id is held it takes these now, and
%   questions that followed it.

traced_held(Id) :-
    with_agent(Id, ( agent_status(Id, held, _),
                     taken(Id, Asker, Answer) )),
    !,
    question_answered(Asker, answer(Answer)),
    traced_held(Id).
traced_held(_).

taken(Id, Asker, ok) :-
    agent_unorder(Id, asked(watched(Change), Asker)),
    change(Id, Change).
taken(Id, Asker, again) :-
    agent_unorder(Id, asked(question(_), Asker)).
