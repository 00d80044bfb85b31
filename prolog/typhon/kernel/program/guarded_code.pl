:- module(typhon_guarded_code,
          [ code_guarded/3,             % +Policy, +Hash, -Module
            code_check/3                % +Policy, +Hash, +Sent
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(code, [code_make/3, code_module/2, code_program/2]).
:- use_module(guard, [guard_program/3]).
:- use_module(mobile, [mobile_predicates/3]).
:- use_module(source, [clause_parts/3]).

/** <module> Programs as hosts have them that guard

Beside a program there is for each policy what it is rewritten to, see
typhon_guard, once in the process; it goes after the program.

*Threading*: any thread; a mutex guards the table.
*/

:- multifile typhon_code:retiring/1.

:- dynamic
    variant/3,                  % Hash, Policy, Module
    retired/1.                  % Module: goes next time

%!  code_guarded(+Policy, +Hash, -Module) is det.
%
%   Module has the program Hash, which is installed, as Policy lets it run.
%
%   @error permission_error(call, sandboxed, Culprit)

code_guarded(Policy, Hash, Module) :-
    variant(Hash, Policy, Module0),
    !,
    Module = Module0.
code_guarded(Policy, Hash, Module) :-
    code_program(Hash, Program0),
    guard_program(Policy, Program0, Program),
    kinds(Program0, Kinds),
    with_mutex(typhon_guarded_code,
               make(Hash, Policy, Program, Kinds, Module)).

make(Hash, Policy, _, _, Module) :-
    variant(Hash, Policy, Module0),
    !,
    Module = Module0.
make(Hash, Policy, Program, Kinds, Module) :-
    code_make(Program, Kinds, Module),
    assertz(variant(Hash, Policy, Module)).

kinds(program(_, _, _, Clauses), Kinds) :-
    findall((Head:-Body)-none,
            ( member(Clause, Clauses), clause_parts(Clause, Head, Body) ),
            Rules),
    mobile_predicates(Rules, Kinds, _).

%!  code_check(+Policy, +Hash, +Sent) is det.
%
%   Look at a program that is not installed yet: already its libraries could
%   be unwanted here.  Sent is as of code_receive/2.
%
%   @error permission_error(call, sandboxed, Culprit)

code_check(_, Hash, _) :-
    code_module(Hash, _),
    !.                                  % it was checked here
code_check(Policy, _, Sent) :-
    ( subsumes_term(_-_, Sent) -> Sent = Program-_ ; Program = Sent ),
    (   subsumes_term(program(_, _, _, _), Program),
        acyclic_term(Program)
    ->  guard_program(Policy, Program, _)
    ;   true                            % is no program, or comes later
    ).

typhon_code:retiring(Hash) :-
    with_mutex(typhon_guarded_code, retire(Hash)).

retire(Hash) :-
    forall(retract(retired(Module)), '$destroy_module'(Module)),
    forall(retract(variant(Hash, _, Module)), assertz(retired(Module))).
