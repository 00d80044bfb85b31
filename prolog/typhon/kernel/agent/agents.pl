:- module(typhon_agents,
          [ agent/5,                    % ?Id, ?Host, ?Module, ?Hash, ?Life
            agent_here/5,               % ?Id, ?Host, ?Module, ?Hash, ?Life
            agent_on/2,                 % +Id, -Host
            agent_status/3,             % ?Id, ?Status, ?Goals
            agent_rests/3,              % +Id, ?Status, -Goals
            agent_enter/3,              % +Agent, +Status, +Goals
            agent_remove/2,             % +Id, -Orders
            agent_mobile/6,             % +Id, -Host, -Module, -Hash, -Life,
                                        % -Until
            agent_departing/7,          % +Id, +Host, -Module, -Hash, -Life,
                                        % -Hops, -Until
            agent_move/5,               % +Id, +Host, +Module, +Life, +Until
            agent_replace/6,            % +Id, +Host, +Module, +Hash, +Life,
                                        % +Until
            state_destroy/2,            % +Id, +Module
            agent_put_life/2,           % +Id, +Life
            agent_put/3,                % +Id, +Status, +Goals
            agent_note/3,               % +Id, +Status, +Goals
            agent_rest/3,               % +Id, +Status, +Goals
            agent_take/3,               % +Id, -Goals, -Order
            agent_claim/3,              % +Id, ?Status, -Goals
            agent_enter/5,              % +Id, +Host, +Module, +Hash, +Life
            agent_hand_over/4,          % +Id, +Hops, +Way, +Frame
            agent_under_way/6,          % ?Id, ?Hops, -Host, -Hash, -Way,
                                        % -Frame
            agent_remove/3,             % +Id, +Hops, -Mail
            agent_thawed/5,             % +Id, +Module, +Life, +Status, +Goals
            agent_ready/2,              % +Id, +Goals
            agent_wakes/2,              % +Id, +Goals
            agent_mail/2,               % +Id, +Messages
            is_life/1,                  % @Term
            make_life/5,                % +Lifetime, +Tokens, +Payloads,
                                        % +Static, -Life
            life_parent/2,              % +Life, -Id
            life_hops/2,                % +Life, -Count
            life_tokens/2,              % +Life, -Tokens
            life_payloads/2,            % +Life, -Payloads
            life_extras/2,              % +Life, -Extras
            agent_extras_missing/1,     % @Life
            agent_extras_load/1,        % +Life
            set_payloads_of_life/3,     % +Payloads, +Life0, -Life
            set_extras_of_life/3,       % +Extras, +Life0, -Life
            life_may_move/2,            % +Life, -May
            life_hop/3,                 % +Life0, -Life, -Hops
            life_came/2,                % @Life, -Hops
            life_before/2,              % +Life, -Life0
            life_clone/3                % +Id, +Life0, -Life
          ]).

/** <module> The records of the agents in this process

Only this module changes these records.  An agent has

  - a module of its name with its state, see typhon_agent_module;
  - a life, see below;
  - a status, one of `ready`, `running`, sleeping(Until),
    waiting(Pattern, Until), `resident`, `held`, `resumed`, `obeying`,
    leaving(Host, At), transit(Host, Sent), cloning(Host, Sent) or
    faulty(Error), with the goals still to run.  While a control predicate is
    under way the goals are Hole-Goals, see typhon_machine;
  - a mailbox, and orders, see typhon_mailbox.

The goals of a record may be frames, see typhon_chunks, which have a meaning
only in this process: the predicates that return the goals of an agent or note
them in the journal convert frames to goals of its program.

For an agent that was handed over to another process, see typhon_hop, this
process keeps only the sent frame and a mailbox until the other process has
accepted the agent.  A predicate that reads such an agent thaws it: the agent
gets a record again, with the status of an agent in transit.

Database changes are the largest cost of a hop.  So an agent that runs has no
status clause: the thread that retracts `ready` owns the agent.

The tables must be called with a bound id, or with atoms: the index on compound
terms, which Prolog makes by itself, is not safe if other threads retract
(9.0.4 aborts in deleteActiveClauseFromBucket).

A life is

    life(Parent, Hops, Lifetime, Tokens, Payloads, Static, Extras)

the agent of which it is a clone or `none`, the number of its hops, the number
of hops after which it ends or `inf`, the tokens that it shows to hosts that
require one, a list of Name-PIs, whether it must not move, and a list of terms
that options let it carry.  A life goes over the wire and into restore points as
it is; only this module accesses its arguments.

*Threading*: predicates that change a record run inside with_agent/2. Those of
a life are pure, except life_carried/2 and agent_extras_load/1, which load
code.
*/

:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/durable',
              [durable_drop/3, durable_on/0, enqueue_changes/0]).
:- use_module('../base/on_demand', [on_demand_load/2, on_demand_missing/2]).
:- use_module('../host', [events_forget/1, parts_call/3, schedule/2]).
:- use_module('../program', [plain_goals/2]).
:- use_module(mailbox,
              [ agent_ordered/1, agent_unorder/2, agent_unorder_all/2,
                mail_all/2, mail_drop/1, mail_put/2, mail_wakes/3 ]).

:- dynamic
    record/6,                           % Id, Host, Module, Hash, Life, Until
    agent_rests/3,
    agent_under_way/6.

:- multifile
    typhon_code:in_use/1,
    put_down/3,                         % Id, Status, Goals: write them to the journal
    state_ends/2,                       % Id, Module: Module is about to be destroyed
    thaw/1,                             % Id, which is under way, needs a record
    not_cloned/1,                       % Extra: a clone does not carry it
    carries/3.                          % Name, Id, Extra: the agent is in this process
                                        % now, and carries Extra, of functor name Name

%!  agent_rests(+Id, ?Status, -Goals) is nondet.
%
%   As agent_status/3, for callers that only pass Goals on: they may be frames.
%   There is no clause if Id runs.

%!  agent_under_way(?Id, ?Hops, ?Host, ?Hash, ?Way, ?Frame) is nondet.
%
%   Id is under way as Frame, on its hop number Hops, from Host.

%!  agent(?Id, ?Host, ?Module, ?Hash, ?Life) is nondet.
%
%   The agents of this process: Id is on Host, its state is in Module, and Hash
%   names its program.

agent(Id, Host, Module, Hash, Life) :-
    nonvar(Id),
    !,
    (   record(Id, Host, Module, Hash, Life, _)
    ->  true
    ;   agent_under_way(Id, _, _, _, _, _),
        thaw(Id),
        record(Id, Host, Module, Hash, Life, _)
    ->  true
    ).
agent(Id, Host, Module, Hash, Life) :-
    forall(agent_under_way(Thawed, _, Host, _, _, _), ignore(thaw(Thawed))),
    record(Id, Host, Module, Hash, Life, _).

%!  agent_here(?Id, ?Host, ?Module, ?Hash, ?Life) is nondet.
%
%   As agent/5, without the agents that are under way as a frame.

agent_here(Id, Host, Module, Hash, Life) :-
    record(Id, Host, Module, Hash, Life, _).

%!  agent_on(+Id, -Host) is semidet.
%
%   Id is in this process: on Host, or under way from there.

agent_on(Id, Host) :-
    (   record(Id, Host0, _, _, _, _)
    ;   agent_under_way(Id, _, Host0, _, _, _)
    ),
    !,
    Host = Host0.

typhon_code:in_use(Hash) :-
    (   record(_, _, _, Hash, _, _)
    ;   agent_under_way(_, _, _, Hash, _, _)
    ),
    !.

%!  agent_enter(+Agent, +Status, +Goals) is det.
%
%   Add the record of Agent, an agent/5 term.

agent_enter(agent(Id, Host, Module, Hash, Life), Status, Goals) :-
    assertz(record(Id, Host, Module, Hash, Life, 0)),
    agent_note(Id, Status, Goals),
    assertz(agent_rests(Id, Status, Goals)),
    parts_call(comes, Host, [Id, Host, Module, Hash]),
    life_carried(Life, Id).

%!  agent_remove(+Id, -Orders:list) is semidet.
%
%   Remove the record of Id, its mail, and its module.

agent_remove(Id, Orders) :-
    retract(record(Id, Host, Module, _, _, _)),
    retractall(agent_rests(Id, _, _)),
    parts_call(goes, Host, [Id, Host, Module]),
    durable_drop(agent, Id, 0),
    mail_drop(Id),
    agent_unorder_all(Id, Orders),
    state_destroy(Id, Module).

%!  state_destroy(+Id, +Module) is det.
%
%   Id has, or had, its state in Module, which it no longer uses.

state_destroy(Id, Module) :-
    forall(state_ends(Id, Module), true),
    '$destroy_module'(Module).

%!  agent_mobile(+Id, -Host, -Module, -Hash, -Life, -Until:integer) is semidet.
%
%   As agent/5, for an agent that is to travel.  Its state is known to be mobile
%   as of generation Until, see agent_state_mobile/4; 0 if it was not checked.

agent_mobile(Id, Host, Module, Hash, Life, Until) :-
    record(Id, Host, Module, Hash, Life, Until),
    !.

%!  agent_departing(+Id, +Host, -Module, -Hash, -Life, -Hops, -Until)
%                 is semidet.
%
%   As agent_mobile/6, for an agent on Host that may move and carries no extras.
%   Life is its life with one more hop, number Hops.

agent_departing(Id, Host, Module, Hash, Life, Hops, Until) :-
    record(Id, Host, Module, Hash, Life0, Until),
    !,
    Life0 = life(Parent, Hops0, Most, Tokens, Payloads, false, []),
    (   Most == inf
    ->  true
    ;   integer(Most),
        Hops0 < Most
    ),
    Hops is Hops0+1,
    Life = life(Parent, Hops, Most, Tokens, Payloads, false, []).

%!  agent_move(+Id, +Host, +Module, +Life, +Until:integer) is det.
%
%   Move Id to Host, with its state in Module; destroy its old module, if that
%   is another one.

agent_move(Id, Host, Module, Life, Until) :-
    record(Id, From, Old, Hash, _, _),
    !,
    agent_replace(Id, Host, Module, Hash, Life, Until),
    parts_call(goes, From, [Id, From, Module]),
    parts_call(comes, Host, [Id, Host, Module, Hash]),
    (   Old == Module
    ->  true
    ;   state_destroy(Id, Old)
    ).

%!  agent_replace(+Id, +Host, +Module, +Hash, +Life, +Until:integer) is det.
%
%   Replace the record of Id.  The older one is removed last, so that readers
%   always find one.  Clause references are not used, see typhon_prolog_faults.

agent_replace(Id, Host, Module, Hash, Life, Until) :-
    assertz(record(Id, Host, Module, Hash, Life, Until)),
    retract(record(Id, _, _, _, _, _)),
    !.

                /*******************************
                *            STATUS            *
                *******************************/

%!  agent_status(?Id, ?Status, ?Goals) is nondet.
%
%   Status is `running` for an agent without a status clause.  Agents that are
%   under way as a frame get a record first.

agent_status(Id, Status, Goals) :-
    forall(agent(Id, _, _, _, _), true),
    status_now(Id, Status, Goals).

status_now(Id, Status, Goals) :-
    agent_rests(Id, Status, Goals0),
    goals_shown(Goals0, Goals).
status_now(Id, running, []) :-
    record(Id, _, _, _, _, _),
    \+ agent_rests(Id, _, _).

%   goals_shown(+Goals0, -Goals): convert frames to goals.  The other forms of
%   goals, for agents that are held or cloned, contain no frames.

goals_shown([Goal|Goals0], Goals) =>
    plain_goals([Goal|Goals0], Goals).
goals_shown(hop(Hole-Goals0, Since), Shown) =>
    Shown = hop(Hole-Goals, Since),
    plain_goals(Goals0, Goals).
goals_shown(Goals0, Goals) =>
    Goals = Goals0.

%!  agent_put(+Id, +Status, +Goals) is det.
%
%   Set the status of Id.  Before other threads can see it, it is noted in the
%   unit of work, which ends here.

agent_put(Id, Status, Goals) :-
    (   durable_on
    ->  agent_note(Id, Status, Goals),
        enqueue_changes
    ;   true
    ),
    retractall(agent_rests(Id, _, _)),
    assertz(agent_rests(Id, Status, Goals)).

%!  agent_note(+Id, +Status, +Goals) is det.
%
%   Note the status of Id in the unit of work, and do not set it.

agent_note(Id, Status, Goals) :-
    (   durable_on
    ->  goals_shown(Goals, Shown),
        forall(put_down(Id, Status, Shown), true)
    ;   true
    ).

%!  agent_rest(+Id, +Status, +Goals) is det.
%
%   Id stops running and gets Status, or is ready if it has got an order since.

agent_rest(Id, Status, Goals) :-
    (   agent_ordered(Id)
    ->  agent_ready(Id, Goals)
    ;   agent_put(Id, Status, Goals)
    ).

%!  agent_take(+Id, -Goals, -Order) is semidet.
%
%   Id, which is ready, begins to run, and Order is `none`; or Id begins to obey
%   Order, its oldest order.

agent_take(Id, Goals, Order) :-
    retract(agent_rests(Id, ready, Goals0)),
    !,
    (   agent_unorder(Id, Oldest)
    ->  goals_shown(Goals0, Goals),     % Order may change the program
        assertz(agent_rests(Id, obeying, Goals)),
        Order = Oldest
    ;   Goals = Goals0,
        Order = none
    ).

%!  agent_claim(+Id, ?Status, -Goals) is semidet.
%
%   Take Id if it has that Status.  From now on only the caller may change Id,
%   and an order from outside cannot end it.

agent_claim(Id, Status, Goals) :-
    retract(agent_rests(Id, Status, Goals)),
    !.

                /*******************************
                *           UNDER WAY          *
                *******************************/

%!  agent_enter(+Id, +Host, +Module, +Hash, +Life) is det.
%
%   Add a record of Id, which arrives at Host, a plain host, and runs.

agent_enter(Id, Host, Module, Hash, Life) :-
    assertz(record(Id, Host, Module, Hash, Life, 0)).

%!  agent_hand_over(+Id, +Hops, +Way, +Frame) is semidet.
%
%   Record that Id, which runs, is under way as Frame, and remove its record and
%   its module.  Fails if Id has an order or was ended.

agent_hand_over(Id, Hops, Way, Frame) :-
    record(Id, Host, Module, Hash, _, _),
    \+ agent_ordered(Id),
    \+ agent_rests(Id, _, _),
    !,
    assertz(agent_under_way(Id, Hops, Host, Hash, Way, Frame)),
    retract(record(Id, _, _, _, _, _)),
    '$destroy_module'(Module).

%!  agent_remove(+Id, +Hops, -Mail:list) is semidet.
%
%   Remove the record of Id under way; Mail has come for it meanwhile.

agent_remove(Id, Hops, Mail) :-
    retract(agent_under_way(Id, Hops, _, _, _, _)),
    !,
    mail_all(Id, Mail).

%!  agent_thawed(+Id, +Module, +Life, +Status, +Goals) is det.
%
%   Give Id, which is under way as a frame, a record again.

agent_thawed(Id, Module, Life, Status, Goals) :-
    agent_under_way(Id, _, Host, Hash, _, _),
    !,
    assertz(agent_rests(Id, Status, Goals)),
    assertz(record(Id, Host, Module, Hash, Life, 0)),
    retractall(agent_under_way(Id, _, _, _, _, _)).

%!  agent_ready(+Id, +Goals) is semidet.
%
%   Let Id continue with Goals in its next turn.  Fails if it was ended
%   meanwhile.

agent_ready(Id, Goals) :-
    record(Id, Host, _, _, _, _),
    !,
    agent_put(Id, ready, Goals),
    schedule(Host, Id).

%!  agent_wakes(+Id, +Goals) is semidet.
%
%   As agent_ready/2, for an agent that rested with these Goals: the journal has
%   them already.

agent_wakes(Id, Goals) :-
    record(Id, Host, _, _, _, _),
    !,
    wakes_on(Host, Id, Goals).

wakes_on(Host, Id, Goals) :-
    retractall(agent_rests(Id, _, _)),
    assertz(agent_rests(Id, ready, Goals)),
    schedule(Host, Id).

%!  agent_put_life(+Id, +Life) is det.

agent_put_life(Id, Life) :-
    record(Id, Host, Module, Hash, _, Until),
    !,
    agent_replace(Id, Host, Module, Hash, Life, Until),
    events_forget(Id),
    life_carried(Life, Id).

                /*******************************
                *             MAIL             *
                *******************************/

%!  agent_mail(+Id, +Messages:list) is semidet.
%
%   Put Messages in the mailbox and wake the agent if it waits for one of them.
%   Fails if the agent is not in this process.

agent_mail(Id, Messages) :-
    agent_on(Id, Host),
    (   agent_rests(Id, Status, Goals)
    ->  (   mail_wakes(Status, Id, Messages)
        ->  wakes_on(Host, Id, Goals)
        ;   true
        )
    ;   mail_put(Id, Messages)          % Id runs, or is under way
    ).

                /*******************************
                *            LIVES             *
                *******************************/

%!  is_life(@Term) is semidet.
%
%   Term is a life, with arguments of the right types.

is_life(life(Parent, Hops, Lifetime, Tokens, Payloads, Static, Extras)) :-
    atom(Parent),
    integer(Hops),
    atomic(Lifetime),
    is_list(Tokens),
    is_list(Payloads),
    all_carried(Payloads),
    atom(Static),
    is_list(Extras).

%   A life from another process could name predicates of other modules, which
%   would be abolished when the payload is detached.

all_carried([]).
all_carried([Payload|Payloads]) :-
    nonvar(Payload),
    Payload = Name-PIs,
    atom(Name),
    is_list(PIs),
    forall(member(PI, PIs), is_indicator(PI)),
    all_carried(Payloads).

is_indicator(PI) :-
    nonvar(PI),
    PI = Name/Arity,
    atom(Name),
    integer(Arity).

%!  make_life(+Lifetime, +Tokens:list, +Payloads:list, +Static:boolean,
%!            -Life) is det.
%
%   Life is the life of a new agent that is no clone.

make_life(Lifetime, Tokens, Payloads, Static,
          life(none, 0, Lifetime, Tokens, Payloads, Static, [])).

%!  life_parent(+Life, -Id) is det.
%!  life_hops(+Life, -Count:integer) is det.
%!  life_tokens(+Life, -Tokens:list) is det.
%!  life_payloads(+Life, -Payloads:list) is det.
%!  life_extras(+Life, -Extras:list) is det.

life_parent(life(Parent, _, _, _, _, _, _), Parent).
life_hops(life(_, Hops, _, _, _, _, _), Hops).
life_tokens(life(_, _, _, Tokens, _, _, _), Tokens).
life_payloads(life(_, _, _, _, Payloads, _, _), Payloads).
life_extras(life(_, _, _, _, _, _, Extras), Extras).

%!  set_payloads_of_life(+Payloads:list, +Life0, -Life) is det.
%!  set_extras_of_life(+Extras:list, +Life0, -Life) is det.

set_payloads_of_life(Payloads, life(P, H, L, T, _, S, E),
                     life(P, H, L, T, Payloads, S, E)).

set_extras_of_life(Extras, life(P, H, L, T, Ps, S, _),
                   life(P, H, L, T, Ps, S, Extras)).

%!  life_may_move(+Life, -May) is det.
%
%   May is `go`, `static` if it must not move, or `end` if it has made all its
%   hops.

life_may_move(life(_, Hops, Most, _, _, Static, _), May) :-
    (   Static == true
    ->  May = static
    ;   integer(Most),
        Hops >= Most
    ->  May = end
    ;   May = go
    ).

%!  life_hop(+Life0, -Life, -Hops:integer) is det.
%
%   Life is Life0 with one more hop, number Hops.

life_hop(life(Parent, Hops0, Most, Tokens, Payloads, Static, Extras),
         life(Parent, Hops, Most, Tokens, Payloads, Static, Extras), Hops) :-
    Hops is Hops0+1.

%!  life_came(@Life, -Hops:integer) is semidet.
%
%   Life, any term, is that of an agent that has made Hops hops and carries no
%   extras.

life_came(Life, Hops) :-
    is_life(Life),
    Life = life(_, Hops, _, _, _, _, []).

%!  life_before(+Life, -Life0) is det.
%
%   Life0 is Life before its last hop.

life_before(life(Parent, Hops, Most, Tokens, Payloads, Static, Extras),
            life(Parent, Hops0, Most, Tokens, Payloads, Static, Extras)) :-
    Hops0 is Hops-1.

%!  life_clone(+Id, +Life0, -Life) is det.
%
%   Life is the life of a clone of Id, whose life is Life0.

life_clone(Id, life(_, _, Most, Tokens, Payloads, Static, Extras0),
           life(Id, 0, Most, Tokens, Payloads, Static, Extras)) :-
    exclude(not_cloned, Extras0, Extras).

%   life_carried(+Life, +Id): the agent Id, with this Life, is in this process
%   now: pass the extras that it carries to their options.

life_carried(Life, Id) :-
    life_extras(Life, Extras),
    (   Extras == []
    ->  true
    ;   forall(extra(Life, Name, Extra),
               ( on_demand_load(carries, Name),
                 ignore(carries(Name, Id, Extra)) ))
    ).

%!  agent_extras_missing(@Life) is semidet.
%
%   Life, any term, has an extra whose option is not loaded.

agent_extras_missing(Life) :-
    is_life(Life),
    extra(Life, Name, _),
    on_demand_missing(carries, Name),
    !.

%!  agent_extras_load(+Life) is det.
%
%   Load the options of all extras.  Not for the thread of a connection.

agent_extras_load(Life) :-
    forall(extra(Life, Name, _), on_demand_load(carries, Name)).

%   extra(+Life, ?Name, -Extra) is nondet: Life has Extra, of functor name Name.
%   Extras may come from a peer, so they may be any terms.

extra(Life, Name, Extra) :-
    life_extras(Life, Extras),
    member(Extra, Extras),
    callable(Extra),
    functor(Extra, Name, _).
