:- module(test_brokers,
          [ broker_start/2,             % +Options, -Broker
            broker_stop/1,              % +Broker
            broker_restart/1,           % +Broker
            broker_signal/2,            % +Broker, +Signal
            broker_url/2,               % +Broker, -URL
            broker_log/2,               % +Broker, -Text
            with_broker/3,              % +Options, -Broker, :Goal
            with_mqtt/3,                % +Broker, +Options, :Goal
            client_publishes/3,         % +Broker, +Topic, +Args
            client_publishes_numbers/4, % +Broker, +Topic, +N, -Pid
            client_receives/4           % +Broker, +Args, :Goal, -Lines
          ]).

/** <module> MQTT brokers for tests, and clients of other programs

A broker is a real mosquitto at its own port. Other clients are mosquitto_pub
and mosquitto_sub.

*Threading*: one test at a time.
*/

:- use_module(common).
:- use_module(fixtures).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(socket),
              [tcp_close_socket/1, tcp_connect/2, tcp_socket/1]).
:- use_module(library(typhon)).

:- meta_predicate
    with_broker(+, -, 0),
    with_mqtt(+, +, 0),
    client_receives(+, +, 0, -).

:- dynamic running/2.                   % Port, Pid

%!  broker_start(+Options, -Broker) is det.
%!  broker_stop(+Broker) is det.
%!  broker_restart(+Broker) is det.
%!  broker_signal(+Broker, +Signal) is det.
%
%   Options are lines of its configuration; `anonymous(false)` omits the line
%   that admits anonymous clients.  One that was stopped by broker_signal/2
%   and `term` can be started again, at its port.

broker_start(Options, broker(Port, Dir)) :-
    make_tmp_dir(Dir),
    free_port(Port),
    directory_file_path(Dir, conf, Conf),
    setup_call_cleanup(
        open(Conf, write, Out),
        configure(Out, Port, Dir, Options),
        close(Out)),
    broker_restart(broker(Port, Dir)).

configure(Out, Port, Dir, Options) :-
    format(Out, 'listener ~d 127.0.0.1~n', [Port]),
    format(Out, 'log_dest file ~w/log~nlog_type all~n', [Dir]),
    format(Out, 'user root~nmax_queued_messages 100000~n', []),
    (   memberchk(anonymous(false), Options)
    ->  true
    ;   format(Out, 'allow_anonymous true~n', [])
    ),
    forall(( member(Line, Options), atom(Line) ),
           ( atomic_list_concat(Parts, '$DIR', Line),
             atomic_list_concat(Parts, Dir, Text),
             format(Out, '~w~n', [Text]) )).

broker_restart(broker(Port, Dir)) :-
    directory_file_path(Dir, conf, Conf),
    process_create('/usr/sbin/mosquitto', ['-c', Conf],
                   [stdin(null), stderr(null), process(Pid)]),
    assertz(running(Port, Pid)),
    wait_until(listens(Port), 10).

listens(Port) :-
    tcp_socket(Socket),
    catch(call_cleanup(tcp_connect(Socket, '127.0.0.1':Port),
                       tcp_close_socket(Socket)),
          error(_, _), fail).

broker_stop(broker(Port, Dir)) :-
    forall(retract(running(Port, Pid)), end(Pid, kill)),
    delete_directory_and_contents(Dir).

%   A signal is lost while mosquitto starts.

end(Pid, Signal) :-
    process_kill(Pid, Signal),
    wait_for_end(Pid, 5, Status),
    (   Status == timeout
    ->  end(Pid, Signal)
    ;   true
    ).

broker_signal(broker(Port, _), term) :-
    !,
    retract(running(Port, Pid)),
    end(Pid, term).
broker_signal(broker(Port, _), Signal) :-
    running(Port, Pid),
    process_kill(Pid, Signal).

%!  broker_url(+Broker, -URL) is det.
%!  broker_log(+Broker, -Text) is det.

broker_url(broker(Port, _), URL) :-
    format(atom(URL), 'mqtt://127.0.0.1:~d', [Port]).

broker_log(broker(_, Dir), Text) :-
    directory_file_path(Dir, log, File),
    read_file_to_string(File, Text, []).

%!  with_broker(+Options, -Broker, :Goal) is semidet.
%!  with_mqtt(+Broker, +Options, :Goal) is semidet.
%
%   Calls Goal once with a broker; with a host alpha that has it.

with_broker(Options, Broker, Goal) :-
    no_leaks(setup_call_cleanup(
                 broker_start(Options, Broker),
                 once(Goal),
                 broker_stop(Broker))).

with_mqtt(Broker, Options, Goal) :-
    broker_url(Broker, URL),
    capturing(setup_call_cleanup(
                  host_start(alpha),
                  ( mqtt_start(alpha, URL, Options),
                    once(Goal) ),
                  host_stop(alpha)), _).

%!  client_publishes(+Broker, +Topic, +Args) is det.
%!  client_publishes_numbers(+Broker, +Topic, +N, -Pid) is det.
%!  client_receives(+Broker, +Args, :Goal, -Lines) is semidet.
%
%   mosquitto_pub and mosquitto_sub; Goal is called when the latter has
%   subscribed, and Lines are what it prints until it ends.  Process Pid
%   publishes the numbers from 1 to N with QoS 1, as fast as it can.

client_publishes(broker(Port, _), Topic, Args) :-
    process_create(path(mosquitto_pub),
                   ['-p', Port, '-t', Topic|Args],
                   [stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)).

client_publishes_numbers(broker(Port, Dir), Topic, N, Pid) :-
    directory_file_path(Dir, numbers, File),
    setup_call_cleanup(
        open(File, write, Out),
        forall(between(1, N, I), format(Out, '~d~n', [I])),
        close(Out)),
    format(atom(Command), 'exec mosquitto_pub -p ~d -t ~w -q 1 -l < ~w',
           [Port, Topic, File]),
    process_create('/bin/sh', ['-c', Command],
                   [stderr(null), process(Pid)]).

client_receives(Broker, Args, Goal, Lines) :-
    Broker = broker(Port, _),
    flag(typhon_client, N, N+1),
    format(atom(Name), 'client~d', [N]),
    append(['-p', Port, '-W', 20, '-i', Name], Args, All),
    setup_call_cleanup(
        process_create(path(mosquitto_sub), All,
                       [stdout(pipe(Out)), stderr(null), process(Pid)]),
        ( wait_until(subscribed(Broker, Name), 10),
          once(Goal),
          read_string(Out, _, Text) ),
        ( close(Out), end(Pid, kill) )),
    split_string(Text, "\n", "", Lines0),
    append(Lines, [""], Lines0).

subscribed(Broker, Name) :-
    broker_log(Broker, Text),
    format(string(Line), "Sending SUBACK to ~w", [Name]),
    sub_string(Text, _, _, _, Line),
    !.
