:- module(typhon_probe,
          [ probe_start/3,              % +Context, +Goals, -Probe
            probe_next/2,               % +Probe, -Step
            probe_stop/1                % +Probe
          ]).
:- use_module('../../kernel/program',
              [fault_note/1, fault_noted/1, machine_run/3, plain_goals/2]).

/** <module> The machine, goal by goal

To see what an agent does goal by goal, run it in a probe: an engine
in which the machine stops before each goal that it looks up.  Between two
goals it is a term that holds no thread, with all choice points.

The machine knows nothing of it.  It looks a goal up in the table
'$mobile'/6 of the program's module; here it is given this module in place of
that, whose table says which goal it is, and then looks it up where it is to
be found.  What Prolog runs to its end by itself is one goal.

*Threading*: one thread at a time has a probe; it may be another each time.
*/

%!  probe_start(+Context, +Goals, -Probe) is det.
%!  probe_next(+Probe, -Step) is det.
%!  probe_stop(+Probe) is det.
%
%   Probe runs Goals as machine_run/3 does.  Each Step is goal(Goal, Goals),
%   which is next, with those that come after it as far as the machine has
%   them at hand, or, the last one, outcome(Outcome, Goals0), Goals0 being those
%   with which it began.  Nothing is left of a probe after that, or when it is
%   stopped; what was the matter is noted in the thread that took the outcome.

probe_start(context(Program, Agent), Goals, Probe) :-
    (   nb_current(typhon_context, Context)
    ->  true
    ;   Context = none
    ),
    engine_create(Step, run(Context, Program, Agent, Goals, Step), Probe).

%   Global variables are the engine's own.

run(Context, Program, Agent, Goals, outcome(Outcome, Goals)-Note) :-
    nb_setval(typhon_context, Context),
    nb_setval(typhon_probed, Program),
    machine_run(context(typhon_probe, Agent), Goals, Outcome),
    fault_noted(Note),
    stops_at(Outcome).

stops_at(Outcome) :-
    (   Outcome = effect(Control, _, [_|Goals]),
        \+ again(Control)
    ->  engine_yield(goal(Control, Goals)-none)
    ;   true
    ).

%   An agent that is woken looks whether its time has come.

again(sleep_until(_)).
again(receive_until(_, _)).
again(receive_until(_, _, _)).
again('$fault'(_)).

:- public '$mobile'/6.

'$mobile'(Goal, Program:Clause, More, Goals, Barrier, Guard) :-
    plain_goals(Goals, Left),
    engine_yield(goal(Goal, Left)-none),
    nb_getval(typhon_probed, Program),
    Program:'$mobile'(Goal, Clause, More, Goals, Barrier, Guard).

probe_next(Probe, Step) :-
    engine_next(Probe, Step0-Note),
    Step = Step0,
    (   Step = outcome(_, _)
    ->  fault_note(Note),
        probe_stop(Probe)
    ;   true
    ).

probe_stop(Probe) :-
    engine_destroy(Probe).
