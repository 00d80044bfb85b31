:- module(test_crossed,
          [ calls_record/0,
            called_modules/1            % -Modules: and forget them
          ]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).

/** <module> The modules of the platform that any thread calls

Each predicate of these modules that has clauses is wrapped, but for those that
are dynamic or transparent.

*Threading*: flags, one for each module.
*/

%!  calls_record is det.
%!  called_modules(-Modules:list) is det.
%
%   From now on called modules are recorded; Modules are those called since
%   that, or since the last called_modules/1.

calls_record :-
    forall(own_module(Module),
           ( key(Module, Key),
             flag(Key, _, 0),
             wrap_module(Module, Key) )).

called_modules(Modules) :-
    findall(Module,
            ( own_module(Module),
              key(Module, Key),
              flag(Key, 1, 0) ),
            Unsorted),
    sort(Unsorted, Modules).

own_module(Module) :-
    current_module(Module),
    module_property(Module, file(File)),
    sub_atom(File, _, _, _, '/prolog/typhon/').

key(Module, Key) :-
    atom_concat(test_crossed_, Module, Key).

wrap_module(Module, Key) :-
    forall(( current_predicate(_, Module:Head),
             wrappable(Module:Head) ),
           wrap_predicate(Module:Head, test_crossed, Wrapped,
                          test_crossed:noted(Key, Wrapped))).

wrappable(Predicate) :-
    \+ predicate_property(Predicate, imported_from(_)),
    \+ predicate_property(Predicate, dynamic),
    \+ predicate_property(Predicate, transparent),
    predicate_property(Predicate, number_of_clauses(Clauses)),
    Clauses > 0.

:- public noted/2.

noted(Key, Wrapped) :-
    flag(Key, _, 1),
    call(Wrapped).
