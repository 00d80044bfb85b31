/*  How plans for settings end, and which of two solutions is better.  To be
    included in learning algorithms.
*/

%!  repeated(+Settings, -Actions) is det.
%
%   Use Settings for as many pages on end as the goal wants.

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
%   Settings that were good after fewer pages needed less of a search on one
%   printer.

better(Actions, Others) :-
    length(Actions, Length),
    length(Others, OthersLength),
    Length < OthersLength.
