:- module(typhon_host_parts,
          [ parts/3,                    % ?Phase, ?Host, ?Closures
            parts_call/3,               % +Phase, +Host, +Args
            amended/5,                  % +Phase, +Host, +About, +Term0, -Term
            parts_load/1,               % +Options
            parts_compile/1,            % +Host
            parts_forget/1              % +Host
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [pairs_values/2]).

:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module('../base/options', [options_load/2]).

/** <module> The parts of a host: what options add to it

An option joins the acts of a host by a clause of the hook

    part(Phase, Host, Order, Closure)

that holds while the option is on for Host.  The clauses of this hook are
asked when the options of the host change, and never in between: an act looks
up one list of closures, and a host without options has none.

  | phase         | called with                  | when                        |
  | ------------- | ---------------------------- | --------------------------- |
  | admit         | From, Entrant, Host, Verdict | an agent asks to enter, see |
  |               |                              | typhon_gate                 |
  | admit_program | From, Entrant, Host, Verdict | its program is here, too    |
  | view          | (a module)                   | an agent is installed, see  |
  |               |                              | typhon_agent_module             |
  | module        | Module                       | its module begins to get    |
  |               |                              | its state                   |
  | comes         | Id, Host, Module, Hash       | the agent stands on Host    |
  |               |                              | from now on                 |
  | goes          | Id, Host, Module             | it does no longer; Module   |
  |               |                              | is the one that it has now  |
  | turn          | Turn, Goals, Outcome         | runs the machine, within    |
  |               |                              | limits, see typhon_turn     |
  | acts          | Agent, Act                   | an agent, or `none`, is     |
  |               |                              | about to act: `move`,       |
  |               |                              | `clone`, `attach`,          |
  |               |                              | send(Message), log(What),   |
  |               |                              | leave(Fact), say(Term)      |
  | makes_text    | Length                       | a running agent makes atoms |
  |               |                              | of that length              |
  | adds_clause   | Module, Clause               | a running agent, whose      |
  |               |                              | state is in Module, adds it |
  | permit        | Proof, Right                 | a peer uses a right, see    |
  |               |                              | typhon_peer_rights          |
  | security      | Host, Peer, Proof, What      | a security event, see there |
  | payload       | From, Payload, Host, Reason  | is refused, see             |
  |               |                              | typhon_payloads             |
  | new_program   | Host, Id, Sent               | Id gets another program,    |
  |               |                              | sent as of code_receive/2;  |
  |               |                              | raises what forbids it      |

Those that admit succeed with a verdict which is not `ok`.  Of `turn` there is
one.  `acts` raises an error if the agent must not.  A peer has a right
if all that permit succeed.  Other closures amend what goes from one host to
another, and are called with Host, About, Term0, Term:

  | phase   | Term    | About                      | when                     |
  | ------- | ------- | -------------------------- | ------------------------ |
  | departs | state   | hop(Id, Hash, Hops, Goals, | it goes to the address   |
  |         |         | To)                        | To, of another process   |
  | arrives | state   | hop(Id, Hash, Hops, Goals, | it comes to Address from |
  |         |         | from(Peer, Address))       | the process at Peer      |
  | papers  | program | program(Id, Hash,          | what is sent to Endpoint |
  |         |         | Endpoint)                  | with an agent            |
  | created | state   | Peer                       | the process at Peer      |
  |         |         |                            | creates an agent here    |
  | cloned  | state   | Id                         | of a clone of Id         |
  | copied  | state   | Id                         | of a restore point of Id |
  | deliver | mail    | Id                         | comes for Id             |
  | tuple   | mark    | Agent                      | `none` at first, of a    |
  |         |         |                            | fact that Agent leaves   |

State is as of agent_state/2.

Closures of a phase are called in the order of their numbers.

What an option keeps of a host follows the life of the host by the hooks

    check(Options)              before it starts: raises what is wrong
    begins(Host, Place, Options)  it has a place, and is not reachable yet; if
                                this raises, the host does not start
    changeable(Option)          host_change/2 takes Option
    changes(Option, Host)       it is about to be put
    compiled(Host)              its parts are those of its new options
    untrusted(Option)           with Option a host admits agents that it does
                                not trust
    unnoted(Option)             it is not restored with the host
    limit(Host, What, Most)     agents on Host may use so much of What
    ends(Host)                  it is no more

*Threading*: any thread reads; all else holds the mutex of host_start/2.
*/

:- multifile
    part/4,                     % Phase, Host, Order, Closure
    check/1,
    begins/3,
    changeable/1,
    changes/2,
    compiled/1,
    untrusted/1,
    unnoted/1,
    limit/3,
    ends/1.

:- dynamic compiled/1.

:- dynamic parts/3.             % Phase, Host, Closures

%!  parts(?Phase, ?Host, ?Closures:list) is nondet.
%
%   Host has these Closures in Phase: a fact, so that what has no parts costs
%   one lookup.  The first one counts, and there is none without closures.

%!  parts_call(+Phase, +Host, +Args:list) is det.
%
%   Call all closures of Host with Args; bindings are undone.
%
%   @error what a closure raises

parts_call(Phase, Host, Args) :-
    (   parts(Phase, Host, Closures)
    ->  forall(member(Closure, Closures), apply(Closure, Args))
    ;   true
    ).

%!  amended(+Phase, +Host, +About, +Term0, -Term) is det.
%
%   Term is Term0 as the parts of Host amend it, one after the other.

amended(Phase, Host, About, Term0, Term) :-
    (   parts(Phase, Host, Closures)
    ->  amended_by(Closures, Host, About, Term0, Term)
    ;   Term = Term0
    ).

amended_by([], _, _, Term, Term).
amended_by([Closure|Closures], Host, About, Term0, Term) :-
    call(Closure, Host, About, Term0, Term1),
    amended_by(Closures, Host, About, Term1, Term).

%!  parts_load(+Options) is det.
%
%   All that a host with Options needs is loaded.

parts_load(Options) :-
    options_load(host_option, Options),
    (   member(Option, Options),
        untrusted(Option)
    ->  on_demand_load(untrusted, any)
    ;   true
    ).

%!  parts_compile(+Host) is det.
%!  parts_forget(+Host) is det.
%
%   The options of Host have changed; Host is no more.  The new list is there
%   before the old one goes.

parts_compile(Host) :-
    findall(Phase-Closures, parts(Phase, Host, Closures), Olds),
    findall(Phase-Closures, in_order(Host, Phase, Closures), News),
    forall(member(Phase-Closures, News),
           assertz(parts(Phase, Host, Closures))),
    forall(member(Phase-Closures, Olds),
           once(retract(parts(Phase, Host, Closures)))),
    forall(compiled(Host), true).

in_order(Host, Phase, Closures) :-
    bagof(Order-Closure, part(Phase, Host, Order, Closure), Pairs0),
    keysort(Pairs0, Pairs),
    pairs_values(Pairs, Closures).

parts_forget(Host) :-
    retractall(parts(_, Host, _)).
