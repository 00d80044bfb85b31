/*  The end of plans for settings, and the comparison of two solutions.
    Included in learning algorithms.
*/

%!  repeated(+Settings, -Actions) is det.
%
%   Actions use Settings for as many successive pages as the goal requires.

repeated(Settings, [use(Settings)|Again]) :-
    (   setting(pages, Pages)
    ->  true
    ;   Pages = 4
    ),
    Times is Pages - 1,
    length(Again, Times),
    maplist(=(again), Again).

%!  better(+Actions, +Others) is semidet.
%
%   True if Actions needs fewer pages than Others: fewer actions mean a shorter
%   search on one printer.

better(Actions, Others) :-
    length(Actions, Length),
    length(Others, OthersLength),
    Length < OthersLength.
