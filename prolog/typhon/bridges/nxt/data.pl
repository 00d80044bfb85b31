:- module(typhon_nxt_data,
          [ bytes_hex/2,                % +Bytes, -Hex
            hex_bytes/2,                % +Hex, -Bytes
            nxt_text/2                  % +Length, +Text
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).

/** <module> Bytes and names as the helper takes them

*Threading*: any thread.
*/

%!  bytes_hex(+Bytes:list, -Hex:atom) is det.
%!  hex_bytes(+Hex:atom, -Bytes:list) is det.
%
%   Hex are the two hexadecimal digits of each byte.

bytes_hex(Bytes, Hex) :-
    must_be(list(between(0, 255)), Bytes),
    foldl(byte_hex, Bytes, Codes, []),
    atom_codes(Hex, Codes).

byte_hex(Byte, Codes, Rest) :-
    format(codes(Codes, Rest), '~|~`0t~16r~2+', [Byte]).

hex_bytes(Hex, Bytes) :-
    atom_codes(Hex, Codes),
    phrase(bytes(Bytes), Codes).

bytes([Byte|Bytes]) -->
    [High,Low],
    !,
    { code_type(High, xdigit(H)),
      code_type(Low, xdigit(L)),
      Byte is H*16+L
    },
    bytes(Bytes).
bytes([]) -->
    [].

%!  nxt_text(+Length:integer, +Text) is det.
%
%   @error domain_error(nxt_text(Length), Text) if Text is not an atom of 1
%          to Length ASCII characters

nxt_text(Length, Text) :-
    must_be(atom, Text),
    atom_codes(Text, Codes),
    length(Codes, Long),
    (   between(1, Length, Long),
        forall(member(Code, Codes), between(1, 127, Code))
    ->  true
    ;   domain_error(nxt_text(Length), Text)
    ).
