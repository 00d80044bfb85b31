:- module(cutting_proxy,
          [ with_proxy/3,               % +Target, -Proxy, :Goal
            proxy_start/3,              % +Target, -Proxy, -Address
            proxy_stop/1,               % +Proxy
            proxy_address/2,            % +Proxy, -Address
            proxy_cut/1,                % +Proxy
            proxy_cut_after/3,          % +Proxy, +Direction, +Bytes
            proxy_hold/2,               % +Proxy, +Direction
            proxy_release/2,            % +Proxy, +Direction
            proxy_cuts/2                % +Proxy, -Count
          ]).

/** <module> A TCP proxy that breaks connections, for tests

The proxy listens at an address of its own and forwards to a target, both
being atoms 'Interface:Port'. Directions are `up`, from the client to the
target, and `down`.

*Threading*: the predicates may be called from any thread.
*/

:- use_module(relay).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3]).

:- meta_predicate with_proxy(+, -, 0).

:- dynamic
    proxy/2,                            % Proxy, Address
    cut_after/3,                        % Proxy, Direction, Bytes
    held/2,                             % Proxy, Direction
    cuts/2.                             % Proxy, Count

%!  with_proxy(+Target, -Proxy, :Goal)
%
%   Run Goal with a proxy in front of Target.

with_proxy(Target, Proxy, Goal) :-
    setup_call_cleanup(
        proxy_start(Target, Proxy, _),
        Goal,
        proxy_stop(Proxy)).

%!  proxy_start(+Target, -Proxy, -Address) is det.

proxy_start(Target, Proxy, Address) :-
    relay_start(Target, pump, Proxy, Address),
    assertz(cuts(Proxy, 0)),
    assertz(proxy(Proxy, Address)).

%!  proxy_stop(+Proxy) is det.

proxy_stop(Proxy) :-
    retract(proxy(Proxy, _)),
    relay_stop(Proxy),
    retractall(cut_after(Proxy, _, _)),
    retractall(held(Proxy, _)),
    retractall(cuts(Proxy, _)).

proxy_address(Proxy, Address) :-
    proxy(Proxy, Address).

%!  proxy_cut(+Proxy) is det.
%
%   Close all connections that are open now.

proxy_cut(Proxy) :-
    relay_cut(Proxy).

%!  proxy_cut_after(+Proxy, +Direction, +Bytes) is det.
%
%   Forward Bytes more bytes in Direction, then close the connection. Once.

proxy_cut_after(Proxy, Direction, Bytes) :-
    retractall(cut_after(Proxy, Direction, _)),
    assertz(cut_after(Proxy, Direction, Bytes)).

%!  proxy_hold(+Proxy, +Direction) is det.
%!  proxy_release(+Proxy, +Direction) is det.
%
%   Forward nothing from now on: the connection looks alive and is silent.

proxy_hold(Proxy, Direction) :-
    assertz(held(Proxy, Direction)).

proxy_release(Proxy, Direction) :-
    retractall(held(Proxy, Direction)),
    relay_pumps(Proxy, Direction, Pumps),
    maplist(go_on, Pumps).

go_on(Pump) :-
    catch(thread_send_message(Pump, go), error(existence_error(_, _), _), true).

%!  proxy_cuts(+Proxy, -Count) is det.
%
%   Count connections were cut after a number of bytes.

proxy_cuts(Proxy, Count) :-
    cuts(Proxy, Count).

		 /*******************************
		 *            PUMPS             *
		 *******************************/

pump(Proxy, _, Direction, In, Out) :-
    repeat,
    peek_byte(In, Byte),                % fill_buffer/1 may leave In locked
    (   Byte == -1
    ->  !
    ;   read_pending_codes(In, Codes, []),
        pass(Proxy, Direction),
        forward_codes(Codes, Out, Proxy, Direction),
        fail
    ).

pass(Proxy, Direction) :-
    (   held(Proxy, Direction)
    ->  thread_get_message(go),
        pass(Proxy, Direction)
    ;   true
    ).

forward_codes(Codes, Out, Proxy, Direction) :-
    length(Codes, Length),
    (   retract(cut_after(Proxy, Direction, Bytes))
    ->  (   Bytes >= Length
        ->  Left is Bytes-Length,
            assertz(cut_after(Proxy, Direction, Left)),
            carry(Out, Codes)
        ;   length(Last, Bytes),
            append(Last, _, Codes),
            carry(Out, Last),
            count_cut(Proxy),
            cut
        )
    ;   carry(Out, Codes)
    ).

count_cut(Proxy) :-
    with_mutex(cutting_proxy,
               ( retract(cuts(Proxy, Count0)),
                 Count is Count0+1,
                 assertz(cuts(Proxy, Count)) )).
