:- module(typhon_frame,
          [ frame_write/2,              % +Out, +Bytes
            frame_read/3,               % +In, +MaxBytes, -Bytes
            term_bytes/3,               % +Codec, +Term, -Bytes
            bytes_term/3,               % +Codec, +Bytes, -Term
            mobile_term/1               % +Term
          ]).

/** <module> Frames: terms as counted bytes

A frame is a big-endian four-byte length and that many bytes. Bytes are
a string of codes 0..255, the body of one term in one of two codecs:

  - `fast` is the internal record format. It is only for peers of one
    word size, byte order and a tried range of versions: a record of
    another word size does not raise, it aborts the process.
  - `text` is canonical text in UTF-8, independent of the operators and
    flags of both sides.

_Threading_: no state; every predicate may be called from any thread. The
owner of a stream sees to it that one thread at a time writes to it.
*/

:- use_module(library(error), [resource_error/1, syntax_error/1,
                               type_error/2]).
:- use_module(text, [term_text/2, text_term/2]).

%!  frame_write(+Out, +Bytes) is det.
%
%   Write one frame to the binary stream Out. Does not flush.

frame_write(Out, Bytes) :-
    string_length(Bytes, Length),
    B3 is (Length>>24) /\ 255,
    B2 is (Length>>16) /\ 255,
    B1 is (Length>>8) /\ 255,
    B0 is Length /\ 255,
    put_byte(Out, B3),
    put_byte(Out, B2),
    put_byte(Out, B1),
    put_byte(Out, B0),
    write(Out, Bytes).

%!  frame_read(+In, +MaxBytes, -Bytes) is det.
%
%   Read one frame. Bytes is `end_of_file` when In ends where a frame
%   would begin.
%
%   @error syntax_error(truncated_frame) In ends inside the frame.
%   @error resource_error(frame_bytes) the frame is longer than MaxBytes.

frame_read(In, MaxBytes, Bytes) :-
    get_byte(In, B3),
    (   B3 == -1
    ->  Bytes = end_of_file
    ;   get_byte(In, B2),
        get_byte(In, B1),
        get_byte(In, B0),
        (   B0 == -1
        ->  syntax_error(truncated_frame)
        ;   Length is B3<<24 \/ B2<<16 \/ B1<<8 \/ B0,
            frame_body(In, Length, MaxBytes, Bytes)
        )
    ).

frame_body(_, Length, MaxBytes, _) :-
    Length > MaxBytes,
    !,
    resource_error(frame_bytes).
frame_body(In, Length, _, Bytes) :-
    read_string(In, Length, Bytes),
    (   string_length(Bytes, Length)
    ->  true
    ;   syntax_error(truncated_frame)
    ).

%!  term_bytes(+Codec, +Term, -Bytes) is det.
%
%   Bytes are Term in Codec, `fast` or `text`.
%
%   @error type_error(mobile_term, Culprit) as mobile_term/1. The codec
%   `fast` only notices blobs: ask mobile_term/1 about foreign terms.

term_bytes(fast, Term, Bytes) :-
    (   serialized(Term, Bytes)
    ->  true
    ;   refuse(Term)
    ).
term_bytes(text, Term, Bytes) :-
    mobile_term(Term),
    term_text(Term, Bytes).

serialized(Term, Bytes) :-
    catch(fast_term_serialized(Term, Bytes),
          error(permission_error(_, _, _), _),
          fail).

%!  bytes_term(+Codec, +Bytes, -Term) is det.
%
%   The inverse of term_bytes/3. Never call this on the bytes of somebody
%   who has not proved himself.
%
%   @error syntax_error(Message) the text is damaged.

bytes_term(fast, Bytes, Term) :-
    fast_term_serialized(Term, Bytes).
bytes_term(text, Bytes, Term) :-
    text_term(Bytes, Term).

%!  mobile_term(+Term) is det.
%
%   True when Term can travel.
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
    (   culprit(Term, Culprit)
    ->  type_error(mobile_term, Culprit)
    ;   type_error(mobile_term, Term)
    ).

culprit(Term, Term) :-
    cyclic_term(Term),
    !.
culprit(Term, Term) :-
    attvar(Term),
    !.
culprit(Term, Term) :-
    blob(Term, Type),
    Type \== text,
    Type \== reserved_symbol,
    !.
culprit(Term, Culprit) :-
    compound(Term),
    compound_name_arguments(Term, _, Args),
    member_culprit(Args, Culprit).

member_culprit([Arg|Args], Culprit) :-
    (   culprit(Arg, Culprit0)
    ->  Culprit = Culprit0
    ;   member_culprit(Args, Culprit)
    ).
