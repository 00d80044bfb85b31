:- module(test_helper, []).

/** <module> Tests of helper processes: reports of one that cannot start
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [write_file/3]).
:- use_module('../../../lib/fixtures').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(thread), [concurrent/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/bridges/helper)).

%   with_complaining(:Goal): there is a helper that reports what it lacks, and
%   ends, whenever it is started.

:- meta_predicate with_complaining(0), with_helper(+, 0).

with_complaining(Goal) :-
    Says = 'echo \'{"error":"no_thing","message":"why"}\'; exit 3',
    capturing(with_helper(Says, Goal), _).

with_helper(Says, Goal) :-
    setup_call_cleanup(
        helper_open(complaining, command(path(sh), ['-c',Says]),
                    [restart(always)]),
        Goal,
        helper_close(complaining)).

asked(Error) :-
    helper_ask(complaining, _{do:something}, 5, Answer),
    (   Answer = said(Dict)
    ->  Error = Dict.error
    ;   Error = Answer
    ).

:- begin_tests(helper).

%   The reason is given also while the helper is down, until it is restarted.

test(each_caller_gets_the_reason_of_the_end, Errors == ["no_thing"]) :-
    no_leaks(with_complaining(
        findall(Error, ( between(1, 5, _), is_down, asked(Error) ), All))),
    sort(All, Errors).

%   No message reports a restart either.

test(helper_without_its_packages_is_not_restarted,
     Errors-Messages == ["no_thing","no_thing"]-[]) :-
    Says = 'echo \'{"error":"no_thing","message":"why","again":false}\'; \c
            exit 3',
    no_leaks(capturing(with_helper(Says, findall(Error,
                                                 ( member(_, [1,2]),
                                                   asked(Error),
                                                   is_down ),
                                                 Errors)),
                       Messages)).

test(late_answer_leaves_one_serving_thread,
     Answers == [said("timeout"),ok(1),ok(1)]) :-
    no_leaks(with_tmp_dir(late(Answers))).

%   A method past its deadline that announces a later answer has been replaced.
%   Two calls of `meet` at once would count each other.

late([Slow,First,Second], Dir) :-
    directory_file_path(Dir, 'slow.py', File),
    helper_file('lib/helper.py', Lib),
    file_directory_name(Lib, Path),
    write_file(File, 'import sys, threading, time~n\c
                      sys.path.insert(0, "~w")~n\c
                      from helper import Helper, LATER~n\c
                      class Slow(Helper):~n\c
                      \x20   met, gone = 0, threading.Event()~n\c
                      \x20   def do_slow(self, request, deadline):~n\c
                      \x20       while not request["job"].answered:~n\c
                      \x20           time.sleep(0.01)~n\c
                      \x20       return LATER~n\c
                      \x20   def do_meet(self, request, deadline):~n\c
                      \x20       self.met += 1~n\c
                      \x20       time.sleep(0.5)~n\c
                      \x20       met, self.met = self.met, 0~n\c
                      \x20       return met~n\c
                      Slow().run()~n', [Path]),
    helper_python([], Python),
    setup_call_cleanup(
        helper_open(slow, command(Python, [File]), []),
        ( answer(slow, 0.2, Slow),
          concurrent(2, [answer(meet, 5, First), answer(meet, 5, Second)], [])
        ),
        helper_close(slow)).

answer(Do, Seconds, Short) :-
    helper_ask(slow, _{do:Do}, Seconds, Answer),
    (   Answer = said(Dict)
    ->  Short = said(Dict.error)
    ;   Short = Answer
    ).

is_down :-
    wait_until(\+ helper_pid(complaining, _), 20).

:- end_tests(helper).
