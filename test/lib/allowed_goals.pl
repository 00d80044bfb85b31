:- module(test_allowed_goals,
          [ nameable/1,                 % ?Head
            allowed_goal/2              % ?Head, ?How
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program), [vocabulary_word/2]).
:- use_module(library(typhon/options/guard/allowed),
              [allowed/3, allowed_library/1, policy_read/1]).

/** <module> Goals that the policy `guarded` allows

*Threading*: any thread.
*/

%!  nameable(?Head) is nondet.
%
%   Agents can name this predicate of the system, of a library that they may
%   use, or of their vocabulary.

nameable(Head) :-
    predicate_property(system:Head, defined).
nameable(Head) :-
    (   vocabulary_word(_, Name/Arity)
    ;   allowed_library(Library),
        use_module(test_allowed_libraries:Library),
        absolute_file_name(Library, File, [file_type(prolog), access(read)]),
        module_property(Module, file(File)),
        module_property(Module, exports(PIs)),
        member(Name/Arity, PIs)
    ),
    functor(Head, Name, Arity).

%!  allowed_goal(?Head, ?How) is nondet.
%
%   Goals like Head are allowed, How as of allowed/3.

:- table allowed_goal/2.

allowed_goal(Head, How) :-
    policy_read(guarded),
    nameable(Head),
    allowed(guarded, Head, How).
