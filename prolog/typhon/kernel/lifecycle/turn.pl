:- module(typhon_turn,
          [ turn_engine/3,              % +Agent, +Start, -Engine
            turn_run/5,                 % +Engine, +Turn, +Start, -Outcome,
                                        % -Goals0
            turn_unit/1,                % :Goal
            turn_settled/0,
            turn_concluded/4,           % +Turn, +Outcome, :Conclude, -Next
            turn_broken/1,              % -Outcome
            turn_overruled/2,           % +Host, -Outcome
            turn_bounded/1,             % +Host
            turn_over/1                 % +Id
          ]).
:- use_module('../program', [machine_ready/1, machine_run/3]).
:- use_module('../host', [parts/3]).

/** <module> A turn: one run of the machine, which options may change

A turn is turn(Id, Host, Context): the agent, the host on which it stands, and
the context of the machine.  It starts with goals(Goals), or with
resumed(State) where an option put the agent down in the middle of its goals.
Its engine is `machine`, or a closure of an option that runs the agent in its
place, called with Turn, Start, Outcome and Goals0.

Options change turns at the hooks below, and as the part `turn` of a host, see
typhon_host_parts, and nowhere else.  A hook that no option defines costs one
call that fails.

*Threading*: in the worker that has the agent.
*/

:- meta_predicate
    turn_unit(0),
    turn_concluded(+, +, 1, -).

:- multifile
    engine/3,                   % Agent, Start, Engine
    limit_passed/1,             % Outcome: of the agent that this thread ran,
                                % and that was interrupted at a limit
    unit/2,                     % Run, Conclude: call(Run, Goal) runs an agent,
                                % call(Conclude, Id, Outcome, Goal, Next) the
                                % rest, as one unit of work
    settle/0,                   % that unit ends here
    over/1.                     % Id: its worker leaves it

%!  turn_engine(+Agent, +Start, -Engine) is det.
%
%   What runs Agent, agent(Id, Host, Hash, Life), from here.

turn_engine(Agent, Start, Engine) :-
    (   engine(Agent, Start, Engine0)
    ->  Engine = Engine0
    ;   Engine = machine
    ).

%!  turn_run(+Engine, +Turn, +Start, -Outcome, -Goals0) is det.
%
%   Run the agent to its next stop, from Goals0.  Outcome is that of
%   machine_run/3, `held` if the agent was put down in the middle of its goals,
%   or over(Resource) if it passed a limit.

turn_run(machine, Turn, goals(Goals), Outcome, Goals) :-
    !,
    (   unit(Run, _)
    ->  call(Run, typhon_turn:bounded_run(Turn, Goals, Outcome))
    ;   bounded_run(Turn, Goals, Outcome)
    ).
turn_run(Engine, Turn, Start, Outcome, Goals0) :-
    call(Engine, Turn, Start, Outcome, Goals0).

bounded_run(Turn, Goals, Outcome) :-
    Turn = turn(_, Host, Context),
    (   parts(turn, Host, [Run|_])
    ->  machine_ready(Context),
        call(Run, Turn, Goals, Outcome)
    ;   machine_run(Context, Goals, Outcome)
    ).

%!  turn_unit(:Goal) is det.
%!  turn_concluded(+Turn, +Outcome, :Conclude, -Next) is det.
%!  turn_settled is det.
%
%   Run Goal, in which the agent acts, in the unit of work of this turn;
%   call(Conclude, Next), which does what Outcome asks for, ends the unit; it
%   ends before.

turn_unit(Goal) :-
    (   unit(Run, _)
    ->  call(Run, Goal)
    ;   call(Goal)
    ).

turn_concluded(turn(Id, _, _), Outcome, Conclude, Next) :-
    (   unit(_, Whole)
    ->  call(Whole, Id, Outcome, call(Conclude, Next), Next)
    ;   call(Conclude, Next)
    ).

turn_settled :-
    (   settle
    ->  true
    ;   true
    ).

%!  turn_broken(-Outcome) is det.
%!  turn_overruled(+Host, -Outcome) is semidet.
%
%   How an agent ends that was interrupted in the middle of a goal; that it
%   ends in this way whatever it catches, as it passed a limit on Host.

turn_broken(Outcome) :-
    (   limit_passed(Passed)
    ->  Outcome = Passed
    ;   Outcome = disposed
    ).

turn_overruled(Host, Outcome) :-
    parts(turn, Host, _),
    limit_passed(Outcome),
    !.

%!  turn_bounded(+Host) is semidet.
%
%   Turns on Host have limits.

turn_bounded(Host) :-
    parts(turn, Host, _),
    !.

%!  turn_over(+Id) is det.
%
%   The worker leaves the agent, which rests, goes on elsewhere or has ended.

turn_over(Id) :-
    (   over(Id)
    ->  true
    ;   true
    ).
