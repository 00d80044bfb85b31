:- module(test_site, []).

% `make doc`: who reads the documents as a site finds all of them, in order,
% and every predicate; no link leads nowhere; words are found.

:- use_module('../lib/common').
:- use_module('../../doc/site/broken', [broken/2]).
:- use_module('../../doc/site/dom').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [ delete_directory_and_contents/1, directory_file_path/3,
                directory_member/3 ]).
:- use_module(library(lists), [append/3, last/2, member/2, nth0/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(sgml), [load_html/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/nxt), []).

:- needs([doc]).

                /*******************************
                *             SITE             *
                *******************************/

%   One for all tests, made as the user makes it.

:- dynamic made/1.

site(Dir) :-
    made(Dir),
    !.
site(Dir) :-
    tmp_file(typhon_site, Dir),
    project_file('doc/site.pl', Program),
    run_swipl([Program, --, Dir], [cwd('/')], Status, Out, Err),
    assertion(made(Status, Out, Err) == made(exit(0), "", "")),
    assertz(made(Dir)),
    at_halt(delete_directory_and_contents(Dir)).

page(Name, Dom) :-
    site(Dir),
    directory_file_path(Dir, Name, File),
    load_html(File, Dom, [syntax_errors(quiet), max_errors(-1)]).

%   The pages to which the navigation of the page Name leads, in order.

navigation(Name, Links) :-
    page(Name, Dom),
    dom_element(Dom, element(nav, _, Nav)),
    !,
    findall(Link,
            ( dom_element(Nav, Element),
              dom_attribute(Element, href, Link),
              \+ sub_atom(Link, 0, _, _, #) ),
            [_|Links]).

document_page(Page) :-
    project_file('doc/*.md', Pattern),
    expand_file_name(Pattern, Files),
    member(File, Files),
    file_base_name(File, Base),
    file_name_extension(Stem, md, Base),
    file_name_extension(Stem, html, Page).

                /*******************************
                *          PREDICATES          *
                *******************************/

public(PI) :-
    member(Module, [ typhon, typhon_words, typhon_memory, typhon_nxt ]),
    module_property(Module, exports(PIs)),
    member(PI, PIs),
    PI \== message_failed/2.

%   What is said of the predicate after its head, and those beside it.

explained(Dom, Name/Arity) :-
    atomic_list_concat([Name, Arity], /, Id),
    dom_element(Dom, element(dl, _, List)),
    append(_, [Term|After], List),
    Term = element(dt, _, _),
    dom_element([Term], Anchor),
    dom_attribute(Anchor, id, Id),
    member(element(dd, _, Description), After),
    !,
    dom_text(Description, Text),
    split_string(Text, "", " \n", [Clean]),
    Clean \== "".

                /*******************************
                *            SEARCH            *
                *******************************/

node :-
    absolute_file_name(path(node), _, [access(execute), file_errors(fail)]).

node_prints(Script, Text) :-
    setup_call_cleanup(
        process_create(path(node), [-],
                       [ stdin(pipe(In, [encoding(utf8)])),
                         stdout(pipe(Out, [encoding(utf8)])), process(Pid) ]),
        ( write(In, Script),
          close(In),
          read_string(Out, _, Text),
          process_wait(Pid, exit(0)) ),
        close(Out)).

%   What the script of the page finds, by the places of the hits.

found(Words, Places) :-
    site(Dir),
    findall(Text, ( member(Name, ['sections.js', 'search.js']),
                    directory_file_path(Dir, Name, File),
                    read_file_to_string(File, Text, [encoding(utf8)]) ),
            Texts),
    format(string(Ask),
           "~nfor (const hit of search(\"~w\")) console.log(hit.at)~n",
           [Words]),
    atomic_list_concat(Texts, '\n', Scripts),
    string_concat(Scripts, Ask, Script),
    node_prints(Script, Text),
    split_string(Text, "\n", "", Strings),
    append(Found, [""], Strings),
    !,
    maplist(atom_string, Places, Found).

%   What a reader sees below the field, in a document of a few lines.

shown(Words, Text) :-
    site(Dir),
    findall(Script, ( member(Name, ['sections.js', 'search.js']),
                      directory_file_path(Dir, Name, File),
                      read_file_to_string(File, Script, [encoding(utf8)]) ),
            Scripts),
    format(string(Ask),
           "~nconst element = () => ({ children: [], append() {},
                replaceChildren(...all) { this.children = all; } });
            globalThis.document = { createElement: element };
            const place = element();
            show(place, \"~w\");
            console.log(place.children.map(e => e.textContent).join())~n",
           [Words]),
    append(Scripts, [Ask], Parts),
    atomic_list_concat(Parts, '\n', Script),
    node_prints(Script, Text).

                /*******************************
                *         BROKEN SITES         *
                *******************************/

broken_in(Pages, Problems) :-
    with_tmp_dir(broken_among(Pages, Problems)).

broken_among(Pages, Problems, Dir) :-
    forall(member(Name-Html, Pages), write_page(Dir, Name, Html)),
    findall(Problem,
            ( broken(Dir, Found), without_directory(Found, Problem) ),
            Problems).

write_page(Dir, Name, Html) :-
    directory_file_path(Dir, Name, File),
    setup_call_cleanup(open(File, write, Out), write(Out, Html), close(Out)).

without_directory(Problem0, Problem) :-
    Problem0 =.. [Kind, File, What],
    file_base_name(File, Base),
    Problem =.. [Kind, Base, What].

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(site).

test(is_made_and_nothing_leads_nowhere, Problems == []) :-
    site(Dir),
    findall(Problem, broken(Dir, Problem), Problems).

test(navigation_has_every_document, Missing == []) :-
    navigation('index.html', Links),
    findall(Page, ( document_page(Page), \+ memberchk(Page, Links) ),
            Missing).

test(navigation_is_in_reading_order) :-
    navigation('index.html', Links),
    nth0(0, Links, 'index.html'),
    nth0(1, Links, 'contents.html'),
    nth0(2, Links, 'tutorial.html'),
    nth0(Agents, Links, 'agents.html'),
    nth0(Architecture, Links, 'architecture.html'),
    Agents < Architecture,
    last(Links, 'predicates.html'),
    !.

test(navigation_is_the_same_on_every_page) :-
    navigation('index.html', Links),
    forall(member(Page, Links), navigation(Page, Links)).

test(explains_every_public_predicate, Missing == []) :-
    page('predicates.html', Dom),
    findall(PI, ( public(PI), \+ explained(Dom, PI) ), Missing).

test(reference_has_no_internals, Found == []) :-
    page('predicates.html', Dom),
    findall(Id,
            ( dom_element(Dom, Anchor),
              dom_attribute(Anchor, id, Id),
              memberchk(Id, [ 'message_failed/2', 'child_start/5',
                              'pheromone_emit/3', 'cut_again/2' ]) ),
            Found).

test(reference_is_grouped_by_task, nondet) :-
    page('predicates.html', Dom),
    dom_element(Dom, element(article, _, Dom0)),
    append(_, [element(h3, _, ['Create agents'])|After], Dom0),
    append(Entries, [element(h3, _, _)|_], After),
    \+ memberchk(element(h3, _, _), Entries),
    explained(Entries, agent_create/3),
    \+ explained(Entries, agent_join/3).

test(words_of_programs_lead_to_the_reference) :-
    page('tutorial.html', Dom),
    dom_element(Dom, element(pre, _, Program)),
    dom_element(Program, Link),
    dom_attribute(Link, href, 'predicates.html#move/1'),
    !.

test(pictures_and_programs_come_along, Missing == []) :-
    site(Dir),
    findall(Name,
            ( member(Name, [ 'img/layers.svg', 'img/synchronisation.png',
                             'source-bench-traveller.pl.html' ]),
              directory_file_path(Dir, Name, File),
              \+ exists_file(File) ),
            Missing).

test(asks_no_server) :-
    site(Dir),
    forall(( directory_member(Dir, File, [extensions([html])]),
             load_html(File, Dom, [syntax_errors(quiet), max_errors(-1)]),
             dom_element(Dom, element(Name, As, _)),
             memberchk(Name, [script, link, img]),
             member(Key, [src, href]),
             memberchk(Key=Link, As) ),
           \+ sub_atom(Link, _, _, _, '://')).

test(finds_a_predicate_first, [condition(node), Place == Wanted]) :-
    Wanted = 'predicates.html#agent_join/3',
    found(agent_join, [Place|_]).

test(finds_what_has_all_words, [condition(node)]) :-
    found("virtual time", Places),
    memberchk('time.html#virtual-time', Places),
    found("virtual zebra", []).

test(finds_the_words_of_others,
     [condition(node), forall(member(Word, [supervisor, neighbor, node]))]) :-
    found(Word, [_|_]).
test(says_that_there_is_nothing, [condition(node), Shown == "No results"]) :-
    shown("zebra", Text),
    sub_string(Text, 0, 10, _, Shown).

:- end_tests(site).

:- begin_tests(broken).

test(sees_what_is_in_order, Problems == []) :-
    broken_in([ 'a.html'-'<p id="x/1"><a href="b.html#y">b</a>',
                'b.html'-'<p id="y"><a href="a.html#x/1">a</a>\c
                          <a href="#y">y</a><a href="http://else/">e</a>' ],
              Problems).

test(sees_missing_files_and_places, Problems == Expected) :-
    Expected = [ link('a.html', 'c.html'), link('a.html', '#y'),
                 link('a.html', 'b.html#x'), link('a.html', 'd.png') ],
    broken_in([ 'a.html'-'<p id="x"><a href="c.html">c</a>\c
                          <a href="#y">y</a><a href="b.html#x">b</a>\c
                          <img src="d.png">',
                'b.html'-'<p id="y">b' ],
              Problems).

test(sees_what_is_called_the_same, Problems == [twice('a.html', x)]) :-
    broken_in(['a.html'-'<p id="x">1<p id="x">2'], Problems).

:- end_tests(broken).
