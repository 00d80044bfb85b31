:- module(typhon_creation,
          [ agent_create/2,             % +Program, -Agent
            agent_create/3,             % +Program, -Agent, +Options
            agent_create_by/4,          % +Parent, +Program, -Agent, +Options
            agent_begin/4,              % +Options, +Name, +Start, -Agent
            agent_clone_here/3,         % +Id, +Goals, ?CloneId
            clone_id/2,                 % +Id, -CloneId
            not_static/2                % +Clauses, +PI
          ]).

/** <module> Creating agents

An agent is created from a program or a restore point, in this process or
another, which gets its description.

An agent begins from a program, from a restore point, or as the clone of another
agent.  Its description is

    start(Hash, Life, State, Goals, Mail)

*Threading*: any thread; the reader threads of the endpoint create agents that
other processes order.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [must_be/2, permission_error/3, type_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- autoload(library(occurs), [sub_term/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../agent',
              [ agent/5, agent_build/5, agent_code/2, agent_enter/3,
                agent_handles/2, agent_home/2, agent_id/3, agent_mail/2,
                agent_name/3, agent_ready/2, agent_rest/3, agent_state/2,
                gate/4, gate_refused/4, is_life/1, life_clone/3, mail_count/2,
                make_life/5, no_result_facts/2, origin_inherited/3,
                origin_passed/4, with_agent/2 ]).
:- use_module('../base/durable', [sync_after/1, unit_of_work/1]).
:- use_module('../base/names', [must_be_name/2]).
:- use_module('../base/on_demand', [on_demand_call/3]).
:- use_module('../base/options', [check_options/2]).
:- use_module('../host',
              [ amended/5, event/4, host/3, host_address/2, host_resolve/2,
                host_unknown/1, process_ask/6 ]).
:- use_module('../program',
              [ clause_parts/3, code_install/3, code_locate/2, code_program/2,
                code_sent/2, program_load/6 ]).
:- use_module('../travel', [agent_born/2, clone_born/2]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_later/1, endpoint_reply/2,
                mobile_term/1 ]).
:- use_module(questions, [agent_met/1]).

:- multifile
    first_goal/3,                       % Options, Parent, Goal: the first goal
    typhon_options:declared/4,
    typhon_endpoint:requested/4,
    typhon_programs:unknown/3,
    at_birth/2.                         % Goal, Id: carry out Goal, the first goal of
                                        % Id, which does not run it

:- public
    create_answered/6.                  % goal of a worker

%!  agent_create(+Program, -Agent) is det.
%!  agent_create(+Program, -Agent, +Options) is det.
%
%   Create an agent.  Program is a file specification, such as agents(census),
%   or clauses(Terms), the terms as in a file.  Options:
%
%     - name(+Atom): the id is made from it; default that of the program
%     - host(+Host): the host, also of another process, or any(Tags), see
%       host_resolve/2; default the first host of this process
%     - tokens(+List): tokens for hosts that ask for one
%     - payloads(+Specs): attached from the start
%     - facts(+Clauses): added to its initial state, which its program, or
%       one of the payloads, declares
%     - lifetime(+Hops): its next move after these many hops disposes of it
%     - static(+Boolean): whether it may not move
%
%   @error uninstantiation_error(Agent): use name(Atom) to name the agent
%   @error existence_error(host, Host)
%   @error existence_error(state, PI, Declared): facts of a predicate that is
%   not among the Declared ones
%   @error permission_error(attach, payload, Name),
%   permission_error(attach, procedure, PI): there is already a payload of that
%   name, or a predicate that one provides
%   @error move_refused(Host, Reason), host_unreachable(Host)
%   @error any problem of the program, see typhon_programs
%   @error representation_error(agent_name): the journal cannot store the name

agent_create(Program, Agent) :-
    agent_create(Program, Agent, []).

agent_create(Spec, Agent, Options) :-
    agent_create_by(none, Spec, Agent, Options).

%!  agent_create_by(+Parent, +Program, -Agent, +Options) is det.
%
%   As agent_create/3, for the agent Parent, which runs here, or for `none`.
%   Program may be `self`: the program of Parent, with the state
%   facts(Clauses).  The default host is that of Parent.  Agent has the owner
%   of Parent.
%
%   @error as agent_create/3

agent_create_by(Parent, Spec, Agent, Options) :-
    must_be(var, Agent),
    check_options(agent_option, Options),
    once(create_by(Options, Parent, Spec, Agent)).

create_by(Options, Parent, Spec, Agent) :-
    target(Options, Parent, Target),
    program_of(Spec, Parent, Program, Initial, Hash),
    Program = program(Name0, Declared, _, Clauses),
    option(name(Name), Options, Name0),
    must_be_name(agent_name, Name),
    birth(Options, Declared, Initial, Clauses, Life, State0),
    mobile_term(State0),
    from_parent(Parent, Target, State0, State),
    start_goals(Clauses, Initial, Goals0),
    findall(Goal, first_goal(Options, Parent, Goal), Goals, Goals0),
    State = state(PIs, _),
    Offered = typhon_creation:may_be_offered(Target, Clauses),
    forall(typhon_programs:unknown(Hash, PIs, Offered), true),
    create(Target, Name, start(Hash, Life, State, Goals, []), Agent).

program_of(Spec, Parent, Program, [], Hash) :-
    Spec == self,
    agent(Parent, _, _, Hash, _),
    !,
    code_program(Hash, Program).
program_of(Spec, _, Program, Initial, Hash) :-
    program_load(Spec, Program, Initial, Hash, Kinds, Places),
    code_install(Hash, Program, Kinds),
    code_locate(Hash, Places).

from_parent(none, _, State, State) :-
    !.
from_parent(Parent, Target, State0, State) :-
    agent(Parent, _, Module, _, _),
    ( Target = remote(_, _, Endpoint) ; endpoint_address(Endpoint) ),
    !,
    origin_passed(Parent-Module, Endpoint, State0, State).

%   may_be_offered(+Target, +Clauses, +Problem) is semidet: the predicate of
%   Problem, which the program with these Clauses calls and which no code known
%   here defines, may exist all the same.  A place of this process defines it;
%   or, if no other name looks similar, the target host in another process, or a
%   payload that the program attaches, may define it.

may_be_offered(_, _, problem(unknown_procedure(Name/Arity), _, _)) :-
    functor(Head, Name, Arity),
    host(_, _, Place),
    '$get_predicate_attribute'(Place:Head, defined, 1),
    !.
may_be_offered(Target, Clauses, problem(_, _, offered([]))) :-
    ( Target = remote(_, _, _) ; attaches(Clauses) ),
    !.

attaches(Clauses) :-
    member((_:-Body), Clauses),
    sub_term(Goal, Body),
    subsumes_term(attach(_), Goal),
    !.

typhon_options:declared(agent_option, name(X), atom, X).
typhon_options:declared(agent_option, host(X), atom, X).
typhon_options:declared(agent_option, host(X), host_description, X).
typhon_options:declared(agent_option, tokens(X), list, X).
typhon_options:declared(agent_option, payloads(X), list, X).
typhon_options:declared(agent_option, facts(X), list, X).
typhon_options:declared(agent_option, lifetime(X), nonneg, X).
typhon_options:declared(agent_option, lifetime(X), oneof([inf]), X).
typhon_options:declared(agent_option, static(X), boolean, X).

target(Options, Parent, Where) :-
    (   option(host(Host), Options)
    ->  host_resolve(Host, Where)
    ;   agent(Parent, Host, _, _, _)
    ->  Where = local(Host)
    ;   host(Name, _, _)
    ->  Where = local(Name)
    ;   throw(error(existence_error(host, here),
                    context(agent_create/3,
                            'start one with host_start/1')))
    ).

birth(Options, Declared, Initial, Clauses, Life,
      state(PIs, StateClauses)) :-
    option(tokens(Tokens), Options, []),
    option(lifetime(Lifetime), Options, inf),
    option(static(Static), Options, false),
    option(facts(Facts), Options, []),
    option(payloads(Specs), Options, []),
    append(Initial, Facts, StateClauses0),
    with_payloads(Specs, Clauses, []-(Declared-StateClauses0),
                  Payloads-(PIs-StateClauses)),
    maplist(initial_fact(Clauses, PIs), Facts),
    make_life(Lifetime, Tokens, Payloads, Static, Life).

with_payloads([], _, State, State) :-
    !.
with_payloads(Specs, Clauses, State0, State) :-
    on_demand_call(payload, any,
                   typhon_payloads:payloads_added(Specs, Clauses, State0,
                                                  State)).

initial_fact(Clauses, PIs, Fact) :-
    clause_parts(Fact, Head, _),
    must_be(callable, Head),
    functor(Head, Name, Arity),
    not_static(Clauses, Name/Arity),
    (   memberchk(Name/Arity, PIs)
    ->  true
    ;   throw(error(existence_error(state, Name/Arity, PIs), _))
    ).

%!  not_static(+Clauses, +PI) is det.
%
%   @error permission_error(attach, procedure, PI) if PI has a clause among
%          Clauses, those of a program

not_static(Clauses, Name/Arity) :-
    functor(General, Name, Arity),
    (   member(Clause, Clauses),
        clause_parts(Clause, General, _)
    ->  permission_error(attach, procedure, Name/Arity)
    ;   true
    ).

start_goals(Clauses, Initial, Goals) :-
    (   member(All, [Clauses,Initial]),
        member(Clause, [main,(main:-_)]),
        memberchk(Clause, All)
    ->  Goals = [main]
    ;   Goals = []
    ).

                /*******************************
                *       HERE OR ELSEWHERE      *
                *******************************/

create(local(Host), Name, Start, Agent) :-
    agent_begins(Host, Name, Start, here, Answer),
    begun_agent(Answer, Host, Agent).
create(remote(Address, HostName, Endpoint), Name, Start, Agent) :-
    Start = start(Hash, _, _, _, _),
    code_sent(Hash, Program),
    process_ask(Endpoint, Address, agent,
                create(HostName, Name, Start, Program), Answer, 10),
    begun_agent(Answer, Address, Agent),
    agent_met(Agent).

typhon_endpoint:requested(agent, create(HostName, Name, Start, Program), Peer,
                          ReplyTo) :-
    Answers = typhon_creation:create_answered(HostName, Name, Start, Program,
                                              Peer, ReplyTo),
    (   \+ begins_at_once(Start),
        endpoint_later(Answers)
    ->  true
    ;   call(Answers)
    ).

create_answered(HostName, Name, Start, Program, Peer, ReplyTo) :-
    From = from(Peer, Program, newborn),
    catch(create_for(From, HostName, Name, Start, Answer),
          error(Formal, _),
          ( gate_refused(HostName, From, malformed, error(Formal)),
            Answer = refused(error(Formal)) )),
    endpoint_reply(ReplyTo, Answer).

create_for(From, HostName, Name, start(Hash, Life, State0, Goals, Mail),
           Answer) :-
    must_be_name(agent_name, Name),
    must_be_life(Life),
    must_be_state(State0),
    must_be(list, Goals),
    must_be(list, Mail),
    arg(1, From, Peer),
    (   atom(HostName)
    ->  amended(created, HostName, Peer, State0, State)
    ;   State = State0
    ),
    agent_begins(HostName, Name, start(Hash, Life, State, Goals, Mail), From,
                 Answer).

must_be_life(Life) :-
    (   is_life(Life)
    ->  true
    ;   type_error(agent_life, Life)
    ).

must_be_state(State) :-
    (   subsumes_term(state(_, _), State),
        arg(2, State, Clauses),
        is_list(Clauses)
    ->  true
    ;   type_error(agent_state, State)
    ).

%!  agent_begin(+Options, +Name, +Start, -Agent) is det.
%
%   Create an agent on the host that Options name, as in agent_create/3.

agent_begin(Options, Name, Start, Agent) :-
    target(Options, none, Where),
    create(Where, Name, Start, Agent).

                /*******************************
                *          BEGINNING           *
                *******************************/

:- '$clausable'(at_birth/2).

%   agent_begins(+Host, +Name, +Start, +From, -Answer): An agent begins on
%   Host, a host of this process. Answer is created(Id), or another verdict of
%   gate/4.

agent_begins(Host, Name, Start, From, Answer) :-
    sync_after(unit_of_work(started(Host, Name, Start, From, none, _,
                                    Answer))).

%   begins_at_once(@Start): no goal of the agent is for the hook at_birth/2,
%   which may load code. Start may come from a peer.

begins_at_once(Start) :-
    \+ ( subsumes_term(start(_, _, _, [_,_|_], _), Start),
         arg(4, Start, [Goal|_]),
         callable(Goal),
         clause(at_birth(Goal, _), _) ).

%!  begun_agent(+Answer, +Host, -Agent) is det.
%
%   Agent is that of Answer, of agent_begins/5 on Host, a name or an address.
%
%   @error move_refused(Address, Reason), existence_error(host, Address)

begun_agent(created(Id), _, Id) :-
    !.
begun_agent(Answer, Host, _) :-
    host_address(Host, Address),
    not_begun(Answer, Address).

not_begun(need_program, Address) :-
    throw(error(move_refused(Address, need_program), _)).
not_begun(refused(unknown_host), Address) :-
    host_unknown(Address).
not_begun(refused(Reason), Address) :-
    throw(error(move_refused(Address, Reason), _)).

%!  agent_clone_here(+Id, +Goals, ?CloneId) is det.
%
%   Create a clone of Id on the same host, with Goals to run.  CloneId may be
%   one of clone_id/2.
%
%   @error move_refused(Host, Reason)

agent_clone_here(Id, Goals, CloneId) :-
    agent(Id, Host, Module, Hash, Life0),
    agent_state(Module, State0),
    no_result_facts(State0, State1),
    amended(cloned, Host, Id, State1, State2),
    origin_inherited(Id, State2, State),
    life_clone(Id, Life0, Life),
    agent_name(Id, Name, _),
    started(Host, Name, start(Hash, Life, State, Goals, []), here, Id, CloneId,
            Answer),
    begun_agent(Answer, Host, CloneId),
    event(hops, Host, Id, cloned(CloneId)).

%!  clone_id(+Id, -CloneId) is det.

clone_id(Id, CloneId) :-
    agent(Id, Host, _, _, _),
    host(Host, Address, _),
    agent_name(Id, Name, _),
    agent_id(Name, Address, CloneId).

%   started(+Host, +Name, +Start, +From, +Parent, ?Id, -Answer): as
%   agent_begins/5, without the unit of work.  Parent is `none`, or the agent of
%   which Id is a clone.

started(Host, Name, Start, From, Parent, Id, Answer) :-
    Start = start(Hash, Life, State, _, Mail),
    gate(Host, From-entrant(Name, Hash, Life, State, Mail),
         install(Host, Name, Start, Id, Goals), Verdict),
    (   Verdict == ok
    ->  Answer = created(Id),
        start_agent(Host, Id, Goals, Parent)
    ;   Answer = Verdict
    ).

install(Host, Name, Start, Id, Goals, Verdict) :-
    (   host(Host, Address, Place)
    ->  ( nonvar(Id) -> true ; agent_id(Name, Address, Id) ),
        (   with_agent(Id, install(Id, Host, Place, Start, Goals))
        ->  Verdict = ok
        ;   Verdict = need_program      % it was evicted meanwhile
        )
    ;   Verdict = refused(unknown_host) % the host is stopping
    ).

install(Id, Host, Place, start(Hash, Life, State, Goals0, Mail), Goals) :-
    agent_build(Id, Place, Hash, State-Goals0, Module-Goals),
    agent_enter(agent(Id, Host, Module, Hash, Life), arriving, []),
    agent_mail(Id, Mail).

start_agent(Host, Id, Goals0, Parent) :-
    agent_home(Id, Address),
    agent_born(Id, Address),
    record_clone(Parent, Id),
    do_birth_goals(Goals0, Id, Goals),
    event(life, Host, Id, created),
    debug(typhon(agent), '~w: created on ~w', [Id, Address]),
    with_agent(Id, begin(Goals, Id)).

%   Goals of at_birth/2 are done before orders can move the agent.

do_birth_goals([Goal|Goals0], Id, Goals) :-
    callable(Goal),
    at_birth(Goal, Id),
    !,
    do_birth_goals(Goals0, Id, Goals).
do_birth_goals(Goals, _, Goals).

%   A clone is recorded before it runs and can have clones of its own.

record_clone(none, _) :-
    !.
record_clone(Parent, Id) :-
    clone_born(Parent, Id).

%   An agent that only handles messages is resident from the start.

begin([], Id) :-
    agent(Id, _, Module, _, _),
    agent_code(Module, Program),
    agent_handles(Program, Module),
    mail_count(Id, 0),
    !,
    agent_rest(Id, resident, []).
begin(Goals, Id) :-
    agent_ready(Id, Goals).
