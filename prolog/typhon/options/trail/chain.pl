:- module(typhon_chain,
          [ chain_add/4,                % +Link, +Chain0, +Most, -Chain
            chain_links/2               % +Text, -Links
          ]).

/** <module> Links in one string

A string of links costs the same to carry, to keep and to pass on, however
many they are. Link(Text, Hex, C) is

    00000123Hex C Text

with the number of characters that follow the first eight. The oldest is the
first.

*Threading*: pure.
*/

%!  chain_add(+Link, +Chain0, +Most, -Chain) is semidet.
%
%   Chain is Count-Text: with Link there are Count0 of them; the oldest go
%   until there are no more than Most. Fails if there are not so many.

chain_add(link(Text, Hex, C), Count0-Chain0, Most, Count-Chain) :-
    format(string(Link), '~w ~d ~s', [Hex, C, Text]),
    string_length(Link, Length),
    format(string(Framed), '~`0t~d~8|~s', [Length, Link]),
    string_concat(Chain0, Framed, Chain1),
    newest(Count0, Most, Chain1, 0, Start, Count),
    sub_string(Chain1, Start, _, 0, Chain).

newest(Count, Most, _, Start, Start, Count) :-
    Count =< Most,
    !.
newest(Count0, Most, Chain, Start0, Start, Count) :-
    framed(Chain, Start0, _, Start1),
    Count1 is Count0-1,
    newest(Count1, Most, Chain, Start1, Start, Count).

%   framed(+Chain, +Start, -Link, -End): one that stands there.

framed(Chain, Start, Link, End) :-
    sub_string(Chain, Start, 8, _, Digits),
    number_string(Length, Digits),
    integer(Length),
    Length >= 0,
    Begin is Start+8,
    sub_string(Chain, Begin, Length, _, Link),
    End is Begin+Length.

%!  chain_links(+Text, -Links:list) is semidet.
%
%   The oldest first. Text may be anything: what comes where no link begins is
%   one of no signature, and it fails for what is no string.

chain_links(Chain, Links) :-
    string(Chain),
    string_length(Chain, Length),
    links(0, Length, Chain, Links).

links(End, End, _, []) :-
    !.
links(Start, End, Chain, [Link|Links]) :-
    framed(Chain, Start, Framed, Next),
    link(Framed, Link),
    !,
    links(Next, End, Chain, Links).
links(Start, _, Chain, [link(Rest, "", none)]) :-
    sub_string(Chain, Start, _, 0, Rest).

link(Framed, link(Text, Hex, C)) :-
    until_space(Framed, Hex, Numbered),
    until_space(Numbered, Digits, Text),
    number_string(C, Digits).

until_space(Text, Before, After) :-
    sub_string(Text, Length, _, Rest, " "),
    !,
    sub_string(Text, 0, Length, _, Before),
    sub_string(Text, _, Rest, 0, After).
