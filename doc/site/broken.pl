:- module(site_broken,
          [ broken/2                    % +Dir, -Problem
          ]).

/** <module> What does not hold together in a site

Reads the site as a browser would, and knows nothing of how it was made.

*Threading*: any thread.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(sgml), [load_html/3]).
:- use_module(library(uri), [uri_components/2, uri_encoded/3]).
:- use_module(dom, [dom_attribute/3, dom_element/2]).

%!  broken(+Dir, -Problem) is nondet.
%
%   Problem is link(File, Link), where there is no such file or no such
%   place in it, or twice(File, Id).

broken(Dir, Problem) :-
    findall(File, directory_member(Dir, File, [extensions([html])]), Files),
    maplist(file_contents, Files, Contents),
    member(contents(File, Ids, Links), Contents),
    (   member(Link, Links),
        \+ leads_somewhere(Link, File, Contents),
        Problem = link(File, Link)
    ;   msort(Ids, Sorted),
        append(_, [Id, Id|_], Sorted),
        Problem = twice(File, Id)
    ).

file_contents(File, contents(File, Ids, Links)) :-
    load_html(File, Dom, [syntax_errors(quiet), max_errors(-1)]),
    findall(Id, in(Dom, id, Id), Ids),
    findall(Link, ( in(Dom, href, Link) ; in(Dom, src, Link) ), Links).

in(Dom, Name, Value) :-
    dom_element(Dom, Element),
    dom_attribute(Element, Name, Value).

leads_somewhere(Link, File, Contents) :-
    uri_components(Link, uri_components(Scheme, _, Path, _, Fragment)),
    (   nonvar(Scheme)                  % elsewhere
    ->  memberchk(Scheme, [http, https, mailto])
    ;   target(Path, File, Target),
        exists_file(Target),
        in_file(Fragment, Target, Contents)
    ).

target('', File, File) :-
    !.
target(Path, File, Target) :-
    uri_encoded(path, Name, Path),
    file_directory_name(File, Dir),
    directory_file_path(Dir, Name, Target).

in_file(Fragment, _, _) :-
    var(Fragment),
    !.
in_file(Fragment, File, Contents) :-
    uri_encoded(fragment, Id, Fragment),
    memberchk(contents(File, Ids, _), Contents),
    memberchk(Id, Ids).
