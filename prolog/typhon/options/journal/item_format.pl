:- module(typhon_item_format,
          [ format_current/2,           % -Version, -Sample
            format_must_be/3,           % +Place, +Version, +Sample
            bytes_sum/2                 % +Bytes, -Sum
          ]).
:- use_module(library(lists), [member/2]).

/** <module> The format of the items in a journal

*Threading*: any thread.
*/

%!  format_current(-Version, -Sample:atom) is det.
%!  format_must_be(+Place, +Version, +Sample) is det.
%
%   The journal at Place has this format, which is ours.  A process of another
%   version or word size must not read the items: any difference in their format
%   shows in the sample.
%
%   @error journal_version(Place, Version)

format_current(Version, Sample) :-
    format_version(Version),
    sample(Sample).

format_must_be(Place, Version0, Sample0) :-
    format_current(Version, Sample),
    (   Version0 == Version,
        Sample0 == Sample
    ->  true
    ;   throw(error(journal_version(Place, Version0), _))
    ).

format_version(1).

sample(Sample) :-
    Big is 1<<62,
    Huge is 1<<70,
    fast_term_serialized(f(X, X, -1, Big, Huge, 1.5, "text", [a]), Bytes),
    string_codes(Bytes, Codes),
    findall(Text, ( member(Code, Codes), format(atom(Text), '~16r.', [Code]) ),
            Texts),
    atomic_list_concat(Texts, Sample).

%!  bytes_sum(+Bytes:string, -Sum:integer) is det.
%
%   24 bits: term_hash/2 gives 24 or 32 bits in different versions, and the
%   integers of SQL drivers are signed.

bytes_sum(Bytes, Sum) :-
    term_hash(Bytes, Hash),
    Sum is Hash /\ 0xffffff.
