:- module(test_search, []).
:- use_module('../../app/packaging/parts', [left_out/2]).
:- use_module('../lib/common').
:- use_module('../lib/site').
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).

:- if(exists_source(library(json))).
:- use_module(library(json), [json_read_dict/2]).
:- else.
:- use_module(library(http/json), [json_read_dict/2]).
:- endif.

:- needs([doc, nodejs]).

/** <module> What the search of the site finds first

By the scripts of its pages, which Node runs.

*Threading*: the main thread.
*/

%   expected(?Word, ?Page): a reader who looks for Word wants this page.

expected(license, contributing).
expected(contribute, contributing).
expected(bug, contributing).
expected(docker, install).
expected(systemd, install).
expected(upgrade, upgrading).
expected(uninstall, install).
expected(windows, install).
expected(macos, install).
expected(firewall, 'two-machines').
expected(cookie, 'two-machines').
expected(tls, keys).
expected(sandbox, security).
expected(quota, security).
expected(crash, journal).
expected(backup, journal).
expected(postgresql, journal).
expected(python, bridges).
expected(mqtt, bridges).
expected(ros, 'bridges-ros').
expected(jade, 'bridges-fipa').
expected(lego, robots).
expected(supervisor, supervision).
expected(broadcast, 'writing-agents').
expected(topology, networks).
expected(simulation, time).
expected(debug, looking).
expected(breakpoint, looking).
expected(replay, 'page-map').
expected(latency, performance).

is_there(Page) :-
    atomic_list_concat(['doc/', Page, '.md'], File),
    \+ left_out(File, _).

%   found_first(+Word, -Page): the name of the first page that is found, in
%   small letters; `none` if there is none.

found_first(Word, Page) :-
    all_found(Found),
    memberchk(Word-Pages, Found),
    (   Pages = [First|_]
    ->  page_name(First, Page)
    ;   Page = none
    ).

page_name(Place, Page) :-
    file_base_name(Place, Base),
    file_name_extension(Name, html, Base),
    downcase_atom(Name, Page).

%   all_found(-Found): Word-Pages, the pages that are found, the best first.

:- table all_found/1.

all_found(Found) :-
    findall(Word, expected(Word, _), Words),
    site(Site),
    project_file('test/lib/site_search.js', Script),
    setup_call_cleanup(
        process_create(path(node), [Script, Site],
                       [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
        ( call_cleanup(maplist(writeln(In), Words), close(In)),
          maplist(pages_found(Out), Words, Found) ),
        ( close(Out), process_wait(Pid, Status) )),
    assertion(Status == exit(0)).

pages_found(Out, Word, Word-Pages) :-
    json_read_dict(Out, Pages).

:- begin_tests(search).

test(first_page_is_the_one_that_readers_want,
     [forall(( expected(Word, Page), is_there(Page) )), Found == Page]) :-
    found_first(Word, Found).

:- end_tests(search).
