:- module(typhon_places,
          [ clauses_names/2,            % +Places, -Lists
            place/3,                    % +Places, +N, -Place
            is_places/1                 % @Term
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3]).

/** <module> The places of the clauses of a program

Places hold the file and the line of each clause of a program, in order.  They
are a list of File-Lines, one for each run of clauses from one file, short
enough to be sent with the program.  Where the names of variables are known,
names(Lists) follows, with the names of the variables of each clause, in the
order of term_variables/2.  Programs that do not come from a file have no
places: [].  Two programs that differ only in places are the same.

*Threading*: pure.
*/

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
