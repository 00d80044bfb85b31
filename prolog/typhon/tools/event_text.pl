:- module(typhon_event_text,
          [ happening/3,                % +What, //
            own_event/1,                % +What
            short_name/2                % +Name, -Short
          ]).
:- use_module('../kernel/base/error_text', [error_told/3, term_told/3]).
:- use_module('../kernel/agent', [fault_told/5]).

/** <module> Texts of events and of faults of agents

The report of a fault is one sentence: the agent, its host, the number of hops,
the error, and the clause.

*Threading*: pure; print_message/2 calls it in any thread.
*/

%!  happening(+What, -Text, ?Rest) is det.
%
%   Text is the message for an event, see typhon_events: an act of an agent, or
%   an event that concerns an agent or a host.

happening(What) -->
    { own(What, If, Text), call(If) },
    !,
    Text.
happening(What) -->
    [ 'logs ' ],
    term_told(What).

%!  own_event(+What) is semidet.
%
%   What is an event of the platform.  Agents may log any term, so a logged term
%   of the same form is mistaken for an event.

own_event(What) :-
    own(What, If, _),
    call(If),
    !.

%   own(+What, -If, -Text): What is an event if the goal If succeeds.  Text, the
%   body of a grammar rule, is its message.

own(created, true, [ 'begins' ]).
own(ended(Outcome), true, ([ 'ends, ' ], term_told(Outcome))).
own(faulty(Error), true, ([ 'is faulty: ' ], term_told(Error))).
own(fault(fault(Error, Goal, Place, _)), true,
    ( [ 'is faulty, ' ], term_told(Error), [ ': ' ], term_told(Goal),
      [ ', at ~w'-[Place] ] )).
own(link(To), is_name(To), named('is linked with ~w', To)).
own(unlink(To), is_name(To), named('is not linked with ~w any more', To)).
own(started, true, [ 'starts' ]).
own(stopped, true, [ 'stops' ]).
own(refused(Agent, Reason), atom(Agent),
    ( named('refuses ~w', Agent), [ ': ' ], term_told(Reason) )).
own(left(To), is_name(To), named('leaves for ~w', To)).
own(stayed(To), is_name(To), named('could not go to ~w', To)).
own(arrived(From, Seconds), ( atom(From), number(Seconds) ),
    ( named('comes from ~w', From), [ ', in ~4g s'-[Seconds] ] )).
own(cloned(Clone), is_name(Clone), named('has a clone, ~w', Clone)).
own(sent(To), atom(To), named('sends to ~w', To)).
own(sent(To, Message), atom(To),
    ( [ 'sends ' ], term_told(Message), named(' to ~w', To) )).
own(received(From), atom(From), named('takes a message from ~w', From)).
own(received(From, Message), atom(From),
    ( [ 'takes ' ], term_told(Message), named(' from ~w', From) )).
own(leave(Fact), true, ( [ 'leaves ' ], term_told(Fact), [ ' here' ] )).
own(take(Fact), true, ( [ 'takes ' ], term_told(Fact), [ ' up here' ] )).
own(goal(Goal), true, goal_shown(Goal)).

goal_shown(Goal) -->
    { copy_term(Goal, Shown, _),
      numbervars(Shown, 0, _, [singletons(true)])
    },
    [ '~W'-[ Shown, [ quoted(true), portray(false), numbervars(true),
                      max_depth(10), spacing(next_argument) ] ] ].

is_name(Name) :-
    atom(Name),
    sub_atom(Name, _, _, _, @),
    !.

named(Format, Name) -->
    { short_name(Name, Short) },
    [ Format-[Short] ].

%!  short_name(+Name, -Short) is det.
%
%   Short is the part before `@` in the id of an agent or the address of a host;
%   other names are unchanged.

short_name(Name, Short) :-
    atom(Name),
    sub_atom(Name, Before, _, _, @),
    !,
    sub_atom(Name, 0, Before, _, Short).
short_name(Name, Name).

                /*******************************
                *      REPORTS OF FAULTS       *
                *******************************/

:- multifile
    prolog:error_message//1,
    prolog:message//1.

prolog:error_message(permission_error(resume, agent, Agent)) -->
    [ 'Agent ~w is not faulty: there is nothing to resume'-[Agent] ].
prolog:error_message(step_not_completed) -->
    [ 'The step was not completed, and may have been done in part: \c
       this is a defect of Typhon or of an option' ].

prolog:message(typhon(faulty(Agent, Error, Fault))) -->
    agent_at(Agent, Fault),
    raised(Error, Agent),
    goal_of(Error, Fault),
    raised_in(Fault).
prolog:message(typhon(agent_failed(Agent, Fault))) -->
    agent_at(Agent, Fault),
    failed_last(Fault).
prolog:message(typhon(mailbox_full(Agent, Max))) -->
    [ 'Agent ~w is faulty, and its mailbox is full: messages beyond ~D \c
       are dropped'-[Agent, Max] ].
prolog:message(typhon(message_undone(Agent, From, Message, Fault))) -->
    agent_at(Agent, Fault),
    [ 'did not do with ' ],
    term_told(Message),
    [ ' from ~w what on_message/2 says; it '-[From] ],
    failed_last(Fault).

%   agent_at(+Agent, +Fault)//: the text is as "Agent x at beta (hop 3): ".

agent_at(Agent, Fault) -->
    { fault_told(Fault, _, _, Address, Hops),
      atomic_list_concat([Host|_], @, Address)
    },
    [ 'Agent ~w at ~w (hop ~D): '-[Agent, Host, Hops] ].

%   An undefined predicate is reported without the module of the agent.

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

%   The goal is reported if the error names neither the problem nor the
%   predicate that raised it, or if the clause is not known.

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

%   Goal calls a predicate in whose clause the error was raised.

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

%   clauses_told(+Where)//: the text names the clause of the goal and that of
%   its caller.

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
