:- module(typhon_host_setup,
          [ host_setup_check/2,         % +Places, +Names
            host_setup_files/3,         % +Places, +Name, -Files
            host_setup_goals/3          % +Places, +Name, -Goals
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/host', [host_listed/2]).
:- use_module(topology, [number_name/2]).

/** <module> The contents of the places of a network

Places is an item, or a list of items:

  - a file: text, a path of atoms a/b, or Alias(Name) for a search path Alias;
    it is consulted into the places of all hosts
  - any other term: a goal, which is called once in the place of each host;
    a goal without arguments is written call(Name)
  - Host-Items: items only for the host with the name or number Host

*Threading*: pure, but for the lookup of search paths.
*/

%!  host_setup_check(+Places, +Names) is det.
%
%   Check the form of Places, and that it names only hosts of the network.
%
%   @arg Names are the names of the hosts
%   @error type_error(callable, Item), existence_error(host, Host)

host_setup_check(Places, Names) :-
    host_listed(Places, Items),
    maplist(check_item(Names), Items).

check_item(Names, Item) :-
    must_be(nonvar, Item),
    (   Item = Host-Items
    ->  host_name(Host, Name),
        (   memberchk(Name, Names)
        ->  host_setup_check(Items, Names)
        ;   existence_error(host, Host)
        )
    ;   is_file(Item)
    ->  true
    ;   must_be(callable, Item)
    ).

host_name(Host, Name) :-
    (   integer(Host)
    ->  number_name(Host, Name)
    ;   must_be(atom, Host),
        Name = Host
    ).

%!  host_setup_files(+Places, +Name, -Files) is det.
%
%   Files are consulted into the place of host Name, in order.

host_setup_files(Places, Name, Files) :-
    findall(Item, ( item(Places, Name, Item), is_file(Item) ), Files).

%!  host_setup_goals(+Places, +Name, -Goals) is det.
%
%   Goals are called in the place of host Name, in order.

host_setup_goals(Places, Name, Goals) :-
    findall(Item, ( item(Places, Name, Item), \+ is_file(Item) ), Goals).

item(Places, Name, Item) :-
    host_listed(Places, Items),
    member(Item0, Items),
    (   Item0 = Host-Own
    ->  host_name(Host, Name),
        item(Own, Name, Item)
    ;   Item = Item0
    ).

is_file(Item) :-
    ( atom(Item) ; string(Item) ),
    !.
is_file(_/_) :-
    !.
is_file(Item) :-
    compound(Item),
    compound_name_arity(Item, Alias, 1),
    user:file_search_path(Alias, _),
    !.
