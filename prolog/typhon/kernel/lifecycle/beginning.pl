:- module(typhon_beginning,
          [ agent_begins/5,             % +Host, +Name, +Start, +From, -Answer
            begins_at_once/1,           % @Start
            begun_agent/3,              % +Answer, +Host, -Agent
            agent_clone_here/3,         % +Id, +Goals, ?CloneId
            clone_id/2                  % +Id, -CloneId
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module('../base/durable', [sync_changes/0, unit_of_work/1]).
:- use_module('../host',
              [ amended/5, event/4, host/3, host_address/2, host_unknown/1 ]).
:- use_module('../agent',
              [ agent/5, agent_build/5, agent_code/2, agent_enter/3, agent_handles/2,
                agent_home/2, agent_id/3, agent_mail/2, agent_name/3,
                agent_ready/2, agent_rest/3, agent_state/2, gate/4,
                life_clone/3, mail_count/2, no_result_facts/2,
                origin_inherited/3, with_agent/2 ]).
:- use_module('../travel', [agent_born/2, clone_born/2]).

/** <module> How agents begin on a host of this process

An agent begins from a program, from a restore point, or as the clone of another
agent.  Its description is

    start(Hash, Life, State, Goals, Mail)

*Threading*: any thread; the reader threads of the endpoint for agents that
other processes order.
*/

:- multifile at_birth/2.        % Goal, Id: carry out Goal, the first goal of
                                % Id, which does not run it
:- '$clausable'(at_birth/2).

%!  agent_begins(+Host, +Name, +Start, +From, -Answer) is det.
%
%   An agent begins on Host, a host of this process.  Answer is created(Id), or
%   another verdict of gate/4.

agent_begins(Host, Name, Start, From, Answer) :-
    unit_of_work(started(Host, Name, Start, From, none, _, Answer)),
    sync_changes.

%!  begins_at_once(@Start) is semidet.
%
%   No goal of the agent is for the hook at_birth/2, which may load code.  Start
%   may come from a peer.

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
