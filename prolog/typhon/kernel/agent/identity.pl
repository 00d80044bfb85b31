:- module(typhon_identity,
          [ agent_id/3,                 % +Name, +Home, -Id
            agent_name/3,               % +Id, -Name, -Number
            agent_owned/1,              % +Id
            agent_owned/2,              % +Id, +Owner
            agent_home/2,               % +Id, -Home
            agent_home_endpoint/2,      % +Id, -Endpoint
            origin_inherited/3          % +Id, +State0, -State
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [representation_error/1]).
:- use_module(library(lists), [append/3]).
:- use_module('../base/durable_changes', [durable_key/1, durable_on/0]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_keys/1, endpoint_own_proof/1]).
:- use_module('../host', [address_parts/3, time_repeats/2]).

/** <module> The ids of agents

An id is Name.Mark.Number@Home: from what the agent was made, the process,
the how manieth in it, and the address of the host on which it was born.
Where there are keys Mark ends with the name in the certificate of the
process, as in visitor.7k234tum-alpha.0@..: the owner of the agent, which has to
prove that, see typhon_birth.

*Threading*: any thread.
*/

%!  agent_id(+Name, +Home, -Id) is det.
%
%   A new id: unique among processes and restarts.
%
%   @error representation_error(agent_name): no journal could have it

agent_id(Name, Home, Id) :-
    flag(typhon_agent_id, N, N+1),
    process_mark(Mark),
    atomic_list_concat([Name, '.', Mark, N, '@', Home], Id),
    (   durable_on,
        \+ durable_key(Id)
    ->  representation_error(agent_name)
    ;   true
    ).

:- multifile
    ids_anew/0,                 % what is known of old ids is forgotten
    id_anew/1,                  % what is known of Id is
    typhon_durable:dump/4,
    typhon_runtime:beginning/1.

:- dynamic
    ids_anew/0,
    mark/1.

typhon_runtime:beginning(Kind) :-
    retractall(mark(_)),
    (   time_repeats(Kind, Mark)
    ->  flag(typhon_agent_id, _, 0),
        assertz(mark(Mark)),
        forall(ids_anew, true)
    ;   true
    ).

typhon_durable:dump(flag, typhon_agent_id, N, '') :-
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
    owner_part(Owner),
    format(atom(Mark), '~36r~w.', [Y, Owner]),
    assertz(mark(Mark)).

owner_part(Part) :-
    endpoint_keys(_),
    endpoint_own_proof(certificate(Name)),
    !,
    spelt(Name, Spelt),
    atom_concat(-, Spelt, Part).
owner_part('').

%   spelt(+Name, -Spelt): what could be mistaken for another part of an id
%   is written as a number.

spelt(Name, Spelt) :-
    atom_codes(Name, Codes),
    foldl(spelt_code, Codes, Parts, []),
    atomic_list_concat(Parts, Spelt).

spelt_code(Code, [Part|Parts], Parts) :-
    (   Code < 128,
        ( code_type(Code, csym) ; Code =:= 0'- )
    ->  char_code(Part, Code)
    ;   format(atom(Part), '!~16r!', [Code])
    ).

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

%!  agent_owned(+Id) is semidet.
%!  agent_owned(+Id, +Owner) is semidet.
%
%   Id says that it belongs to us; to the process with the certificate of that
%   name.

agent_owned(Id) :-
    endpoint_own_proof(certificate(Own)),
    agent_owned(Id, Own).

agent_owned(Id, Owner) :-
    sub_atom(Id, Before, _, _, '@'),
    !,
    sub_atom(Id, 0, Before, _, Local),
    atomic_list_concat(Parts, '.', Local),
    append(_, [Mark, _], Parts),
    !,
    sub_atom(Mark, _, _, After, -),
    !,
    sub_atom(Mark, _, After, 0, Said),
    spelt(Owner, Said).

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

%!  origin_inherited(+Id, +State0, -State) is det.
%
%   State0 is that of Id, which stands here, State that of a clone of it.  The
%   id of the clone will say that it was born here: where Id was born, if
%   elsewhere, is a fact among its state.

origin_inherited(Id, State, State) :-
    State = state(_, Clauses),
    (   memberchk('$owner'(_), Clauses)
    ;   agent_home_endpoint(Id, Home),
        endpoint_address(Home)
    ),
    !.
origin_inherited(Id, state(Empty, Clauses),
                 state(Empty, ['$owner'(home(Home))|Clauses])) :-
    agent_home_endpoint(Id, Home).
