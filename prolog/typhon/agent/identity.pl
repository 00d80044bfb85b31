:- module(typhon_identity,
          [ agent_id/3,                 % +Name, +Home, -Id
            agent_name/3,               % +Id, -Name, -Number
            agent_home/2,               % +Id, -Home
            agent_home_endpoint/2       % +Id, -Endpoint
          ]).
:- use_module(library(lists), [append/3]).
:- use_module('../host', [address_parts/3]).

/** <module> The ids of agents

An id is Name.Mark.Number@Home: from what the agent was made, the process,
the how manieth in it, and the address of the host on which it was born.

*Threading*: any thread.
*/

%!  agent_id(+Name, +Home, -Id) is det.
%
%   A new id: unique among processes and restarts.

agent_id(Name, Home, Id) :-
    flag(typhon_agent_id, N, N+1),
    process_mark(Mark),
    atomic_list_concat([Name, '.', Mark, N, '@', Home], Id).

:- multifile
    ids_anew/0,                 % what is known of old ids is forgotten
    id_anew/1,                  % what is known of Id is
    typhon_recovery:kept/4,
    typhon_runtime:beginning/1.

:- dynamic
    ids_anew/0,
    mark/1.

%   In virtual time the same ids come again.

typhon_runtime:beginning(real) :-
    retractall(mark(_)).
typhon_runtime:beginning(virtual) :-
    flag(typhon_agent_id, _, 0),
    retractall(mark(_)),
    assertz(mark('v.')),
    forall(ids_anew, true).

typhon_recovery:kept(flag, typhon_agent_id, N, '') :-
    flag(typhon_agent_id, N, N).

process_mark(Mark) :-
    mark(Mark),
    !.
process_mark(Mark) :-
    with_mutex(typhon_mark, make_mark),
    mark(Mark).

make_mark :-
    mark(_),
    !.
make_mark :-
    X is random(1<<40),
    get_time(Now),
    Y is X xor truncate(Now*1000000) /\ (1<<40-1),
    format(atom(Mark), '~36r.', [Y]),
    assertz(mark(Mark)).

%!  agent_name(+Id, -Name:atom, -Number:integer) is det.
%
%   Id was made from Name, as the one of that Number in its process.

agent_name(Id, Name, Number) :-
    sub_atom(Id, Before, _, _, '@'),
    !,
    sub_atom(Id, 0, Before, _, Local),
    atomic_list_concat(Parts, '.', Local),
    append(NameParts, [_Mark, Last], Parts),
    !,
    atomic_list_concat(NameParts, '.', Name),
    atom_number(Last, Number).

%!  agent_home(+Id, -Home) is semidet.
%!  agent_home_endpoint(+Id, -Endpoint) is semidet.
%
%   Home is the address of the host on which Id was born, Endpoint that of
%   its process.

agent_home(Id, Home) :-
    atom(Id),
    sub_atom(Id, B, _, _, '@'),
    !,
    B1 is B+1,
    sub_atom(Id, B1, _, 0, Home).

agent_home_endpoint(Id, Endpoint) :-
    agent_home(Id, Home),
    address_parts(Home, _, Endpoint).
