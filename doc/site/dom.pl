:- module(site_dom,
          [ dom_edit/3,                 % :Edit, +Dom0, -Dom
            dom_element/2,              % +Dom, -Element
            dom_attribute/3,            % +Element, +Name, -Value
            dom_text/2,                 % +Dom, -Text
            dom_html/2,                 % +Dom, -Html
            html_dom/2                  % +Html, -Dom
          ]).

/** <module> Documents as terms

A Dom is a list of text and element(Name, Attributes, Dom), as of
library(sgml).

*Threading*: pure.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module(library(sgml),
              [load_structure/3, xml_quote_attribute/3, xml_quote_cdata/3]).

:- meta_predicate
    dom_edit(2, +, -).

%!  dom_edit(:Edit, +Dom0, -Dom) is det.
%
%   Replaces each node for which call(Edit, Node, Nodes) succeeds by Nodes,
%   and looks into the others.

dom_edit(Edit, Dom0, Dom) :-
    maplist(edit(Edit), Dom0, Doms),
    append(Doms, Dom).

edit(Edit, Node, Nodes) :-
    call(Edit, Node, Nodes),
    !.
edit(Edit, element(Name, Attributes, Dom0), Nodes) :-
    !,
    Nodes = [element(Name, Attributes, Dom)],
    dom_edit(Edit, Dom0, Dom).
edit(_, Text, [Text]).

%!  dom_element(+Dom, -Element) is nondet.
%
%   The elements at any depth, in the order of their beginnings.

dom_element(Dom, Element) :-
    member(Outer, Dom),
    Outer = element(_, _, Inner),
    (   Element = Outer
    ;   dom_element(Inner, Element)
    ).

%!  dom_attribute(+Element, +Name, -Value) is semidet.

dom_attribute(element(_, Attributes, _), Name, Value) :-
    memberchk(Name=Value, Attributes).

%!  dom_text(+Dom, -Text:string) is det.
%
%   The text without its elements.

dom_text(Dom, Text) :-
    texts(Dom, Texts, []),
    atomics_to_string(Texts, Text).

texts([]) -->
    [].
texts([Node|Nodes]) -->
    node_texts(Node),
    texts(Nodes).

node_texts(element(_, _, Dom)) -->
    !,
    texts(Dom).
node_texts(Text) -->
    [Text].

atomics_to_string(Atomics, String) :-
    atomic_list_concat(Atomics, Atom),
    atom_string(Atom, String).

                /*******************************
                *             TEXT             *
                *******************************/

%!  dom_html(+Dom, -Html:string) is det.

dom_html(Dom, Html) :-
    html(Dom, Texts, []),
    atomics_to_string(Texts, Html).

html([]) -->
    [].
html([Node|Nodes]) -->
    node(Node),
    html(Nodes).

node(element(Name, Attributes, _)) -->
    { void(Name) },
    !,
    ['<', Name],
    attributes(Attributes),
    ['>'].
node(element(Name, Attributes, Dom)) -->
    !,
    ['<', Name],
    attributes(Attributes),
    ['>'],
    html(Dom),
    ['</', Name, '>'].
node(Text) -->
    { xml_quote_cdata(Text, Quoted, utf8) },
    [Quoted].

attributes([]) -->
    [].
attributes([Name=Value|Attributes]) -->
    { xml_quote_attribute(Value, Quoted, utf8) },
    [' ', Name, '="', Quoted, '"'],
    attributes(Attributes).

void(br).
void(hr).
void(img).
void(input).
void(link).
void(meta).

%!  html_dom(+Html:string, -Dom) is det.
%
%   Reads a part of a page. It must be well-formed; the only entity that is
%   not of XML is nbsp.

html_dom(Html, Dom) :-
    atomic_list_concat(Parts, '&nbsp;', Html),
    atomic_list_concat(Parts, '\u00a0', Clean),
    atomic_list_concat(['<dom>', Clean, '</dom>'], Xml),
    setup_call_cleanup(
        open_string(Xml, In),
        load_structure(stream(In), [element(dom, _, Dom)],
                       [dialect(xml), space(preserve)]),
        close(In)).
