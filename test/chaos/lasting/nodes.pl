:- module(lasting_nodes,
          [ with_nodes/4,               % +Options, -Nodes, :Goal, -Told
            node_host/2,                % ?Node, ?Host
            nodes_said/2,               % +Nodes, -Lines
            nodes_check/1,              % +Nodes
            faults_begin/1,             % +Options
            faults_end/0
          ]).

/** <module> Processes with journals, and their faults

Each is restarted when it dies. While faults are on they kill themselves at
the steps of the journal, the power fails, and from time to time one of them
has a fault: it is killed, or all are; it is suspended for a while; its
connections break; its disk is full. Journals may be in the engine of a fleet,
which is killed, suspended or emptied then, or opens a journal for another
process while the one that has it is suspended.

*Threading*: a thread supervises each process, and another one causes faults;
the rest is for one thread.
*/

:- use_module(power, [power_cut/1]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(random), [random/3, random_between/3, random_member/2]).
:- use_module(library(readutil), [read_file_to_string/3, read_line_to_string/2]).
:- use_module('../../../prolog/typhon/kernel/base/prolog_faults', [spawn/3]).
:- use_module('../../lib/common', [free_port/1, wait_until/2]).
:- use_module('../../lib/redis',
              [redis_empty/1, redis_line/3, redis_restart/1, redis_signal/2]).

:- meta_predicate with_nodes(+, -, 0, -).

:- prolog_load_context(directory, Dir),
   directory_file_path(Dir, 'node.pl', File),
   assertz(node_file(File)).

:- dynamic
    node_file/1,
    child/3,                            % Name, Pid, In
    ready/1,                            % Pid: its host has started
    orders/1,                           % the first orders of a child
    engine/1,                           % Redis: has the journals
    calm/0,                             % processes that end are not started again
    guard/1,                            % Thread
    fault_thread/1,                     % Thread
    most/1,                             % faults that are allowed
    happened/2.                         % What, Times

%!  with_nodes(+Options, -Nodes, :Goal, -Told) is semidet.
%
%   Call Goal while processes run as in Options; Told are What-Times for all
%   their faults.

with_nodes(Options, Nodes, Goal, Told) :-
    option(processes(Count), Options, 3),
    numlist(1, Count, Numbers),
    maplist(node(Options), Numbers, Nodes),
    retractall(calm),
    retractall(happened(_, _)),
    retractall(most(_)),
    retractall(orders(_)),
    assertz(orders([])),
    retractall(engine(_)),
    forall(option(engine(Redis), Options), assertz(engine(Redis))),
    setup_call_cleanup(
        maplist(watch_over, Nodes),
        once(Goal),
        end_all),
    findall(What-Times, happened(What, Times), Told).

node(Options, Number, node(Name, Port, Journal, Sync, Swipl)) :-
    option(dir(Dir), Options, _),
    option(sync(Sync), Options, normal),
    current_prolog_flag(executable, This),
    option(swipl(Swipl), Options, This),
    atom_concat(h, Number, Name),
    free_port(Port),
    directory_file_path(Dir, Name, Journal).

%!  nodes_said(+Nodes, -Lines:list(string)) is det.
%
%   The output of the processes.

nodes_said(Nodes, Lines) :-
    findall(Line,
            ( member(node(Name, _, Journal, _, _), Nodes),
              atom_concat(Journal, '.err', File),
              exists_file(File),
              read_file_to_string(File, Text, []),
              split_string(Text, "\n", "", Texts),
              member(One, Texts),
              format(string(Line), '~w: ~w', [Name, One]) ),
            Lines).

%!  node_host(?Node, ?Host) is det.

node_host(node(Name, Port, _, _, _), Host) :-
    format(atom(Host), '~w@127.0.0.1:~d', [Name, Port]).

end_all :-
    faults_end,
    assertz(calm),
    forall(child(_, Pid, _), signalled(Pid, kill)),
    forall(retract(guard(Guard)), thread_join(Guard, _)).

%   The process may have died just now.

signalled(Pid, Signal) :-
    catch(process_kill(Pid, Signal), error(existence_error(process, _), _),
          true).

count(What) :-
    with_mutex(lasting,
               ( ( retract(happened(What, N0)) -> true ; N0 = 0 ),
                 N is N0+1,
                 assertz(happened(What, N)) )),
    (   enough
    ->  disarm
    ;   true
    ).

%   On a slow machine processes would die before anything is done.

enough :-
    most(Most),
    with_mutex(lasting, aggregate_all(sum(N), happened(_, N), Sum)),
    Sum >= Most.

                /*******************************
                *           PROCESSES          *
                *******************************/

watch_over(Node) :-
    thread_self(Me),
    thread_create(guard(Node, Me), Guard),
    assertz(guard(Guard)),
    thread_get_message(ready(Node)).

%   Errors of the thread that supervises a process must be printed.

guard(Node, Asker) :-
    catch(keep(Node, Asker), Ball, true),
    (   var(Ball)
    ->  true
    ;   print_message(error, Ball),
        count(unguarded)
    ).

keep(Node, Asker) :-
    Node = node(Name, _, Journal, _, _),
    atom_concat(Journal, '.err', Said),
    start(Node, Pid, In, Out, Err),
    read_line_to_string(Out, Line),
    (   Line == "ready"
    ->  assertz(ready(Pid)),
        ( nonvar(Asker) -> thread_send_message(Asker, ready(Node)) ; true )
    ;   true
    ),
    setup_call_cleanup(
        open(Said, append, Copy),
        copy_stream_data(Err, Copy),    % until it ends
        close(Copy)),
    process_wait(Pid, Status),
    retractall(child(Name, _, _)),
    retractall(ready(Pid)),
    close(In, [force(true)]),
    close(Out, [force(true)]),
    close(Err, [force(true)]),
    (   calm
    ->  true
    ;   died(Status, Said),
        ( \+ engine(_), power_cut(Journal) -> count(power_cut) ; true ),
        keep(Node, _)
    ).

died(killed(9), _) :-
    !,
    count(death).
died(Status, Said) :-
    read_file_to_string(Said, Text, []),
    format(user_error, 'ended by itself: ~p~n~w~n', [Status, Text]),
    count(ended(Status)).

%   A process that exceeds its file size limit gets an error, and is not
%   killed.

start(node(Name, Port, Dir, Sync, Swipl), Pid, In, Out, Err) :-
    node_file(File),
    random_between(1, 1000000, Seed),
    ( engine(redis(Engine, _, _)) -> true ; Engine = none ),
    spawn(path(sh),
          [ '-c', 'trap "" XFSZ; exec "$@"', sh, Swipl, File, '--',
            Name, Port, Dir, Sync, Seed, Engine ],
          [ stdin(pipe(In)), stdout(pipe(Out)), stderr(pipe(Err)),
            process(Pid) ]),
    with_mutex(lasting_orders,
               ( orders(Orders),
                 assertz(child(Name, Pid, In)),
                 send_order(In, orders(Orders)) )).

send_order(In, Term) :-
    catch(( format(In, '~q.~n', [Term]), flush_output(In) ),
          error(_, _),
          true).                        % the process died just now

                /*******************************
                *            FAULTS            *
                *******************************/

%!  faults_begin(+Options) is det.
%!  faults_end is det.
%
%   Options: crash(P), power(P), kill(Seconds) between faults from outside;
%   faults(List), their kinds; most(N): no more faults after N; slow(Seconds)
%   that each commit takes more.

faults_begin(Options) :-
    option(crash(P), Options, 0.001),
    (   option(sync(full), Options)     % nothing else survives that
    ->  option(power(W), Options, 0)
    ;   W = 0
    ),
    option(kill(Seconds), Options, inf),
    option(most(Most), Options, inf),
    assertz(most(Most)),
    option(slow(Slow), Options, 0),
    tell_all([dies(P), power(W), slow(Slow)]),
    (   Seconds == inf
    ->  true
    ;   option(faults(Faults), Options,
               [kill, kill, kill_all, stop, cut, full]),
        thread_create(causes_faults(Seconds, Faults), Thread),
        assertz(fault_thread(Thread))
    ).

faults_end :-
    (   retract(fault_thread(Thread))
    ->  thread_send_message(Thread, faults_end),
        thread_join(Thread, _)
    ;   true
    ),
    disarm.

disarm :-
    tell_all([dies(0), power(0), slow(0)]).

%!  nodes_check(+Nodes) is det.
%
%   The processes print their pending data; returns when they have done so, if
%   they can.

nodes_check(Nodes) :-
    with_mutex(lasting_orders, forall(child(_, _, In), send_order(In, look))),
    catch(wait_until(\+ ( member(Node, Nodes), \+ looked(Node) ), 10),
          error(timeout_error(_, _), _), true).

looked(Node) :-
    nodes_said([Node], Lines),
    member(Line, Lines),
    sub_string(Line, _, _, 0, ": looked"),
    !.

tell_all(Orders) :-
    with_mutex(lasting_orders,
               ( retractall(orders(_)),
                 assertz(orders(Orders)),
                 forall(( child(_, _, In), member(Order, Orders) ),
                        send_order(In, Order)) )).

%   If the thread ended by an error an engine might stay killed.

causes_faults(Seconds, Faults) :-
    catch(make_faults(Seconds, Faults), Ball, true),
    (   var(Ball)
    ->  true
    ;   print_message(error, Ball),
        count(no_more_faults)
    ).

make_faults(Seconds, Faults) :-
    Longest is 2*Seconds,
    random(0.0, Longest, Pause),
    (   peace_within(Pause)
    ->  true
    ;   enough
    ->  thread_self(Me),
        thread_get_message(Me, faults_end)
    ;   findall(Pid-In, child(_, Pid, In), Children),
        ignore(( random_member(Child, Children),
                 random_member(What, Faults),
                 count(What),
                 happens(What, Child) )),
        make_faults(Seconds, Faults)
    ).

peace_within(Seconds) :-
    thread_self(Me),
    thread_get_message(Me, faults_end, [timeout(Seconds)]).

happens(kill, Pid-_) :-
    signalled(Pid, kill).
happens(kill_all, _) :-
    forall(child(_, Pid, _), signalled(Pid, kill)).
happens(stop, Pid-_) :-
    signalled(Pid, stop),
    for_a_while,
    signalled(Pid, cont).
happens(cut, _-In) :-
    with_mutex(lasting_orders, send_order(In, cut)).
happens(rest, Pid-In) :-
    ready(Pid),
    !,
    with_mutex(lasting_orders, send_order(In, rest)).
happens(rest, _).
happens(full, Pid-_) :-
    ready(Pid),                         % a process that is starting would end
    !,
    longest_file(Pid, 1),
    for_a_while,
    longest_file(Pid, unlimited).
happens(full, _).
happens(engine_kill, _) :-
    engine(Redis),
    redis_signal(Redis, kill),
    for_a_while,
    redis_restart(Redis).
happens(engine_stop, _) :-
    engine(Redis),
    redis_signal(Redis, stop),
    for_a_while(6.0),
    redis_signal(Redis, cont).
happens(engine_empty, _) :-
    engine(Redis),
    redis_empty(Redis).
happens(usurp, Pid-_) :-
    ready(Pid),
    !,
    engine(Redis),
    child(Name, Pid, _),
    signalled(Pid, stop),
    usurped(Redis, Name),
    signalled(Pid, cont).
happens(usurp, _).

%   Another process opens the journal, and closes it without a change.

usurped(Redis, Name) :-
    atomic_list_concat(['f:{lab}:j:', Name, ':owner'], Key),
    redis_line(Redis, [get, Key], [Owner]),
    split_string(Owner, " ", "", [Epoch0|_]),
    number_string(Epoch, Epoch0),
    Later is Epoch+1,
    format(atom(Other), '~d ', [Later]),
    redis_line(Redis, [set, Key, Other], _),
    for_a_while.

for_a_while :-
    for_a_while(2.0).

for_a_while(Most) :-
    random(0.1, Most, Seconds),
    (   peace_within(Seconds)
    ->  thread_self(Me),
        thread_send_message(Me, faults_end)
    ;   true
    ).

longest_file(Pid, Bytes) :-
    format(atom(File), '--fsize=~w:unlimited', [Bytes]),
    spawn(path(prlimit), ['--pid', Pid, File],
          [stderr(null), process(P)]),
    process_wait(P, _).
