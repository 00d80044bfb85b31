:- module(test_frame_proxy,
          [ frame_proxy_start/4,        % +Name, +Target, -Proxy, -Address
            frame_proxy_stop/1,         % +Proxy
            script/2,                   % +Events, :Crash
            happened/1,                 % -Events
            script_end/1,               % -Events
            has_crashed/1,              % +Name
            go_on/0,
            frames_passed/2             % +Link, -Count
          ]).

/** <module> Proxies that let frames pass by a script

The proxy of each endpoint recognises frames by their heads only. Those from A
to B are numbered from 1 on over all connections of the two since script/2,
and Link is A-B, each the name of an endpoint or the address of one without a
proxy. An event

    at(Link, Number, When, Action)

is carried out once, when that frame is to be passed on: `before` it, after
half of it has passed (`inside`), or `after` it. Actions are

  - cut: both sides see that the connection ends
  - mute: nothing more passes on this connection, in either direction
  - hold(Seconds): the frame, and what comes after it, waits
  - stop: it waits until go_on/0
  - crash(Name): call(Crash, Name); the rest of the frame is lost

*Threading*: the threads of the relays pass frames on. The other predicates are
for the main thread of a test.
*/

:- use_module(relay).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(lists), [member/2]).

:- meta_predicate script(+, 1).

:- dynamic
    proxy/3,                            % Proxy, Name, Address
    client/2,                           % Connection, Name
    muted/1,                            % Connection
    frames/3,                           % `come` or `gone`, Link, Count
    event/2,                            % Link-Number-When, Action
    event_happened/1,                   % at(Link, Number, When, Action)
    crash/1,                            % Closure
    crashed/1,                          % Name
    stopped/1.                          % Thread

%!  frame_proxy_start(+Name, +Target, -Proxy, -Address) is det.
%
%   Links name the endpoint behind the proxy Name.

frame_proxy_start(Name, Target, Proxy, Address) :-
    relay_start(Target, pump, Proxy, Address),
    assertz(proxy(Proxy, Name, Address)).

%!  frame_proxy_stop(+Proxy) is det.

frame_proxy_stop(Proxy) :-
    relay_stop(Proxy),
    retractall(proxy(Proxy, _, _)),
    (   proxy(_, _, _)
    ->  true
    ;   script([], true),
        retractall(client(_, _)),
        retractall(muted(_))
    ).

%!  script(+Events, :Crash) is det.
%
%   The next frame of each link has number 1, and Events are pending.

script(Events, Crash) :-
    with_mutex(frame_proxy, new_script(Events, Crash)).

new_script(Events, Crash) :-
    retractall(crash(_)),
    retractall(frames(_, _, _)),
    retractall(event(_, _)),
    retractall(event_happened(_)),
    retractall(crashed(_)),
    assertz(crash(Crash)),
    forall(member(at(Link, Number, When, Action), Events),
           assertz(event(Link-Number-When, Action))).

%!  happened(-Events:list) is det.
%
%   The events of the script that have happened.

happened(Events) :-
    findall(Event, event_happened(Event), Events).

%!  script_end(-Events:list) is det.
%
%   End the script: Events have happened, and no other will.

script_end(Events) :-
    with_mutex(frame_proxy, ( retractall(event(_, _)), happened(Events) )).

%!  has_crashed(+Name) is semidet.
%
%   An event `crash(Name)` has happened and is over.

has_crashed(Name) :-
    crashed(Name).

%!  go_on is det.
%
%   Resume the frames that events `stop` hold.

go_on :-
    forall(retract(stopped(Thread)),
           catch(thread_send_message(Thread, go_on),
                 error(existence_error(_, _), _), true)).

%!  frames_passed(+Link, -Count) is det.

frames_passed(Link, Count) :-
    (   frames(gone, Link, Count0)
    ->  Count = Count0
    ;   Count = 0
    ).

		 /*******************************
		 *            PUMPS             *
		 *******************************/

pump(Proxy, Connection, Direction, In, Out) :-
    handshake(Direction, Connection, In, Out, HeadBytes),
    link(Direction, Proxy, Connection, Link),
    frames(HeadBytes, Connection, Link, In, Out).

link(up, Proxy, Connection, Client-Name) :-
    client(Connection, Client),
    proxy(Proxy, Name, _).
link(down, Proxy, Connection, Name-Client) :-
    link(up, Proxy, Connection, Client-Name).

%   Each side sends three lines, the first `typhon Version ...` with its
%   address, the last `resume ...`.

handshake(Direction, Connection, In, Out, HeadBytes) :-
    line(In, Out, First),
    split_string(First, " ", "", ["typhon", Version|Words]),
    head_bytes(Version, HeadBytes),
    (   Direction == up
    ->  client_named(Words, Connection)
    ;   true
    ),
    lines_to_resume(In, Out).

head_bytes("2", 7).                     % length, check
head_bytes("3", 15).                    % length, check, counts

client_named([_Nonce, _Process, _Start, Word|_], Connection) :-
    atom_string(Address, Word),
    (   proxy(_, Name, Address)
    ->  true
    ;   Name = Address
    ),
    assertz(client(Connection, Name)).

lines_to_resume(In, Out) :-
    line(In, Out, Line),
    (   string_concat("resume ", _, Line)
    ->  true
    ;   lines_to_resume(In, Out)
    ).

line(In, Out, Line) :-
    read_line_to_string(In, Line),
    string(Line),
    string_concat(Line, "\n", Text),
    carry(Out, Text).

frames(HeadBytes, Connection, Link, In, Out) :-
    repeat,
    (   frame(HeadBytes, In, Frame)
    ->  pass(Frame, Connection, Link, Out),
        fail
    ;   !
    ).

frame(HeadBytes, In, Frame) :-
    read_string(In, HeadBytes, Head),
    string_codes(Head, [B3, B2, B1, B0|_]),
    Length is B3<<24 \/ B2<<16 \/ B1<<8 \/ B0,
    read_string(In, Length, Body),
    string_length(Body, Length),
    string_concat(Head, Body, Frame).

		 /*******************************
		 *            FRAMES            *
		 *******************************/

pass(Frame, Connection, Link, Out) :-
    with_mutex(frame_proxy, count(come, Link, Number)),
    happens(Link-Number-before, Connection),
    string_length(Frame, Length),
    Half is Length//2,
    sub_string(Frame, 0, Half, Rest, First),
    sub_string(Frame, Half, Rest, 0, Second),
    pass(First, Connection, Out),
    happens(Link-Number-inside, Connection),
    pass(Second, Connection, Out),
    with_mutex(frame_proxy, count(gone, Link, _)),
    happens(Link-Number-after, Connection).

pass(_, Connection, _) :-
    muted(Connection),
    !.
pass(Text, _, Out) :-
    carry(Out, Text).

count(What, Link, Number) :-
    (   retract(frames(What, Link, Number0))
    ->  true
    ;   Number0 = 0
    ),
    Number is Number0+1,
    assertz(frames(What, Link, Number)).

happens(Where, Connection) :-
    (   event(Where, _),
        with_mutex(frame_proxy, taken(Where, Action))
    ->  do(Action, Connection)
    ;   true
    ).

taken(Where, Action) :-
    retract(event(Where, Action)),
    Where = Link-Number-When,
    (   Action == stop
    ->  thread_self(Me),
        assertz(stopped(Me))
    ;   true
    ),
    assertz(event_happened(at(Link, Number, When, Action))).

do(cut, _) :-
    cut.
do(mute, Connection) :-
    assertz(muted(Connection)).
do(hold(Seconds), _) :-
    sleep(Seconds).
do(stop, _) :-
    thread_get_message(go_on).
do(crash(Name), _) :-
    crash(Crash),
    sig_atomic(( call(Crash, Name),     % which ends this connection
                 assertz(crashed(Name)) )),
    cut.
