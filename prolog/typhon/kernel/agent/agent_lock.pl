:- module(typhon_agent_lock,
          [ with_agent/2,               % +Id, :Goal
            agents_passed/0
          ]).

/** <module> A mutex for each agent

There are 64 mutexes: the id of an agent chooses one.

*Threading*: any thread.  Nothing inside with_agent/2 may block.
*/

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
%   A thread that was inside with_agent/2 when this was called has left it.

agents_passed :-
    forall(shard(_, Mutex), with_mutex(Mutex, true)).

:- dynamic shard/2.

%   A saved state has them already where it runs this again.

make_shards :-
    shard(_, _),
    !.
make_shards :-
    forall(between(0, 63, I),
           ( atom_concat(typhon_agents_, I, Mutex),
             assertz(shard(I, Mutex))
           )),
    compile_predicates([shard/2]).

:- initialization(make_shards, now).
