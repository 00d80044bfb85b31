:- module(test_helper, []).

/** <module> Tests of processes that help: what is heard of one that cannot
*/

:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/helper)).

%   with_complaining(:Goal): there is a helper that says what it lacks, and ends,
%   whenever it is started.

:- meta_predicate with_complaining(0).

with_complaining(Goal) :-
    Says = 'echo \'{"error":"no_thing","message":"why"}\'; exit 3',
    listening(setup_call_cleanup(
                  helper_open(complaining, command(path(sh), ['-c',Says]),
                              [restart(always)]),
                  Goal,
                  helper_close(complaining)), _).

asked(Error) :-
    helper_ask(complaining, _{do:something}, 5, Answer),
    (   Answer = said(Dict)
    ->  Error = Dict.error
    ;   Error = Answer
    ).

:- begin_tests(helper).

%   Also while it is down, until it is started once more.

test(whoever_asks_hears_why_it_ends, Errors == ["no_thing"]) :-
    no_leaks(with_complaining(
        findall(Error, ( between(1, 5, _), is_down, asked(Error) ), All))),
    sort(All, Errors).

is_down :-
    wait_until(\+ helper_pid(complaining, _), 20).

:- end_tests(helper).
