:- module(tartarus_messages,
          [ post_agent/2,               % +Agent, +Message
            post_agent/3,               % +Platform, +Location, ?Message
            accept/3,                   % +Location, +Message, -Answer
            set_log_server/2,           % +Ip, +Port
            set_log_serverr/2,          % +Ip, +Port
            set_log_serverrr/2,         % +Ip, +Port
            send_log/2,                 % +Name, +Message
            send_log1/2,                % +Name, +Message
            send_log2/2,                % +Name, +Message
            logged/3                    % +File, +Entry, -Done
          ]).
:- use_module('../typhon', [agent_property/2, agent_send/2, remote/2]).
:- use_module('../typhon/kernel/base/error_text', [print_error/2]).
:- use_module('../typhon/kernel/base/private', [private_open/4]).
:- use_module('../typhon/kernel/base/text', [format_shown/3]).
:- use_module(lives, [record/3, run_apart/1]).
:- use_module(platform,
              [ here/1, location_address/2, print_lines/2, print_problem/2,
                same_location/2 ]).

/** <module> Messages, and log servers

A message is a goal for another platform, as a list [Functor,Agent|Arguments].
It is called there in a thread of its own; the sender learns only whether it was
accepted.

Any platform can be a log server, and there may be three.  A log server prints
the entries sent to it, and appends them to a file in its working directory.

*Threading*: any thread; accept/3 and logged/3 in workers, one entry at a time.
*/

%!  post_agent(+Platform, +Location, ?Message:list) is semidet.
%!  post_agent(+Agent, +Message:list) is semidet.
%
%   Platform is `platform`.  A message is accepted if its agent lives at that
%   Location, or is one of platform, server, serverr and serverrr; or if it is
%   the id of an agent of Typhon, which gets Functor(Arguments...) as a
%   message.  If the agent is unbound, it is bound to the first one there, or
%   to `platform`.

post_agent(platform, Location, Message) :-
    nonvar(Location),
    Location = (Ip,Port),
    is_list(Message),
    catch(delivered(Location, Message, Answer),
          error(Formal, _),
          ( print_problem('No message can be sent to ~w, port ~w: ~p',
                          [Ip, Port, Formal]),
            fail )),
    (   Answer = accepted(Agent)
    ->  Message = [_,Agent|_]
    ;   print_lines("Ack:fail~n", []),
        print_problem('The message to ~w, port ~w was not accepted: ~p',
                      [Ip, Port, Message]),
        fail
    ).

post_agent(Agent, Message) :-
    record(Agent, _, Location),
    post_agent(platform, Location, Message),
    !.

delivered(Location, Message, Answer) :-
    here(Here),
    own(Here, Location),
    !,
    accept(Location, Message, Answer).
delivered(Location, Message, Answer) :-
    location_address(Location, Address),
    remote(Address, tartarus_messages:accept(Location, Message, Answer)).

own(Here, Location) :-
    same_location(Here, Location),
    !.
own(_, Location) :-
    record(_, _, Own),
    same_location(Own, Location),
    !.

%!  accept(+Location, +Message, -Answer) is det.
%
%   Answer is accepted(Agent) or `refused`.

accept(Location, Message, Answer) :-
    (   Message = [Functor,Agent|Arguments],
        atom(Functor),
        addressee(Agent, Location)
    ->  deliver(Agent, Functor, Arguments),
        Answer = accepted(Agent)
    ;   Answer = refused
    ).

addressee(Agent, Location) :-
    var(Agent),
    !,
    (   lives_at(Agent0, Location)
    ->  Agent = Agent0
    ;   Agent = platform
    ).
addressee(Agent, _) :-
    memberchk(Agent, [platform,server,serverr,serverrr]),
    !.
addressee(Agent, Location) :-
    lives_at(Agent, Location),
    !.
addressee(Agent, _) :-
    native(Agent).

lives_at(Agent, Location) :-
    record(Agent, _, Own),
    same_location(Own, Location),
    !.

native(Agent) :-
    atom(Agent),
    sub_atom(Agent, _, _, _, @),
    \+ record(Agent, _, _),
    agent_property(Agent, host(_)),
    !.

deliver(Agent, Functor, Arguments) :-
    \+ record(Agent, _, _),
    native(Agent),
    !,
    Message =.. [Functor|Arguments],
    agent_send(Agent, Message).
deliver(Agent, Functor, Arguments) :-
    Goal =.. [Functor,Agent|Arguments],
    run_apart(tartarus_messages:handle(Goal)).

%   No caller gets failure or an error, so it is reported here.

handle(Goal) :-
    catch(user:Goal, Error, true),
    !,
    (   var(Error)
    ->  true
    ;   Error == '$aborted'
    ->  true
    ;   print_error(warning, Error)
    ).
handle(Goal) :-
    print_message(warning, format('Message ~p failed', [Goal])).

                /*******************************
                *         LOG SERVERS          *
                *******************************/

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
    catch(remote(Address, tartarus_messages:logged(File, Entry, Done)),
          error(Formal, _),
          ( print_problem('The log server ~w cannot be reached: ~p',
                          [Server, Formal]),
            fail )),
    Done == true.

%!  logged(+File, +Entry, -Done) is det.

logged(File, Entry, true) :-
    with_mutex(tartarus_log,
               setup_call_cleanup(
                   private_open(File, append, Out, [encoding(utf8)]),
                   format_shown(Out, "~n~w", [Entry]),
                   close(Out))),
    print_lines("~w~n", [Entry]).
