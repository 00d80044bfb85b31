:- module(test_nxt_bricks,
          [ with_brick/3,               % +Args, -Brick, :Goal
            with_world/4,               % +Scene, +Args, -World, :Goal
            start_brick/2,              % +Args, -Brick
            stop_brick/1,               % +Brick
            end_status/3,               % +Pid, +Seconds, -Status
            ask/3,                      % +Brick, +Line, -Term
            tell/2,                     % +Brick, +Line
            tell/3,                     % +Brick, +Format, +Args
            brick_place/3,              % +Brick, ?Name, -Place
            with_line/3,                % +Place, -Line, :Goal
            open_line/2,                % +Place, -Line
            close_line/1,               % +Line
            exchange/3,                 % +Line, +Request, -Reply
            send/2,                     % +Line, +Request
            send_bytes/2,               % +Line, +Bytes
            receive/2,                  % +Line, -Reply
            receive_bytes/3,            % +Line, +Count, -Bytes
            hex_list/2                  % ?Hex, ?Bytes
          ]).

/** <module> Simulated bricks and worlds as processes of their own

A brick and a world are both `sim(Pid, In, Out, Places)`; a line leads to a
brick by a pseudo-terminal or TCP. Telegrams are atoms of hexadecimal
digits, without the two bytes of length.

*Threading*: the predicates may be called in any thread.
*/

:- use_module(common, [project_file/2, python/1, wait_until/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3, process_kill/2,
                                 process_wait/2, process_wait/3]).
:- use_module(library(socket), [tcp_connect/3]).

:- meta_predicate
    with_brick(+, -, 0),
    with_world(+, +, -, 0),
    with_line(+, -, 0).

%!  with_brick(+Args:list, -Brick, :Goal) is semidet.
%
%   Calls Goal once while `brick.py Args` is running.

with_brick(Args, Brick, Goal) :-
    setup_call_cleanup(start_brick(Args, Brick),
                       once(Goal),
                       stop_brick(Brick)).

%!  with_world(+Scene:atom, +Args:list, -World, :Goal) is semidet.
%
%   Calls Goal once while `world.py Scene Args` is running.

with_world(Scene, Args, World, Goal) :-
    setup_call_cleanup(
        start('bridges/nxt/world.py', [Scene|Args], World),
        once(Goal),
        stop_brick(World)).

%!  start_brick(+Args:list, -Brick) is det.
%
%   To be ended by stop_brick/1.

start_brick(Args, Brick) :-
    start('bridges/nxt/brick.py', Args, Brick).

start(Script, Args, sim(Pid, In, Out, Places)) :-
    python(Python),
    project_file(Script, File),
    process_create(Python, [File, '--until-eof'|Args],
                   [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
    set_stream(Out, timeout(60)),
    catch(read(Out, Term), Error, Term = Error),
    (   Term = ready(Places)
    ->  true
    ;   stop_brick(sim(Pid, In, Out, [])),
        throw(error(not_ready(Term), _))
    ).

%!  stop_brick(+Brick) is det.

stop_brick(sim(Pid, In, Out, _)) :-
    close(In, [force(true)]),
    close(Out, [force(true)]),
    catch(end_status(Pid, 20, Status), error(_, _), Status = gone),
    (   Status == timeout
    ->  process_kill(Pid, kill),
        process_wait(Pid, _)
    ;   true
    ).

%!  end_status(+Pid, +Seconds, -Status) is det.
%
%   Status is how the process ended, or `timeout`.

end_status(Pid, Seconds, Status) :-
    catch(wait_until(ended(Pid, Status), Seconds),
          error(timeout_error(_, _), _),
          Status = timeout).

ended(Pid, Status) :-
    process_wait(Pid, Status, [timeout(0)]),
    Status \== timeout.

%!  ask(+Brick, +Line, -Term) is det.
%
%   Term is the answer to Line.

ask(sim(_, In, Out, _), Line, Term) :-
    format(In, '~w~n', [Line]),
    flush_output(In),
    read(Out, Term).

%!  tell(+Brick, +Line) is semidet.
%!  tell(+Brick, +Format, +Args) is semidet.
%
%   Line is answered by `ok`.

tell(Sim, Line) :-
    ask(Sim, Line, ok).

tell(Sim, Format, Args) :-
    format(atom(Line), Format, Args),
    tell(Sim, Line).

%!  brick_place(+Brick, ?Name, -Place) is nondet.
%
%   Place is pty(Link) or tcp(Port).

brick_place(sim(_, _, _, Places), Name, Place) :-
    member(brick(Name, Pty, Tcp), Places),
    member(Place, [Pty, Tcp]),
    Place \== none.

                /*******************************
                *             LINES            *
                *******************************/

%!  with_line(+Place, -Line, :Goal) is semidet.
%
%   Calls Goal once with a line to the brick at Place.

with_line(Place, Line, Goal) :-
    setup_call_cleanup(open_line(Place, Line),
                       once(Goal),
                       close_line(Line)).

%!  open_line(+Place, -Line) is det.
%!  close_line(+Line) is det.
%
%   Line is line(In, Out, Pid), Pid being that of a relay, or `none`.

open_line(tcp(Port), line(In, Out, none)) :-
    tcp_connect('127.0.0.1':Port, Pair, []),
    stream_pair(Pair, In, Out),
    binary(In, Out).
open_line(pty(Link), line(In, Out, Pid)) :-
    python(Python),
    project_file('test/lib/pty_relay.py', Relay),
    process_create(Python, [Relay, Link],
                   [stdin(pipe(Out)), stdout(pipe(In)), process(Pid)]),
    binary(In, Out).

binary(In, Out) :-
    set_stream(In, timeout(60)),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)).

close_line(line(In, Out, Relay)) :-
    close(Out, [force(true)]),
    close(In, [force(true)]),
    catch(process_wait(Relay, _), error(_, _), true).   % none, or ended

%!  exchange(+Line, +Request:atom, -Reply:atom) is det.
%!  send(+Line, +Request:atom) is det.
%!  receive(+Line, -Reply:atom) is det.
%
%   Telegrams, framed.

exchange(Line, Request, Reply) :-
    send(Line, Request),
    receive(Line, Reply).

send(Line, Request) :-
    hex_list(Request, Bytes),
    length(Bytes, Size),
    Low is Size /\ 255,
    High is Size >> 8,
    send_bytes(Line, [Low, High|Bytes]).

receive(Line, Reply) :-
    receive_bytes(Line, 2, [Low, High]),
    Size is Low + High << 8,
    receive_bytes(Line, Size, Bytes),
    hex_list(Reply, Bytes).

send_bytes(line(_, Out, _), Bytes) :-
    format(Out, '~s', [Bytes]),
    flush_output(Out).

%!  receive_bytes(+Line, +Count, -Bytes) is det.
%
%   Bytes are fewer if the line ends before.

receive_bytes(_, 0, []) :-
    !.
receive_bytes(Line, Count, Bytes) :-
    Line = line(In, _, _),
    get_code(In, Byte),
    (   Byte == -1
    ->  Bytes = []
    ;   Bytes = [Byte|Rest],
        Less is Count-1,
        receive_bytes(Line, Less, Rest)
    ).

%!  hex_list(?Hex:atom, ?Bytes) is det.

hex_list(Hex, Bytes) :-
    var(Hex),
    !,
    phrase(digits(Bytes), Codes),
    atom_codes(Hex, Codes).
hex_list(Hex, Bytes) :-
    atom_codes(Hex, Codes),
    phrase(digits(Bytes), Codes).

digits([Byte|Bytes]) -->
    { nonvar(Byte), ! },
    { format(codes([H, L]), '~|~`0t~16r~2|', [Byte]) },
    [H, L],
    digits(Bytes).
digits([Byte|Bytes]) -->
    [H, L],
    !,
    { code_type(H, xdigit(High)),
      code_type(L, xdigit(Low)),
      Byte is High<<4 + Low
    },
    digits(Bytes).
digits([]) -->
    [].
