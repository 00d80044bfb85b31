:- module(typhon_fipa_directory,
          [ directory_add/4,            % +Directory, +Name, +Description, +Until
            directory_remove/2,         % +Directory, +Name
            directory_has/2,            % +Directory, +Name
            directory_entry/2,          % +Directory, -Description
            directory_forget/1,         % +Directory
            description_matches/2       % +Template, +Description
          ]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(aid, [aid/1, aid_name/2]).

/** <module> Descriptions of agents, and the search for them

A directory is any ground term.  In it each name has one description, which
may be there only until some time.

*Threading*: any thread; a mutex serializes changes.
*/

:- setting(entries, positive_integer, 10000,
           "Descriptions in a directory of FIPA").

:- dynamic entry/4.             % Directory, Name, Description, Until

%!  directory_add(+Directory, +Name, +Description, +Until) is det.
%
%   Replaces the description of Name.  Until is a time stamp, or `inf`.
%
%   @error resource_error(fipa_directory)

directory_add(Directory, Name, Description, Until) :-
    with_mutex(typhon_fipa_directory,
               add(Directory, Name, Description, Until)).

add(Directory, Name, Description, Until) :-
    (   retract(entry(Directory, Name, _, _))
    ->  true
    ;   has_space
    ),
    assertz(entry(Directory, Name, Description, Until)).

has_space :-
    setting(entries, Max),
    (   predicate_property(entry(_, _, _, _), number_of_clauses(Count)),
        Count >= Max
    ->  get_time(Now),
        findall(Ref,
                ( clause(entry(_, _, _, Until), true, Ref),
                  over(Until, Now) ),
                Refs),
        (   Refs == []
        ->  resource_error(fipa_directory)
        ;   forall(member(Ref, Refs), erase(Ref))
        )
    ;   true
    ).

over(Until, Now) :-
    number(Until),
    Until < Now.

%!  directory_remove(+Directory, +Name) is semidet.
%!  directory_has(+Directory, +Name) is semidet.
%!  directory_entry(+Directory, -Description) is nondet.
%!  directory_forget(+Directory) is det.

directory_remove(Directory, Name) :-
    with_mutex(typhon_fipa_directory,
               ( directory_has(Directory, Name),
                 retract(entry(Directory, Name, _, _)) )).

directory_has(Directory, Name) :-
    get_time(Now),
    entry(Directory, Name, _, Until),
    \+ over(Until, Now),
    !.

directory_entry(Directory, Description) :-
    get_time(Now),
    entry(Directory, _, Description, Until),
    \+ over(Until, Now).

directory_forget(Directory) :-
    with_mutex(typhon_fipa_directory,
               retractall(entry(Directory, _, _, _))).

                /*******************************
                *           MATCHING           *
                *******************************/

%!  description_matches(+Template, +Description) is semidet.
%
%   By the rules of FIPA00023: Description has every parameter of Template; of
%   a set each element, in any order, of a sequence in this order.

description_matches(Template, Description), aid(Template) =>
    aid(Description),
    aid_name(Template, Name),
    aid_name(Description, Name).
description_matches(set(Templates), Description) =>
    elements(Description, Elements),
    forall(member(Template, Templates),
           ( member(Element, Elements),
             description_matches(Template, Element) )).
description_matches(Templates, set(Elements)), is_list(Templates) =>
    description_matches(set(Templates), Elements).
description_matches(Templates, Elements), is_list(Templates) =>
    is_list(Elements),
    in_order(Templates, Elements).
description_matches(Template, Description), atomic(Template) =>
    atomic(Description),
    same_text(Template, Description).
description_matches(Template, Description) =>
    compound(Description),
    compound_name_arguments(Template, Name, Wanted),
    compound_name_arguments(Description, Name, Found),
    arguments_match(Wanted, Found).

elements(set(Elements), Elements).
elements(Elements, Elements) :-
    is_list(Elements).

in_order([], _).
in_order([Template|Templates], [Element|Elements]) :-
    (   description_matches(Template, Element)
    ->  in_order(Templates, Elements)
    ;   in_order([Template|Templates], Elements)
    ).

arguments_match([], _).
arguments_match([Key:Wanted|More], Found) :-
    !,
    memberchk(Key:Value, Found),
    description_matches(Wanted, Value),
    arguments_match(More, Found).
arguments_match([Wanted|More], [Value|Values]) :-
    description_matches(Wanted, Value),
    arguments_match(More, Values).

same_text(A, B) :-
    (   A == B
    ->  true
    ;   format(string(Text), '~w', [A]),
        format(string(Text), '~w', [B])
    ).
