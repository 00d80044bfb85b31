:- module(bench_trip,
          [ with_pong/2,                % +Prefix, :Goal
            trips/4                     % +Terms, +Trips, +Streams, -Rates
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(socket)).
:- use_module(common).

/** <module> The bare trip

Two single-threaded processes send a term back and forth over one connection
by fast_term_serialized/2: it has the contents of a hop of the agent of
traveller.pl. No threads, no agents, no answers.

*Threading*: one thread uses the streams.
*/

:- meta_predicate with_pong(+, 1).

%!  with_pong(+Prefix, :Goal) is det.
%
%   Calls Goal(Streams) while a second process returns all terms. Prefix is put
%   before its command line.

with_pong(Prefix, Goal) :-
    tcp_socket(Server),
    tcp_setopt(Server, reuseaddr),
    tcp_bind(Server, '127.0.0.1':Port),
    tcp_listen(Server, 1),
    setup_call_cleanup(
        pong_create(Prefix, Port, Pid),
        setup_call_cleanup(
            ( tcp_accept(Server, Socket, _), streams(Socket, Streams) ),
            call(Goal, Streams),
            close_streams(Streams)),
        ( tcp_close_socket(Server), process_wait(Pid, _) )).

pong_create(Prefix, Port, Pid) :-
    current_prolog_flag(executable, Swipl),
    module_property(bench_trip, file(File)),
    format(atom(Goal), 'bench_trip:pong(~d)', [Port]),
    append(Prefix, [Swipl, '-q', '-g', Goal, '-t', halt, File],
           [Program|Args]),
    process_create(path(Program), Args, [process(Pid)]).

%!  trips(+Terms, +Trips, +Streams, -Rates) is det.
%
%   Terms terms are under way at a time, and make Trips one-way trips together.
%   Rates is as in travelled/4.

trips(Terms, Trips, Streams, rates(PerSecond, PerCpu)) :-
    Each is Trips//2-Terms,
    image(Image),
    processor_time(Streams, Cpu0),
    seconds(( forall(between(1, Terms, _), send_term(Streams, Image)),
              forall(between(1, Each, _),
                     ( receive_term(Streams, Term), send_term(Streams, Term) )),
              forall(between(1, Terms, _), receive_term(Streams, _))
            ),
            Seconds),
    processor_time(Streams, Cpu1),
    Made is 2*(Each+Terms),
    PerSecond is Made/Seconds,
    PerCpu is Made/(Cpu1-Cpu0).

processor_time(Streams, Seconds) :-
    statistics(process_cputime, Here),
    send_term(Streams, cputime),
    receive_term(Streams, cputime(There)),
    Seconds is Here+There.

%   The other process.

pong(Port) :-
    tcp_socket(Socket),
    tcp_connect(Socket, '127.0.0.1':Port),
    streams(Socket, Streams),
    repeat,
    receive_term(Streams, Term),
    (   Term == end_of_file
    ->  !
    ;   thrown_back(Term, Back),
        send_term(Streams, Back),
        fail
    ).

thrown_back(cputime, cputime(Seconds)) :-
    !,
    statistics(process_cputime, Seconds).
thrown_back(Term, Term).

                /*******************************
                *             WIRE             *
                *******************************/

streams(Socket, In-Out) :-
    tcp_setopt(Socket, nodelay),
    tcp_open_socket(Socket, In, Out),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(In, buffer_size(65536)),
    set_stream(Out, buffer_size(65536)).

close_streams(In-Out) :-
    close(Out),
    close(In).

send_term(_-Out, Term) :-
    fast_term_serialized(Term, Bytes),
    string_length(Bytes, Length),
    B3 is Length>>16 /\ 255, B2 is Length>>8 /\ 255, B1 is Length /\ 255,
    put_byte(Out, B3), put_byte(Out, B2), put_byte(Out, B1),
    format(Out, '~s', [Bytes]),
    flush_output(Out).

receive_term(In-_, Term) :-
    get_byte(In, B3),
    (   B3 == -1
    ->  Term = end_of_file
    ;   get_byte(In, B2), get_byte(In, B1),
        Length is B3<<16 \/ B2<<8 \/ B1,
        read_string(In, Length, Bytes),
        fast_term_serialized(Term, Bytes)
    ).

image(hop(peer, image('traveller.abcdefgh.1@here@127.0.0.1:12345', Hash,
                      life(none, 1, inf, [], [], false, []),
                      state([], Facts), [true,main], [], 123.456), known)) :-
    length(Codes, 64),
    maplist([C]>>(C = 0'a), Codes),
    atom_codes(Hash, Codes),
    findall(fact(I, value(I)), between(1, 8, I), Facts0),
    append(Facts0, [left(1000), peer('peer@127.0.0.1:12345')], Facts).
