:- module(typhon_authors,
          [ signature_by/3              % +Authors, +Hash, +Signature
          ]).

/** <module> Whose programs are let in

A host with `authors(Names)` admits agents whose program one of these has
signed, and their payloads, wherever they come from.

*Threading*: any thread; no state.
*/

:- use_module(library(error), [existence_error/2]).
:- use_module('../program', [program_author/3, signature_author/4]).
:- use_module('../wire', [endpoint_keys/1]).
:- use_module(hosts, [host_option/2]).

:- multifile
    typhon_host_parts:begins/3,
    typhon_host_parts:changeable/1,
    typhon_host_parts:part/4.

%   Without an authority no signature is valid.

typhon_host_parts:begins(_, _, Options) :-
    (   \+ memberchk(authors(_), Options)
    ->  true
    ;   endpoint_keys(_)
    ->  true
    ;   existence_error(host_option, tls)
    ).

typhon_host_parts:changeable(authors(_)).

typhon_host_parts:part(admit_program, Host, 70, typhon_authors:forbids) :-
    host_option(Host, authors(_)).

:- public forbids/4.

%   The signature may come with the program.

forbids(From, entrant(_, Hash, _, _, _), Host, Verdict) :-
    host_option(Host, authors(Authors)),
    \+ signed_by(Authors, Hash),
    (   From = from(_, known, _)
    ->  Verdict = need_program
    ;   Verdict = refused(unsigned)
    ).

%   signed_by(+Authors, +Hash): one of Authors has signed that program.

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
