:- module(test_hits, []).

/** <module> Notes which predicates the tests of a suite execute

Loaded by the files of a copy of this project in which each rule of predicate
N calls `system:'$hit'(N)` first.  The file of the suite, see suite_mark/2, gets,
in the order of time,

| hit(Pid, N)              | the process first executes it, since its start or test |
| begins(Pid, Test, Clock) | Test is Unit:Name                                      |
| ends(Pid, Clock)         |                                                        |

Also processes that are killed have then noted what they did.

*Threading*: any thread.
*/

:- dynamic seen/1, in_test/1.
:- volatile seen/1, in_test/1.

system:'$hit'(Number) :-
    test_hits:seen(Number),
    !.
system:'$hit'(Number) :-
    assertz(test_hits:seen(Number)),
    current_prolog_flag(pid, Pid),
    test_hits:note(hit(Pid, Number)).

%   The cases of one test come one after the other, by the name @(Name, _) in
%   this version.

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(plunit(begin(Unit:Test, _, _)), _, _) :-
    plain_name(Test, Name),
    \+ in_test(Unit:Name),
    retractall(in_test(_)),
    assertz(in_test(Unit:Name)),
    retractall(seen(_)),
    clock(Pid, Now),
    note(begins(Pid, Unit:Name, Now)),
    fail.
user:message_hook(plunit(end(_:_, _, _)), _, _) :-
    clock(Pid, Now),
    note(ends(Pid, Now)),
    fail.

%   The next unit is set up after the end of the former.

user:message_hook(plunit(end(_, _)), _, _) :-
    retractall(seen(_)),
    fail.

plain_name(@(Name, _), Name) :-
    !.
plain_name(Name, Name).

clock(Pid, Now) :-
    current_prolog_flag(pid, Pid),
    get_time(Now).

note(Term) :-
    getenv('TYPHON_HITS', Dir),
    getenv('TYPHON_SUITE', Mark),
    !,
    atomic_list_concat([_, Suite], ':', Mark),
    atomic_list_concat([Dir, /, Suite], File),
    format(string(Line), '~q.~n', [Term]),
    catch(setup_call_cleanup(
              open(File, append, Out),
              write(Out, Line),
              close(Out)),
          error(_, _), true).           % within a cell
note(_).
