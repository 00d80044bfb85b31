:- module(typhon_fault_messages, []).

/** <module> Texts of reports of agents that fail

One sentence: the agent, its host, the number of hops, the error, and the
clause.

*Threading*: called by print_message/2 in any thread.
*/

:- use_module('../kernel/base/error_text', [error_told/3, term_told/3]).
:- use_module('../kernel/agent', [fault_told/5]).

:- multifile
    prolog:error_message//1,
    prolog:message//1.

prolog:error_message(permission_error(resume, agent, Agent)) -->
    [ 'Agent ~w is not faulty: there is nothing to resume'-[Agent] ].

prolog:message(typhon(faulty(Agent, Error, Fault))) -->
    agent_at(Agent, Fault),
    raised(Error, Agent),
    goal_of(Error, Fault),
    raised_in(Fault).
prolog:message(typhon(agent_failed(Agent, Fault))) -->
    agent_at(Agent, Fault),
    failed_last(Fault).
prolog:message(typhon(mailbox_full(Agent, Max))) -->
    [ 'Agent ~w is faulty, and its mailbox is full: of what comes now \c
       nothing is kept beside ~D messages'-[Agent, Max] ].
prolog:message(typhon(message_undone(Agent, From, Message, Fault))) -->
    agent_at(Agent, Fault),
    [ 'did not do with ' ],
    term_told(Message),
    [ ' from ~w what on_message/2 says; it '-[From] ],
    failed_last(Fault).

%   Agent and place, as "Agent x at beta (hop 3): ".

agent_at(Agent, Fault) -->
    { fault_told(Fault, _, _, Address, Hops),
      atomic_list_concat([Host|_], @, Address)
    },
    [ 'Agent ~w at ~w (hop ~D): '-[Agent, Host, Hops] ].

%   An undefined predicate is not reported as missing in the agent's module.

raised(error(existence_error(procedure, Agent:PI), Context), Agent) -->
    !,
    [ 'Unknown procedure: ' ],
    term_told(PI),
    advised(Context).
raised(Error, _) -->
    error_told(Error).

advised(Context) -->
    { subsumes_term(context(_, _), Context),
      Context = context(_, Text),
      atom(Text)
    },
    !,
    [ ' (~w)'-[Text] ].
advised(_) -->
    [].

failed_last(Fault) -->
    { fault_told(Fault, Goal, Where, _, _) },
    [ 'failed: the goal that failed last was ' ],
    goal_told(Goal),
    clauses_told(Where).

%   An error that says neither what is wrong nor which predicate raised it needs
%   the goal; and so does one whose clause is not known.

goal_of(Error, Fault) -->
    { fault_told(Fault, Goal, Where, _, _) },
    (   { Where == [] ; needs_goal(Error), \+ stands_inside(Goal, Where) }
    ->  [ ', at ' ],
        goal_told(Goal)
    ;   []
    ).

needs_goal(error(Formal, Context)) :-
    nonvar(Formal),
    functor(Formal, Kind, _),
    memberchk(Kind, [ instantiation_error, uninstantiation_error, type_error,
                      domain_error, representation_error ]),
    \+ ( subsumes_term(context(_, _), Context),
         Context = context(Caller, _),
         nonvar(Caller) ).

%   The goal is the call of a predicate in whose clause the error was raised.

stands_inside(Goal, [[at(Name/Arity, _)|_]|_]) :-
    callable(Goal),
    functor(Goal, Name, Arity).

raised_in(Fault) -->
    { fault_told(Fault, _, Where, _, _) },
    clauses_told(Where).

goal_told((If->true)) -->
    !,
    goal_told(once(If)).
goal_told((If->_)) -->
    !,
    [ '( ' ], goal_told(If), [ ' -> ... ) without else' ].
goal_told((If*->_)) -->
    !,
    [ '( ' ], goal_told(If), [ ' *-> ... ) without else' ].
goal_told(Goal0) -->
    { copy_term(Goal0, Goal),
      numbervars(Goal, 0, _, [singletons(true)])
    },
    [ '~W'-[Goal, [ quoted(true), portray(false), max_depth(10),
                    spacing(next_argument), numbervars(true) ]] ].

%   In which clause that was.

clauses_told([]) -->
    [].
clauses_told([Places|Callers]) -->
    [ ', in ' ],
    places_told(Places),
    callers_told(Callers).

callers_told([]) -->
    [].
callers_told([Places|_]) -->
    [ ', called from ' ],
    places_told(Places).

places_told([Place]) -->
    place_told(Place).
places_told([Place,Other|Places]) -->
    place_told(Place),
    [ ' or ' ],
    places_told([Other|Places]).

place_told(at(PI, File:Line)) -->
    { file_base_name(File, Base) },
    [ '~q (~w:~d)'-[PI, Base, Line] ].
place_told(at(PI, clause(N))) -->
    [ '~q, clause ~d'-[PI, N] ].
place_told(at(PI, state)) -->
    [ '~q, a rule of its own'-[PI] ].
