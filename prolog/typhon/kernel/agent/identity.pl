:- module(typhon_identity,
          [ with_agent/2,               % +Id, :Goal
            agents_passed/0,
            agent_id/3,                 % +Name, +Home, -Id
            agent_name/3,               % +Id, -Name, -Number
            agent_home/2,               % +Id, -Home
            agent_home_endpoint/2,      % +Id, -Endpoint
            agent_origin/5,             % +Host, +Id, +Hash, +State, -Origin
            origin_key/2,               % +Origin, -Key
            origin_said/2,              % +State, -Origin
            origin_inherited/3,         % +Id, +State0, -State
            origin_passed/4             % +Parent, +Endpoint, +State0, -State
          ]).
:- use_module(library(error), [representation_error/1]).
:- use_module(library(lists), [append/3]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../base/durable', [durable/6, durable_key/2, durable_on/0]).
:- use_module('../wire', [endpoint_address/1]).
:- use_module('../host', [time_repeats/2]).

/** <module> The ids of agents, and their mutexes

An id is Name.Mark.Number@Home: the name from which the agent was made, a mark
of the process, the number of the agent in it, and the address of the host on
which it was born.  An option may add to Mark a means by which the process can
prove that the agent is its own, as in visitor.7k234tum-alpha.0@..

The origin of an agent, which no agent can choose, is

  - home(Endpoint): the process in which the agent, or the agent of which it is
    a clone, was born
  - another term, which an option defines

If the id does not show the origin, the state of the agent has a fact
'$owner'(Origin), which travels with it.  A guarded agent cannot access this
fact.

There are 64 mutexes: the id of an agent selects its mutex.

*Threading*: any thread.  A goal inside with_agent/2 must not block.
*/

%!  agent_id(+Name, +Home, -Id) is det.
%
%   A new id: unique among processes and restarts.
%
%   @error representation_error(agent_name) if the id cannot be a journal key

agent_id(Name, Home, Id) :-
    flag(typhon_agent_id, N, N+1),
    process_mark(Mark),
    atomic_list_concat([Name, '.', Mark, N, '@', Home], Id),
    (   durable_on,
        \+ durable_key(Id, 0)
    ->  representation_error(agent_name)
    ;   true
    ).

:- multifile
    ids_anew/0,                 % ids repeat: discard all data on old ids
    id_anew/1,                  % Id repeats: discard all data on it
    mark_suffix/1,              % Suffix: of the marks of this process
    origin/4,                   % Host, Hash, State, Origin: other than its home
    typhon_runtime:beginning/1.

:- dynamic mark/1.

typhon_runtime:beginning(Kind) :-
    retractall(mark(_)),
    (   time_repeats(Kind, Mark)
    ->  flag(typhon_agent_id, _, 0),
        assertz(mark(Mark)),
        forall(ids_anew, true)
    ;   true
    ).

:- durable(flag, Name, N, '', ( Name = typhon_agent_id, flag(Name, N, N) ),
           set_flag(Name, N)).

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
    monotonic_time(Now),
    Y is X xor truncate(Now*1000000) /\ (1<<40-1),
    ( mark_suffix(Suffix) -> true ; Suffix = '' ),
    format(atom(Mark), '~36r~w.', [Y, Suffix]),
    assertz(mark(Mark)).

%!  agent_name(+Id, -Name:atom, -Number:integer) is det.
%
%   Id was made from Name, as agent number Number of its process.

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
%
%   Home is the address of the host on which Id was born.

agent_home(Id, Home) :-
    atom(Id),
    sub_atom(Id, B, _, _, '@'),
    !,
    B1 is B+1,
    sub_atom(Id, B1, _, 0, Home).

%!  agent_home_endpoint(+Id, -Endpoint) is semidet.
%
%   Endpoint is that of the process in which Id was born.

agent_home_endpoint(Id, Endpoint) :-
    atom(Id),
    atomic_list_concat([_, Name, Endpoint], '@', Id),
    Name \== '',
    Endpoint \== ''.

%!  agent_origin(+Host, +Id, +Hash, +State, -Origin) is semidet.
%
%   Origin is the origin of the agent Id on Host.  Hash is that of its program,
%   State as in agent_state/2, or module(Module).

agent_origin(Host, _, Hash, State, Origin) :-
    origin(Host, Hash, State, Origin),
    !.
agent_origin(_, _, _, State, home(Endpoint)) :-
    origin_said(State, Origin),
    subsumes_term(home(_), Origin),
    Origin = home(Endpoint),
    atom(Endpoint),
    !.
agent_origin(_, Id, _, _, home(Endpoint)) :-
    agent_home_endpoint(Id, Endpoint).

%!  origin_key(+Origin, -Key:atom) is det.
%
%   Key names Origin in tables.

origin_key(Origin, Key) :-
    Origin =.. Parts,
    atomic_list_concat(Parts, ' ', Key).

%!  origin_said(+State, -Origin) is semidet.
%
%   State has a fact with that Origin, which may be any term.

origin_said(module(Module), Origin) :-
    '$c_current_predicate'(_, Module:'$owner'(_)),
    Module:'$owner'(Origin).
origin_said(state(_, Clauses), Origin) :-
    memberchk('$owner'(Origin), Clauses).

%!  origin_inherited(+Id, +State0, -State) is det.
%
%   State0 is the state of Id, an agent of this process; State is that of a
%   clone.  The id of the clone will name this process as its home, so if Id was
%   born elsewhere, State has a fact with its home.

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

%!  origin_passed(+Parent, +Endpoint, +State0, -State) is det.
%
%   State is the state of an agent that Parent, Id-Module, creates at Endpoint.
%   The new agent has the origin of Parent.

origin_passed(_-Module, _, state(PIs, Clauses),
              state(PIs, ['$owner'(Origin)|Clauses])) :-
    origin_said(module(Module), Origin),
    !.
origin_passed(Id-_, Endpoint, State, State) :-
    agent_home_endpoint(Id, Endpoint),
    !.
origin_passed(Id-_, _, state(PIs, Clauses),
              state(PIs, ['$owner'(home(Home))|Clauses])) :-
    agent_home_endpoint(Id, Home).

                /*******************************
                *            MUTEXES           *
                *******************************/

:- meta_predicate with_agent(+, 0).

%!  with_agent(+Id, :Goal) is semidet.
%
%   Run Goal once while no other thread changes the record of Id.

with_agent(Id, Goal) :-
    term_hash(Id, Hash),
    I is Hash /\ 63,
    shard(I, Mutex),
    with_mutex(Mutex, Goal).

%!  agents_passed is det.
%
%   Wait until each thread that is inside with_agent/2 now has left it.

agents_passed :-
    forall(shard(_, Mutex), with_mutex(Mutex, true)).

%   shard(-I, -Mutex)

term_expansion(shards, Shards) :-
    findall(shard(I, Mutex),
            ( between(0, 63, I), atom_concat(typhon_agents_, I, Mutex) ),
            Shards).

shards.
