:- module(typhon_agents,
          [ agent/5,                    % ?Id, ?Host, ?Module, ?Hash, ?Life
            agent_status/3,             % ?Id, ?Status, ?Goals
            agent_module/5,             % +Id, +Place, +Hash, +State, -Module
            agent_enter/5,              % +Id, +Host, +Module, +Hash, +Life
            agent_remove/1,             % +Id
            agent_state/2,              % +Module, -State
            agent_put_life/2,           % +Id, +Life
            agent_put/3,                % +Id, +Status, +Goals
            agent_take/2,               % +Id, -Goals
            agent_departs/3,            % +Id, -Dest, -Goals
            agent_ready/2,              % +Id, +Goals
            with_agent/2,               % +Id, :Goal
            agent_mail/2,               % +Id, +Message
            agent_order/2,              % +Id, +Order
            agent_next_order/2,         % +Id, -Order
            agent_all_orders/2,         % +Id, -Orders
            agent_ordered/1,            % +Id
            agent_id/3,                 % +Name, +Home, -Id
            agent_home/2,               % +Id, -Home
            agent_name/3,               % +Id, -Name, -Number
            agent_handles/2,            % +Module, +Hash
            attach_clauses/3,           % +Module, +Hash, +Payload
            detach_clauses/2            % +Module, +PIs
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(apply), [maplist/2]).
:- use_module('../program', [code_module/2]).
:- use_module('../host', [schedule/2]).
:- use_module(mailbox, [mail_all/2, mail_put/2]).

/** <module> Agents that stand in this process

The records of agents, each with one owner: this module.  An agent is

  - a module of its name with its state: everything dynamic in it.  Its
    program is found through the import chain, see typhon_code and typhon_place;
  - a life(Parent, Hops, Lifetime, Tokens, Payloads, Static);
  - a status, one of `ready`, `running`, sleeping(Until),
    waiting(Pattern, Until), `resident`, `obeying`, leaving(Host, At),
    transit(Host, Sent), cloning(Host, Sent) or faulty(Error), with
    the goals still to run.  While a control predicate is under way the
    goals are Hole-Goals, see typhon_machine;
  - a mailbox, see typhon_mailbox, and orders from outside.

Changes of the database are what a hop costs most of.  So an agent that
runs has no status at all: whoever removes `ready` has it.

The tables must be asked by id, or by atoms: an index on compound terms,
which Prolog makes by itself, is not safe where other threads retract
(9.0.4 aborts in deleteActiveClauseFromBucket).

*Threading*: what changes a record runs inside with_agent/2, which holds
one of 64 mutexes, chosen by the agent.  Nothing inside it may block.
*/

:- meta_predicate with_agent(+, 0).

:- multifile typhon_code:in_use/1.

:- dynamic
    agent/5,                    % Id, Host, Module, Hash, Life
    status/3,                   % Id, Status, Goals; none: it runs
    order/2.                    % Id, Order

%!  agent(?Id, ?Host, ?Module, ?Hash, ?Life) is nondet.
%
%   The agents of this process: where they stand, the module of their
%   state, the hash of their program, and their life.

typhon_code:in_use(Hash) :-
    agent(_, _, _, Hash, _),
    !.

%!  with_agent(+Id, :Goal) is semidet.
%
%   Run Goal once while no other thread changes the record of Id.

with_agent(Id, Goal) :-
    term_hash(Id, Hash),
    I is Hash /\ 63,
    shard(I, Mutex),
    with_mutex(Mutex, Goal).

:- dynamic shard/2.

make_shards :-
    forall(between(0, 63, I),
           ( atom_concat(typhon_agents_, I, Mutex),
             assertz(shard(I, Mutex))
           )),
    compile_predicates([shard/2]).

:- initialization(make_shards, now).

                /*******************************
                *           IDENTITY           *
                *******************************/

%!  agent_id(+Name, +Home, -Id) is det.
%
%   A new id: unique among processes and restarts.

agent_id(Name, Home, Id) :-
    flag(typhon_agent_id, N, N+1),
    process_mark(Mark),
    atomic_list_concat([Name, '.', Mark, N, '@', Home], Id).

:- dynamic mark/1.

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

%!  agent_home(+Id, -Home) is semidet.
%
%   Home is the address of the host on which Id was born.

agent_home(Id, Home) :-
    atom(Id),
    sub_atom(Id, B, _, _, '@'),
    !,
    B1 is B+1,
    sub_atom(Id, B1, _, 0, Home).

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

                /*******************************
                *       MODULES AND STATE      *
                *******************************/

%!  agent_module(+Id, +Place, +Hash, +State, -Module) is det.
%!  agent_enter(+Id, +Host, +Module, +Hash, +Life) is det.
%
%   Make a module with the state of an agent, and then its record; status and
%   goals come separately.  What is wrong with the state is found by the
%   former, which leaves nothing behind.
%
%   @arg State is state(Empty, Clauses): what is dynamic without having
%        clauses, and the clauses of all else.
%   @error what assertz/1 raises

agent_module(Id, Place, Hash, state(Empty, Clauses), Module) :-
    free_module(Id, Module),
    code_module(Hash, Program),
    set_module(Module:class(temporary)),
    set_module(Module:base(Program)),
    add_import_module(Module, Place, end),
    catch(( declare_all(Empty, Module),
            add_clauses(Clauses, Module) ),
          error(Formal, Context),
          ( '$destroy_module'(Module),
            throw(error(Formal, Context)) )).

%   A copy that waits for the end of its hop has a module already.

free_module(Id, Module) :-
    (   agent(Id, _, Id, _, _)
    ->  atom_concat(Id, ' again', Module)
    ;   Module = Id
    ).

agent_enter(Id, Host, Module, Hash, Life) :-
    assertz(agent(Id, Host, Module, Hash, Life)).

declare_all([], _).
declare_all([PI|PIs], Module) :-
    dynamic(Module:PI),
    declare_all(PIs, Module).

add_clauses([], _).
add_clauses([Clause|Clauses], Module) :-
    assertz(Module:Clause),
    add_clauses(Clauses, Module).

%!  agent_state(+Module, -State) is det.

agent_state(Module, state(Empty, Clauses)) :-
    findall(Item, state_item(Module, Item), Items),
    split(Items, Empty, Clauses).

%   The internal forms of predicate_property/2, which is ten times slower.

state_item(Module, Item) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    (   '$get_predicate_attribute'(Module:Head, number_of_clauses, N),
        N > 0
    ->  clause(Module:Head, Body),
        (   Body == true
        ->  Item = Head
        ;   Item = (Head:-Body)
        )
    ;   functor(Head, Name, Arity),
        Item = (:- dynamic(Name/Arity))
    ).

split([], [], []).
split([Item|Items], Empty, Clauses) :-
    (   Item = (:- dynamic(PI))
    ->  Empty = [PI|Empty1],
        split(Items, Empty1, Clauses)
    ;   Clauses = [Item|Clauses1],
        split(Items, Empty, Clauses1)
    ).

%!  agent_remove(+Id) is semidet.
%
%   Forget the record of Id.  Its mailbox goes, too.

agent_remove(Id) :-
    retract(agent(Id, _, Module, _, _)),
    retractall(status(Id, _, _)),
    mail_all(Id, _),
    retractall(order(Id, _)),
    '$destroy_module'(Module).

%!  agent_handles(+Module, +Hash) is semidet.
%
%   True if the agent has a handler for messages.

agent_handles(Module, Hash) :-
    code_module(Hash, Program),
    (   '$c_current_predicate'(_, Program:on_message(_,_))
    ->  true
    ;   predicate_property(Module:on_message(_,_), number_of_clauses(N)),
        N > 0
    ).

%!  attach_clauses(+Module, +Hash, +Payload) is det.
%
%   @error permission_error(attach, procedure, PI) if the agent has a
%          predicate of that name already

attach_clauses(Module, Hash, payload(_, PIs, Clauses)) :-
    code_module(Hash, Program),
    maplist(free(Module, Program), PIs),
    declare_all(PIs, Module),
    add_clauses(Clauses, Module).

free(Module, Program, Name/Arity) :-
    functor(Head, Name, Arity),
    (   (   '$c_current_predicate'(_, Program:Head),
            \+ predicate_property(Program:Head, imported_from(_))
        ;   '$c_current_predicate'(_, Module:Head),
            predicate_property(Module:Head, dynamic)
        )
    ->  permission_error(attach, procedure, Name/Arity)
    ;   true
    ).

%!  detach_clauses(+Module, +PIs) is det.

detach_clauses(Module, PIs) :-
    forall(member(PI, PIs), abolish(Module:PI)).

                /*******************************
                *            STATUS            *
                *******************************/

%!  agent_status(?Id, ?Status, ?Goals) is nondet.

agent_status(Id, Status, Goals) :-
    status(Id, Status, Goals).
agent_status(Id, running, []) :-
    agent(Id, _, _, _, _),
    \+ status(Id, _, _).

%!  agent_put(+Id, +Status, +Goals) is det.

agent_put(Id, Status, Goals) :-
    retractall(status(Id, _, _)),
    assertz(status(Id, Status, Goals)).

%!  agent_take(+Id, -Goals) is semidet.
%
%   Id, which is ready, runs from now on.

agent_take(Id, Goals) :-
    retract(status(Id, ready, Goals)),
    !.

%!  agent_departs(+Id, -Dest, -Goals) is semidet.
%
%   Id, which was leaving for Dest, belongs to the caller from now on: an
%   order from outside can no longer end it.

agent_departs(Id, Dest, Goals) :-
    retract(status(Id, leaving(Dest, _), Goals)),
    !.

%!  agent_ready(+Id, +Goals) is det.
%
%   Id goes on with Goals when its turn comes.

agent_ready(Id, Goals) :-
    agent_put(Id, ready, Goals),
    agent(Id, Host, _, _, _),
    !,
    schedule(Host, Id).

%!  agent_put_life(+Id, +Life) is det.

agent_put_life(Id, Life) :-
    retract(agent(Id, Host, Module, Hash, _)),
    !,
    assertz(agent(Id, Host, Module, Hash, Life)).

                /*******************************
                *       MAIL AND ORDERS        *
                *******************************/

%!  agent_mail(+Id, +Message) is det.
%
%   Put Message in the mailbox and wake the agent if it waits for it.

agent_mail(Id, Message) :-
    mail_put(Id, Message),
    (   status(Id, Status, Goals),
        wakes(Status, Message)
    ->  agent_ready(Id, Goals)
    ;   true
    ).

wakes(resident, _).
wakes(waiting(Pattern, _), Message) :-
    \+ Pattern \= Message.

%!  agent_order(+Id, +Order) is det.
%!  agent_next_order(+Id, -Order) is semidet.
%!  agent_all_orders(+Id, -Orders:list) is det.
%!  agent_ordered(+Id) is semidet.

agent_order(Id, Order) :-
    assertz(order(Id, Order)).

agent_next_order(Id, Order) :-
    retract(order(Id, Order)),
    !.

%   One by one: see typhon_mailbox.

agent_all_orders(Id, Orders) :-
    (   agent_next_order(Id, Order)
    ->  Orders = [Order|More],
        agent_all_orders(Id, More)
    ;   Orders = []
    ).

agent_ordered(Id) :-
    order(Id, _),
    !.
