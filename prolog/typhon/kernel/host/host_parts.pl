:- module(typhon_host_parts,
          [ parts/3,                    % ?Phase, ?Host, ?Closures
            hosts_apart/2,              % +Host1, +Host2
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

An option adds code to the operations of a host by a clause of the hook

    part(Phase, Host, Order, Closure)

which succeeds while the option is on for Host.  The clauses of this hook are
called when the options of the host change, and at no other time: an operation
looks up one list of closures, and a host without options has none.

  | phase         | called with                  | when                        |
  | ------------- | ---------------------------- | --------------------------- |
  | admit         | From, Entrant, Host, Verdict | an agent asks to enter, see |
  |               |                              | typhon_gate                 |
  | admit_program | From, Entrant, Host, Verdict | its program is here, too    |
  | view          | (a module)                   | an agent is installed, see  |
  |               |                              | typhon_agent_module         |
  | module        | Module                       | before the state of an      |
  |               |                              | agent is put in Module      |
  | comes         | Id, Host, Module, Hash       | the agent is on Host from   |
  |               |                              | now on                      |
  | goes          | Id, Host, Module             | it has left; Module is its  |
  |               |                              | present module              |
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
  |               |                              | typhon_remote               |
  | security      | Host, Peer, Proof, What      | see security_event/3        |
  | payload       | From, Payload, Host, Reason  | a payload is refused, see   |
  |               |                              | typhon_payloads             |
  | away          | (true)                       | no other host of this       |
  |               |                              | process reaches Host, nor   |
  |               |                              | Host any other              |
  | new_program   | Host, Id, Hash-Sent          | Id gets another program,    |
  |               |                              | sent as in code_receive/2;  |
  |               |                              | an error forbids it         |

A closure of `admit` or `admit_program` fails where it has no objection, and
else returns a verdict other than `ok`.  There is only one closure of `turn`.
A closure of `acts` raises an error if the agent is not allowed to act.  A peer
has a right if all closures of `permit` succeed.  The closures of the following
phases change a term that is passed from one host to another.  They are called
with Host, About, Term0, Term:

  | phase   | Term    | About                      | when                     |
  | ------- | ------- | -------------------------- | ------------------------ |
  | departs | state   | hop(Id, Hash, Hops, Goals, | the agent leaves for the |
  |         |         | To)                        | address To, of another   |
  |         |         |                            | process                  |
  | arrives | state   | hop(Id, Hash, Hops, Goals, | it arrives at Address    |
  |         |         | from(Peer, Address))       | from the process at Peer |
  | papers  | program | program(Id, Hash,          | its program is sent to   |
  |         |         | Endpoint)                  | Endpoint                 |
  | created | state   | Peer                       | the process at Peer      |
  |         |         |                            | creates an agent here    |
  | cloned  | state   | Id                         | Id is cloned             |
  | copied  | state   | Id                         | a restore point of Id is |
  |         |         |                            | made                     |
  | deliver | mail    | Id                         | a message arrives for Id |
  | tuple   | mark    | Agent                      | Agent leaves a fact; the |
  |         |         |                            | mark is `none` at first  |

State is as in agent_state/2.

The closures of a phase are called in ascending order of their numbers.

An option that has data for each host follows the life of the host by the hooks

    check(Options)              before it starts: raises an error if Options
                                are wrong
    begins(Host, Place, Options)  it has a place, and is not reachable yet; if
                                this raises an error, it does not start
    changeable(Option)          host_change/2 accepts Option
    changes(Option, Host)       Option is about to be set
    compiled(Host)              its parts are those of its new options
    untrusted(Option)           with Option a host admits agents that it does
                                not trust
    unnoted(Option)             it is not restored with the host
    limit(Host, What, Most)     agents on Host may use up to Most of What
    ends(Host)                  it has stopped

*Threading*: any thread reads; all changes hold the mutex of host_start/2.
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

:- '$clausable'(ends/1).

:- dynamic
    compiled/1,
    parts/3.                    % Phase, Host, Closures

%!  parts(?Phase, ?Host, ?Closures:list) is nondet.
%
%   Host has these Closures in Phase.  This is a fact, so that a host without
%   parts costs one lookup.  No list is empty.  While parts change there may be
%   two facts, of which the first counts.

%!  hosts_apart(+Host1, +Host2) is semidet.
%
%   Neither agents nor messages get from one of these hosts of this process to the
%   other, because one of them is away.

hosts_apart(Host1, Host2) :-
    parts(away, _, _),                  % rarely
    Host1 \== Host2,
    ( parts(away, Host1, _) ; parts(away, Host2, _) ),
    !.

%!  parts_call(+Phase, +Host, +Args:list) is det.
%
%   Call all closures of Host with Args; bindings are undone.
%
%   @error those of the closures

parts_call(Phase, Host, Args) :-
    (   parts(Phase, Host, Closures)
    ->  forall(member(Closure, Closures), apply(Closure, Args))
    ;   true
    ).

%!  amended(+Phase, +Host, +About, +Term0, -Term) is det.
%
%   Term is Term0 after all parts of Host in Phase have changed it, one after
%   another.

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
%   Load all code that a host with Options needs.

parts_load(Options) :-
    options_load(host_option, Options),
    (   member(Option, Options),
        untrusted(Option)
    ->  on_demand_load(untrusted, any)
    ;   true
    ).

%!  parts_compile(+Host) is det.
%
%   The options of Host have changed: compile its parts.  The new list is added
%   before the old one is removed.

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

%!  parts_forget(+Host) is det.

parts_forget(Host) :-
    retractall(parts(_, Host, _)).
