:- module(typhon_places,
          [ places/2,                   % +Locations, -Places
            places_named/4,             % +Places0, +Clauses, +Sources, -Places
            clauses_names/2,            % +Places, -Lists
            place/3,                    % +Places, +N, -Place
            is_places/1                 % @Term
          ]).
:- use_module(library(apply), [maplist/2, maplist/4]).
:- use_module(library(lists),
              [append/3, member/2, memberchk/2, nth1/3, same_length/2]).

/** <module> The places of the clauses of a program

Places hold the file and the line of each clause of a program, in order.  They
are a list of File-Lines, one for each run of clauses from one file, short
enough to be sent with the program.  Where the names of variables are known,
names(Lists) follows, with the names of the variables of each clause, in the
order of term_variables/2.  Programs that do not come from a file have no
places: [].  Two programs that differ only in places are the same.

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

%!  places_named(+Places0, +Clauses, +Sources, -Places) is det.
%
%   Places are Places0, of Clauses, with the names of variables from Sources,
%   see source_terms/5.

places_named([], _, _, Places) =>
    Places = [].
places_named(Places0, Clauses, Sources, Places) =>
    findall(File:Line, ( member(File-Lines, Places0), member(Line, Lines) ),
            Locations),
    maplist(names_of(Sources), Locations, Clauses, Lists),
    append(Places0, [names(Lists)], Places).

names_of(Sources, Location, Clause, Names) :-
    (   findall(Found, member(names(Location, Found), Sources), [Names0]),
        term_variables(Clause, Variables),
        same_length(Variables, Names0)
    ->  Names = Names0
    ;   Names = []
    ).

%!  clauses_names(+Places, -Lists) is det.
%
%   Lists are lists of names of variables, one for each clause; [] if they are
%   not known.

clauses_names(Places, Lists) :-
    (   memberchk(names(Lists0), Places)
    ->  Lists = Lists0
    ;   Lists = []
    ).

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
%
%   Term has the form of places; it may come from a peer.

is_places(Places) :-
    is_list(Places),
    maplist(is_part, Places).

is_part(Part) :-
    (   subsumes_term(names(_), Part)
    ->  Part = names(Lists),
        is_list(Lists),
        maplist(is_names, Lists)
    ;   run_of_lines(Part)
    ).

%   Names are printed unquoted, so they must be names of variables.

is_names(Names) :-
    is_list(Names),
    forall(member(Name, Names), is_name(Name)).

is_name(Name) :-
    atom(Name),
    atom_codes(Name, [First|Codes]),
    ( First == 0'_ ; code_type(First, upper) ),
    !,
    forall(member(Code, Codes), code_type(Code, csym)).

run_of_lines(Run) :-
    subsumes_term(_-_, Run),
    Run = File-Lines,
    atom(File),
    is_list(Lines),
    forall(member(Line, Lines), integer(Line)).
