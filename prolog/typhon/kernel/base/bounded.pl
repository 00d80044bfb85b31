:- module(typhon_bounded,
          [ bounded/2                   % :Fact, +Setting
          ]).
:- use_module(library(settings), [setting/2]).

/** <module> Tables that forget the oldest

*Threading*: inside the mutex of the table, or where it does not matter that
a fact too many is forgotten.
*/

:- meta_predicate bounded(0, +).

:- multifile forgotten/1.               % Fact

%!  bounded(:Fact, +Setting) is det.
%
%   A fact like Fact was added.  Now and then forget the oldest of what
%   exceeds Setting, module:name.

bounded(Fact, Setting) :-
    Setting = _:Key,
    flag(Key, N, N+1),
    (   N mod 100 =:= 0
    ->  setting(Setting, Max),
        predicate_property(Fact, number_of_clauses(Count)),
        Excess is Count-Max,
        forall(between(1, Excess, _), forget(Fact))
    ;   true
    ).

%   Modules that hold it elsewhere are notified.

forget(Fact) :-
    (   retract(Fact)
    ->  strip_module(Fact, _, Plain),
        forall(forgotten(Plain), true)
    ;   true
    ).
