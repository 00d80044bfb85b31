:- module(typhon_fast_bytes,
          [ fast_bytes_term/2           % +Bytes, -Term
          ]).
:- use_module(library(error), [type_error/2]).

/** <module> Terms from their bytes

As fast_term_serialized/2, which is not safe with threads, on 9.0.4 and on
10.1: atoms that only the new term has are lost if another thread collects atoms
while it is made.  The collector walks the global stack from term to term, to
find atoms that are in use; where the new term is not complete yet there is what
was there before, of which some looks as if it were the head of something large,
and it goes on beyond the end.

Where there is nothing but unbound variables it walks on.

Bytes may say that a variable has attributes, such as a goal that runs when the
variable is bound.  No such term is read.

*Threading*: any thread.
*/

%!  fast_bytes_term(+Bytes, -Term) is det.
%
%   The inverse of fast_term_serialized/2.  Never call this on the bytes of
%   a peer that is not authenticated.
%
%   @error type_error(mobile_term, attributed_variable)

fast_bytes_term(Bytes, Term) :-
    words(Bytes, Words),
    cleared(Words),
    fast_term_serialized(Read, Bytes),
    (   term_attvars(Read, [])
    ->  Term = Read
    ;   type_error(mobile_term, attributed_variable)
    ).

%   words(+Bytes, -Words): the term takes so many on the global stack at most.
%   No byte makes more than one and a half; for large ones it is read from the
%   head, where it follows the kind and the number of bytes.

words(Bytes, Words) :-
    string_length(Bytes, Length),
    (   Length < 4096
    ->  Words is 2*Length
    ;   number_at(2, Bytes, 0, _, I),
        number_at(I, Bytes, 0, Words, _)
    ).

%   Seven bits a byte, the highest first; the last byte has no eighth bit.

number_at(I, Bytes, N0, N, End) :-
    string_code(I, Bytes, Code),
    N1 is N0<<7 \/ (Code /\ 0x7f),
    I1 is I+1,
    (   Code < 0x80
    ->  N = N1,
        End = I1
    ;   number_at(I1, Bytes, N1, N, End)
    ).

cleared(Words) :-
    functor(_, cleared, Words),
    fail.
cleared(_).
