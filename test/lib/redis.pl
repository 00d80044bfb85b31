:- module(test_redis,
          [ with_redis/2,               % -Redis, :Goal
            with_redis/3,               % +Options, -Redis, :Goal
            with_sentinel/3,            % +Port, -Address, :Goal
            redis_address/2,            % +Redis, -Address
            redis_signal/2,             % +Redis, +Signal
            redis_restart/1,            % +Redis
            redis_empty/1,              % +Redis
            redis_line/3,               % +Redis, +Command, -Lines
            lease_lapses/2,             % +Redis, +Host
            journal_lapses/2,           % +Redis, +Host
            with_fleet/4,               % +Options, -Redis, +Specs, :Goal
            member_spec/5               % +Redis, +Name, +Joins, +Host, -Spec
          ]).

/** <module> Servers of Redis for suites

Each has its data in a temporary directory, and confirms what is on the disk.

*Threading*: one test at a time.
*/

:- use_module(common).
:- use_module(slowness, [patience/2]).
:- use_module(texts, [write_file/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_stream_to_codes/2]).
:- use_module(library(settings), [current_setting/1, set_setting/2]).
:- use_module(library(socket),
              [tcp_close_socket/1, tcp_connect/2, tcp_socket/1]).
:- use_module(library(typhon)).

:- meta_predicate
    with_redis(-, 0),
    with_redis(+, -, 0),
    with_sentinel(+, -, 0),
    with_fleet(+, -, +, 0).

:- dynamic running/2.           % Port, Pid

%!  with_redis(-Redis, :Goal) is semidet.
%!  with_redis(+Options, -Redis, :Goal) is semidet.
%
%   As once(Goal), while Redis runs.  Options are arguments of its command line.

with_redis(Redis, Goal) :-
    with_redis([], Redis, Goal).

with_redis(Options, Redis, Goal) :-
    with_tmp_dir(Dir, with_redis_in(Dir, Options, Redis, Goal)).

:- public with_redis_in/4.

:- meta_predicate with_redis_in(+, +, ?, 0).

with_redis_in(Dir, Options, redis(Port, Dir, Options), Goal) :-
    free_port(Port),
    setup_call_cleanup(redis_restart(redis(Port, Dir, Options)),
                       once(Goal),
                       stop(Port)).

%!  with_sentinel(+Port, -Address, :Goal) is semidet.
%
%   As once(Goal), while a sentinel at Address watches the server at Port, as
%   `lab`.  A master that is silent for a second is replaced.

with_sentinel(Master, Address, Goal) :-
    with_tmp_dir(Dir, sentinel_in(Dir, Master, Address, Goal)).

:- public sentinel_in/4.

:- meta_predicate sentinel_in(+, +, -, 0).

sentinel_in(Dir, Master, '127.0.0.1':Port, Goal) :-
    free_port(Port),
    directory_file_path(Dir, 'sentinel.conf', File),
    write_file(File,
               'bind 127.0.0.1~nport ~d~ndir ~w~n\c
                sentinel monitor lab 127.0.0.1 ~d 1~n\c
                sentinel down-after-milliseconds lab 1000~n\c
                sentinel failover-timeout lab 10000~n', [Port,Dir,Master]),
    setup_call_cleanup(launch(Port, [File,'--sentinel']),
                       once(Goal),
                       stop(Port)).

%!  redis_restart(+Redis) is det.
%!  redis_signal(+Redis, +Signal) is det.
%
%   Start Redis again, at its port; send it Signal, and wait for its end where
%   that ends it. Of a suspended engine an answer is not waited for as long as on
%   a busy machine.

redis_restart(redis(Port, Dir, Options)) :-
    append(['--port', Port, '--bind', '127.0.0.1', '--dir', Dir, '--save', '',
            '--appendonly', yes, '--appendfsync', always],
           Options, Args),
    directory_file_path(Dir, 'redis.log', Log),
    launch(Port, ['--logfile', Log|Args]).

%   A process that is not detached gets SIGTERM when the thread that started it
%   ends.

launch(Port, Args) :-
    process_create(path('redis-server'), Args,
                   [ stdin(null), stdout(null), stderr(null), process(Pid),
                     detached(true) ]),
    assertz(running(Port, Pid)),
    wait_until(listens(Port), 10).

listens(Port) :-
    tcp_socket(Socket),
    catch(call_cleanup(tcp_connect(Socket, '127.0.0.1':Port),
                       tcp_close_socket(Socket)),
          error(_, _), fail).

redis_signal(redis(Port, _, _), Signal) :-
    running(Port, Pid),
    process_kill(Pid, Signal),
    (   ( Signal == kill ; Signal == term )
    ->  process_wait(Pid, _),
        retractall(running(Port, _))
    ;   Signal == stop
    ->  engine_waits(2)
    ;   patience(2, Seconds),
        engine_waits(Seconds)
    ).

engine_waits(Seconds) :-
    (   current_setting(typhon_fleet:engine_seconds)
    ->  set_setting(typhon_fleet:engine_seconds, Seconds)
    ;   true
    ).

stop(Port) :-
    (   retract(running(Port, Pid))
    ->  process_kill(Pid, kill),
        process_wait(Pid, _)
    ;   true
    ).

%!  redis_address(+Redis, -Address) is det.

redis_address(redis(Port, _, _), '127.0.0.1':Port).

%!  redis_empty(+Redis) is det.
%
%   It loses all that it has.

redis_empty(Redis) :-
    redis_line(Redis, [flushall], _).

%!  redis_line(+Redis, +Command:list, -Lines) is det.
%
%   What redis-cli prints for Command.

redis_line(redis(Port, _, _), Command, Lines) :-
    process_create(path('redis-cli'), ['-p', Port|Command],
                   [stdout(pipe(Out)), process(Pid)]),
    read_stream_to_codes(Out, Codes),
    close(Out),
    process_wait(Pid, exit(0)),
    split_string(Codes, "\n", "\r", Lines0),
    append(Lines, [""], Lines0).

%!  lease_lapses(+Redis, +Host) is det.
%!  journal_lapses(+Redis, +Host) is det.
%
%   A process with Host, which does not run, loses its lease; another one may then
%   open its journal. This process, a member, notices each.

lease_lapses(Redis, Host) :-
    atomic_list_concat([_,E], @, Host),
    redis_line(Redis, [zadd,'f:{lab}:lease',xx,0,E], _),
    redis_line(Redis, [set,'f:{lab}:grace',0], _),
    % the next look at others is a twentieth of a lease later
    wait_until(( redis_line(Redis, [decrby,'f:{lab}:last',4000], _),
                 typhon_members:fleet_told(lab),
                 redis_line(Redis, [zscore,'f:{lab}:gone',E], [Since]),
                 Since \== "" ), 30).

journal_lapses(Redis, Host) :-
    atomic_list_concat([_,E], @, Host),
    atom_concat('f:{lab}:p:', E, Process),
    redis_line(Redis, [hget,Process,journal], [Journal]),
    atomic_list_concat(['f:{lab}:j:',Journal,':lease'], Lease),
    redis_line(Redis, [del,Lease], _),
    redis_line(Redis, [zadd,'f:{lab}:orphans',xx,0,E], _),
    typhon_members:fleet_told(lab).

%!  with_fleet(+Options, -Redis, +Specs, :Goal) is semidet.
%
%   As once(Goal), in a member of the fleet `lab`, which joined it with Options,
%   with the hosts of Specs, Name-Tags.  Nothing may be left afterwards.  Unless
%   Options say it no lease lapses where a busy machine stops a process for a while.

with_fleet(Options, Redis, Specs, Goal) :-
    no_leaks(with_redis(Redis, as_member(Options, Redis, Specs, Goal))).

:- meta_predicate as_member(+, +, +, 0).

as_member(Options, Redis, Specs, Goal) :-
    redis_address(Redis, Address),
    setup_call_cleanup(
        ( lasting(Options, Joins),
          fleet_join(lab, [redis(Address)|Joins]) ),
        ( forall(member(Name-Tags, Specs),
                 host_start(Name, [fleet(lab), tags(Tags)])),
          once(Goal) ),
        ( forall(typhon_host:host(Host, _, _), host_stop(Host)),
          catch(fleet_leave(lab), error(existence_error(_, _), _), true) )).

%!  member_spec(+Redis, +Name, +Joins, +Host, -Spec) is det.
%
%   Spec is that of with_peers/2 for a process that joins `lab` with the options
%   Joins; its host has the options Host.

member_spec(Redis, Name, Joins0, Host,
            Name-[ setup(fleet_join(lab, [redis(Address)|Joins])),
                   host([fleet(lab)|Host]) ]) :-
    redis_address(Redis, Address),
    lasting(Joins0, Joins).

lasting(Joins0, Joins) :-
    (   memberchk(lease(_), Joins0)
    ->  Joins = Joins0
    ;   Joins = [lease(60)|Joins0]
    ).
