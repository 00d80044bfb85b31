:- module(typhon_authors,
          [ signed_by/2,                % +Authors, +Hash
            signature_by/3              % +Authors, +Hash, +Signature
          ]).

/** <module> Whose programs are let in

A host with `authors(Names)` admits agents whose program one of these has
signed, and their payloads, wherever they come from.

*Threading*: any thread; no state.
*/

:- use_module('../program', [program_author/3, signature_author/4]).
:- use_module('../wire', [endpoint_keys/1]).

%!  signed_by(+Authors:list, +Hash) is semidet.
%
%   One of Authors has signed the program of this Hash.

signed_by(Authors, Hash) :-
    endpoint_keys(Keys),
    program_author(Keys, Hash, Author),
    memberchk(Author, Authors),
    !.

%!  signature_by(+Authors:list, +Hash, +Signature) is semidet.
%
%   Signature, which may be anything, is one by one of Authors for what has
%   this Hash.

signature_by(Authors, Hash, Signature) :-
    endpoint_keys(Keys),
    signature_author(Keys, Hash, Signature, Author),
    memberchk(Author, Authors),
    !.
