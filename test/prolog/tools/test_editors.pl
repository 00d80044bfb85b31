:- module(test_editors, []).

% The answers of SWI-Prolog to an editor about an agent program.

:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(prolog_colour),
              [ prolog_colourise_query/3, prolog_colourise_stream/3 ]).
:- use_module(library(prolog_xref),
              [ xref_clean/1, xref_defined/3, xref_source/2 ]).
:- use_module(library(typhon)).

%   seen(+Text, :Goal): call(Goal, File) for a file with Text that an editor
%   has open.

seen(Text, Goal) :-
    with_tmp_dir(seen_in(Text, Goal)).

seen_in(Text, Goal, Dir) :-
    directory_file_path(Dir, 'program.pl', File),
    write_file(File, Text),
    looked_at(File, Goal).

looked_at(File, Goal) :-
    setup_call_cleanup(
        xref_source(File, [silent(true)]),
        once(call(Goal, File)),
        xref_clean(File)).

:- thread_local coloured/1.

%   The goals, and heads, that are shown as Class.

shown_as(Class, PIs, File) :-
    retractall(coloured(_)),
    setup_call_cleanup(
        open(File, read, In),
        prolog_colourise_stream(In, File, note),
        close(In)),
    findall(Name/Arity,
            ( member(Kind, [goal(Class, Goal), head(Class, Goal)]),
              coloured(Kind),
              functor(Goal, Name, Arity) ),
            Found),
    sort(Found, PIs).

note(Colour, _, _) :-
    assertz(coloured(Colour)).

census("\c
:- agent(census, [state([seen/2])]).
main :- neighbours(Hosts), tour(Hosts), next_host(random, _), nonsense.
tour([]).
tour([Host|Hosts]) :-
    move(Host), here(Here), assertz(seen(Here, 1)), tour(Hosts).
on_message(From, M) :- seen(M, _), sleep(1), send(From, yes), log(M).
").

%   Whether a fragment of Text is shown as Class.

shows(Text, Part, Class) :-
    seen(Text, shown(Part, Text, Class)).

shown(Part, Text, Class, File) :-
    retractall(coloured(_)),
    setup_call_cleanup(
        open(File, read, In),
        prolog_colourise_stream(In, File, note_part(Text)),
        close(In)),
    coloured(Part-Class),
    !.

note_part(Text, Class, Start, Length) :-
    (   sub_string(Text, Start, Length, _, Part)
    ->  assertz(coloured(Part-Class))
    ;   true                            % after the end
    ).

asked(Query, Part, Class, File) :-
    retractall(coloured(_)),
    prolog_colourise_query(Query, File, note_part(Query)),
    coloured(Part-Class),
    !.

unknown(PIs, File) :-
    findall(Name/Arity,
            ( xref_called(File, Goal, _),
              \+ xref_defined(File, Goal, _),
              \+ predicate_property(system:Goal, visible),
              functor(Goal, Name, Arity) ),
            PIs).

comes_from(Goal, Module, File) :-
    xref_defined(File, Goal, imported(From)),
    module_property(Module, file(From)).

program(Name, File) :-
    atomic_list_concat(['examples/classics/', Name, '.pl'], Relative),
    project_file(Relative, File).

:- begin_tests(editors).

test(vocabulary_is_highlighted) :-
    census(Text),
    seen(Text, comes_from(move(_), typhon_words)),
    seen(Text, comes_from(clone(_, _), typhon_words)),
    seen(Text, comes_from(next_host(_, _), typhon_migration)).

test(only_undefined_predicates_are_marked, PIs == [nonsense/0]) :-
    census(Text),
    seen(Text, shown_as(undefined, PIs)).

test(entry_points_count_as_called, PIs == []) :-
    census(Text),
    seen(Text, shown_as(unreferenced, PIs)).

test(state_is_dynamic) :-
    census(Text),
    seen(Text, [File]>>xref_defined(File, seen(_, _), dynamic(_))).

test(directive_is_known) :-
    forall(member(Text, [":- agent(a).", ":- agent(a, [state([b/1])]).",
                         ":- payload(a, [provides([b/1])])."]),
           seen(Text, shown_as(undefined, []))).

test(vocabulary_is_built_in) :-
    census(Text),
    forall(member(Part-Goal, [ "move"-move(_), "here"-here(_),
                               "sleep"-sleep(_), "next_host"-next_host(_, _),
                               "send"-send(_, _) ]),
           shows(Text, Part, goal(built_in, Goal))).

test(options_are_known) :-
    Text = ":- agent(a, [state([b/1]), color(red)]).\n",
    shows(Text, "a", identifier),
    shows(Text, "b/1", predicate_indicator(dynamic(_), b(_))),
    shows(Text, "color(red)", type_error(_)).

test(query_about_a_program) :-
    census(Text),
    seen(Text, asked("seen(H, _), move(H)", "move", goal(built_in, _))),
    seen(Text, asked("seen(H, _), move(H)", "seen", goal(dynamic(_), _))).

test(users_of_the_library, PIs == [nonsense/0]) :-
    project_file('prolog/typhon.pl', Typhon),
    format(string(Text),
           ":- use_module(~q).~n\c
            p :- host_start(a), agent_create(x, A), hosts, nonsense,~n\c
                agent_join(A, _, 5), network_stop(A).~n", [Typhon]),
    seen(Text, unknown(PIs)).

test(payload_offers_what_it_provides, PIs == [hidden/1]) :-
    seen(":- payload(p, [provides([shown/1])]).\nshown(1).\nhidden(1).\n",
         shown_as(unreferenced, PIs)).

test(incomplete_directive_is_no_error) :-
    forall(member(Text, [":- agent(a, X).", ":- agent(a, [state(X)]).",
                         ":- agent(a, [state([b|X])]).", ":- agent(A, B).",
                         ":- payload(a, b).", ":- X."]),
           seen(Text, shown_as(undefined, _))).

test(other_files_are_not_affected, PIs == [clone/2, move/1]) :-
    seen(":- module(m, [p/1]).\np(X) :- move(X), clone(X, _).\n",
         shown_as(undefined, PIs)).

test(loading_is_not_affected, Term == (:- agent(a, [state([b/1])]))) :-
    expand_term((:- agent(a, [state([b/1])])), Term).

test(programs_of_tartarus_have_no_errors, Undefined == [choose/3, at/3]) :-
    findall(PI,
            ( member(Name, [ hello, sum, dictionary, game, salesman, flood,
                             explorer, tree, sorter, pathfinder ]),
              program(Name, File),
              looked_at(File, shown_as(undefined, PIs)),
              member(PI, PIs) ),
            Undefined).

:- end_tests(editors).
