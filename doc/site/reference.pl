:- module(site_reference,
          [ reference_dom/1             % -Dom
          ]).

/** <module> The reference: what PlDoc knows of the public predicates

All that library(typhon), the vocabulary of agents and library(typhon/nxt)
export, room by room, and what their comments refer to. Predicates that
share a comment share an entry.

*Threading*: the main thread. PlDoc notes comments while files are loaded,
so this room is loaded before any other that loads library(typhon).
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(http/html_write), [print_html/1]).
:- use_module(library(lists), [append/2, append/3, list_to_set/2, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_values/2]).
:- use_module(library(pldoc)).
:- use_module(library(pldoc/doc_html), []).
:- use_module(library(pldoc/doc_process), [doc_comment/4]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(uri), [uri_components/2, uri_query_components/2]).
:- use_module(dom,
              [dom_attribute/3, dom_edit/3, dom_element/2, html_dom/2]).
:- use_module(markdown, [slug/2]).

:- doc_collect(true).
:- use_module('../../prolog/typhon', []).
:- use_module('../../prolog/typhon/network/networks', []).  % else on demand
:- use_module('../../prolog/typhon/nxt', []).
:- use_module('../../prolog/typhon/fipa', []).
:- doc_collect(false).

                /*******************************
                *         WHAT IS PUBLIC       *
                *******************************/

%   part(-Id, -Module): all that Module exports is public.

part(library, typhon).
part(inside, typhon_words).
part(inside, typhon_memory).
part(robots, typhon_nxt).
part(fipa, typhon_fipa).

title(library, "At the top level and in programs: library(typhon)").
title(inside, "Inside an agent").
title(robots, "Robots: library(typhon/nxt)").
title(fipa, "Platforms of FIPA: library(typhon/fipa)").
title(others, "What these refer to").

%   public(?Module, -PI): of the part Module; what is part of library(typhon),
%   too, is told there.

public(Module, Room:PI) :-
    part(_, Module),
    module_property(Module, exports(PIs)),
    member(PI, PIs),
    defined_in(Module, PI, Room),
    \+ ( Module \== typhon, defined_in(typhon, PI, Room) ).
public(typhon_words, typhon_words:sleep/1).     % with the name of another

defined_in(Module, Name/Arity, Room) :-
    functor(Head, Name, Arity),
    (   predicate_property(Module:Head, imported_from(Room0))
    ->  Room = Room0
    ;   Room = Module
    ).

%   rooms(+Module): this one, then what its file re-exports, in that order.

rooms(Module) -->
    [Module],
    { module_property(Module, file(File)),
      file_directory_name(File, Dir),
      read_file_to_terms(File, Terms, []),
      findall(Room,
              ( member((:- Directive), Terms),
                reexported(Directive, Spec),
                absolute_file_name(Spec, Path,
                                   [file_type(prolog), relative_to(Dir)]),
                module_property(Room, file(Path)) ),
              Rooms)
    },
    all_rooms(Rooms).

all_rooms([]) -->
    [].
all_rooms([Room|Rooms]) -->
    rooms(Room),
    all_rooms(Rooms).

reexported(reexport(Spec), Spec).
reexported(reexport(Spec, _), Spec).

                /*******************************
                *            ENTRIES           *
                *******************************/

%   entries(+PIs, -Entries): the comments of these, in the order of the
%   file: entry(Place, Comment, PIs).

entries(PIs, Entries) :-
    findall(Place-(Comment-PI),
            ( member(PI, PIs),
              once(doc_comment(PI, Place, _, Comment)) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    maplist(entry, Groups, Entries).

entry(Place-CommentPIs, entry(Place, Comment, PIs)) :-
    CommentPIs = [Comment-_|_],
    pairs_values(CommentPIs, PIs).

%   What PlDoc shows of a comment, and whereto it refers.

entry_dom(Entry, Dom) :-
    Entry = entry(Place, Comment, [PI|_]),
    PI = Module:_,
    phrase(pldoc_html:objects([doc(PI, Place, Comment)],
                              [navtree(false), module(Module)]), Tokens),
    tokens_dom(Tokens, Dom).

%   The same of a module, without a heading with buttons.

about_dom(File, Heading, Comment, Dom) :-
    phrase(pldoc_html:file_header(File, [file(Heading, Comment)]), Tokens),
    tokens_dom(Tokens, Dom).

:- multifile prolog:doc_file_title//3.

prolog:doc_file_title(_, _, _) -->
    [].

tokens_dom(Tokens, Dom) :-
    with_output_to(string(Html), print_html(Tokens)),
    html_dom(Html, Dom).

refers(Dom, PI) :-
    dom_element(Dom, Element),
    pldoc_link(Element, PI).

pldoc_link(Element, PI) :-
    dom_attribute(Element, href, Link),
    sub_atom(Link, 0, _, _, '/pldoc/doc_for?'),
    uri_components(Link, uri_components(_, _, _, Query, _)),
    uri_query_components(Query, [object=Object]),
    term_to_atom(PI, Object),
    PI = _:_/_.

%   As it stands on our page. PlDoc makes links for its own server.

settle(Known, element(a, As, Dom), Nodes) :-
    pldoc_link(element(a, As, Dom), _:Name/Arity),
    !,
    atomic_list_concat([Name, Arity], /, Id),
    (   memberchk(Id, Known)
    ->  atom_concat(#, Id, Link),
        Nodes = [element(a, [href=Link], [element(code, [], Dom)])]
    ;   Nodes = [element(code, [], Dom)]
    ).
settle(_, element(a, As, Dom), [element(a, [href=Link], Dom)]) :-
    memberchk(href=Manual, As),
    sub_atom(Manual, 0, _, _, '/pldoc/'),
    atom_concat('https://www.swi-prolog.org', Manual, Link).
settle(_, element(a, As, Dom), [element(a, [id=Id, href=Link], Dom)]) :-
    memberchk(name=Id, As),
    atom_concat(#, Id, Link).
settle(_, element(span, [style='float:right'], _), []).

                /*******************************
                *             PAGE             *
                *******************************/

%!  reference_dom(-Dom) is det.
%
%   The page of all public predicates. The id of a predicate is its name and
%   arity.

reference_dom([element(h1, [id=predicates], ["All predicates"])|Dom]) :-
    findall(Id, part(Id, _), Ids0),
    list_to_set(Ids0, Ids),
    maplist(part_rooms, Ids, Parts0),
    referred(Parts0, Others),
    append(Parts0, [Others], Parts),
    maplist(part_dom, Parts, Doms),
    append(Doms, Dom0),
    findall(PI, ( dom_element(Dom0, E), dom_attribute(E, name, PI) ), Known),
    dom_edit(settle(Known), Dom0, Dom).

%   A part is part(Id, Rooms), a room is room(Heading, Dom).

part_rooms(Id, part(Id, Rooms)) :-
    findall(Room,
            ( part(Id, Module),
              phrase(rooms(Module), Modules),
              member(Definer, Modules),
              findall(Definer:PI, public(Module, Definer:PI), PIs),
              room(Definer, PIs, Room) ),
            Rooms).

room(Module, PIs, room(Heading, Dom)) :-
    PIs = [_|_],
    once(doc_comment(Module:module(Heading), File:_, _, Comment)),
    about_dom(File, Heading, Comment, About),
    entries(PIs, Entries),
    maplist(entry_dom, Entries, Doms),
    append([About|Doms], Dom).

%   What is not public, and named by what is.

referred(Parts, part(others, Rooms)) :-
    findall(Module-(Module:PI),
            ( member(part(_, Others), Parts),
              member(room(_, Dom), Others),
              refers(Dom, Module:PI),
              \+ public(_, Module:PI) ),
            Pairs0),
    sort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    findall(Room, ( member(Module-PIs, Groups), room(Module, PIs, Room) ),
            Rooms).

part_dom(part(Id, Rooms),
         [element(h2, [id=Id], [Title]), element(p, [class=names], Links)
         |Dom]) :-
    title(Id, Title),
    findall(Name, ( member(room(_, Body), Rooms), dom_element(Body, E),
                    dom_attribute(E, name, Name) ), Names0),
    sort(Names0, Names),
    findall(Node, ( member(Name, Names), name_link(Name, Node) ), Links),
    maplist(room_dom(Id), Rooms, Doms),
    append(Doms, Dom).

name_link(Name, element(a, [href=Link], [Name])) :-
    atom_concat(#, Name, Link).
name_link(_, " ").

room_dom(Part, room(Heading, Dom),
         [element(h3, [id=Id], [Heading])|Dom]) :-
    slug(Heading, Slug),
    atomic_list_concat([Part, Slug], -, Id).
