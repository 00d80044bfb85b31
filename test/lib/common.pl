:- module(test_common,
          [ needs/1,                    % +Names
            missing/1,                  % -Packages
            missing/2,                  % +Names, -Packages
            project_file/2,             % +Relative, -Absolute
            with_tmp_dir/1,             % :Goal
            with_tmp_dir/2,             % -Dir, :Goal
            make_tmp_dir/1,             % -Dir
            shell_script/2,             % +File, +Line
            no_leaks/1,                 % :Goal
            state_size/2,               % +Module, -Facts
            with_settings/2,            % +Values, :Goal
            wait_until/2,               % :Goal, +Seconds
            elapsed/2,                  % :Goal, -Seconds
            soon/2,                     % +Seconds, +Most
            with_swipl/5,               % +Args, -Pid, -In, -Out, :Goal
            python/1,                   % -Executable
            run_swipl/5,                % +Args, +Options, -Status, -Out, -Err
            wait_for_end/3,             % +Pid, +Seconds, -Status
            stop_process/1,             % +Pid
            is_dead/1,                  % +Pid
            free_port/1                 % -Port
          ]).

/** <module> Common predicates of all test suites

A suite begins with `:- use_module('../lib/common')`, after which
library(typhon), agents(X) and payloads(X) are those of this tree, and the
cookie of the endpoints is a private one; then `:- needs(Names)` if it needs
packages that not every machine has.

*Threading*: the predicates may be called in any thread.  no_leaks/1 checks
the whole process, so no other test should run meanwhile.
*/

:- use_module(slowness, [patience/2]).
:- use_module(texts, [write_file/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [include/3, maplist/2, maplist/3]).
:- use_module(library(filesex),
              [ chmod/2,
                delete_directory_and_contents/1,
                directory_file_path/3,
                make_directory_path/1
              ]).
:- use_module(library(lists), [last/2, member/2, subtract/3]).
:- use_module(library(option), [select_option/4]).
:- use_module(library(ordsets), [ord_subtract/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/3]).
:- use_module(library(random), [random_between/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(settings), [set_setting/2, setting/2]).
:- use_module(library(socket),
              [ tcp_bind/2, tcp_close_socket/1, tcp_setopt/2,
                tcp_socket/1 ]).

:- meta_predicate
    with_tmp_dir(1),
    with_tmp_dir(-, 0),
    no_leaks(0),
    with_settings(+, 0),
    wait_until(0, +),
    elapsed(0, -),
    with_swipl(+, -, -, -, 0).

:- dynamic root/1.

:- prolog_load_context(directory, Dir),
   atom_concat(Root, '/test/lib', Dir),
   retractall(root(_)),
   assertz(root(Root)).

:- multifile user:file_search_path/2.
:- dynamic user:file_search_path/2.

user:file_search_path(library, Dir) :-
    root(Root),
    atom_concat(Root, '/prolog', Dir).

%!  needs(+Names) is det.
%
%   The suite needs the packages or groups Names of .ci/packages. As a
%   directive: if a package is missing the suite is skipped, and test/run.pl
%   reports it.

:- dynamic needed/1.

needs(Names) :-
    assertz(needed(Names)).

%!  missing(-Packages:list(string)) is det.
%!  missing(+Names, -Packages:list(string)) is det.
%
%   Packages that the suite needs, or of Names, that this machine does not
%   have.

missing(Packages) :-
    findall(Name, ( needed(Names), member(Name, Names) ), Names),
    missing(Names, Packages).

missing([], []) :-
    !.
missing(Names, Packages) :-
    project_file('.ci/install', Install),
    setup_call_cleanup(
        process_create(Install, ['--missing'|Names],
                       [stdin(null), stdout(pipe(Out)), process(Pid)]),
        read_string(Out, _, Text),
        close(Out)),
    process_wait(Pid, exit(0), []),
    split_string(Text, " ", " \n", Parts),
    subtract(Parts, [""], Packages).

%!  project_file(+Relative, -Absolute) is det.
%!  project_file(-Relative, +Absolute) is semidet.
%
%   Absolute is the file at Relative, seen from the root of the tree.

project_file(Relative, Absolute) :-
    nonvar(Relative),
    !,
    root(Root),
    directory_file_path(Root, Relative, Absolute).
project_file(Relative, Absolute) :-
    root(Root),
    atom_concat(Root, /, Start),
    atom_concat(Start, Relative, Absolute).

                /*******************************
                *           FIXTURES           *
                *******************************/

%!  with_tmp_dir(:Goal) is semidet.
%!  with_tmp_dir(-Dir, :Goal) is semidet.
%
%   Calls Goal(Dir), or Goal, once; the directory Dir is removed afterwards.

with_tmp_dir(Goal) :-
    with_tmp_dir(Dir, call(Goal, Dir)).

with_tmp_dir(Dir, Goal) :-
    setup_call_cleanup(
        make_tmp_dir(Dir),
        once(Goal),
        delete_directory_and_contents(Dir)).

%!  make_tmp_dir(-Dir) is det.
%
%   Dir is a new directory: a killed process may have left one of the name that
%   tmp_file/2 gives to another with its number.

make_tmp_dir(Dir) :-
    tmp_file(typhon_test, Dir0),
    (   exists_directory(Dir0)
    ->  make_tmp_dir(Dir)
    ;   make_directory_path(Dir0),
        Dir = Dir0
    ).

%!  shell_script(+File, +Line) is det.
%
%   File becomes a program: a shell script with Line.

shell_script(File, Line) :-
    write_file(File, "#!/bin/sh~n~s~n", [Line]),
    chmod(File, +x).

%!  with_settings(+Values, :Goal) is semidet.
%
%   Calls Goal once with settings changed, Values a list of Setting=Value.

with_settings(Values, Goal) :-
    maplist(setting_now, Values, Old),
    setup_call_cleanup(maplist(set, Values), once(Goal), maplist(set, Old)).

setting_now(Setting=_, Setting=Value) :-
    setting(Setting, Value).

set(Setting=Value) :-
    set_setting(Setting, Value).

%!  wait_until(:Goal, +Seconds) is det.
%
%   Waits for Goal to become true, by polling.  It sleeps in between: waits
%   for messages that are this short have been seen to spin for ever on a busy
%   machine.  On a slow machine the deadline is later, see slowness.pl.
%
%   @error timeout_error(wait_until, Goal)

wait_until(Goal, Seconds) :-
    get_time(Now),
    patience(Seconds, Longer),
    Deadline is Now+Longer,
    poll(Goal, 0.001, Deadline).

poll(Goal, _, _) :-
    call(Goal),
    !.
poll(Goal, Pause, Deadline) :-
    get_time(Now),
    (   Now < Deadline
    ->  sleep(Pause),
        Longer is min(0.05, 2*Pause),
        poll(Goal, Longer, Deadline)
    ;   throw(error(timeout_error(wait_until, Goal), _))
    ).

%!  elapsed(:Goal, -Seconds) is semidet.
%
%   As once(Goal), which takes Seconds.

elapsed(Goal, Seconds) :-
    get_time(T0),
    once(Goal),
    get_time(T1),
    Seconds is T1-T0.

%!  soon(+Seconds, +Most) is semidet.
%
%   Seconds are less than Most, on a slow machine than proportionally more.

soon(Seconds, Most) :-
    patience(Most, Longer),
    Seconds < Longer.

                /*******************************
                *             LEAKS            *
                *******************************/

%!  no_leaks(:Goal) is semidet.
%
%   Calls Goal once.  It must leave behind no thread, stream, message queue,
%   temporary module or child process; they have half a minute to go away.
%
%   @error leaked(Things) where Things are thread(Id), stream(S), queue(Q),
%   module(M) and process(Pid)

no_leaks(Goal) :-
    footprint(Before),
    once(Goal),
    catch(wait_until(leaked(Before, []), 30),
          error(timeout_error(wait_until, _), _),
          left_behind(Before)).

left_behind(Before) :-
    leaked(Before, Things),
    (   Things == []
    ->  true
    ;   throw(error(leaked(Things), _))
    ).

%   Unreferenced objects exist until they are collected.

leaked(Before, Things) :-
    garbage_collect_clauses,
    garbage_collect_atoms,
    footprint(After),
    ord_subtract(After, Before, New),
    include(is_own, New, Things).

%   Processes of others, too, come while a test runs.

is_own(process(Pid)) :-
    !,
    current_prolog_flag(pid, Me),
    parent(Pid, Me).
is_own(_).

footprint(Set) :-
    findall(Thing, thing(Thing), List),
    sort(List, Set).

thing(thread(Thread)) :-
    thread_property(Thread, status(_)),
    \+ system_thread(Thread).
thing(stream(Stream)) :-
    stream_property(Stream, mode(_)).
thing(queue(Queue)) :-
    message_queue_property(Queue, size(_)).
thing(module(Module)) :-
    module_property(Module, class(temporary)).
thing(process(Pid)) :-
    exists_directory('/proc/self'),
    directory_files('/proc', Entries),
    member(Entry, Entries),
    atom_number(Entry, Pid).

%   The process may have ended since it was found.

system_thread(Thread) :-
    catch(thread_property(Thread, alias(Alias)),
          error(existence_error(thread, _), _), fail),
    system_alias(Alias).

system_alias(gc).
system_alias('__thread_pool_manager').

parent(Pid, Parent) :-
    format(atom(File), '/proc/~d/stat', [Pid]),
    stat(File, _, Field),
    number_string(Parent, Field).

%   stat(+File, -State:string, -Parent:string) is semidet.

stat(File, State, Parent) :-
    catch(read_file_to_string(File, Text, []),
          error(_, _), fail),           % the process has ended
    % the name, in parentheses, may hold blanks and parentheses itself
    split_string(Text, ")", "", Parts),
    last(Parts, Rest),
    split_string(Rest, " ", " ", [State, Parent|_]).

%!  state_size(+Module, -Facts:integer) is det.
%
%   Facts is the number of facts in the dynamic predicates of Module.

state_size(Module, Facts) :-
    aggregate_all(sum(N),
                  ( predicate_property(Module:Head, dynamic),
                    \+ predicate_property(Module:Head, imported_from(_)),
                    functor(Head, Name, _),
                    \+ sub_atom(Name, 0, _, _, '$wrap$'), % of wrap_predicate/4
                    predicate_property(Module:Head, number_of_clauses(N)) ),
                  Facts).

                /*******************************
                *       SEPARATE PROCESSES     *
                *******************************/

%!  stop_process(+Pid) is det.
%
%   Pid is suspended when this succeeds: the signal takes effect in each
%   thread separately.

stop_process(Pid) :-
    process_kill(Pid, stop),
    format(atom(Threads), '/proc/~d/task/*/stat', [Pid]),
    wait_until(( expand_file_name(Threads, Files),
                 \+ ( member(File, Files), stat(File, State, _),
                      State \== "T" ) ), 30).

%!  is_dead(+Pid) is semidet.
%
%   The process has ended, whether or not it has been waited for.

is_dead(Pid) :-
    format(atom(File), '/proc/~d/stat', [Pid]),
    (   stat(File, State, _)
    ->  State == "Z"
    ;   true
    ).

%!  with_swipl(+Args, -Pid, -In, -Out, :Goal) is semidet.
%
%   Calls Goal once while a `swipl Args` of its own is running.  In is the
%   stream that writes to its standard input, Out reads its standard output.

%   However Goal ends, the process is dead afterwards; Goal itself may have
%   waited for its end.

with_swipl(Args, Pid, In, Out, Goal) :-
    setup_call_cleanup(
        start_swipl(Args, Pid, In, Out),
        once(Goal),
        end_swipl(Pid, In, Out)).

start_swipl(Args, Pid, In, Out) :-
    current_prolog_flag(executable, Swipl),
    process_create(Swipl, Args,
                   [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]).

end_swipl(Pid, In, Out) :-
    kill_swipl(Pid),
    close(In, [force(true)]),
    close(Out, [force(true)]).

kill_swipl(Pid) :-
    catch(process_wait(Pid, Status, [timeout(0)]), error(_, _), Status = gone),
    (   Status == timeout
    ->  process_kill(Pid, kill),
        process_wait(Pid, _, [])
    ;   true
    ).

%!  run_swipl(+Args, +Options, -Status, -Out, -Err) is det.
%
%   Runs `swipl Args` to its end with an empty standard input.  Status is as
%   of process_wait/2, or `timeout`: then it was killed.  Out and Err are the
%   strings it wrote.  Options: timeout(Seconds), default 60; others as of
%   process_create/3.

run_swipl(Args, Options0, Status, Out, Err) :-
    select_option(timeout(Seconds), Options0, Options, 60),
    with_tmp_dir(run_swipl_in(Args, Options, Seconds, Status, Out, Err)).

run_swipl_in(Args, Options, Seconds, Status, Out, Err, Dir) :-
    directory_file_path(Dir, out, OutFile),
    directory_file_path(Dir, err, ErrFile),
    setup_call_cleanup(
        ( open(OutFile, write, OutStream),
          open(ErrFile, write, ErrStream)
        ),
        run_process(Args, [ stdin(null),
                            stdout(stream(OutStream)),
                            stderr(stream(ErrStream))
                          | Options
                          ], Seconds, Status),
        ( close(OutStream),
          close(ErrStream)
        )),
    read_file_to_string(OutFile, Out, []),
    read_file_to_string(ErrFile, Err, []).

run_process(Args, Options, Seconds, Status) :-
    current_prolog_flag(executable, Swipl),
    setup_call_cleanup(
        process_create(Swipl, Args, [process(Pid)|Options]),
        wait_for_end(Pid, Seconds, Status),
        kill_swipl(Pid)).

%!  python(-Executable) is det.
%
%   The interpreter of the system, not another one earlier in PATH, which may be
%   a script that looks for one.

python('/usr/bin/python3') :-
    exists_file('/usr/bin/python3'),
    !.
python(path(python3)).

%!  wait_for_end(+Pid, +Seconds, -Status) is det.
%
%   Status is how the process ended, or `timeout`.  On Unix process_wait/3
%   knows only the timeouts 0 and infinite, hence the polling.

wait_for_end(Pid, Seconds, Status) :-
    catch(wait_until(ended(Pid, Status0), Seconds), % a status is had only once
          error(timeout_error(wait_until, _), _),
          Status0 = timeout),
    Status = Status0.

ended(Pid, Status) :-
    process_wait(Pid, Status, [timeout(0)]),
    Status \== timeout.

%!  free_port(-Port:integer) is det.
%
%   A port of the loopback interface that is free now, was not given out before,
%   and that the system gives only when asked for it: it draws the
%   ports of outgoing connections from a higher range. Processes that have drawn
%   the same seed begin at different ports, and test/run.pl gives each of the
%   suites that run at the same time ports of its own.

:- dynamic given/1.                     % Port: may be in use any time

free_port(Port) :-
    ports(First, Count),
    current_prolog_flag(pid, Pid),
    repeat,
    random_between(1, Count, Drawn),
    Port is First + (Drawn + 7919*Pid) mod Count,
    \+ given(Port),
    catch(try_port(Port), error(socket_error(_, _), _), fail),
    !,
    assertz(given(Port)).

ports(First, Count) :-
    getenv('TYPHON_PORTS', Text),
    !,
    term_to_atom(First+Count, Text).
ports(10000, 20000).

try_port(Port) :-
    tcp_socket(Socket),
    call_cleanup(( tcp_setopt(Socket, reuseaddr),
                   tcp_bind(Socket, '127.0.0.1':Port) ),
                 tcp_close_socket(Socket)).

                /*******************************
                *         PRIVATE COOKIE       *
                *******************************/

%   A process started by a test inherits the cookie of the test.

private_cookie :-
    getenv('TYPHON_COOKIE_FILE', _),
    !.
private_cookie :-
    make_tmp_dir(Dir),
    directory_file_path(Dir, cookie, File),
    unsetenv('TYPHON_COOKIE'),
    setenv('TYPHON_COOKIE_FILE', File),
    at_halt(delete_directory_and_contents(Dir)).

:- initialization(private_cookie).

:- multifile prolog:error_message//1.

prolog:error_message(leaked(Things)) -->
    [ 'Left behind: ~p'-[Things] ].
prolog:error_message(timeout_error(wait_until, Goal)) -->
    [ 'Waited in vain for ~p'-[Goal] ].
