:- module(typhon_authors,
          [ host_enter/4                % +Name, +Hash, +Tokens, -Answer
          ]).

/** <module> Whose programs are let in

A host with `authors(Names)` admits agents whose program one of these has
signed, wherever they come from.

*Threading*: any thread; no state.
*/

:- use_module('../program', [program_author/3]).
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
