:- module(typhon_gate,
          [ gate/4,                     % +Host, +Entrant, :Install, -Verdict
            gate_refused/4              % +Host, +From, +Agent, +Reason
          ]).
:- use_module(library(lists), [member/2]).
:- autoload(library(terms), [term_size/2]).
:- use_module('../base/bounds', [memory_short/1]).
:- use_module('../program', [code_known/2, code_receive/2]).
:- use_module('../host',
              [ event/4, host/3, host_admits/2, host_closed/1, host_enter/3,
                host_uncount/1, host_load/2, parts/3, security_event/2,
                security_event/3 ]).
:- use_module(agent_module, [agent_program/3]).
:- use_module(agents, [agent_on/2, life_tokens/2]).
:- use_module(identity, [agent_home/2]).

/** <module> Admission: which agents a host accepts

Every agent that begins on a host, or comes to it, passes gate/4: when it is
created, cloned or restored there, and at the end of a hop, from this process or
from another.  The reasons to refuse an agent are tested in the same order on
each path: those of options, see typhon_host_parts, then token and capacity.
Each refusal is logged as a security event and reported as an event, only here.

The agent is

    entrant(Agent, Hash, Life, State, Mail)

its id, or the name from which its id will be made; the hash of its program;
its life; its state, as in agent_state/2, or module(Module); the messages that
it brings.  Its source is

  - here: it begins, in this process
  - going: it hops within this process
  - from(Peer, Program, Shown): the process at Peer has sent it with Program,
    as in code_receive/2, or `known`.  Shown is `newborn`, or papers(Papers),
    which prove that Peer may bring it.

*Threading*: any thread.  Agents that enter at the same time never exceed the
capacity of the host.
*/

:- meta_predicate gate(+, +, 1, -).

:- multifile
    forbidden/2,                % Ball, Reason: installing the agent raised
                                % Ball, which means a refusal for Reason
    typhon_rights:agent_scope/2.

%!  gate(+Host, +Entrant, :Install, -Verdict) is det.
%
%   Admit an agent.  Entrant is Source-Agent.  If there is no reason to refuse
%   it, a slot on Host is reserved and call(Install, Verdict) installs the
%   agent.  The slot is released unless Verdict is `ok`.  Other verdicts are
%   refused(Reason), `need_program`, and those of Install.
%
%   Signals are deferred from reservation to installation; before, the program
%   is compiled.  While memory is short the process has no capacity for more
%   agents.
%
%   @error what Install raises, unless it means that Host refuses the agent

gate(Host, From-Entrant, Install, Verdict) :-
    (   against(From, Entrant, Host, Verdict)
    ->  true
    ;   Entrant = entrant(_, Hash, Life, _, _),
        life_tokens(Life, Tokens),
        ignore(make_ready(Host, Tokens, Hash)),
        sig_atomic(enter(Host, Tokens, From, Install, Verdict))
    ),
    (   Verdict = refused(Reason)
    ->  arg(1, Entrant, Agent),
        gate_refused(Host, From, Agent, Reason)
    ;   true
    ).

%   Libraries are loaded here: after admission, and outside of mutexes.

make_ready(Host, Tokens, Hash) :-
    host_admits(Host, Tokens),
    host(Host, _, Place),
    agent_program(Place, Hash, _).

enter(Host, Tokens, From, Install, Verdict) :-
    host_enter(Host, Tokens, Entered),
    (   Entered == ok
    ->  (   From \== going,
            host_load(Host, Load),
            memory_short(Load)
        ->  Verdict = refused(capacity)
        ;   catch(call(Install, Verdict), Ball,
                  not_installed(Ball, Host, Verdict))
        ),
        ( Verdict == ok -> true ; host_uncount(Host) )
    ;   Verdict = Entered
    ).

not_installed(Ball, _, refused(Reason)) :-
    forbidden(Ball, Reason),
    !.
not_installed(Ball, Host, _) :-
    host_uncount(Host),
    throw(Ball).

                /*******************************
                *            REASONS           *
                *******************************/

%   against(+From, +Entrant, +Host, -Verdict): Verdict is the first reason to
%   refuse the agent.  host_enter/3 tests the remaining reasons afterwards:
%   token, capacity.

against(from(_, _, _), _, Host, refused(unknown_host)) :-
    \+ open(Host),
    !.
against(From, Entrant, Host, Verdict) :-
    parts(admit, Host, Closures),
    member(Closure, Closures),
    call(Closure, From, Entrant, Host, Verdict),
    !.
against(from(_, Program, _), entrant(_, Hash, _, _, _), _, need_program) :-
    lacks_program(Program, Hash),
    !.
against(From, Entrant, Host, Verdict) :-
    parts(admit_program, Host, Closures),
    member(Closure, Closures),
    call(Closure, From, Entrant, Host, Verdict),
    !.

%   A request of a peer may name any term as the host.

open(Host) :-
    atom(Host),
    \+ host_closed(Host).

%   @error domain_error(program_of_hash(Hash), Program)

lacks_program(Program, Hash) :-
    (   Program == known
    ->  \+ code_known(Hash, _)
    ;   \+ code_receive(Hash, Program)
    ).

                /*******************************
                *           REFUSALS           *
                *******************************/

%!  gate_refused(+Host, +From, +Agent, +Reason) is det.
%
%   Log and report that Host has refused Agent.

gate_refused(Host, From, Agent, Reason) :-
    (   atom(Host),
        host(Host, _, _)
    ->  shown(Reason, Shown),
        noted(From, Host, refused(Agent, Shown)),
        event(hosts, Host, none, refused(Agent, Shown))
    ;   true
    ).

%   The goal comes from a peer, so it may be of any size.

shown(policy(Goal), policy(Name/Arity)) :-
    compound(Goal),
    term_size(Goal, Cells),
    Cells > 1000,
    !,
    compound_name_arity(Goal, Name, Arity).
shown(Reason, Reason).

%   Own process and proof are passed explicitly: the thread may be one that
%   reads from a peer while it runs an agent of this process.

noted(from(Peer, _, _), Host, What) :-
    !,
    security_event(Host, Peer, What).
noted(_, Host, What) :-
    security_event(Host, What).

                /*******************************
                *       RIGHTS OF PEERS        *
                *******************************/

%   The host of an agent decides what other processes may do with it; for an
%   agent that is elsewhere, the host on which it was born.

typhon_rights:agent_scope(Id, Host) :-
    agent_on(Id, Host),
    !.
typhon_rights:agent_scope(Id, Host) :-
    agent_home(Id, Address),
    host(Host, Address, _),
    !.
