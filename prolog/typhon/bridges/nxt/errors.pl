:- module(typhon_nxt_errors,
          [ nxt_failure/4               % +Answer, +Brick, +Port, +What
          ]).

/** <module> What can go wrong with a brick

*Threading*: any thread.
*/

:- multifile
    prolog:error_message//1.

%!  nxt_failure(+Answer, +Brick, +Port, +What) is failure.
%
%   Raise the error that an answer of the helper, or its missing, means. The
%   context is context(nxt(Brick, What), Text), Text being the words of the
%   helper.
%
%   @error existence_error(nxt_port, Port) if there is no such port
%   @error permission_error(open, nxt_port, Port)
%   @error permission_error(lock, nxt_port, Port) if another program has it
%   @error timeout_error(nxt(What), Brick) if the brick is silent
%   @error nxt_error(refused(Status), Brick), Status being the name of the
%          status byte
%   @error nxt_error(line_lost, Brick)
%   @error nxt_error(garbage, Brick) if there was an answer that is none
%   @error nxt_error(open_failed, Brick) for other reasons
%   @error nxt_error(helper_died(Status), Brick), Status as of
%          process_wait/2, or `stuck` if it had to be killed
%   @error existence_error(python_module, serial)
%   @error existence_error(python, Program)
%   @error existence_error(nxt_brick, Brick) if it was disconnected meanwhile
%   @error domain_error(nxt_request, What) if the helper does not take it

nxt_failure(Answer, Brick, Port, What) :-
    failure(Answer, Brick, Port, What, Formal, Text),
    throw(error(Formal, context(nxt(Brick, What), Text))).

failure(said(Dict), Brick, Port, What, Formal, Text) :-
    get_dict(error, Dict, Kind),
    get_dict(message, Dict, Text0),
    (   Kind == no_pyserial,
        get_dict(python, Dict, Python)
    ->  atomic_list_concat([Python, ': ', Text0], Text)
    ;   Text = Text0
    ),
    formal(Kind, Dict, Brick, Port, What, Formal).
failure(died(Status), Brick, _, _, nxt_error(helper_died(Status), Brick), _).
failure(stuck, Brick, _, _, nxt_error(helper_died(stuck), Brick), _).
failure(closed, Brick, _, _, existence_error(nxt_brick, Brick), _).
failure(error(Formal, Context), _, _, _, Formal, Text) :-
    ( Context = context(_, Text) -> true ; true ).

formal(no_such_port, _, _, Port, _, existence_error(nxt_port, Port)) :- !.
formal(permission, _, _, Port, _,
       permission_error(open, nxt_port, Port)) :- !.
formal(busy_port, _, _, Port, _,
       permission_error(lock, nxt_port, Port)) :- !.
formal(timeout, _, Brick, _, What, timeout_error(nxt(What), Brick)) :- !.
formal(refused, Dict, Brick, _, _, nxt_error(refused(Status), Brick)) :-
    !,
    get_dict(status, Dict, Status).
formal(no_pyserial, _, _, _, _,
       existence_error(python_module, serial)) :- !.
formal(bad_request, _, _, _, What, domain_error(nxt_request, What)) :- !.
formal(Kind, _, Brick, _, _, nxt_error(Kind, Brick)).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(existence_error(nxt_port, Port)) -->
    [ 'There is no port ~w'-[Port] ].
prolog:error_message(existence_error(nxt_brick, Brick)) -->
    [ 'No brick ~w is connected'-[Brick] ].
prolog:error_message(existence_error(python, Python)) -->
    [ 'There is no Python ~w (install python3, or set \c
       typhon_nxt_helper:python)'-[Python] ].
prolog:error_message(existence_error(python_module, serial)) -->
    [ 'This Python has no pyserial (install it: apt install \c
       python3-serial, or pip install pyserial)' ].
prolog:error_message(permission_error(open, nxt_port, Port)) -->
    [ 'You may not use ~w (is your user in the group dialout?)'-[Port] ].
prolog:error_message(permission_error(lock, nxt_port, Port)) -->
    [ 'Another program uses ~w'-[Port] ].
prolog:error_message(permission_error(connect, nxt_brick, Brick)) -->
    [ 'A brick ~w is connected already'-[Brick] ].
prolog:error_message(timeout_error(nxt(What), Brick)) -->
    [ 'Brick ~w did not answer ~w in time'-[Brick, What] ].
prolog:error_message(domain_error(nxt_request, What)) -->
    [ 'No brick can be asked for such a ~w'-[What] ].
prolog:error_message(nxt_error(Problem, Brick)) -->
    problem(Problem, Brick).

problem(refused(Status), Brick) -->
    [ 'Brick ~w refuses: ~w'-[Brick, Status] ].
problem(line_lost, Brick) -->
    [ 'The line to brick ~w was lost'-[Brick] ].
problem(garbage, Brick) -->
    [ 'What brick ~w answered makes no sense'-[Brick] ].
problem(open_failed, Brick) -->
    [ 'The port of brick ~w cannot be opened'-[Brick] ].
problem(low_battery(Volts), Brick) -->
    [ 'The battery of brick ~w is low: ~w'-[Brick, Volts] ].
problem(slow(Time), Brick) -->
    [ 'Brick ~w takes ~w to answer'-[Brick, Time] ].
problem(helper_died(stuck), Brick) -->
    [ 'The helper of brick ~w did not answer, and was killed'-[Brick] ].
problem(helper_died(Status), Brick) -->
    [ 'The helper of brick ~w ended: ~w'-[Brick, Status] ].
problem(Problem, Brick) -->
    [ 'Brick ~w: ~w'-[Brick, Problem] ].
