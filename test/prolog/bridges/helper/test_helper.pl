:- module(test_helper, []).

/** <module> Tests of helper processes: reports of one that cannot start
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [write_file/3]).
:- use_module('../../../lib/fixtures').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(thread), [concurrent/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/bridges/helper)).
:- use_module(library(typhon/bridges/helper/process), [process_kill_of/1]).
:- use_module(library(typhon/bridges/helper/owner), [own/4, own_state/2]).
:- use_module(library(typhon/kernel/base/monotonic), [monotonic_time/1]).
:- use_module(library(typhon/kernel/base/server),
              [server_call/4, server_cast/2, server_start/4, server_stop/1]).

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
test(exception_in_a_pool_is_the_answer, Answer == said("exception")) :-
    no_leaks(with_tmp_dir(with_slow(answer(unplugged, 20, Answer)))).

%   A method past its deadline that announces a later answer has been replaced.
%   Two calls of `meet` at once would count each other.

late([Slow,First,Second], Dir) :-
    with_slow(( answer(slow, 0.2, Slow),
                concurrent(2, [answer(meet, 5, First), answer(meet, 5, Second)],
                           []) ),
              Dir).

:- meta_predicate with_slow(0, +).

with_slow(Goal, Dir) :-
    directory_file_path(Dir, 'slow.py', File),
    helper_file('lib/helper.py', Lib),
    file_directory_name(Lib, Path),
    write_file(File, 'import sys, threading, time~n\c
                      sys.path.insert(0, "~w")~n\c
                      from concurrent.futures import ThreadPoolExecutor~n\c
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
                      \x20   def do_unplugged(self, request, deadline):~n\c
                      \x20       pool = ThreadPoolExecutor(1)~n\c
                      \x20       return self.later(pool, request, open, "/x")~n\c
                      Slow().run()~n', [Path]),
    helper_python([], Python),
    setup_call_cleanup(
        helper_open(slow, command(Python, [File]), []),
        Goal,
        helper_close(slow)).

answer(Do, Seconds, Short) :-
    helper_ask(slow, _{do:Do}, Seconds, Answer),
    (   Answer = said(Dict)
    ->  Short = said(Dict.error)
    ;   Short = Answer
    ).

test(delays_double_up_to_ten_seconds,
     Delays == [0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 10, 10]) :-
    no_leaks(with_owner(command('/no/program', []), Owner, Reports,
                        findall(Delay,
                                ( between(1, 8, _),
                                  server_cast(Owner, timeout),
                                  next_state(Reports, down(Delay)) ),
                                Delays))).
test(first_restart_is_immediate, States == [up(0), up(0.1), down(0.2)]) :-
    no_leaks(capturing(with_owner(command(path(sh), ['-c', 'exit 3']),
                                  _, Reports,
                                  ( length(States, 3),
                                    maplist(next_state(Reports), States) )),
                       _)).
test(restart_after_five_seconds_is_immediate,
     [ forall(member(Age-Next, [2-down(0.2), 5.5-up(0.1)])), State == Next ]) :-
    no_leaks(capturing(with_owner(command(path(cat), []), Owner, Reports,
                                  restarted(Owner, Reports, Age, State)),
                       _)).

%   The second process has been running for Age seconds when it ends.

restarted(Owner, Reports, Age, State) :-
    next_state(Reports, up(0)),
    process_kill_of(Owner),
    next_state(Reports, up(0.1)),
    server_cast(Owner, age(Age)),
    next_state(Reports, up(0.1)),
    process_kill_of(Owner),
    next_state(Reports, State).

:- meta_predicate with_owner(+, -, -, 0).

%   with_owner(+Command, -Owner, -Reports, :Goal): the owner of a helper that is
%   always restarted; the queue Reports gets its states.

with_owner(Command, Owner, Reports, Goal) :-
    setup_call_cleanup(
        ( message_queue_create(Lines),
          message_queue_create(Reports) ),
        owned(owner(test, Command, always, test, Lines), Owner, Reports, Goal),
        ( message_queue_destroy(Lines),
          message_queue_destroy(Reports) )).

owned(Me, Owner, Reports, Goal) :-
    own_state(always, until(_, State)),
    setup_call_cleanup(
        server_start(test, reporting(Reports, Me), State, Owner),
        ( next_state(Reports, down(first)),
          once(Goal) ),
        ( server_call(Owner, quit, 20, done),
          server_stop(Owner) )).

reporting(Reports, Me, Message, State0, Next) :-
    (   Message = age(Seconds)
    ->  State0 = up(Process, _, Wait),
        monotonic_time(Now),
        Since is Now-Seconds,
        Next = up(Process, Since, Wait)
    ;   own(Me, Message, State0, Next)
    ),
    thread_send_message(Reports, Next).

next_state(Reports, Short) :-
    thread_get_message(Reports, Next, [timeout(20)]),
    short(Next, Short).

short(until(_, State), Short) :- short(State, Short).
short(up(_, _, Wait), up(Wait)).
short(down(_, Wait, _), down(Wait)).

is_down :-
    wait_until(\+ helper_pid(complaining, _), 20).

:- end_tests(helper).
