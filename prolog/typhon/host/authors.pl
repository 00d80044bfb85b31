:- module(typhon_authors,
          [ host_enter/4,               % +Name, +Hash, +Tokens, -Answer
            host_choosy/1,              % +Name
            host_signed/3               % +Name, +Hash, +Signature
          ]).

/** <module> Whose programs are let in

A host with `authors(Names)` admits agents whose program one of these has
signed, and their payloads, wherever they come from.

*Threading*: any thread; no state.
*/

:- use_module('../program', [program_author/3, signature_author/4]).
:- use_module('../wire', [endpoint_keys/1]).
:- use_module(hosts, [host_enter/3, host_option/2]).

%!  host_enter(+Name, +Hash, +Tokens, -Answer) is det.
%
%   As host_enter/3, for an agent whose program has this Hash; Answer may be
%   refused(unsigned).

host_enter(Name, Hash, Tokens, Answer) :-
    (   unsigned(Name, Hash)
    ->  Answer = refused(unsigned)
    ;   host_enter(Name, Tokens, Answer)
    ).

unsigned(Name, Hash) :-
    host_option(Name, authors(Authors)),
    \+ ( endpoint_keys(Keys),
         program_author(Keys, Hash, Author),
         memberchk(Author, Authors) ).

%!  host_choosy(+Name) is semidet.
%!  host_signed(+Name, +Hash, +Signature) is semidet.
%
%   Only what certain authors have signed is let in; Signature, which may be
%   anything, shows that for what has this Hash.

host_choosy(Name) :-
    host_option(Name, authors(_)).

host_signed(Name, Hash, Signature) :-
    host_option(Name, authors(Authors)),
    endpoint_keys(Keys),
    signature_author(Keys, Hash, Signature, Author),
    memberchk(Author, Authors).
