:- module(typhon_unknown,
          [ unknown_problems/2,         % +Located, -Problems
            unknown_advice/3            % +PI, +Own, -Advice
          ]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module('../base/names', [names_near/3]).
:- use_module(mobile, [body_calls/2, built_in/1, near_built_in/2]).
:- use_module(parts, [file_parts/4, library_directive/2, part/3]).

/** <module> Calls of predicates that a program does not define

A place or a payload may define them, or the name is mistyped.  They are
problems as in typhon_problems.

*Threading*: pure, but that a library is looked up.
*/

%!  unknown_problems(+Located, -Problems:list) is det.
%
%   Problems are unknown_procedure(PI) for each predicate that the agent
%   program Located calls, and neither it nor Prolog nor the vocabulary
%   defines.  What the program changes is its state, declared or not.

unknown_problems(Located, Problems) :-
    file_parts(agent, Located, Parts, _),
    part(rules, Parts, Rules),
    findall(PI, own(Parts, PI), Own0),
    sort(Own0, Own),
    findall(problem(unknown_procedure(PI), Location, Advice),
            ( unknown(Rules, Own, Parts, PI, Location),
              unknown_advice(PI, Own, Advice) ),
            Problems0),
    sort(Problems0, Problems).

unknown(Rules, Own, Parts, PI, Location) :-
    member((_:-Body)-Location, Rules),
    body_calls(Body, Calls),
    member(call(PI, _), Calls),
    \+ memberchk(PI, Own),
    \+ built_in(PI),
    \+ imported(Parts, PI).

own(Parts, Name/Arity) :-
    part(rules, Parts, Rules),
    member((Head:-_)-_, Rules),
    callable(Head),
    functor(Head, Name, Arity).
own(Parts, PI) :-
    part(rules, Parts, Rules),
    member((_:-Body)-_, Rules),
    body_calls(Body, Calls),
    member(changes(PI), Calls).
own(Parts, PI) :-
    part(state, Parts, State),
    member(PI, State).

imported(Parts, PI) :-
    library_directive(Parts, Library-_),
    exports(Library, PI),
    !.

exports(Library, PI) :-
    absolute_file_name(Library, File,
                       [ file_type(prolog), access(read),
                         file_errors(fail) ]),
    load_files(File, [if(not_loaded), imports([])]),
    module_property(Module, file(File)),
    exported(Module, PI).

exported(Module, PI) :-
    module_property(Module, exports(Exports)),
    memberchk(PI, Exports).

%!  unknown_advice(+PI, +Own:list, -Advice) is det.
%
%   Advice, see typhon_advice, says what to do about a call of PI in a program
%   whose own predicates are Own: import library(typhon), or call what has the
%   same name and another arity, or a name like it.

unknown_advice(PI, _, of_library(typhon)) :-
    exported(typhon, PI),
    !.
unknown_advice(Name/Arity, Own, offered(Near)) :-
    findall(PI, ( member(PI, Own) ; near_built_in(Name/Arity, PI) ), PIs),
    findall(Name/N, member(Name/N, PIs), Same),
    ( Same == [] -> Known = PIs ; Known = Same ),
    sort(Known, Sorted),
    names_near(Name, Sorted, Near).
