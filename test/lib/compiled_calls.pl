:- module(test_compiled_calls,
          [ compiled_calls/2            % +Body, -Calls
          ]).
:- use_module(library(lists), [member/2]).

/** <module> What the code of a clause calls

*Threading*: any thread.
*/

%!  compiled_calls(+Body, -Calls) is det.
%
%   Calls are the Name/Arity of the calls in the code of a clause with this
%   body, or elsewhere(PI) if they are made in another module, or meta(PI) if
%   they depend on the arguments.  Calls is [] if SWI-Prolog refuses the body.

compiled_calls(Body, Calls) :-
    catch(setup_call_cleanup(
              assertz('test compiled':(p :- Body), Clause),
              findall(Call, calls(Clause, 0, Call), Calls0),
              erase(Clause)),
          error(_, _), Calls0 = []),
    sort(Calls0, Calls).

calls(Clause, PC, Call) :-
    \+ clause_property(Clause, fact),
    '$fetch_vm'(Clause, PC, Next, Instruction),
    (   instruction(Instruction, Call)
    ;   calls(Clause, Next, Call)
    ).

instruction(Instruction, Call) :-
    Instruction =.. [Name|Args],
    sub_atom(Name, 0, _, _, i_),
    (   by_arguments(Name)
    ->  Call = meta(Instruction)
    ;   member(Arg, Args),
        nonvar(Arg),
        indicator(Arg, PI)
    ->  ( sub_atom(Name, _, _, 0, m) -> Call = elsewhere(PI) ; Call = PI )
    ;   fail
    ).

by_arguments(i_usercall0).
by_arguments(i_usercalln).
by_arguments(i_call1).
by_arguments(i_calln).
by_arguments(i_det).

indicator(Name/Arity, Name/Arity) :-
    atom(Name),
    integer(Arity).
indicator(_:Name/Arity, Name/Arity).
