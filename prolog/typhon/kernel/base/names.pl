:- module(typhon_names,
          [ must_be_name/2,             % +Domain, @Name
            names/2,                    % +Kind, -Names
            names_near/3,               % +Name, +Names, -Near
            names_proposed/3,           % +Name, +Names, -Text
            names_listed/2,             % +Names, -Text
            names_joined/3,             % +Names, +Separator, -Text
            names_some/3,               % +Names, +Most, -Text
            counted/3                   % +Count, +Noun, -Text
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [append/3, last/2, member/2]).
:- use_module(text, [is_printable/1]).
:- use_module(library(solution_sequences), [limit/2]).

/** <module> Names, and those that users mistype

The modules that own a kind of names (hosts, programs, options, topologies)
define the names by clauses of known/2.  Messages use them for proposals and
lists, and the top level for completion.

*Threading*: any thread.
*/

:- multifile
    known/2.                    % Kind, Name: an atom, or a term like ring('N')

%!  must_be_name(+Domain, @Name) is det.
%
%   Name can be the name of a host, an agent or a log server.  It has no `@`: the
%   first `@` of an id or address ends the name.  It is printable, because every
%   process that knows the id or address prints it in messages.
%
%   @error type_error(atom, Name), domain_error(Domain, Name)

must_be_name(Domain, Name) :-
    must_be(atom, Name),
    (   Name \== '',
        \+ sub_atom(Name, _, _, _, @),
        is_printable(Name)
    ->  true
    ;   throw(error(domain_error(Domain, Name),
                    context(_, 'a name is not empty, and has no @ and no \c
                                hidden characters')))
    ).

%   Longer lists of names are not searched.

most_names(2000).

%   Longer lists of names are not shown.

most_listed(40).

%!  names(+Kind, -Names:list) is det.
%
%   Names are all names of Kind, each once.

names(Kind, Names) :-
    most_names(Most),
    findall(Name, limit(Most, known(Kind, Name)), Names0),
    sort(Names0, Names).

%!  names_near(+Name:atom, +Names:list, -Near:list) is det.
%
%   Near are up to three of Names that the user may have meant by Name, by
%   dwim_match/2.  An id or address is also compared by the part before the
%   first `.` or `@`, a path by its last part: `census` finds
%   'census.4f2a1@alpha@...', and 'survey/census'.

names_near(Name, Names, Near) :-
    findall(Known,
            limit(3, ( member(Known, Names),
                       once(is_near(Name, Known)) )),
            Near).

is_near(Name, Known) :-
    Name \== Known,
    name_of(Known, Plain),
    form(Name, A),
    form(Plain, B),
    ( A == B ; dwim_match(A, B) ).

name_of(Name/Arity, Name) :-
    integer(Arity),
    !.
name_of(Known, Name) :-
    callable(Known),
    functor(Known, Name, _).

form(Name, Name).
form(Name, Short) :-
    split_string(Name, ".@", "", [Head|_]),
    split_string(Head, "/", "", Parts),
    last(Parts, Short0),
    Short0 \== "",
    atom_string(Short, Short0),
    Short \== Name.

                /*******************************
                *            TEXTS             *
                *******************************/

%!  names_proposed(+Name, +Names:list, -Text:atom) is det.
%
%   Text asks whether one of Names was meant by Name; it is empty if none of
%   them is similar.

names_proposed(Name, Names, Text) :-
    atom(Name),
    names_near(Name, Names, Near),
    Near \== [],
    !,
    names_joined(Near, ' or ', Listed),
    format(atom(Text), ' (did you mean ~w?)', [Listed]).
names_proposed(_, _, '').

%!  names_listed(+Names:list, -Text:atom) is det.
%
%   Text lists Names; it is empty if there are too many.

names_listed(Names, Text) :-
    most_listed(Most),
    length(Names, Count),
    between(1, Most, Count),
    !,
    names_joined(Names, ', ', Listed),
    format(atom(Text), '; there are ~w', [Listed]).
names_listed(_, '').

%!  names_joined(+Names:list, +Separator, -Text:atom) is det.

names_joined(Names, Separator, Text) :-
    maplist(name_text, Names, Texts),
    atomic_list_concat(Texts, Separator, Text).

%!  names_some(+Names:list, +Most, -Text:atom) is det.
%
%   Text is the first Most of Names, and the number of the others.

names_some(Names, Most, Text) :-
    length(Names, Count),
    (   Count > Most
    ->  length(Some, Most),
        append(Some, _, Names),
        names_joined(Some, ', ', Listed),
        More is Count-Most,
        format(atom(Text), '~w and ~D more', [Listed, More])
    ;   names_joined(Names, ', ', Text)
    ).

%!  counted(+Count:integer, +Noun, -Text:atom) is det.
%
%   Text is Count with Noun in the number that it needs: `1 host`, `2 hosts`.

counted(1, Noun, Text) :-
    !,
    atom_concat('1 ', Noun, Text).
counted(Count, Noun, Text) :-
    ( sub_atom(Noun, _, _, 0, ss) -> End = es ; End = s ),
    format(atom(Text), '~D ~w~w', [Count, Noun, End]).

%   name_text(+Name, -Text): ring('N') as ring(N), state(S) as state(_).

name_text(Name, Text) :-
    copy_term(Name, Copy),
    term_variables(Copy, Variables),
    maplist(=('_'), Variables),
    format(atom(Text), '~w', [Copy]).
