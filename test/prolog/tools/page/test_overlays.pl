:- module(test_overlays, []).
:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/tools/page/overlays)).

/*  What mechanisms declare to be seen. */

declared("
:- agent(clerk, []).
overlay('queue', bar, leave(request(_)), add(1)).
overlay('queue', bar, take(request(_)), add(-1)).
overlay('reserved', label, log(reserved(Robot, Task)), Robot-Task).
overlay('reserved', label, log(released(Robot)), Robot-none).
overlay('traffic', link, log(sent(A, B, N)), (A,B)-N).
overlay('not one', pie, log(x), 1).
overlay(Unbound, bar, Whenever, 1).
overlay('broken', bar, log(.
main :- halt.
").

%   shown(+What, -Rows): of one event.

shown(What, Rows) :-
    with_tmp_dir(shown_in(What, Rows)).

shown_in(What, Rows, Dir) :-
    directory_file_path(Dir, 'clerk.pl', File),
    declared(Text),
    setup_call_cleanup(open(File, write, Out), write(Out, Text), close(Out)),
    overlays_declared([File], Overlays),
    event_rows([event(2.5, 'a@h:1', 'x.1@a@h:1', What)], Overlays,
               [_|Rows]).

infinite(What, Kind, Value) :-
    event_rows([event(2.5, 'a@h:1', 'x.1@a@h:1', What)],
               [ overlay(best, bar, log(N), N),
                 overlay(sum, bar, leave(of(M)), add(M)) ],
               [_, [_, _, _, Kind, _, _, Value]]).

:- begin_tests(overlays).

test(sum, Rows == [[2.5, "a@h:1", "x.1@a@h:1", "add", "queue", "a@h:1", 1]]) :-
    shown(leave(request(7)), Rows).
test(less, [Kind, Value] == ["add", -1]) :-
    shown(take(request(7)), [[_, _, _, Kind, _, _, Value]]).
test(other_host, [Where, Value] == ["b@h:2", "task('<b>')"]) :-
    shown(log(reserved('b@h:2', task('<b>'))),
          [[_, _, _, "show", "reserved", Where, Value]]).
test(ended, Value == null) :-
    shown(log(released('b@h:2')), [[_, _, _, "show", _, "b@h:2", Value]]).
test(of_a_link, Where-Value == "a@h:1 b@h:2"-12) :-
    shown(log(sent('b@h:2', 'a@h:1', 12)), [[_, _, _, _, _, Where, Value]]).
test(nothing_of_it, Rows == []) :-
    shown(log(something(else)), Rows).
test(not_declared, Rows == []) :-
    shown(log(x), Rows).
test(infinite, [Values, Kinds] == [["1.0Inf", "add(1.0Inf)"],
                                 ["show", "show"]]) :-
    Inf is inf,
    findall(Kind-Value,
            ( member(What, [log(Inf), leave(of(Inf))]),
              infinite(What, Kind, Value) ),
            Pairs),
    pairs_keys_values(Pairs, Kinds, Values).
test(hops_are_no_overlays, Rows == []) :-
    shown(left('b@h:2'), Rows).
test(variables_of_agents, Rows == []) :-
    shown(log(_), Rows).
test(variables_in_values, Value == "_") :-
    shown(log(reserved('b@h:2', _)), [[_, _, _, "show", _, _, Value]]).
test(of_agents) :-
    overlays_declared([], Overlays),
    overlay_dicts(Overlays, Dicts),
    findall(Name, ( member(Dict, Dicts), get_dict(name, Dict, Name) ), Names),
    assertion(memberchk("task executed", Names)).
test(no_file, error(existence_error(source_sink, _), _)) :-
    overlays_declared(['no such file.pl'], _).

:- end_tests(overlays).
