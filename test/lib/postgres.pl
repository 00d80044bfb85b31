:- module(test_postgres,
          [ postgres_start/0,
            postgres_stop/0,
            postgres_crash/0,
            postgres_restart/0,
            postgres_url/2,             % +Schema, -Url
            postgres_cut/1,             % +Schema
            with_postgres_relay/3,      % +Schema, -Url, :Goal
            postgres_relay/1            % +Order
          ]).

/** <module> A PostgreSQL server for a suite

It has its data in a temporary directory, and listens at a socket there.

*Threading*: the main thread.
*/

:- use_module(common, [make_tmp_dir/1]).
:- use_module(vanishing_relay,
              [vanishing_order/2, vanishing_start/3, vanishing_stop/1]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [append/3, last/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

:- meta_predicate with_postgres_relay(+, -, 0).

:- dynamic
    running/3,                          % Dir, Pid, Err
    crashed/1,                          % Dir
    relay/1.                            % Relay

%!  postgres_start is det.
%!  postgres_stop is det.
%!  postgres_url(+Schema, -Url) is det.
%
%   Start the server; stop it and remove its files; the URL of a schema there.

postgres_start :-
    make_tmp_dir(Dir),
    owned(Dir),
    run(initdb, ['-D', Dir, '-U', typhon, '-A', trust, '-N', '-E', 'UTF8',
                 '--locale=C']),
    start(Dir, Pid, Err),
    assertz(running(Dir, Pid, Err)).

postgres_stop :-
    retract(running(Dir, Pid, Err)),
    process_kill(Pid, int),
    process_wait(Pid, _),
    close(Err),
    delete_directory_and_contents(Dir).

%!  postgres_crash is det.
%!  postgres_restart is det.
%
%   Stop it at once, as `pg_ctl stop -m immediate`; restart it.

postgres_crash :-
    retract(running(Dir, Pid, Err)),
    process_kill(Pid, quit),
    process_wait(Pid, _),
    close(Err),
    assertz(crashed(Dir)).

postgres_restart :-
    retract(crashed(Dir)),
    start(Dir, Pid, Err),
    assertz(running(Dir, Pid, Err)).

start(Data, Pid, Err) :-
    command(postgres, ['-D', Data, '-k', Data, '-h', '', '-F'], File, Args),
    process_create(File, Args,
                   [stdin(null), stdout(null), stderr(pipe(Err)), process(Pid)]),
    repeat,
    read_line_to_string(Err, Line),
    (   Line == end_of_file
    ->  throw(error(system_error(no_postgres), _))
    ;   sub_string(Line, _, _, _, "ready to accept")
    ),
    !.

postgres_url(Schema, Url) :-
    running(Dir, _, _),
    format(atom(Url), 'postgresql://typhon@/postgres?host=~w&schema=~w',
           [Dir, Schema]).

%!  postgres_cut(+Schema) is det.
%
%   The server ends all connections with the journal.

postgres_cut(Schema) :-
    running(Dir, _, _),
    format(atom(Sql),
           'select pg_terminate_backend(pid) from pg_locks \c
            where locktype=\'advisory\' and \c
            objid::bigint=(hashtext(\'~w\')::bigint & 4294967295)',
           [Schema]),
    run(psql, ['-q', '-h', Dir, '-U', typhon, '-c', Sql, postgres]).

                /*******************************
                *            RELAY             *
                *******************************/

%!  with_postgres_relay(+Schema, -Url, :Goal) is semidet.
%!  postgres_relay(+Order) is det.
%
%   Calls Goal once while the schema is reachable at Url, too, on a simulated
%   machine that can `vanish` and `return`, or whose connections `break`:
%   these are Orders.

with_postgres_relay(Schema, Url, Goal) :-
    running(Dir, _, _),
    directory_file_path(Dir, '.s.PGSQL.5432', Socket),
    setup_call_cleanup(relay_start(Socket, Relay, Port),
                       ( relay_url(Port, Schema, Url), once(Goal) ),
                       relay_stop(Relay)).

relay_start(Socket, Relay, Port) :-
    vanishing_start(Socket, Relay, Port),
    assertz(relay(Relay)).

relay_stop(Relay) :-
    retractall(relay(Relay)),
    vanishing_stop(Relay).

relay_url(Port, Schema, Url) :-
    format(atom(Url), 'postgresql://typhon@127.0.0.1:~d/postgres?schema=~w',
           [Port, Schema]).

postgres_relay(Order) :-
    relay(Relay),
    vanishing_order(Relay, Order).

                /*******************************
                *           PROGRAMS           *
                *******************************/

%   PostgreSQL refuses to run as root.

command(Name, Args0, File, Args) :-
    program(Name, Program),
    (   root
    ->  File = path(setpriv),
        append([ '--reuid=nobody', '--regid=nogroup', '--clear-groups',
                 Program ], Args0, Args)
    ;   File = Program,
        Args = Args0
    ).

run(Name, Args0) :-
    command(Name, Args0, File, Args),
    process_create(File, Args,
                   [stdin(null), stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)).

program(Name, Program) :-
    expand_file_name('/usr/lib/postgresql/*/bin', Dirs),
    last(Dirs, Dir),
    directory_file_path(Dir, Name, Program).

owned(Dir) :-
    (   root
    ->  process_create(path(chown), ['nobody:nogroup', Dir], [process(Pid)]),
        process_wait(Pid, exit(0))
    ;   true
    ).

root :-
    setup_call_cleanup(
        process_create(path(id), ['-u'], [stdout(pipe(Out)), process(Pid)]),
        read_line_to_string(Out, User),
        ( close(Out), process_wait(Pid, _) )),
    User == "0".
