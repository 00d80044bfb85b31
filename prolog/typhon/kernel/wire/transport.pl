:- module(typhon_transport,
          [ transport_begin/1,          % +Options
            transport_end/0,
            transport_disagrees/1,      % +Option
            endpoint_own_proof/1,       % ?Proof
            transport_unknown/1,        % -Proof
            transport_first/2,          % +Byte, +Out
            transport_open/6,           % +Role, +In, +Out, -TIn, -TOut, -Proof
            transport_octets/1,         % +Stream
            transport_close/0,
            transport_proof/1,          % -Proof
            transport_as/2,             % +Proof, :Goal
            transport_forget/0,
            transport_input/2,          % +In, +Seconds
            line_read/3,                % +In, +Deadline, -Line
            line_write/2,               % +Out, +Line
            refusal_text/2,             % +Why, -Text
            alone/1,                    % ?Address
            alone_begin/1,              % +Address
            alone_end/0
          ]).

/** <module> Transports: how connections carry bytes and peers prove themselves

On plain TCP the bytes of a connection are those of its stream, and its peer
proves that it knows the cookie. An option may define another transport by the
hooks

    begins(Options, Transport, Own, Unknown)
                                an endpoint starts with Options: its connections
                                use Transport, its proof to peers is Own, and a
                                peer without session has the proof Unknown
    ends(Transport)             the endpoint has stopped
    disagrees(Option)           a running endpoint does not have Option
    first_byte(Byte, Transport) Byte is the first of a client of Transport;
                                `plain` is a client without transport
    misfit(Client, Own, Line, Why)
                                a client of transport Client has connected to an
                                endpoint of transport Own: it gets Line, and is
                                refused because of Why
    refusal(Why, Text)          Text describes Why of misfit/4, or of an error
                                of opens/7
    opens(Transport, Role, In, Out, TIn, TOut, Proof)
                                the connection uses TIn and TOut, which read and
                                write In and Out; the peer has given Proof
    closes                      close the streams, if any, that opens/7 has
                                opened in this thread: an exception has removed
                                their bindings

All but the first three are called in the thread of a connection.

An endpoint that is alone has no connections: a process without peers needs no
sockets and no threads.

A transport may have read bytes ahead that its stream does not report:
transport_input/2 tests both.

*Threading*: the caller serializes begin and end; the rest as the hooks.
*/

:- use_module(library(error), [permission_error/3, syntax_error/1]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../base/index', [part_joins/3]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module('../base/options', [options_load/2]).

:- multifile
    begins/4,                           % Options, Transport, Own, Unknown
    ends/1,                             % Transport
    disagrees/1,                        % Option
    first_byte/2,                       % Byte, Transport
    misfit/4,                           % Client, Own, Line, Why
    refusal/2,                          % Why, Text
    opens/7,                            % Transport, Role, In, Out, TIn, TOut,
                                        % Proof
    closes/0.

:- dynamic refusal/2.
:- dynamic current/3.           % Transport, Own, Unknown: not plain TCP

%!  transport_begin(+Options) is det.
%
%   Choose the transport of the endpoint, which starts with Options.
%
%   @error those of the hook begins/4

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

%!  transport_end is det.
%
%   End the transport of the endpoint, which has stopped.

transport_end :-
    (   retract(current(Transport, _, _))
    ->  forall(ends(Transport), true)
    ;   true
    ).

%!  transport_disagrees(+Option) is semidet.
%
%   The endpoint does not have Option.

transport_disagrees(Option) :-
    disagrees(Option),
    !.

%!  endpoint_own_proof(?Proof) is semidet.
%
%   A process with this proof has the keys, or, on plain TCP, the cookie, of
%   this process.

endpoint_own_proof(Proof) :-
    transport(_, Own, _),
    Proof = Own.

%!  transport_unknown(-Proof) is det.
%
%   Proof is that of a peer without session.

transport_unknown(Proof) :-
    transport(_, _, Proof).

transport(Transport, Own, Unknown) :-
    current(Transport, Own, Unknown),
    !.
transport(plain, cookie, cookie).

                 /*******************************
                 *          CONNECTIONS         *
                 *******************************/

%!  transport_first(+Byte, +Out) is det.
%
%   Byte is the first of a client of the transport of this endpoint.  For
%   another client write a line to Out that fits in any buffer, and raise an
%   error.
%
%   @error permission_error(authenticate, peer, Why)

transport_first(Byte, Out) :-
    client(Byte, Client),
    transport(Own, _, _),
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

%!  refusal_text(+Why, -Text:atom) is semidet.
%
%   Text describes Why of permission_error(authenticate, peer, Why), if it is a
%   reason that an option defines.

refusal_text(Why, Text) :-
    refusal(Why, Text),
    !.

%!  transport_open(+Role, +In, +Out, -TIn, -TOut, -Proof) is det.
%
%   From now on the connection uses TIn and TOut: In and Out themselves on plain
%   TCP. Proof is the proof that the peer has given, or will give: `cookie` on
%   plain TCP.
%
%   @error those of the hook opens/7

transport_open(Role, In, Out, TIn, TOut, Proof) :-
    (   current(Transport, _, _)
    ->  opens(Transport, Role, In, Out, TIn, TOut, Proof),
        nb_setval(typhon_below, In)
    ;   TIn = In,
        TOut = Out,
        Proof = cookie
    ),
    nb_setval(typhon_proof, Proof).

%!  transport_octets(+Stream) is det.
%
%   Stream carries frames: their bytes are characters, for the flag
%   stream_type_check.

transport_octets(Stream) :-
    set_stream(Stream, type(text)),
    set_stream(Stream, encoding(iso_latin_1)),
    set_stream(Stream, buffer_size(65536)).

%!  transport_close is det.
%
%   Close the streams that transport_open/6 has opened in this thread, if any.

transport_close :-
    forall(closes, true).

%!  transport_proof(-Proof) is semidet.
%
%   In the thread of a connection: the proof of the peer.

transport_proof(Proof) :-
    nb_current(typhon_proof, Proof),
    Proof \== none.

%!  transport_as(+Proof, :Goal) is semidet.
%
%   Call Goal on behalf of the peer of a connection, in a thread that has none.
%   Proof is the proof of the peer there, `none` if there was no connection.

:- meta_predicate transport_as(+, 0).

transport_as(Proof, Goal) :-
    setup_call_cleanup(nb_setval(typhon_proof, Proof), once(Goal),
                       transport_forget).

%!  transport_forget is det.
%
%   Forget the proof: this thread no longer has a connection, and goes on with
%   other work.

transport_forget :-
    nb_setval(typhon_proof, none).

%!  transport_input(+In, +Seconds) is semidet.
%
%   In the thread of a connection: bytes can be read from In, or will arrive
%   within Seconds.

transport_input(In, Seconds) :-
    (   nb_current(typhon_below, Below)
    ->  wait_for_input([In, Below], [_|_], Seconds)
    ;   wait_for_input([In], [_], Seconds)
    ).

                /*******************************
                *             LINES            *
                *******************************/

%!  line_read(+In, +Deadline, -Line:string) is det.
%
%   Read a line of at most 512 bytes before Deadline, a time stamp.
%
%   @error timeout_error(read, In)
%   @error syntax_error(line) if it is too long
%   @error syntax_error(end_of_file)

line_read(In, Deadline, Line) :-
    line_codes(In, Deadline, 512, Codes),
    string_codes(Line, Codes).

line_codes(In, Deadline, Space, Codes) :-
    monotonic_time(Now),
    Left is max(0.001, Deadline-Now),
    set_stream(In, timeout(Left)),
    get_code(In, Byte),
    (   Byte == 0'\n
    ->  Codes = []
    ;   Byte == -1
    ->  syntax_error(end_of_file)
    ;   Space > 0
    ->  Codes = [Byte|More],
        Space1 is Space-1,
        line_codes(In, Deadline, Space1, More)
    ;   syntax_error(line)
    ).

%!  line_write(+Out, +Line) is det.
%
%   Write Line and a newline to Out, and flush it.

line_write(Out, Line) :-
    format(Out, "~w\n", [Line]),
    flush_output(Out).

                /*******************************
                *             ALONE            *
                *******************************/

:- dynamic alone/1.                     % Address

%!  alone(?Address) is semidet.
%
%   The endpoint of this process is alone, and has this Address.

%!  alone_begin(+Address) is det.
%
%   The endpoint begins to be alone, at Address.

alone_begin(Address) :-
    assertz(alone(Address)).

%!  alone_end is det.
%
%   The endpoint that is alone stops.

alone_end :-
    retractall(alone(_)).
