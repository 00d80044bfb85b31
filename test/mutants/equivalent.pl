:- module(test_equivalent,
          [ equivalent_change/2         % +Change, -Reason
          ]).

/** <module> Changes that change nothing that can be observed

*Threading*: any thread.
*/

:- use_module(changes, [change_words/3]).

%   equivalent(File, Predicate, Kind, Old, New, Reason): Old and New are the
%   words of the text before and after.

:- dynamic equivalent/6.

%!  equivalent_change(+Change, -Reason:string) is semidet.

equivalent_change(Change, Reason) :-
    Change = change(File, _, _, _, Kind, Predicate, _),
    equivalent(File, Predicate, Kind, _, _, _),
    change_words(Change, Old, New),
    equivalent(File, Predicate, Kind, Old, New, Reason).
