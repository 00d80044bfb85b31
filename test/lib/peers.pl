:- module(test_peers,
          [ with_peers/2,               % +Specs, :Goal
            peer_restart/1,             % +Peer
            peer_do/2,                  % +Peer, ?Goal
            peer_try/3,                 % +Peer, ?Goal, -Outcome
            peer_agent/4,               % +Peer, +Clauses, +Facts, -Id
            peer_proxy/2,               % +Peer, -Proxy
            peer_signal/2,              % +Peer, +Signal
            peer_pid/2,                 % ?Peer, -Pid
            peer_kill/1,                % +Peer
            peer_ends/2,                % +Peer, -Status
            peer_crash/1,               % +Peer
            peer_host/2,                % +Peer, -Address
            peer_messages/2             % +Peer, -Lines
          ]).

/** <module> Processes with hosts in them, for tests

A peer is another Prolog process, known by an atom, that carries out goals. It
communicates with the test through pipes, so that tests can disturb its
endpoint.

*Threading*: for the main thread of a test, but for peer_crash/1.
*/

:- use_module(common, [ free_port/1, is_dead/1, project_file/2, python/1,
                         stop_process/1, wait_for_end/3, wait_until/2 ]).
:- use_module(cutting_proxy, [proxy_start/3, proxy_stop/1]).
:- use_module(frame_proxy, [frame_proxy_start/4, frame_proxy_stop/1]).
:- use_module(relay, [relay_admit/1, relay_refuse/1]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- meta_predicate with_peers(+, 0).

:- dynamic
    spec/2,                             % Peer, Args
    peer/4,                             % Peer, Pid, In, Out
    host/3,                             % Peer, Address, Options
    proxy/2,                            % Peer, Proxy
    frame_proxy/2,                      % Peer, Proxy
    messages/2.                         % Peer, File

%!  with_peers(+Specs, :Goal) is semidet.
%
%   Run Goal once with processes. A spec is a name or Name-Options, where
%   Options are: host(Options) for the host that has the name of the peer;
%   proxy(true) or proxy(frames): others reach it through a cutting proxy, or
%   through one that knows frames; codec(text); setup(Goal): done before the
%   host is started.

with_peers(Specs, Goal) :-
    setup_call_cleanup(
        true,
        ( maplist(start, Specs), once(Goal) ),
        stop_all).

start(Peer-Options) :-
    !,
    free_port(Port),
    place(Peer, Options, Port, Known, PlaceOptions),
    codec(Options, Args),
    option(host(HostOptions), Options, []),
    append(PlaceOptions, HostOptions, AllOptions),
    option(setup(Setup), Options, true),
    format(atom(Host), '~w@127.0.0.1:~d', [Peer, Known]),
    tmp_file(Peer, File),
    assertz(messages(Peer, File)),
    assertz(spec(Peer, Args)),
    assertz(host(Peer, Host,
                 ( Setup, host_start(Peer, AllOptions) ))),
    launch(Peer).
start(Peer) :-
    start(Peer-[]).

%   place(+Peer, +Options, +Port, -Known, -HostOptions): the peer listens at Port,
%   and announces the port Known of its proxy if it has one.

place(Peer, Options, Port, Known, [port(Port), advertise(Address)]) :-
    option(proxy(Kind), Options),
    !,
    atom_concat('127.0.0.1:', Port, Target),
    start_proxy(Kind, Peer, Target, Address),
    atom_concat('127.0.0.1:', KnownText, Address),
    atom_number(KnownText, Known).
place(_, _, Port, Port, [port(Port)]).

start_proxy(true, Peer, Target, Address) :-
    proxy_start(Target, Proxy, Address),
    assertz(proxy(Peer, Proxy)).
start_proxy(frames, Peer, Target, Address) :-
    frame_proxy_start(Peer, Target, Proxy, Address),
    assertz(frame_proxy(Peer, Proxy)).

codec(Options, [Speak]) :-
    option(codec(Codec), Options),
    !,
    format(atom(Speak), '--codec=~w', [Codec]).
codec(_, []).

launch(Peer) :-
    spec(Peer, Args),
    messages(Peer, File),
    project_file('test/lib/peer_main.pl', Main),
    current_prolog_flag(executable, Swipl),
    append([Swipl, '-g', peer_main, Main, '--'], Args, Argv),
    python(Python),
    alone(Alone),
    setup_call_cleanup(
        open(File, append, Err),
        process_create(Python, ['-ISEc', Alone|Argv],
                       [ stdin(pipe(In)), stdout(pipe(Out)),
                         stderr(stream(Err)), process(Pid) ]),
        close(Err)),
    set_stream(Out, timeout(150)),
    assertz(peer(Peer, Pid, In, Out)),
    host(Peer, _, Start),
    peer_do(Peer, Start).

%   A socket of a proxy that a process inherits is not closed when the proxy
%   closes it, and SWI-Prolog has no way to say that it shall not be inherited.

alone("import os, sys; os.closerange(3, 1024); \c
       os.execv(sys.argv[1], sys.argv[1:])").

stop_all :-
    forall(peer(Peer, _, _, _), peer_kill(Peer)),
    forall(retract(proxy(_, Proxy)), proxy_stop(Proxy)),
    forall(retract(frame_proxy(_, Proxy)), frame_proxy_stop(Proxy)),
    forall(retract(messages(_, File)),
           ( exists_file(File) -> delete_file(File) ; true )),
    retractall(spec(_, _)),
    retractall(host(_, _, _)).

%!  peer_restart(+Peer) is det.
%
%   Start a Peer that was killed, with its host at the same address.

peer_restart(Peer) :-
    (   frame_proxy(Peer, Proxy)
    ->  relay_refuse(Proxy),            % if the peer did not crash
        relay_admit(Proxy)
    ;   true
    ),
    launch(Peer).

%!  peer_crash(+Peer) is det.
%
%   From any thread: Peer ends at once, and no process listens at its address
%   when this succeeds. The caller then calls peer_kill/1 and peer_restart/1.

peer_crash(Peer) :-
    (   frame_proxy(Peer, Proxy)
    ->  relay_refuse(Proxy)
    ;   true
    ),
    peer(Peer, Pid, _, _),
    process_kill(Pid, kill),
    wait_until(is_dead(Pid), 30).

%!  peer_kill(+Peer) is det.

peer_kill(Peer) :-
    retract(peer(Peer, Pid, In, Out)),
    process_kill(Pid, kill),
    process_wait(Pid, _),
    close(In, [force(true)]),
    close(Out, [force(true)]).

%!  peer_ends(+Peer, -Status) is det.
%
%   Wait until Peer ends by itself.

peer_ends(Peer, Status) :-
    retract(peer(Peer, Pid, In, Out)),
    wait_for_end(Pid, 60, Status),
    close(In, [force(true)]),
    close(Out, [force(true)]).

%!  peer_signal(+Peer, +Signal) is det.
%
%   After `stop`, Peer is suspended when it returns.

peer_signal(Peer, Signal) :-
    peer(Peer, Pid, _, _),
    (   Signal == stop
    ->  stop_process(Pid)
    ;   process_kill(Pid, Signal)
    ).

%!  peer_pid(?Peer, -Pid) is nondet.

peer_pid(Peer, Pid) :-
    peer(Peer, Pid, _, _).

%!  peer_proxy(+Peer, -Proxy) is det.

peer_proxy(Peer, Proxy) :-
    proxy(Peer, Proxy).

%!  peer_host(+Peer, -Address) is det.

peer_host(Peer, Address) :-
    host(Peer, Address, _).

%!  peer_do(+Peer, ?Goal) is semidet.
%
%   once(Goal) in the process Peer; errors are thrown here.

peer_do(Peer, Goal) :-
    peer_try(Peer, Goal, Outcome),
    (   Outcome = raised(Error)
    ->  throw(Error)
    ;   Outcome = yes
    ).

%!  peer_try(+Peer, ?Goal, -Outcome) is det.
%
%   Outcome is `yes`, `no` or raised(Error).

peer_try(Peer, Goal, Outcome) :-
    peer(Peer, _, In, Out),
    format(In, '~k.~n', [Goal]),
    flush_output(In),
    read_term(Out, Answer, []),
    (   Answer = yes(Done)
    ->  Goal = Done,
        Outcome = yes
    ;   Answer == end_of_file
    ->  throw(error(system_error(peer_died(Peer)), _))
    ;   Outcome = Answer
    ).

%!  peer_agent(+Peer, +Clauses, +Facts, -Id) is det.
%
%   An agent on the host of Peer.

peer_agent(Peer, Clauses, Facts, Id) :-
    peer_do(Peer, agent_create(clauses(Clauses), Id,
                               [host(Peer), facts(Facts)])).

%!  peer_messages(+Peer, -Lines:list(string)) is det.
%
%   The output of Peer.

peer_messages(Peer, Lines) :-
    messages(Peer, File),
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "", Lines0),
    findall(Line, ( member(Line, Lines0), Line \== "" ), Lines).
