:- module(typhon_takeover, []).
:- use_module(library(debug), [debug/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(thread), [concurrent_forall/3]).
:- use_module(library(socket), [tcp_bind/2, tcp_close_socket/1, tcp_socket/1]).
:- use_module('../../kernel/base/on_demand', [on_demand_call/3]).
:- use_module('../../kernel/host',
              [ address_parts/3, hosts_go_on/0, hosts_rest/0, process_ask/6,
                runtime_acquire/2 ]).
:- use_module('../../kernel/wire',
              [cookie/1, cookie_given/1, endpoint_address/1]).
:- use_module(engine, [engine/3, engine_key/3]).
:- use_module(members,
              [fleet_beat/1, fleet_joined/2, join_fleet/2]).
:- use_module(tags, [hosts_of_fleet/3]).

/** <module> Processes that stand in for others, and those that were replaced

A process whose lease has lapsed may be dead, suspended or cut off.  If its
journal is in the engine, another process may open it one lease later: with the
journal come the addresses, agents, messages and transfers in doubt, as after a
restart.  The first process that asks for such journals gets it, and starts a
stand-in; others connect to that instead.

A process that finds its address or journal with another one sends nothing any
more: its hosts rest, and it ends with status 75, unless it has a terminal.

*Threading*: as the comments say.
*/

:- multifile
    prolog:message//1,
    typhon_connection:leads_to/2,
    typhon_members:beaten/4,
    typhon_members:fenced/2,
    typhon_members:is_gone/1,
    typhon_members:recovers/1,
    typhon_members:stands_at/2,
    typhon_on_demand:joins/2,
    typhon_store:fenced/1.

:- setting(typhon_fleet:fenced_exit, boolean, true,
           "A process without a terminal ends when another one has its address or \c
            its journal").

:- dynamic
    given_up/0,
    meeting/0,                  % this process stands in, and nothing knows it yet
    standing/2.                 % Endpoint, At: this process is known by Endpoint

typhon_on_demand:joins(fleet, joined).

                /*******************************
                *            FENCES            *
                *******************************/

%   In the thread of the fleet or of a commit, which hosts_rest/0 stops.

typhon_members:fenced(Fleet, Why) :-
    gives_up(typhon(fleet_fenced(Fleet, Why))).

typhon_store:fenced(Place) :-
    gives_up(typhon(journal_fenced(Place))).

gives_up(Message) :-
    (   given_up
    ->  true
    ;   assertz(given_up),
        print_message(error, Message),
        thread_create(typhon_takeover:rest, _,
                      [alias(typhon_fleet_end), detached(true)])
    ).

:- public rest/0.

rest :-
    hosts_rest,
    retractall(given_up),
    (   setting(typhon_fleet:fenced_exit, true),
        \+ stream_property(user_input, tty(true))
    ->  halt(75)
    ;   true                            % it has a user
    ).

                /*******************************
                *           STAND-INS          *
                *******************************/

typhon_members:recovers(Fleet) :-
    fleet_joined(Fleet, Options),
    option(recover(How), Options, false),
    How \== false.

typhon_members:beaten(Fleet, _, _, Orphans) :-
    forall(member([Endpoint0,Journal0], Orphans),
           ( atom_string(Endpoint, Endpoint0),
             atom_string(Journal, Journal0),
             recover(Fleet, Endpoint, Journal) )).

recover(Fleet, Endpoint, Journal) :-
    print_message(informational,
                  typhon(fleet_recovers(Fleet, Endpoint, Journal))),
    fleet_joined(Fleet, Options),
    option(recover(How), Options),
    thread_create(typhon_takeover:started(How, Fleet, Options, Endpoint, Journal),
                  _, [detached(true)]).

:- public started/5.

started(true, Fleet, Options, Endpoint, Journal) :-
    !,
    endpoint_address(Own),
    atomic_list_concat([Interface,_], :, Own),
    module_property(typhon_takeover, file(File)),
    file_directory_name(File, Directory),
    directory_file_path(Directory, '../../../typhon.pl', Platform),
    current_prolog_flag(executable, Swipl),
    process_create(Swipl,
                   [ '-q', '-g', 'typhon_takeover:stand_in', '-t', 'halt(1)',
                     Platform, File ],
                   [stdin(pipe(In)), stdout(null), process(Pid)]),
    cookie(Cookie),
    format(In, '~k.~n', [stand_in(Cookie, Fleet, Options, Interface, Endpoint,
                                  Journal)]),
    close(In),
    process_wait(Pid, Status),
    debug(typhon(fleet), 'stand-in for ~w: ~w', [Endpoint, Status]).
started([Program|Args0], _, _, Endpoint, Journal) :-
    findall(Arg, ( member(Arg0, Args0), put_in(Arg0, Endpoint, Journal, Arg) ),
            Args),
    process_create(path(Program), Args,
                   [stdin(null), stdout(null), process(Pid)]),
    process_wait(Pid, Status),
    debug(typhon(fleet), '~w for ~w: ~w', [Program, Endpoint, Status]).

%   {endpoint} and {journal} in arguments of a command.

put_in(Arg0, Endpoint, Journal, Arg) :-
    atomic_list_concat(Parts0, '{endpoint}', Arg0),
    atomic_list_concat(Parts0, Endpoint, Arg1),
    atomic_list_concat(Parts, '{journal}', Arg1),
    atomic_list_concat(Parts, Journal, Arg).

%   The goal of a process that stands in for another one.  It reads from standard
%   input for which, opens its journal, and goes on as that process, known by its
%   address, at an address of its own.  It ends when it is fenced in turn.

:- public stand_in/0.

stand_in :-
    read(stand_in(Cookie, Fleet, Options, Interface, Endpoint, Journal)),
    cookie_given(Cookie),
    atomic_list_concat([Fleet,Journal], /, Path),
    join_fleet(Fleet, Options),
    journal_call(typhon_recovery:hosts_journal(redis(Path), [wait(15)])),
    free_port(Interface, Port),
    Runtime = [bind(Interface), advertise(Endpoint), port(Port)],
    runtime_acquire(stand_in, Runtime),
    atomic_list_concat([Interface,Port], :, At),
    assertz(standing(Endpoint, At)),
    assertz(meeting),
    journal_call(typhon_recovery:hosts_back(Runtime)),
    hosts_go_on,
    meet(Fleet, Endpoint),
    retractall(meeting),
    fleet_beat(Fleet),
    thread_get_message(typhon_never).

journal_call(Goal) :-
    on_demand_call(host_option, journal, Goal).

%   With port(0) it would be that of the journal, which the other process may hold.

free_port(Interface, Port) :-
    tcp_socket(Socket),
    call_cleanup(tcp_bind(Socket, Interface:Port), tcp_close_socket(Socket)).

typhon_members:stands_at(Endpoint, At) :-
    standing(Endpoint, At).

%   Peers may still be connected to the process for which this one stands in, and
%   would send to that: a later start of the same process displaces it.  So this
%   one meets them before its hosts are known to be up.

typhon_members:is_gone(_) :-
    meeting.

meet(Fleet, Own) :-
    hosts_of_fleet(Fleet, Hosts, [state(up)]),
    findall(Peer, ( member(Host, Hosts),
                    address_parts(Host, _, Peer),
                    Peer \== Own ),
            Peers0),
    sort(Peers0, Peers),
    concurrent_forall(member(Peer, Peers), typhon_takeover:met(Peer),
                      [threads(16)]).

:- public met/1.

met(Peer) :-
    catch(process_ask(Peer, Peer, hosting, hosts, _, 3), error(_, _), true).

%   In the thread that is about to connect to Address.

typhon_connection:leads_to(Address, At) :-
    fleet_joined(Fleet, _),
    engine_key(Fleet, [at], Key),
    catch(engine(Fleet, hget(Key, Address), At0), error(_, _), fail),
    !,
    atom_string(At, At0).

                /*******************************
                *            MESSAGES          *
                *******************************/

prolog:message(typhon(fleet_fenced(Fleet, address))) -->
    [ 'Another process has the address of this one in the fleet ~w: '-[Fleet],
      nl, 'the hosts of this process rest' ].
prolog:message(typhon(fleet_fenced(Fleet, journal))) -->
    [ 'Another process has opened the journal of this one in the fleet ~w: '-
      [Fleet], nl, 'the hosts of this process rest' ].
prolog:message(typhon(journal_fenced(Place))) -->
    [ 'Another process has opened the journal ~w of this one: '-[Place], nl,
      'the hosts of this process rest' ].
prolog:message(typhon(fleet_recovers(Fleet, Endpoint, Journal))) -->
    [ 'Process ~w of the fleet ~w has gone: another one opens its journal ~w'-
      [Endpoint, Fleet, Journal] ].
