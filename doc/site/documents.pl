:- module(site_documents,
          [ documents/1,                % -Groups
            source_document/2           % +Path, -Document
          ]).

/** <module> What is to be read, and in which order

A document is document(Path, Title, Dom). Paths are relative to the root of
the tree, which is the working directory.

*Threading*: the main thread, as site_reference.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(colour, [code_dom/3]).
:- use_module(dom, [dom_edit/3, dom_text/2]).
:- use_module(links, [linked/3, site_file/3]).
:- use_module(markdown, [markdown_dom/2]).
:- use_module(reference, [reference_dom/1]).

%!  documents(-Groups) is det.
%
%   Groups are Heading-Documents: README.md and doc/contents.md; what the
%   sections of that link to, in that order; the reference of predicates.

documents(["Start"-[Readme, Contents]|Groups]) :-
    document('README.md', Readme),
    document('doc/contents.md', Contents),
    Contents = document(_, _, Dom),
    groups(Dom, Groups0),
    reference_dom(Reference),
    append(Groups0,
           ["Predicates"-[document('predicates.md', "All predicates",
                                   Reference)]],
           Groups).

groups([], []).
groups([element(h2, _, Heading)|After], [Text-Documents|Groups]) :-
    !,
    dom_text(Heading, Text),
    until_heading(After, Here, Rest),
    findall(Path, ( linked('doc/contents.md', Here, Path),
                    site_file(page, Path, _) ), Paths),
    maplist(document, Paths, Documents),
    groups(Rest, Groups).
groups([_|After], Groups) :-
    groups(After, Groups).

until_heading([], [], []).
until_heading([Node|Nodes], Before, Rest) :-
    (   Node = element(h2, _, _)
    ->  Before = [],
        Rest = [Node|Nodes]
    ;   Before = [Node|More],
        until_heading(Nodes, More, Rest)
    ).

document(Path, document(Path, Title, Dom)) :-
    markdown_dom(Path, Dom0),
    dom_edit(paint, Dom0, Dom),
    memberchk(element(h1, _, Heading), Dom),
    dom_text(Heading, Title).

paint(element(pre, [], [element(code, [class=Class], [Text])]),
      [element(pre, [class=Kind], Dom)]) :-
    atom_concat('language-', Kind, Class),
    code_dom(Kind, Text, Dom).

%!  source_document(+Path, -Document) is det.
%
%   Any other file of the tree.

source_document(Path,
                document(Path, Path,
                         [ element(h1, [id=file], [Path]),
                           element(pre, [class=Kind], Dom)
                         ])) :-
    read_file_to_string(Path, Text, [encoding(utf8)]),
    (   file_name_extension(_, pl, Path)
    ->  Kind = prolog
    ;   Kind = text
    ),
    code_dom(Kind, Text, Dom).
