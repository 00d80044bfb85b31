:- module(typhon_ordered_moves,
          [ move_awaited/2,             % +Id, +Asker
            move_failed/2,              % +Id, +Formal
            move_over/2                 % +Id, +Answer
          ]).

/** <module> Callers that wait for a move that they ordered

A caller of agent_move/3 waits until the agent is there.  The process in which
the agent takes the order knows how its next hop ends.

*Threading*: any thread.
*/

:- multifile
    answered/2.                 % Asker, Answer: hook

:- dynamic
    waits/2.                    % Id, Asker

%!  move_awaited(+Id, +Asker) is det.
%
%   Id is about to move on an order; Asker waits for the outcome.

move_awaited(Id, Asker) :-
    assertz(waits(Id, Asker)).

%!  move_over(+Id, +Answer) is semidet.
%
%   The move of Id is over: all that wait for it get Answer, answer(arrived),
%   error(Formal), or `none` if Id has ended.  Fails if none waits.

move_over(Id, Answer) :-
    waits(Id, _),
    !,
    forall(retract(waits(Id, Asker)), answered(Asker, Answer)).

%!  move_failed(+Id, +Formal) is det.
%
%   Id stays: the callers that wait get error(Formal).  If none waits, this
%   process reports it.

move_failed(Id, Formal) :-
    (   move_over(Id, error(Formal))
    ->  true
    ;   print_message(warning, typhon(order_failed(Id, Formal)))
    ).
