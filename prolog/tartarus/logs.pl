:- module(tartarus_logs,
          [ set_log_server/2,           % +Ip, +Port
            set_log_serverr/2,          % +Ip, +Port
            set_log_serverrr/2,         % +Ip, +Port
            send_log/2,                 % +Name, +Message
            send_log1/2,                % +Name, +Message
            send_log2/2,                % +Name, +Message
            logged/3                    % +File, +Entry, -Done
          ]).
:- use_module('../typhon', [remote/2]).
:- use_module(platform, [here/1, location_address/2]).
:- use_module(told, [told/2, wrong/2]).

/** <module> Log servers

Any platform is one, and there may be three: what it is sent it prints and
appends to a file in its working directory.

*Threading*: any thread; logged/3 in workers, one entry at a time.
*/

:- dynamic server/2.                    % File, Location

%!  set_log_server(+Ip, +Port) is det.
%!  set_log_serverr(+Ip, +Port) is det.
%!  set_log_serverrr(+Ip, +Port) is det.

set_log_server(Ip, Port) :-
    set('server_log.txt', (Ip,Port)).

set_log_serverr(Ip, Port) :-
    set('server_log1.txt', (Ip,Port)).

set_log_serverrr(Ip, Port) :-
    set('server_log2.txt', (Ip,Port)).

set(File, Location) :-
    retractall(server(File, _)),
    assertz(server(File, Location)).

%!  send_log(+Name, +Message) is semidet.
%!  send_log1(+Name, +Message) is semidet.
%!  send_log2(+Name, +Message) is semidet.
%
%   Fails if there is no such server, or it cannot be reached.

send_log(Name, Message) :-
    send('server_log.txt', Name, Message).

send_log1(Name, Message) :-
    send('server_log1.txt', Name, Message).

send_log2(Name, Message) :-
    send('server_log2.txt', Name, Message).

send(File, Name, Message) :-
    server(File, Server),
    here((Ip,Port)),
    get_time(Time),
    format(atom(Entry), '~w ~w ~w ~w ~w', [Time, Name, Ip, Port, Message]),
    location_address(Server, Address),
    catch(remote(Address, tartarus_logs:logged(File, Entry, Done)),
          error(Formal, _),
          ( wrong('The log server ~w cannot be reached: ~p', [Server, Formal]),
            fail )),
    Done == true.

%!  logged(+File, +Entry, -Done) is det.

logged(File, Entry, true) :-
    with_mutex(tartarus_log,
               setup_call_cleanup(
                   open(File, append, Out, [encoding(utf8)]),
                   format(Out, "~n~w", [Entry]),
                   close(Out))),
    told("~w~n", [Entry]).
