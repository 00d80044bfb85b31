:- module(test_service, []).

% Processes as service managers, containers and scripts start them.

:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(plunit)).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).

:- begin_tests(service, [setup(command_cookie)]).

%   A process that is started with other descriptors than this one is run by sh.

test(runs_with_closed_streams_until_a_signal,
     [ forall(( member(Closed, ['<&-', '>&-', '2>&-', '<&- >&-', '<&- >&- 2>&-']),
                Signal = term ; member(Signal, [int, hup]),
                Closed = '<&- >&- 2>&-' )),
       true(Status-Files == exit(0)-[]) ]) :-
    served([], Closed, signals([Signal]), Status, Files).
test(second_signal_changes_nothing,
     [ forall(member(Signals, [[term,term], [hup,hup,term], [pipe,term]])),
       true(Status == exit(0)) ]) :-
    served([], '', signals(Signals), Status, _).
test(runs_with_few_descriptors, true(Status == exit(0))) :-
    served(['ulimit -n 64;'], '', signals([term]), Status, _).
test(runs_in_any_environment,
     [ forall(member(Setting, ['unset HOME;', 'HOME=/dev/null;', 'TZ=No/Such;',
                               'umask 077;', 'umask 0;', 'LC_ALL=C;',
                               'unset LANG LC_ALL;', 'LC_ALL=POSIX;',
                               'LC_ALL=no_SUCH;', 'cd /proc;'])),
       true(Status == exit(0)) ]) :-
    served([Setting, 'export HOME TZ LC_ALL;'], '', signals([int]), Status, _).
test(text_does_not_depend_on_the_locale,
     [ forall(member(Locale, ['C', 'POSIX', 'C.UTF-8'])),
       true(Line == "X=h\u00e9\u4e2d") ]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'place.pl', File),
          write_file(File, "p('h\u00e9\u4e2d').~n", []),
          free_port(Port),
          format(atom(Set), 'export LC_ALL=~w;', [Locale]),
          format(atom(At), '--port=~d --consult=~w', [Port, File]),
          command([Set], [host, here, At], '', Serve),
          process_create(path(sh), ['-c', Serve],
                         [stdin(null), stdout(null), process(Pid)]),
          format(atom(Host), 'here@127.0.0.1:~d', [Port]),
          call_cleanup(( wait_until(answers(Host), 60),
                         command([Set], [remote, Host, '"p(X)"'], '', Ask),
                         sh(Ask, exit(0), Line0, ""),
                         split_string(Line0, " ", "\n ", Parts),
                         atomic_list_concat(Parts, Line1),
                         atom_string(Line1, Line) ),
                       ended(Pid)) )).

test(host_that_does_not_stop_is_killed, true(Status == killed(9))) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'place.pl', File),
          write_file(File,
                     ":- predicate_property(typhon:host_stop(_), \c
                                            imported_from(M)), \c
                         wrap_predicate(M:host_stop(_), hangs, _, \c
                                        thread_get_message(never)).~n", []),
          format(atom(After), '--consult=~w --stop-seconds=1', [File]),
          served([], After, signals([term]), Status, _) )).

test(cookie_of_other_characters_is_refused,
     [ forall(member(Bytes, ['caf\\303\\251-and-much-more-text', 'caf\\351',
                             '\\320\\277\\320\\260\\321\\200\\320\\276'])) ]) :-
    forall(member(Locale, ['C', 'C.UTF-8']),
           ( format(atom(Set), 'export TYPHON_COOKIE=$(printf "~w") LC_ALL=~w;',
                    [Bytes, Locale]),
             refused(Set, "a cookie has ASCII characters only") )).
test(place_of_the_cookie_is_named_where_there_is_none,
     [ forall(member(Home, ['unset HOME', 'HOME=', 'HOME=/proc',
                            'HOME=/no/such/directory'])) ]) :-
    format(atom(Set), '~w; export HOME; unset TYPHON_COOKIE \c
                       TYPHON_COOKIE_FILE;', [Home]),
    refused(Set, "TYPHON_COOKIE_FILE or TYPHON_COOKIE").
test(commands_that_read_files_need_no_cookie, true(Status == exit(0))) :-
    with_tmp_dir(checked(Status)).
test(full_output_is_reported) :-
    refused('', '>/dev/full', "").
test(unit_sets_what_names_need) :-
    project_file('app/packaging/systemd/typhon@.service', Unit),
    read_file_to_string(Unit, Text, []),
    forall(member(Line, ["LANG=C.UTF-8", "KillSignal=SIGINT"]),
           assertion(sub_string(Text, _, _, _, Line))).

:- end_tests(service).

%   The cookie of this suite, given to the command line as a text.

command_cookie :-
    setenv('TYPHON_COOKIE', 'a-cookie-of-the-services').

%   command(+Before, +Arguments, +After, -Command): a line for sh.

command(Before0, Arguments, After, Command) :-
    atomic_list_concat(Before0, ' ', Before),
    current_prolog_flag(executable, Swipl),
    project_file('app/typhon.pl', App),
    atomic_list_concat(Arguments, ' ', Text),
    format(atom(Command), '~w exec ~w ~w ~w ~w',
           [Before, Swipl, App, Text, After]).

%   served(+Before, +After, +Signals, -Status, -Files): a host answers, gets
%   signals, and ends.  Files are what its descriptors 0 to 2 are, but for
%   those that were given to it and /dev/null.

served(Before, After, signals(Signals), Status, Files) :-
    free_port(Port),
    format(atom(Option), '--port=~d', [Port]),
    command(Before, [host, here, Option], After, Command),
    process_create(path(sh), ['-c', Command],
                   [stdin(null), stdout(null), stderr(null), process(Pid)]),
    format(atom(Host), 'here@127.0.0.1:~d', [Port]),
    call_cleanup(( wait_until(answers(Host), 60),
                   findall(File, ( between(0, 2, N), other_file(Pid, N, File) ),
                           Files),
                   forall(member(Signal, Signals), process_kill(Pid, Signal)),
                   last(Signals, Last),
                   ended_by(Last, Pid, Status) ),
                 ended(Pid)).

%   SWI-Prolog may lose a signal other than SIGINT, see doc/install.md.

ended_by(int, Pid, Status) :-
    !,
    wait_for_end(Pid, 60, Status).
ended_by(Signal, Pid, Status) :-
    wait_for_end(Pid, 20, Status0),
    (   Status0 == timeout
    ->  process_kill(Pid, Signal),
        wait_for_end(Pid, 60, Status)
    ;   Status = Status0
    ).

ended(Pid) :-
    catch(( process_kill(Pid, kill), process_wait(Pid, _) ),
          error(existence_error(process, _), _), true).

answers(Host) :-
    catch(remote(Host, true), error(_, _), fail).

other_file(Pid, N, File) :-
    format(atom(Link), '/proc/~d/fd/~d', [Pid, N]),
    (   read_link(Link, File, _)
    ->  File \== '/dev/null'
    ;   File = closed
    ).

checked(Status, Dir) :-
    directory_file_path(Dir, 'a.pl', File),
    write_file(File, ":- agent(a, []).~nmain :- leave(x).~n", []),
    command(['unset HOME TYPHON_COOKIE TYPHON_COOKIE_FILE;'], [check, File], '',
            Command),
    sh(Command, Status, _, _).

%   refused(+Before, +After, +Text): one line of error, with Text.

refused(Before, Text) :-
    refused(Before, '', Text).

refused(Before, After, Text) :-
    command([Before], [host, here], After, Command),
    sh(Command, Status, Out, Err),
    assertion(Status-Out == exit(1)-""),
    split_string(Err, "\n", "\n", Lines),
    assertion(Lines = [_]),
    assertion(Err \== ""),
    assertion(sub_string(Err, _, _, _, Text)).

sh(Command, Status, Out, Err) :-
    process_create(path(sh), ['-c', Command],
                   [ stdin(null), stdout(pipe(OutStream, [encoding(utf8)])),
                     stderr(pipe(ErrStream, [encoding(utf8)])), process(Pid) ]),
    call_cleanup(( read_string(OutStream, _, Out),
                   read_string(ErrStream, _, Err) ),
                 ( close(OutStream), close(ErrStream) )),
    process_wait(Pid, Status).
