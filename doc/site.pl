:- module(site, []).

/** <module> The documents as a site

    swipl doc/site.pl -- DIR

makes it in DIR: README.md, the pages of doc/ in the order in which
doc/contents.md names them, and a reference of all public predicates. The files that pages point to come along. It can be read, and
searched, without a server. Says which links are broken, and fails if any
are.

*Threading*: the main thread.
*/

:- use_module(site/documents).          % first, see site/reference.pl
:- use_module(site/broken).
:- use_module(site/dom).
:- use_module(site/layout).
:- use_module(site/links).
:- use_module(site/search).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex),
              [copy_file/2, directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(readutil), [read_file_to_terms/3]).

:- initialization(main, main).

:- public main/1.

:- dynamic root/1.

:- prolog_load_context(directory, Dir),
   file_directory_name(Dir, Root),
   assertz(root(Root)).

main([Dir0]) :-
    absolute_file_name(Dir0, Dir),
    root(Root),
    working_directory(_, Root),
    documents(Groups),
    write_site(Dir, Groups),
    findall(Problem, broken(Dir, Problem), Problems),
    forall(member(Problem, Problems), report(Problem)),
    (   Problems == []
    ->  true
    ;   halt(1)
    ).

report(link(File, Link)) :-
    format(user_error, "~w: ~w leads nowhere~n", [File, Link]).
report(twice(File, Id)) :-
    format(user_error, "~w: two are called ~w~n", [File, Id]).

                /*******************************
                *             FILES            *
                *******************************/

write_site(Dir, Groups0) :-
    make_directory_path(Dir),
    public_names(Groups0, Public),
    findall(Path, along(Groups0, Path), Paths0),
    sort(Paths0, Paths),
    copy_pictures(Dir, Paths),
    source_pages(Public, Paths, Sources),
    maplist(group_pages(Public), Groups0, Groups),
    findall(Page, ( member(_-Some, Groups), member(Page, Some) ), Pages),
    version(Version),
    maplist(write_page(Dir, Groups, Version), Pages),
    maplist(write_page(Dir, Groups, Version), Sources),
    search_index(Pages, Index),
    write_file(Dir, 'sections.js', Index),
    forall(member(Own, ['doc/site/style.css', 'doc/site/search.js']),
           copy_file(Own, Dir)).

%   Who stands in the reference, the last of all.

public_names(Groups, Public) :-
    last(Groups, _-[document(_, _, Dom)]),
    findall(PI, ( dom_element(Dom, E), dom_attribute(E, id, PI),
                  sub_atom(PI, _, _, _, /) ), Public).

%   The files that must come along, pictures and sources.

along(Groups, Path) :-
    member(_-Documents, Groups),
    member(document(Source, _, Dom), Documents),
    linked(Source, Dom, Path),
    \+ site_file(page, Path, _).

source_pages(Public, Paths, Pages) :-
    findall(Document,
            ( member(Path, Paths),
              site_file(source, Path, _),
              source_document(Path, Document) ),
            Documents),
    maplist(document_page(Public), Documents, Pages).

group_pages(Public, Heading-Documents, Heading-Pages) :-
    maplist(document_page(Public), Documents, Pages).

document_page(Public, document(Path, Title, Dom0), page(File, Title, Dom)) :-
    site_file(_, Path, File),
    settle_links(Path, Public, Dom0, Dom).

write_page(Dir, Groups, Version, Page) :-
    Page = page(File, _, _),
    page_html(Page, Groups, Version, Html),
    write_file(Dir, File, Html).

copy_pictures(Dir, Paths) :-
    directory_file_path(Dir, img, Pictures),
    make_directory_path(Pictures),
    forall(( member(Path, Paths), site_file(picture, Path, File) ),
           ( directory_file_path(Dir, File, To),
             copy_file(Path, To) )).

write_file(Dir, Name, Text) :-
    directory_file_path(Dir, Name, File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        write(Out, Text),
        close(Out)).

version(Version) :-
    read_file_to_terms('pack.pl', Terms, []),
    memberchk(version(Version), Terms).
