:- module(typhon_places,
          [ places/2,                   % +Locations, -Places
            place/3,                    % +Places, +N, -Place
            is_places/1                 % @Term
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, nth1/3]).

/** <module> Where the clauses of a program stand

Places say of each clause of a program, in order, in which line of which
file it stands: a list of File-Lines, one for each run of clauses from one
file, short enough to travel with the program.  Programs that do not come
from a file have none: [].  Two programs that differ in nothing else are
the same.

*Threading*: pure.
*/

%!  places(+Locations:list, -Places) is det.
%
%   Locations are those of the clauses, see typhon_source.

places([File:Line|Locations], [File-[Line|Lines]|Places]) :-
    !,
    in_file(Locations, File, Lines, Rest),
    places(Rest, Places).
places(_, []).

in_file([File:Line|Locations], File, [Line|Lines], Rest) :-
    !,
    in_file(Locations, File, Lines, Rest).
in_file(Rest, _, [], Rest).

%!  place(+Places, +N:positive_integer, -Place) is semidet.
%
%   Place is the File:Line of the N-th clause.  Fails if it is not known.

place([File-Lines|Places], N, Place) :-
    length(Lines, Count),
    (   nth1(N, Lines, Line)
    ->  Place = File:Line
    ;   Later is N-Count,
        place(Places, Later, Place)
    ).

%!  is_places(@Term) is semidet.

is_places(Places) :-
    is_list(Places),
    maplist(run_of_lines, Places).

run_of_lines(Run) :-
    subsumes_term(_-_, Run),
    Run = File-Lines,
    atom(File),
    is_list(Lines),
    forall(member(Line, Lines), integer(Line)).
