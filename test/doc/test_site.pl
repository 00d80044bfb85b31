:- module(test_site, []).

%   `make doc`: readers of the site find all documents, in order, and every
%   predicate; no link is broken; words are found (test_search looks which pages).

:- use_module('../../app/packaging/parts', [installed/1]).
:- use_module('../lib/browser').
:- use_module('../lib/common').
:- use_module('../lib/site').
:- use_module('../../doc/site/documents', [document/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [ directory_file_path/3, directory_member/3,
                relative_file_name/3 ]).
:- use_module(library(lists), [append/3, last/2, member/2, nth0/3, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(sgml), [load_html/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program), [vocabulary_word/2]).
:- use_module(library(uri), [uri_components/2, uri_encoded/3]).
:- use_module(library(xpath)).

:- ( installed(nxt) -> use_module(library(typhon/nxt), []) ; true ).
:- ( installed(bridges) -> use_module(library(typhon/bridges/ros/service), [])
   ; true
   ).

:- needs([doc, chromium, 'chromium-driver']).

                /*******************************
                *             SITE             *
                *******************************/

page(Name, Dom) :-
    site(Dir),
    (   Name == 'predicates.html'
    ->  directory_file_path(Dir, Name, File)
    ;   atomic_list_concat([Dir, doc, Name], /, File)
    ),
    load_html(File, Dom, [syntax_errors(quiet), max_errors(-1)]).

%   The pages to which the navigation leads, in order.

navigation(Links) :-
    page('contents.html', Dom),
    xpath_chk(Dom, //nav(contains(@class, 'md-nav--primary')), Nav),
    findall(Link, ( xpath(Nav, //a(@href), Link),
                    \+ sub_atom(Link, 0, _, _, #) ), Links).

%   The headings of the navigation, in order.

menu(Titles) :-
    page('contents.html', Dom),
    xpath_chk(Dom, //nav(contains(@class, 'md-nav--primary')), Nav),
    findall(Title,
            xpath(Nav, ul/li/label/span(contains(@class, 'md-ellipsis'),
                                        normalize_space), Title),
            Titles).

document_page(Page) :-
    project_file('.', Root),
    document(Root, Path),
    file_name_extension(Stem0, md, Path),
    index(Stem0, Stem),
    file_name_extension(Stem, html, File),
    relative_file_name(File, 'doc/file', Page).

index(Stem0, Stem) :-
    file_base_name(Stem0, 'README'),
    !,
    file_directory_name(Stem0, Dir),
    directory_file_path(Dir, index, Stem).
index(Stem, Stem).

                /*******************************
                *             LINKS            *
                *******************************/

%   broken(-File, -Link): Link of File leads to no file, or to no anchor in it.
%   The page for missing pages is made for the root of a server.

broken(File, Link) :-
    contents(Contents),
    member(contents(File, _, Links, _), Contents),
    \+ file_base_name(File, '404.html'),
    member(Link, Links),
    \+ leads_somewhere(Link, File, Contents).

%   contents(-Contents): contents(File, Ids, Links, Asked) for each page; what is
%   Asked for a browser loads with the page.

:- table contents/1.

contents(Contents) :-
    site(Dir),
    findall(File, directory_member(Dir, File,
                                   [extensions([html]), recursive(true)]),
            Files),
    maplist(file_contents, Files, Contents).

file_contents(File, contents(File, Ids, Links, Asked)) :-
    load_html(File, Dom, [syntax_errors(quiet), max_errors(-1)]),
    findall(Id, xpath(Dom, //(*(@id)), Id), Ids),
    findall(Link, ( xpath(Dom, //(*(@href)), Link)
                  ; xpath(Dom, //(*(@src)), Link) ), Links0),
    sort(Links0, Links),
    findall(Link, asked(Dom, Link), Asked).

asked(Dom, Link) :- xpath(Dom, //script(@src), Link).
asked(Dom, Link) :- xpath(Dom, //link(@href), Link).
asked(Dom, Link) :- xpath(Dom, //img(@src), Link).

leads_somewhere(Link, File, Contents) :-
    uri_components(Link, uri_components(Scheme, _, Path, _, Fragment)),
    (   nonvar(Scheme)
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
    directory_file_path(Dir, Name, Relative),
    absolute_file_name(Relative, Target).

in_file(Fragment, _, _) :-
    memberchk(Fragment, ['', '__skip']),    % the theme's own
    !.
in_file(Fragment, File, _) :-           % a program of the playground
    string_concat("doc=", Id, Fragment),
    !,
    file_directory_name(File, Play),
    directory_file_path(Play, 'programs.json', Programs),
    read_file_to_string(Programs, Text, [encoding(utf8)]),
    format(string(Known), "\"id\":\"~w\"", [Id]),
    once(sub_string(Text, _, _, _, Known)).
in_file(Fragment, File, Contents) :-
    uri_encoded(fragment, Id, Fragment),
    memberchk(contents(File, Ids, _, _), Contents),
    memberchk(Id, Ids).

                /*******************************
                *          PREDICATES          *
                *******************************/

public(PI) :-
    member(Module, [typhon, typhon_nxt, typhon_ros_service]),
    module_property(Module, exports(PIs)),
    member(PI, PIs).
public(PI) :-
    vocabulary_word(_, PI),
    PI \== message_failed/2.

%   The headings of the reference with their ids, in order.

:- table headings/1.

headings(Headings) :-
    page('predicates.html', Dom),
    xpath_chk(Dom, //article, Article),
    findall(Name-Id,
            ( xpath(Article, //(*), element(Name, Attributes, _)),
              memberchk(id=Id, Attributes) ),
            Headings).

                /*******************************
                *            SEARCH            *
                *******************************/

%   The search results for Words below the field: texts and targets, relative
%   to the root of the site.

search(Words, Text, Places) :-
    found(Found),
    memberchk(found(Words, Text, Places), Found).

%   One browser looks for all words: its start takes longer than they.

:- table found/1.

found(Found) :-
    with_browser(Browser,
        findall(found(Words, Text, Places),
                ( looked_for(Words),
                  searched(Browser, Words, Text, Places) ),
                Found)).

looked_for("agent_join").
looked_for("zebra").
looked_for(Word) :- of_prolog(Word).

of_prolog("supervisor").
of_prolog("neighbor").

searched(Browser, Words, Text, Places) :-
    site(Dir),
    format(atom(Address), 'file://~w/index.html', [Dir]),
    browser_open(Browser, Address),
    browser_click(Browser, "input.md-search__input"),
    browser_keys(Browser, [Words]),
    browser_wait(Browser, "return /(match|No|result)/.test(document\c
                           .querySelector('.md-search-result__meta')\c
                           .textContent.replace('Type to start', ''))"),
    browser_run(Browser, "return [document.querySelector('.md-search-result')\c
                          .textContent, [...document.querySelectorAll(\c
                          'a.md-search-result__link')].map(a => a.href)]",
                [Text, Links]),
    findall(Place, ( member(Link, Links), place(Dir, Link, Place) ), Places).

place(Dir, Link, Place) :-
    split_string(Link, "?#", "", [File|Parts]),
    last([""|Parts], Fragment0),
    uri_encoded(fragment, Fragment, Fragment0),
    atomic_list_concat(['file://', Dir, /], Root),
    string_concat(Root, Page, File),
    atomic_list_concat([Page, #, Fragment], Place).

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(site).

test(site_is_built_without_broken_links, Broken == []) :-
    findall(File-Link, broken(File, Link), Broken).

test(navigation_has_every_document, Missing == []) :-
    navigation(Links),
    findall(Page, ( document_page(Page), \+ memberchk(Page, Links) ),
            Missing).

test(menu_has_the_sections, Titles == Expected) :-
    menu(Titles),
    findall(Title,
            ( member(Title, [ 'Start', 'Platform', 'Thesis', 'Course',
                              'Development', 'Predicates' ]),
              ( Title == 'Course' -> installed(studies) ; true ) ),
            Expected).

test(navigation_is_in_reading_order) :-
    navigation(Links),
    once(nth0(Tutorial, Links, 'tutorial.html')),
    once(nth0(Agents, Links, 'agents.html')),
    once(nth0(Architecture, Links, 'architecture.html')),
    Tutorial < Agents,
    Agents < Architecture,
    last(Links, '../predicates.html').

test(every_public_predicate_is_explained, Missing == []) :-
    headings(Headings),
    findall(PI, ( public(PI), term_to_atom(PI, Id),
                  \+ memberchk(h4-Id, Headings) ), Missing).

test(reference_has_no_internals, Found == []) :-
    headings(Headings),
    findall(Id,
            ( member(Id, [ 'message_failed/2', 'child_start/6',
                           'frame_goals/4' ]),
              memberchk(_-Id, Headings) ),
            Found).

test(reference_has_predicates_of_mechanisms,
     [condition(installed(studies))]) :-
    headings(Headings),
    memberchk(h4-'sequence_start/5', Headings).

test(reference_is_grouped_by_task) :-
    headings(Headings),
    once(append(_, [h3-'create-agents'|After], Headings)),
    once(append(Entries, [h3-_|_], After)),
    memberchk(h4-'agent_create/3', Entries),
    \+ memberchk(h4-'agent_join/3', Entries).

test(code_words_link_to_the_reference) :-
    page('tutorial.html', Dom),
    once(xpath(Dom, //pre//a(@href='../predicates.html#move/1'), _)).

test(pictures_and_programs_are_copied, Missing == []) :-
    site(Dir),
    findall(Name,
            ( member(Name, [ 'doc/img/layers.svg',
                             'examples/voting.pl.html' ]),
              directory_file_path(Dir, Name, File),
              \+ exists_file(File) ),
            Missing).

test(no_server_is_contacted, Servers == []) :-
    contents(Contents),
    findall(Link,
            ( member(contents(_, _, _, Asked), Contents),
              member(Link, Asked),
              sub_atom(Link, _, _, _, '://') ),
            Servers).

test(finds_a_predicate) :-
    search("agent_join", _, Places),
    once(nth1(N, Places, 'predicates.html#agent_join/3')),
    N =< 2.                             % below its page

test(finds_predicates_of_prolog, [forall(of_prolog(Word))]) :-
    search(Word, _, [_|_]).

test(reports_no_matches) :-
    search("zebra", Text, []),
    once(sub_string(Text, _, _, _, "No matching documents")).

:- end_tests(site).
