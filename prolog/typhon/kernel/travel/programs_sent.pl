:- module(typhon_programs_sent,
          [ program_sent/3,             % +Endpoint, +Hash, -Sent
            program_missing/2           % +Endpoint, +Hash
          ]).
:- use_module('../program', [code_sent/2]).
:- use_module('../wire', []).

/** <module> Which programs were sent to which process

A program is sent to processes that lack it as far as we know.

*Threading*: any thread.
*/

:- multifile typhon_endpoint:connection/2.

:- dynamic has_program/2.       % Endpoint, Hash: was sent there

%!  program_sent(+Endpoint, +Hash, -Sent) is det.
%!  program_missing(+Endpoint, +Hash) is det.
%
%   Sent is what goes to Endpoint with an agent of that program: as of
%   code_sent/2, or `known`. The process lacks the program after all.

program_sent(Endpoint, Hash, known) :-
    has_program(Endpoint, Hash),
    !.
program_sent(Endpoint, Hash, Sent) :-
    code_sent(Hash, Sent),
    bound_programs,
    assertz(has_program(Endpoint, Hash)).

program_missing(Endpoint, Hash) :-
    retractall(has_program(Endpoint, Hash)).

%   What is forgotten is sent once more.

most_programs(10000).

bound_programs :-
    predicate_property(has_program(_, _), number_of_clauses(Count)),
    most_programs(Most),
    Count > Most,
    !,
    retractall(has_program(_, _)).
bound_programs.

typhon_endpoint:connection(Endpoint, down) :-
    retractall(has_program(Endpoint, _)).
