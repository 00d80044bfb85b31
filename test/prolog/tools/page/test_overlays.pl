:- module(test_overlays, []).
:- use_module('../../../../app/packaging/parts', [installed/1]).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [write_file/2]).
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/pages').
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(typhon)).

/** <module> Overlays that mechanisms declare

A browser gets them with the events of agents.
*/

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

unbounded("
:- agent(clerk, []).
overlay('best', bar, log(of(N)), N).
overlay('sum', bar, leave(of(M)), add(M)).
").

%   shown(+Goal, -Rows): the rows of the overlays of declared/1 after Goal,
%   each a list without time, host and agent. H stands for the host of the
%   agent.

shown(Goal, Rows) :-
    declared(Text),
    shown(Text, Goal, Rows).

shown(Text, Goal, Rows) :-
    with_tmp_dir(shown_in(Text, Goal, Rows)).

shown_in(Text, Goal, Rows, Dir) :-
    directory_file_path(Dir, 'clerk.pl', File),
    write_file(File, Text),
    with_hosts([alpha, beta],
               with_page([overlays([File])], Base,
                         with_feed(Base, Feed, shown_on(Feed, Goal, Rows)))).

shown_on(Feed, Goal, Rows) :-
    frame(Feed, _),
    create([(main :- Goal, leave(over))], Agent0, [host(alpha)]),
    atom_string(Agent0, Agent),
    address(alpha, Host0),
    atom_string(Host0, Host),
    rows(Feed, Agent, All),
    findall([Kind|Row],
            ( member([_, _, _, Kind|Row0], All),
              member(Kind, ["add", "show"]),
              here(Row0, Host, Row) ),
            Rows).

%   All events of Agent.

rows(Feed, Agent, Rows) :-
    frame(Feed, Frame),
    (   get_dict(events, Frame, Events)
    ->  findall(Row, ( member(Row, Events), Row = [_, _, Agent|_] ), Some)
    ;   Some = []
    ),
    (   member([_, _, _, "ended"|_], Some)
    ->  Rows = Some
    ;   append(Some, More, Rows),
        rows(Feed, Agent, More)
    ).

here([Name, Host, Value], Host, [Name, 'H', Value]) :-
    !.
here(Row, _, Row).

:- begin_tests(overlays).

test(sum, Rows == [["add", "queue", 'H', 1], ["add", "queue", 'H', -1]]) :-
    shown(( leave(request(7)), take(request(7)) ), Rows).
test(other_host, Rows == [["show", "reserved", "b@h:2", "task('<b>')"]]) :-
    shown(log(reserved('b@h:2', task('<b>'))), Rows).
test(ended, Rows == [["show", "reserved", "b@h:2", null]]) :-
    shown(log(released('b@h:2')), Rows).
test(overlay_of_a_link, Rows == [["show", "traffic", "a@h:1 b@h:2", 12]]) :-
    shown(log(sent('b@h:2', 'a@h:1', 12)), Rows).
test(event_of_no_overlay, Rows == []) :-
    shown(log(something(else)), Rows).
test(overlay_of_an_unknown_kind, Rows == []) :-
    shown(log(x), Rows).
test(infinite, Rows == [ ["show", "best", 'H', "1.0Inf"],
                         ["show", "sum", 'H', "add(1.0Inf)"] ]) :-
    unbounded(Text),
    shown(Text, ( X is inf, log(of(X)), leave(of(X)) ), Rows).
test(hops_of_the_program_are_no_overlays, Rows == []) :-
    shown(( move(beta), home(H), move(H) ), Rows).
test(variables_of_agents, Rows == []) :-
    shown(log(_), Rows).
test(variables_in_values, Rows == [["show", "reserved", "b@h:2", "_"]]) :-
    shown(log(reserved('b@h:2', _)), Rows).
test(overlay_of_agents, condition(installed(studies))) :-
    with_hosts([alpha],
               with_page([], Base,
                         with_feed(Base, Feed, frame(Feed, First)))),
    Scene = First.snapshot,
    findall(Name, ( member(Dict, Scene.overlays), Name = Dict.name ), Names),
    assertion(memberchk("task executed", Names)).
test(no_file, error(existence_error(source_sink, _), _)) :-
    with_hosts([alpha], with_page([overlays(['no such file.pl'])], _, true)).

:- end_tests(overlays).
