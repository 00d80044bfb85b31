:- module(typhon_hello,
          [ hello/4,                    % +Process, +Start, +Address, -Hello
            hello_peer/4,               % +Hello, -Process, -Start, -Address
            hello_line/2,               % +Hello, -Line
            line_hello/2,               % +Line, -Hello
            hello_codec/3,              % +Hello, +PeerHello, -Codec
            line_read/3,                % +In, +Deadline, -Line
            line_write/2                % +Out, +Line
          ]).

/** <module> The first lines two endpoints exchange

A connection begins with short lines of fixed format, read byte by byte
under one deadline and never with read/1: nothing of a peer that has not
proved itself is taken for a term.

A hello is hello(Process, Start, Address, Version, Word, Order): the random
id of the process, the number of this start of its endpoint, its listening
address, its Prolog version, word size and byte order.

*Threading*: no state. One thread owns the streams of a connection while
lines are exchanged.
*/

:- use_module(library(error), [syntax_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(frame, [check_bytes/2]).

:- setting(records, boolean, true,
           "Whether terms may travel as records; else always as text").

%!  hello(+Process, +Start, +Address, -Hello) is det.
%
%   Hello is what this process says of itself. Without records it claims
%   no byte order, which agrees with nobody's.

hello(Process, Start, Address,
      hello(Process, Start, Address, Version, Word, Order)) :-
    current_prolog_flag(version, Version),
    current_prolog_flag(address_bits, Word),
    byte_order(Order).

%   1.5 is 0x3ff8 and zeros: a record shows which end comes first. Beside
%   the order stands the check of these bytes, which must agree as well.

byte_order(none) :-
    setting(records, false),
    !.
byte_order(Order) :-
    fast_term_serialized(1.5, Bytes),
    check_bytes(Bytes, Check),
    (   sub_string(Bytes, _, _, _, "\xf8\\x3f\")
    ->  End = little
    ;   End = big
    ),
    atomic_list_concat([End, Check], '.', Order).

%!  hello_peer(+Hello, -Process, -Start, -Address) is det.
%
%   Who says Hello.

hello_peer(hello(Process, Start, Address, _, _, _), Process, Start, Address).

%!  hello_line(+Hello, -Line:string) is det.

hello_line(hello(Process, Start, Address, Version, Word, Order), Line) :-
    format(string(Line), "~w ~d ~w ~d ~d ~w",
           [Process, Start, Address, Version, Word, Order]).

%!  line_hello(+Line, -Hello) is det.
%
%   @error syntax_error(hello)

line_hello(Line, Hello) :-
    (   split_string(Line, " ", "", [P, S, A, V, W, O]),
        number_string(Start, S),
        number_string(Version, V),
        number_string(Word, W)
    ->  atom_string(Process, P),
        atom_string(Address, A),
        atom_string(Order, O),
        Hello = hello(Process, Start, Address, Version, Word, Order)
    ;   syntax_error(hello)
    ).

%!  hello_codec(+Hello, +PeerHello, -Codec) is det.
%
%   Codec is `fast` only where it is known to be safe, else `text`. It is
%   the same whichever of the two hellos is one's own.

hello_codec(hello(_, _, _, Version1, Word1, Order1),
            hello(_, _, _, Version2, Word2, Order2), Codec) :-
    (   Word1 == Word2,
        Order1 == Order2,
        Order1 \== none,
        one_record_format(Version1, Version2)
    ->  Codec = fast
    ;   Codec = text
    ).

one_record_format(Version, Version) :-
    !.
one_record_format(V1, V2) :-
    record_format(Low, High),
    between(Low, High, V1),
    between(Low, High, V2),
    !.

%   Versions First..Last read each other's records (tried both ways). 9.0.4
%   and 10.1.12 do not: of integers of 63 bits and more.

record_format(90000, 90299).

%!  line_read(+In, +Deadline, -Line:string) is det.
%
%   Read a line of at most 512 bytes before Deadline, a time stamp.
%
%   @error timeout_error(read, In)
%   @error syntax_error(line) it is too long
%   @error syntax_error(end_of_file)

line_read(In, Deadline, Line) :-
    line_codes(In, Deadline, 512, Codes),
    string_codes(Line, Codes).

line_codes(In, Deadline, Room, Codes) :-
    get_time(Now),
    Left is max(0.001, Deadline-Now),
    set_stream(In, timeout(Left)),
    get_byte(In, Byte),
    (   Byte == 0'\n
    ->  Codes = []
    ;   Byte == -1
    ->  syntax_error(end_of_file)
    ;   Room > 0
    ->  Codes = [Byte|More],
        Room1 is Room-1,
        line_codes(In, Deadline, Room1, More)
    ;   syntax_error(line)
    ).

%!  line_write(+Out, +Line) is det.

line_write(Out, Line) :-
    format(Out, "~w\n", [Line]),
    flush_output(Out).
