:- module(typhon_authors,
          [ signed_by/2                 % +Authors, +Hash
          ]).

/** <module> Whose programs are let in

A host with `authors(Names)` admits agents whose program one of these has
signed, wherever they come from.

*Threading*: any thread; no state.
*/

:- use_module('../program', [program_author/3]).
:- use_module('../wire', [endpoint_keys/1]).

%!  signed_by(+Authors:list, +Hash) is semidet.
%
%   One of Authors has signed the program of this Hash.

signed_by(Authors, Hash) :-
    endpoint_keys(Keys),
    program_author(Keys, Hash, Author),
    memberchk(Author, Authors),
    !.
