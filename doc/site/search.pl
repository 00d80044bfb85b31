:- module(site_search,
          [ search_index/2              % +Pages, -JavaScript
          ]).

/** <module> What can be found

The index of the site is a script, so that a page can have it where there is
no server. Each section of a page is one entry, and each predicate.

*Threading*: any thread.
*/

:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(dom, [dom_attribute/3, dom_element/2, dom_text/2]).

:- if(exists_source(library(json))).
:- use_module(library(json), [atom_json_dict/3]).
:- else.
:- use_module(library(http/json), [atom_json_dict/3]).
:- endif.

%!  search_index(+Pages, -JavaScript:string) is det.
%
%   Pages are page(File, Title, Dom).

search_index(Pages, JavaScript) :-
    findall(_{at:At, title:Title, page:Page, text:Text},
            ( member(page(File, Page, Dom), Pages),
              section(Dom, Id, Title, Body),
              atomic_list_concat([File, #, Id], At),
              plain(Body, Text) ),
            Entries),
    atom_json_dict(Json, Entries, [as(string), width(0)]),
    string_concat("const sections = ", Json, JavaScript).

%   section(+Dom, -Id, -Title, -Body): a heading with what follows it up to
%   the next; a predicate with what is said of it.

section(Dom, Id, Title, Body) :-
    append(_, [Heading|After], Dom),
    heading(Heading, Id, Text),
    dom_text(Text, Title),
    before_heading(After, Body).
section(Dom, Id, Id, Body) :-
    dom_element(Dom, element(dl, _, List)),
    append(_, [Term|After], List),
    Term = element(dt, _, _),
    dom_element([Term], Anchor),
    dom_attribute(Anchor, id, Id),
    append(Before, [element(dd, As, Description)|_], After),
    \+ memberchk(element(dd, _, _), Before),
    Body = [Term, " ", element(dd, As, Description)].

heading(Heading, Id, Text) :-
    Heading = element(Name, _, Text),
    memberchk(Name, [h1, h2, h3]),
    dom_attribute(Heading, id, Id).

before_heading([], []).
before_heading([Node|Nodes], Body) :-
    (   heading(Node, _, _)
    ->  Body = []
    ;   Node = element(dl, _, _)        % predicates, see section/4
    ->  before_heading(Nodes, Body)
    ;   Body = [Node|More],
        before_heading(Nodes, More)
    ).

plain(Dom, Text) :-
    dom_text(Dom, Text0),
    split_string(Text0, " \n\t", " \n\t", Words0),
    exclude(==(""), Words0, Words),
    atomic_list_concat(Words, ' ', Text).
