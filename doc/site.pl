:- module(site, []).

/** <module> The documents as a site

    swipl doc/site.pl -- DIR

makes it in DIR by MkDocs: README.md, the documents in the order in which
doc/contents.md names them, a reference of all public predicates, and the
files that pages point to. It can be read, and searched, without a server.
Says which links are broken, and fails if any are.

*Threading*: the main thread.
*/

:- use_module('../app/packaging/parts', [left_out/2]).
:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(site/reference).          % first, see there
:- use_module(site/documents, [document/2]).
:- use_module(site/markdown).
:- use_module(site/playable, [playable_sessions/2]).
:- use_module(library(filesex),
              [ copy_file/2, delete_directory_and_contents/1,
                directory_file_path/3, make_directory_path/1,
                relative_file_name/3 ]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- if(exists_source(library(json))).
:- use_module(library(json), [json_write_dict/3]).
:- else.
:- use_module(library(http/json), [json_write_dict/3]).
:- endif.

:- initialization(main, main).

:- public main/1.

:- dynamic root/1.

:- prolog_load_context(directory, Dir),
   file_directory_name(Dir, Root),
   assertz(root(Root)).

main(Argv) :-
    arguments(Argv, [Dir0], []),
    absolute_file_name(Dir0, Dir),
    root(Root),
    working_directory(_, Root),
    tmp_file(typhon_site, Work),
    setup_call_cleanup(
        make_directory(Work),
        ( sources(Work),
          mkdocs(Work, Dir, Status),
          playground(Dir) ),
        delete_directory_and_contents(Work)),
    halt(Status).

                /*******************************
                *            SOURCES           *
                *******************************/

%   What MkDocs reads: the tree as it is, as far as pages point to it.

sources(Work) :-
    directory_file_path(Work, docs, Docs),
    reference(Public, Reference),
    page(Docs, Public, 'predicates.md', Reference),
    findall(File, document('.', File), Files),
    forall(member(File, Files), page(Docs, Public, File)),
    findall(Path, along(Files, Path), Paths0),
    sort(Paths0, Paths),
    forall(member(Path, Paths), come_along(Docs, Public, Path)),
    forall(member(Own, ['style.css', 'iframe-worker.js']),
           ( directory_file_path('doc/site', Own, From),
             directory_file_path(Docs, Own, To),
             copy_file(From, To) )),
    settings(Work, Docs).

page(Docs, Public, File) :-
    document_text(File, Text),
    page(Docs, Public, File, Text).

page(Docs, Public, File, Text) :-
    played(File, Played),
    site_markdown(File, Public, Played, Text, Markdown),
    write_file(Docs, File, Markdown).

%   Without SWI-Prolog for WebAssembly the site has no playground.

played(File, Played) :-
    (   with_playground,
        exists_file(File)
    ->  playable_sessions(File, Played)
    ;   Played = []
    ).

with_playground :-
    exists_file('app/playground/build.js'),
    exists_file('test/lib/wasm/swipl-bundle-no-data.js').

playground(Dir) :-
    with_playground,
    !,
    directory_file_path(Dir, play, Play),
    process_create(path(node),
                   ['--liftoff-only', 'app/playground/build.js', Play],
                   [process(Pid)]),
    process_wait(Pid, exit(0)).
playground(_).

%   The files that must come along, pictures and sources.

along(Files, Path) :-
    member(File, Files),
    document_text(File, Text),
    link_target(Text, Target),
    beside(File, Target, Path),
    exists_file(Path),
    \+ file_name_extension(_, md, Path).

beside(File, Target, Path) :-
    file_directory_name(File, Dir),
    directory_file_path(Dir, Target, Relative),
    absolute_file_name(Relative, Absolute),
    relative_file_name(Absolute, 'README.md', Path).

%   document_text(+File, -Text): links to files that are left out are text only.

document_text(File, Text) :-
    read_file_to_string(File, Text0, [encoding(utf8)]),
    without_links(File, Text0, Text).

without_links(File, Text0, Text) :-
    link_target(Text0, Target),
    atomic_list_concat([Page|_], #, Target),
    beside(File, Page, Path),
    left_out(Path, _),
    !,
    format(string(End), "](~w)", [Target]),
    once(sub_string(Text0, Length, _, After, End)),
    sub_string(Text0, 0, Length, _, Before),
    findall(At, sub_string(Before, At, 1, _, "["), Ats),
    last(Ats, Begin),
    sub_string(Before, 0, Begin, _, Start),
    Word is Begin+1,
    sub_string(Before, Word, _, 0, Words),
    sub_string(Text0, _, After, 0, Rest),
    string_concat(Start, Words, Linked),
    string_concat(Linked, Rest, Text1),
    without_links(File, Text1, Text).
without_links(_, Text, Text).

come_along(Docs, _, Path) :-
    file_name_extension(_, Extension, Path),
    memberchk(Extension, [png, svg]),
    !,
    directory_file_path(Docs, Path, To),
    file_directory_name(To, Dir),
    make_directory_path(Dir),
    copy_file(Path, To).
come_along(Docs, Public, Path) :-
    read_file_to_string(Path, Text, [encoding(utf8)]),
    source_page(Path, Public, Text, Markdown),
    file_name_extension(Path, md, Page),
    write_file(Docs, Page, Markdown).

write_file(Docs, Path, Text) :-
    directory_file_path(Docs, Path, File),
    file_directory_name(File, Dir),
    make_directory_path(Dir),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        write(Out, Text),
        close(Out)).

                /*******************************
                *            MKDOCS            *
                *******************************/

%   YAML that MkDocs reads before ours; JSON is YAML.

settings(Work, Docs) :-
    absolute_file_name('doc/site/mkdocs.yml', Ours),
    findall(Group, group(Group), Groups),
    directory_file_path(Work, 'mkdocs.yml', File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        json_write_dict(Out, _{'INHERIT':Ours, docs_dir:Docs, nav:Groups},
                        [tab(1000000)]),
        close(Out)).

%   Sections of doc/contents.md, with their pages, or parts that have pages.

group(_{'Start':['README.md', 'doc/contents.md']}).
group(Group) :-
    document_text('doc/contents.md', Text),
    headed(Text, '\n## ', Heading, Section),
    findall(Part-Pages,
            ( headed(Section, '\n### ', Part, Listed),
              pages(Listed, Pages),
              Pages \== [] ),
            Parts),
    (   Parts == []
    ->  pages(Section, Items)
    ;   findall(Item, ( member(Pair, Parts), dict_pairs(Item, _, [Pair]) ),
                Items)
    ),
    Items \== [],                       % else all pages are left out
    dict_pairs(Group, _, [Heading-Items]).
group(_{'Predicates':['predicates.md']}).

%   headed(+Text, +Mark, -Heading, -Below) is nondet.

headed(Text, Mark, Heading, Below) :-
    atomic_list_concat([_|Sections], Mark, Text),
    member(Section, Sections),
    atomic_list_concat([Heading|_], '\n', Section),
    atom_concat(Heading, Below, Section).

pages(Text, Pages) :-
    findall(Page,
            ( link_target(Text, Target),
              beside('doc/contents.md', Target, Page) ),
            Pages).

mkdocs(Work, Dir, Status) :-
    directory_file_path(Work, 'mkdocs.yml', Settings),
    process_create(path(sh),
                   [ '-c', 'exec "$("$0" --where)/bin/mkdocs" "$@"',
                     '.ci/mkdocs-material', build, '--quiet', '--strict', '-f', Settings,
                     '-d', Dir ],
                   [process(Pid), environment(['NO_MKDOCS_2_WARNING'=1])]),
    process_wait(Pid, exit(Status)).
