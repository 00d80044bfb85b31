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

%!  chain_add(+Link, +Chain0, +Most, -Chain) is det.
%
%   Chain is Count-Text: with Link there are Count0 of them; the oldest go
%   until there are no more than Most.

chain_add(link(Text, Hex, C), Count0-Chain0, Most, Count-Chain) :-
    format(string(Link), '~w ~d ~s', [Hex, C, Text]),
    string_length(Link, Length),
    format(string(Framed), '~`0t~d~8|~s', [Length, Link]),
    string_concat(Chain0, Framed, Chain1),
    shortened(Count0, Most, Chain1, Count, Chain).

shortened(Count, Most, Chain, Count, Chain) :-
    Count =< Most,
    !.
shortened(Count0, Most, Chain0, Count, Chain) :-
    parted(Chain0, _, Chain1),
    Count1 is Count0-1,
    shortened(Count1, Most, Chain1, Count, Chain).

parted(Chain, Link, Rest) :-
    sub_string(Chain, 0, 8, _, Digits),
    number_string(Length, Digits),
    sub_string(Chain, 8, Length, After, Link),
    sub_string(Chain, _, After, 0, Rest).

%!  chain_links(+Text, -Links:list) is semidet.
%
%   The oldest first. Text may be anything.

chain_links("", []) :-
    !.
chain_links(Chain, [link(Text, Hex, C)|Links]) :-
    string(Chain),
    catch(parted(Chain, Link, Rest), error(_, _), fail),
    sub_string(Link, Before1, _, After1, " "),
    !,
    sub_string(Link, 0, Before1, _, Hex),
    sub_string(Link, _, After1, 0, Numbered),
    sub_string(Numbered, Before2, _, After2, " "),
    !,
    sub_string(Numbered, 0, Before2, _, Digits),
    number_string(C, Digits),
    sub_string(Numbered, _, After2, 0, Text),
    chain_links(Rest, Links).
