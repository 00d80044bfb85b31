:- module(typhon_transport,
          [ transport_begin/1,          % +Options
            transport_end/0,
            transport_disagrees/1,      % +Option
            transport_own/1,            % -Proof
            transport_unknown/1,        % -Proof
            transport_first/2,          % +Byte, +Out
            transport_open/6,           % +Role, +In, +Out, -TIn, -TOut, -Proof
            transport_close/0,
            transport_proof/1,          % -Proof
            transport_as/2,             % +Proof, :Goal
            transport_forget/0,
            transport_input/2,          % +In, +Seconds
            alone/1,                    % ?Address
            alone_begin/1,              % +Address
            alone_end/0
          ]).

/** <module> What carries the bytes of connections

The bytes of a connection are those of its TCP stream, and its peer proves that
it knows the cookie. An option may carry them otherwise, by the hooks

    begins(Options, Transport, Own, Unknown)
                                an endpoint starts with Options: its connections
                                are of Transport, its peers know it as Own, and
                                a peer of which nothing is known is Unknown
    ends(Transport)             it has stopped
    disagrees(Option)           an endpoint that runs does not have Option
    first_byte(Byte, Transport) with Byte a client of Transport begins; `plain`
                                is one without any
    misfit(Client, Own, Line, Why)
                                a client of one transport has met an endpoint of
                                another: the Line that it gets, and why it is
                                turned away
    opens(Transport, Role, In, Out, TIn, TOut, Proof)
                                what is said to the peer goes through TIn and
                                TOut, which read and write In and Out; the peer
                                has proved itself by Proof
    closes                      close what that has opened in this thread, if
                                anything: an exception has taken the bindings
                                away

All but the first three are called in the thread of a connection.

An endpoint that is alone has no connections: a process without peers needs no
sockets and no threads.

A transport that reads ahead has bytes of which its stream knows nothing:
transport_input/2 looks at both.

*Threading*: the caller serializes begin and end; the rest as the hooks.
*/

:- use_module(library(error), [permission_error/3]).
:- use_module('../base/index', [part_joins/3]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module('../base/options', [options_load/2]).
:- use_module(handshake, [line_write/2]).

:- multifile
    begins/4,                           % Options, Transport, Own, Unknown
    ends/1,                             % Transport
    disagrees/1,                        % Option
    first_byte/2,                       % Byte, Transport
    misfit/4,                           % Client, Own, Line, Why
    opens/7,                            % Transport, Role, In, Out, TIn, TOut,
                                        % Proof
    closes/0.

:- dynamic current/3.           % Transport, Own, Unknown: not plain TCP

%!  transport_begin(+Options) is det.
%!  transport_end is det.
%!  transport_disagrees(+Option) is semidet.
%
%   The endpoint starts with Options, and has stopped; it does not have Option.
%
%   @error what begins/4 raises

transport_begin(Options) :-
    options_load(host_option, Options),
    forall(( part_joins(environment, Variable, _),
             getenv(Variable, Value),
             Value \== '' ),
           on_demand_load(environment, Variable)),
    (   begins(Options, Transport, Own, Unknown)
    ->  assertz(current(Transport, Own, Unknown))
    ;   true
    ).

transport_end :-
    (   retract(current(Transport, _, _))
    ->  forall(ends(Transport), true)
    ;   true
    ).

transport_disagrees(Option) :-
    disagrees(Option),
    !.

%!  transport_own(-Proof) is det.
%!  transport_unknown(-Proof) is det.
%
%   How this process proves itself to others; as what a peer counts of which
%   nothing is known.

transport_own(Proof) :-
    (   current(_, Own, _)
    ->  Proof = Own
    ;   Proof = cookie
    ).

transport_unknown(Proof) :-
    (   current(_, _, Unknown)
    ->  Proof = Unknown
    ;   Proof = cookie
    ).

                 /*******************************
                 *          CONNECTIONS         *
                 *******************************/

%!  transport_first(+Byte, +Out) is det.
%
%   A client begins with Byte: that is of our transport. If not we report that,
%   in a line that fits in any buffer.
%
%   @error permission_error(authenticate, peer, Why)

transport_first(Byte, Out) :-
    client(Byte, Client),
    ( current(Own, _, _) -> true ; Own = plain ),
    (   Client == Own
    ->  true
    ;   misfit(Client, Own, Line, Why)
    ->  line_write(Out, Line),
        permission_error(authenticate, peer, Why)
    ;   permission_error(authenticate, peer, protocol)
    ).

client(0't, plain) :-
    !.
client(Byte, Transport) :-
    first_byte(Byte, Transport),
    !.
client(_, other).

%!  transport_open(+Role, +In, +Out, -TIn, -TOut, -Proof) is det.
%
%   What is said to the peer goes through TIn and TOut from now on: In and Out
%   themselves on plain TCP. Proof is how the peer has proved itself, or will:
%   `cookie` there.
%
%   @error what opens/7 raises

transport_open(Role, In, Out, TIn, TOut, Proof) :-
    (   current(Transport, _, _)
    ->  opens(Transport, Role, In, Out, TIn, TOut, Proof),
        nb_setval(typhon_below, In)
    ;   TIn = In,
        TOut = Out,
        Proof = cookie
    ),
    nb_setval(typhon_proof, Proof).

%!  transport_close is det.
%
%   Close what transport_open/6 has opened in this thread, if anything.

transport_close :-
    forall(closes, true).

%!  transport_proof(-Proof) is semidet.
%
%   In the thread of a connection: how the peer has proved itself.

transport_proof(Proof) :-
    nb_current(typhon_proof, Proof),
    Proof \== none.

%!  transport_as(+Proof, :Goal) is semidet.
%
%   Call Goal for the peer of a connection, in a thread that has none: the peer
%   has proved itself by Proof there, `none` if there was no connection.

:- meta_predicate transport_as(+, 0).

transport_as(Proof, Goal) :-
    setup_call_cleanup(nb_setval(typhon_proof, Proof), once(Goal),
                       transport_forget).

%!  transport_forget is det.
%
%   This thread has no connection any more, and goes on as another.

transport_forget :-
    nb_setval(typhon_proof, none).

%!  transport_input(+In, +Seconds) is semidet.
%
%   In the thread of a connection: there is something to read from In, or will
%   be within Seconds.

transport_input(In, Seconds) :-
    (   nb_current(typhon_below, Below)
    ->  wait_for_input([In, Below], [_|_], Seconds)
    ;   wait_for_input([In], [_], Seconds)
    ).

                /*******************************
                *             ALONE            *
                *******************************/

:- dynamic alone/1.                     % Address

%!  alone(?Address) is semidet.
%!  alone_begin(+Address) is det.
%!  alone_end is det.
%
%   The endpoint of this process is alone, and has this Address; from now on, and
%   no longer.

alone_begin(Address) :-
    assertz(alone(Address)).

alone_end :-
    retractall(alone(_)).
