% The applications print what their document shows.

:- module(test_applications, []).
:- use_module('../lib/common').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

application(fire, []).
application(irrigation, ['--days=30']).         % of ninety
application(solar, []).
application(warehouse, []).

:- begin_tests(applications).

test(what_is_printed_is_documented, [forall(application(Name, Options))]) :-
    atomic_list_concat(['examples/applications/', Name, '.pl'], Path),
    project_file(Path, File),
    run_swipl([File, '--speed=0'|Options], [timeout(120)], Status, Out, Err),
    assertion(Status-Err == exit(0)-""),
    project_file('doc/applications.md', Document),
    read_file_to_string(Document, Text, [encoding(utf8)]),
    assertion(sub_string(Text, _, _, _, Out)).

:- end_tests(applications).
