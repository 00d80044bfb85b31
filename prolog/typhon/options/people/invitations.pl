:- module(typhon_invitations,
          [ invite/3,                   % +Host, +Seconds, -Token
            invited/3,                  % +Token, -Host, -Seconds
            uninvite/1                  % +Host
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../../kernel/base/durable',
              [durable/5, durable_assertz/1, durable_retractall/1]).
:- use_module('../../kernel/wire', [random_hex/2]).

/** <module> Tokens by which a person comes to a host

A token is valid for one host, until a date; a host has one at most.  Only the
hash of a token is kept, also in journals and saved networks, from which nobody
can find the token.

*Threading*: any thread; a mutex serialises changes.
*/

:- dynamic invitation/3.                % Hash, Host, Until: as in get_time/1

:- durable(invitation, Hash, 0, Host-Until, invitation(Hash, Host, Until)).

%!  invite(+Host, +Seconds, -Token:atom) is det.
%!  uninvite(+Host) is det.
%
%   Token, of 128 random bits, is valid for Seconds, and replaces an earlier
%   token for Host; no token is valid for Host any more.

invite(Host, Seconds, Token) :-
    random_hex(16, Token),
    hash(Token, Hash),
    get_time(Now),
    Until is Now+Seconds,
    with_mutex(typhon_invitations,
               ( withdraw(Host),
                 durable_assertz(invitation(Hash, Host, Until)) )).

uninvite(Host) :-
    with_mutex(typhon_invitations, withdraw(Host)).

withdraw(Host) :-
    findall(Hash, invitation(Hash, Host, _), Hashes),
    forall(member(Hash, Hashes),
           durable_retractall(invitation(Hash, _, _))).

%!  invited(+Token:atom, -Host, -Seconds) is semidet.
%
%   Token is valid for Host, and for Seconds from now on.  The comparison is one
%   of hashes, so its time tells nothing about valid tokens.

invited(Token, Host, Seconds) :-
    hash(Token, Hash),
    invitation(Hash, Host, Until),
    !,
    get_time(Now),
    Seconds is Until-Now,
    Seconds > 0.

hash(Token, Hash) :-
    sha_hash(Token, Bytes, [algorithm(sha256), encoding(utf8)]),
    hash_atom(Bytes, Hash).
