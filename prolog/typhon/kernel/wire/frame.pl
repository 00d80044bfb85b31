:- module(typhon_frame,
          [ frame_write/3,              % +Out, +Counts, +Bytes
            frame_read/5,               % +In, +MaxBytes, :Meanwhile, -Counts,
                                        % -Bytes
            frame_overhead/1,           % ?Bytes
            count_ahead/3,              % +Counted, +Count, -Ahead
            term_bytes/3,               % +Codec, +Term, -Bytes
            bytes_term/3,               % +Codec, +Bytes, -Term
            bytes_mark/2,               % +Bytes, -Mark
            check_bytes/2,              % +Bytes, -Check
            mobile_term/1,              % +Term
            bundle_fits/1,              % +Bytes
            bundle_next/5,              % +Queue, +Codec, +Space, -Frame, -Many
            bundle_parts/2              % +Bundle, -Parts
          ]).

/** <module> Frames: terms as counted bytes

A frame is a head of fifteen bytes and a body. The head has, big-endian, the
length of the body in four bytes, a check in three, and two counts of four
bytes each, counts(Received, Settled): how many frames of the other side this
side has received, and how many of them are settled, see window.pl. Counts
wrap around. A frame without body carries only its counts.

The body is a string of codes 0..255, one term in one of two codecs:

  - `fast` is the internal record format. It is only for peers of one
    word size, byte order and a tested range of versions: a record of
    another word size does not raise an error, it aborts the process.
  - `text` is canonical text in UTF-8, independent of the operators and
    flags of both sides.

The check detects damage of body and counts in transit before the bytes are
decoded, because a damaged record also aborts the process. It proves nothing
about the sender.

A request or answer that the other side may be unable to decode, a long one or
any text, has a mark with its number before the body: so no caller waits for an
answer that could not be read.

Writing, reading, checking and keeping a small frame costs more than its
content. So up to a hundred of the frames that wait, frame(Bytes, Token,
Settled), become one, bundle(Parts), if they are posts, whose Token is `loose`.

*Threading*: no state; every predicate may be called from any thread. The
owner of a stream ensures that one thread at a time writes to it; the mutex
of the session guards a queue of bundles.
*/

:- use_module(library(error),
              [resource_error/1, syntax_error/1, type_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(sha), [sha_hash/3]).
:- use_module('../base/prolog_faults', [fast_bytes_term/2]).
:- use_module('../base/text', [term_text/2, text_term/2]).
:- use_module('../base/error_text', [is_in_itself/1]).

%!  frame_write(+Out, +Counts, +Bytes) is det.
%
%   Write one frame to the binary stream Out, which is not flushed.

frame_write(Out, counts(Received, Settled), Bytes) :-
    string_length(Bytes, Length),
    R is Received /\ 0xffffffff,
    S is Settled /\ 0xffffffff,
    frame_check(Bytes, R, S, Check),
    L3 is Length>>24, L2 is (Length>>16) /\ 255,
    L1 is (Length>>8) /\ 255, L0 is Length /\ 255,
    C2 is Check>>16, C1 is (Check>>8) /\ 255, C0 is Check /\ 255,
    R3 is R>>24, R2 is (R>>16) /\ 255, R1 is (R>>8) /\ 255, R0 is R /\ 255,
    S3 is S>>24, S2 is (S>>16) /\ 255, S1 is (S>>8) /\ 255, S0 is S /\ 255,
    string_codes(Head, [ L3,L2,L1,L0, C2,C1,C0, R3,R2,R1,R0, S3,S2,S1,S0 ]),
    write(Out, Head),
    write(Out, Bytes).

%   A change of any bit of the counts changes the 24 bits of the check.

frame_check(Bytes, R, S, Check) :-
    check_bytes(Bytes, Hash),
    Check is (Hash + 7919*(R + R>>19) + 104729*(S + S>>19)) /\ 0xffffff.

%!  frame_overhead(?Bytes) is det.
%
%   The length of the head of a frame.

frame_overhead(15).

%!  count_ahead(+Counted, +Count, -Ahead) is semidet.
%
%   Count, as read in a head, is Ahead frames more than Counted; fails if it is
%   less, as in a frame that was written long ago.

count_ahead(Counted, Count, Ahead) :-
    Ahead is (Count-Counted) /\ 0xffffffff,
    Ahead < 0x80000000.

%!  frame_read(+In, +MaxBytes, :Meanwhile, -Counts, -Bytes) is det.
%
%   Read one frame. Bytes is `end_of_file` when In ends where a frame
%   would begin. Meanwhile is called after each 64 kB of a longer frame.
%
%   @error syntax_error(truncated_frame) if In ends inside the frame
%   @error syntax_error(damaged_frame) if the check does not match the bytes;
%   the context is check(Read, Found), and In is at the next frame
%   @error resource_error(frame_bytes) if the frame is longer than MaxBytes

:- meta_predicate
    frame_read(+, +, 0, -, -),
    body_parts(+, +, 0, -).

frame_read(In, MaxBytes, Meanwhile, Counts, Bytes) :-
    read_string(In, 15, Head),
    (   string_codes(Head, [ L3,L2,L1,L0, C2,C1,C0, R3,R2,R1,R0,
                             S3,S2,S1,S0 ])
    ->  Length is L3<<24 \/ L2<<16 \/ L1<<8 \/ L0,
        frame_body(Length, In, MaxBytes, Meanwhile, Bytes),
        R is R3<<24 \/ R2<<16 \/ R1<<8 \/ R0,
        S is S3<<24 \/ S2<<16 \/ S1<<8 \/ S0,
        Counts = counts(R, S),
        Check is C2<<16 \/ C1<<8 \/ C0,
        frame_check(Bytes, R, S, Found),
        (   Found =:= Check
        ->  true
        ;   throw(error(syntax_error(damaged_frame), check(Check, Found)))
        )
    ;   Head == ""
    ->  Bytes = end_of_file
    ;   syntax_error(truncated_frame)
    ).

frame_body(Length, _, MaxBytes, _, _) :-
    Length > MaxBytes,
    !,
    resource_error(frame_bytes).
frame_body(Length, In, _, _, Bytes) :-
    Length =< 65536,
    !,
    body_part(In, Length, Bytes).
frame_body(Length, In, _, Meanwhile, Bytes) :-
    body_parts(Length, In, Meanwhile, Parts),
    atomics_to_string(Parts, Bytes).

body_parts(0, _, _, []) :-
    !.
body_parts(Length, In, Meanwhile, [Part|Parts]) :-
    Size is min(Length, 65536),
    body_part(In, Size, Part),
    call(Meanwhile),
    Left is Length-Size,
    body_parts(Left, In, Meanwhile, Parts).

body_part(In, Length, Part) :-
    read_string(In, Length, Part),
    (   string_length(Part, Length)
    ->  true
    ;   syntax_error(truncated_frame)
    ).

%!  check_bytes(+Bytes, -Check) is det.
%
%   Check is an integer of 24 bits.  For a record it is the cheapest hash, which
%   is the same for all peers that may exchange records, see byte_order/1 in
%   handshake.pl; for a text it is the same everywhere.

check_bytes(Bytes, Check) :-
    (   string_code(1, Bytes, 0'#)      % a text
    ->  sha_hash(Bytes, [C2, C1, C0|_], [encoding(octet)]),
        Check is C2<<16 \/ C1<<8 \/ C0
    ;   term_hash(Bytes, Hash),         % of 24 bits or, since 9.1, of 32
        Check is Hash /\ 0xffffff
    ).

%!  term_bytes(+Codec, +Term, -Bytes) is det.
%
%   Bytes are Term in Codec, `fast` or `text`.
%
%   @error type_error(mobile_term, Culprit) as mobile_term/1. The codec
%   `fast` detects only blobs: test foreign terms with mobile_term/1 first.

term_bytes(fast, Term, Bytes) :-
    rational(Term),
    \+ integer(Term),
    !,                                  % 10.1.12 decodes 1r3 as 3
    term_bytes(text, Term, Bytes).
term_bytes(fast, Term, Bytes) :-
    serialized(Term, Body),
    !,
    (   string_length(Body, Length),
        Length > 65536
    ->  marked(0'!, Term, Body, Bytes)
    ;   Bytes = Body
    ).
term_bytes(fast, Term, _) :-
    refuse(Term).
term_bytes(text, Term, Bytes) :-
    mobile_term(Term),
    term_text(Term, Body),
    marked(0'#, Term, Body, Bytes).

serialized(Term, Bytes) :-
    catch(fast_term_serialized(Term, Bytes),
          error(permission_error(_, _, _), _),
          fail).

%!  bytes_term(+Codec, +Bytes, -Term) is det.
%
%   The inverse of term_bytes/3. Never call this on the bytes of a peer
%   that has not proved itself.
%
%   @error syntax_error(Message) if the text is damaged

bytes_term(fast, Bytes, Term) :-
    (   string_code(1, Bytes, Mark)
    ->  marked_term(Mark, Bytes, Term)
    ;   fast_bytes_term(Bytes, Term)
    ).
bytes_term(text, Bytes, Term) :-
    marked_term(0'#, Bytes, Term).

marked_term(0'!, Bytes, Term) :-
    !,
    unmarked(Bytes, Body),
    fast_bytes_term(Body, Term).
marked_term(0'#, Bytes, Term) :-
    !,
    unmarked(Bytes, Body),
    text_term(Body, Term).
marked_term(_, Bytes, Term) :-
    fast_bytes_term(Bytes, Term).

		 /*******************************
		 *             MARKS            *
		 *******************************/

%   A mark is `#` before text, `!` before a record, as no record begins with
%   either; then the kind of the term, and its number in eighteen digits.

marked(Code, Term, Body, Bytes) :-
    term_mark(Term, Kind, Id),
    format(string(Mark), "~c~w~`0t~d~20|", [Code, Kind, Id]),
    string_concat(Mark, Body, Bytes).

term_mark(request(Id, _, _), ?, Id) :-
    integer(Id),
    !.
term_mark(answer(Id, _), =, Id) :-
    integer(Id),
    !.
term_mark(_, -, 0).

unmarked(Bytes, Body) :-
    (   sub_string(Bytes, 20, _, 0, Body0)
    ->  Body = Body0
    ;   syntax_error(mark)
    ).

%!  bytes_mark(+Bytes, -Mark) is semidet.
%
%   Mark is request(Id) or answer(Id), if Bytes are marked so.

bytes_mark(Bytes, Mark) :-
    sub_string(Bytes, 0, 20, _, Text),
    string_code(1, Text, Code),
    memberchk(Code, `#!`),
    sub_atom(Text, 1, 1, _, Kind),
    mark_kind(Kind, Id, Mark),
    sub_string(Text, 2, 18, 0, Digits),
    number_string(Id, Digits),
    integer(Id).

mark_kind(?, Id, request(Id)).
mark_kind(=, Id, answer(Id)).

		 /*******************************
			 *        MOBILE TERMS          *
		 *******************************/

%!  mobile_term(+Term) is det.
%
%   Term can be sent to another process.
%
%   @error type_error(mobile_term, Culprit) for a stream or another blob,
%   an attributed variable, or a cyclic term inside Term.

mobile_term(Term) :-
    (   acyclic_term(Term),
        term_attvars(Term, []),
        serialized(Term, _)
    ->  true
    ;   refuse(Term)
    ).

refuse(Term) :-
    once(( culprit(Term, Culprit) ; Culprit = Term )),
    type_error(mobile_term, Culprit).

%   A term is searched for cycles in time proportional to its size: so parts of
%   a tree are not.

culprit(Term, Term) :-
    is_in_itself(Term),
    !.
culprit(Term, Culprit) :-
    cyclic_term(Term),
    !,
    arg(_, Term, Arg),
    culprit(Arg, Culprit),
    !.
culprit(Term, Culprit) :-
    tree_culprit(Term, Culprit).

tree_culprit(Term, Term) :-
    attvar(Term),
    !.
tree_culprit(Term, Term) :-
    blob(Term, Type),
    Type \== text,
    Type \== reserved_symbol,
    !.
tree_culprit(Term, Culprit) :-
    compound(Term),
    arg(_, Term, Arg),
    tree_culprit(Arg, Culprit),
    !.

		 /*******************************
		 *            BUNDLES           *
		 *******************************/

%   A bundle is smaller than the space for frames under way, see window.pl.

longest_part(512).
most_parts(100).
part_overhead(16).

%!  bundle_fits(+Bytes) is semidet.
%
%   Bytes may be part of a bundle.

bundle_fits(Bytes) :-
    string_length(Bytes, Length),
    longest_part(Most),
    Length =< Most.

%!  bundle_next(+Queue, +Codec, +Space, -Frame, -Many) is semidet.
%
%   Take the next Frame of Queue, frame(Bytes, Token, Settled): fails if there
%   is none, or if it is longer than Space, a number of bytes.  Many is `true` if
%   it is a bundle.

bundle_next(Queue, Codec, Space, Frame, Many) :-
    thread_peek_message(Queue, Next),
    arg(1, Next, Bytes),
    string_length(Bytes, Length),
    Length =< Space,
    !,
    next(Next, Queue, Codec, Space, Frame, Many).

next(frame(_, loose, _), Queue, Codec, Space, Frame, Many) :-
    !,
    most_parts(Most),
    parts(Most, Space, Queue, 0, Parts, Settled),
    bundled(Parts, Codec, Settled, Frame, Many).
next(Frame, Queue, _, _, Frame, false) :-
    thread_get_message(Queue, _).

bundled([Bytes], _, Settled, frame(Bytes, none, Settled), false) :-
    !.
bundled(Parts, Codec, Settled, frame(Bytes, none, Settled), true) :-
    term_bytes(Codec, bundle(Parts), Bytes).

%   Settled is that of the last part: all frames put before it have been sent by
%   then.

parts(Most, Space0, Queue, Settled0, Parts, Settled) :-
    (   Most > 0,
        thread_peek_message(Queue, Next),
        Next = frame(Part, loose, Settled1),
        string_length(Part, Length),
        Length =< Space0
    ->  thread_get_message(Queue, _),
        Parts = [Part|More],
        part_overhead(Overhead),
        Space is Space0-Length-Overhead,
        Most1 is Most-1,
        parts(Most1, Space, Queue, Settled1, More, Settled)
    ;   Parts = [],
        Settled = Settled0
    ).

%!  bundle_parts(+Bundle, -Parts:list) is semidet.
%
%   Fails if Bundle is malformed: a peer may send any term as a bundle.

bundle_parts(bundle(Parts), Parts) :-
    is_list(Parts),
    \+ ( member(Part, Parts),
         \+ string(Part) ).
