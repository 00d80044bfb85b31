:- module(typhon_item_key,
          [ journal_key/1,              % +Key
            journal_key/2               % +Key, +N
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(uri), [uri_encoded/3]).

/** <module> Under what an item can be kept

An item that the database does not take would be tried for ever, and with it
all that comes after.  What others choose, as the ids of their agents, is looked
at before it is noted.

*Threading*: pure.
*/

%!  journal_key(+Key) is semidet.
%!  journal_key(+Key, +N) is semidet.
%
%   Items can have this key, of so many characters that an index of PostgreSQL
%   takes it; and this number. Key and N may be anything.

journal_key(Key) :-
    atom(Key),
    atom_length(Key, Length),
    Length =< 500,
    is_text(Key).

journal_key(Key, N) :-
    integer(N),
    N >= -(1<<63),
    N < 1<<63,
    journal_key(Key).

%   No code of a character is 0, or half of one of UTF-16. Of what a URI takes as
%   it is that is known at once.

is_text(Key) :-
    uri_encoded(fragment, Key, Encoded),
    Encoded == Key,
    !.
is_text(Key) :-
    atom_codes(Key, Codes),
    \+ ( member(Code, Codes), ( Code =:= 0 ; between(0xd800, 0xdfff, Code) ) ).
