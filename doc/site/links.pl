:- module(site_links,
          [ site_file/3,                % ?Kind, +Path, -File
            linked/3,                   % +Source, +Dom, -Path
            settle_links/4              % +Source, +Public, +Dom0, -Dom
          ]).

/** <module> Where links lead

A page of the site has all files beside it: what was doc/time.md is
time.html, pictures are in img/, and any other file of the tree that a page
points to has a page of its own. Paths are relative to the root of the tree.

*Threading*: any thread.
*/

:- use_module(library(lists), [member/2, select/3]).
:- use_module(library(uri), [uri_components/2]).
:- use_module(dom, [dom_attribute/3, dom_edit/3, dom_element/2]).

%!  site_file(?Kind, +Path, -File) is semidet.
%
%   File is what becomes of Path, a Kind of `page`, `picture` or `source`.

site_file(Kind, Path, File) :-
    kind(Path, Kind0),
    Kind = Kind0,
    site_name(Kind, Path, File).

kind(Path, Kind) :-
    file_name_extension(_, Extension, Path),
    (   extension_kind(Extension, Kind0)
    ->  Kind = Kind0
    ;   Kind = source
    ).

extension_kind(md, page).
extension_kind(gif, picture).
extension_kind(jpg, picture).
extension_kind(png, picture).
extension_kind(svg, picture).

site_name(page, 'README.md', 'index.html') :-
    !.
site_name(page, Path, File) :-
    file_base_name(Path, Base),
    file_name_extension(Stem, md, Base),
    downcase_atom(Stem, Name),
    file_name_extension(Name, html, File).
site_name(picture, Path, File) :-
    file_base_name(Path, Base),
    atom_concat('img/', Base, File).
site_name(source, Path, File) :-
    atomic_list_concat(Parts, /, Path),
    atomic_list_concat([source|Parts], -, Flat),
    atom_concat(Flat, '.html', File).

%!  linked(+Source, +Dom, -Path) is nondet.
%
%   The page of Source, whose text is Dom, points to the file Path.

linked(Source, Dom, Path) :-
    dom_element(Dom, Element),
    member(Name, [href, src]),
    dom_attribute(Element, Name, Link),
    local(Source, Link, Path, _).

%   local(+Source, +Link, -Path, -Fragment): the file is there; Fragment is
%   unbound if Link has none.

local(Source, Link, Path, Fragment) :-
    uri_components(Link, uri_components(Scheme, Host, Relative, _, Fragment)),
    var(Scheme),
    var(Host),
    Relative \== '',
    file_directory_name(Source, Dir),
    atomic_list_concat([/, Dir, /, Relative], Joined),
    absolute_file_name(Joined, Absolute),
    atom_concat(/, Path, Absolute),
    exists_file(Path).

%!  settle_links(+Source, +Public, +Dom0, -Dom) is det.
%
%   Links to files of the tree lead to those of the site. A predicate named
%   as code that is among Public, atoms as `move/1`, becomes a link to the
%   reference. Links that lead nowhere stay as they are.

settle_links(Source, Public, Dom0, Dom) :-
    dom_edit(settle(Source, Public), Dom0, Dom).

settle(Source, _, element(Name, As0, Dom), [element(Name, As, Dom)]) :-
    member(Attribute, [href, src]),
    select(Attribute=Link0, As0, Others),
    !,
    (   local(Source, Link0, Path, Fragment)
    ->  site_file(_, Path, File),
        fragment(Fragment, File, Link)
    ;   Link = Link0
    ),
    As = [Attribute=Link|Others].
settle(_, _, element(Heading, As, Dom), [element(Heading, As, Dom)]) :-
    memberchk(Heading, [h1, h2, h3, h4]).
settle(_, Public, element(code, As, [Text]), Nodes) :-
    predicate_named(As, Text, PI),
    (   memberchk(PI, Public)
    ->  atom_concat('predicates.html#', PI, Link),
        Nodes = [element(a, [class=word, href=Link],
                         [element(code, [], [Text])])]
    ;   As = [name=_]
    ->  Nodes = [Text]
    ;   fail
    ).

fragment(Fragment, File, File) :-
    var(Fragment),
    !.
fragment(Fragment, File, Link) :-
    atomic_list_concat([File, #, Fragment], Link).

%   Told by colour.pl, or as in `move/1` and `move(+Host)`.

predicate_named([name=PI], _, PI) :-
    !.
predicate_named(_, Text, PI) :-
    catch(term_to_atom(Term, Text), error(_, _), fail),
    nonvar(Term),
    (   Term = Name/Arity
    ->  atom(Name),
        integer(Arity)
    ;   compound(Term),
        compound_name_arity(Term, Name, Arity),
        forall(arg(_, Term, Arg), moded(Arg))
    ),
    atomic_list_concat([Name, Arity], /, PI).

moded(Arg) :-
    compound(Arg),
    compound_name_arguments(Arg, Mode, [_]),
    memberchk(Mode, [+, -, ?, :]).
