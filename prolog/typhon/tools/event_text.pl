:- module(typhon_event_text,
          [ event_lines/3,              % +What, //
            own_event/1,                % +What
            short_name/2                % +Name, -Short
          ]).
:- use_module('../kernel/base/error_text', [error_lines/3, term_lines/3]).
:- use_module('../kernel/agent', [fault_parts/5]).

/** <module> Texts of events and of faults of agents

The report of a fault is one sentence: the agent, its host, the number of hops,
the error, and the clause.

*Threading*: pure; print_message/2 calls it in any thread.
*/

%!  event_lines(+What, -Text, ?Rest) is det.
%
%   Text is the message for an event, see typhon_events: an act of an agent, or
%   an event that concerns an agent or a host.

event_lines(What) -->
    { own(What, If, Text), call(If) },
    !,
    Text.
event_lines(What) -->
    [ 'logs ' ],
    term_lines(What).

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
own(ended(Outcome), true, ([ 'ends, ' ], term_lines(Outcome))).
own(faulty(Error), true, ([ 'is faulty: ' ], term_lines(Error))).
own(fault(fault(Error, Goal, Place, _)), true,
    ( [ 'is faulty, ' ], term_lines(Error), [ ': ' ], term_lines(Goal),
      [ ', at ~w'-[Place] ] )).
own(link(To), is_name(To), named('is linked with ~w', To)).
own(unlink(To), is_name(To), named('is not linked with ~w any more', To)).
own(started, true, [ 'starts' ]).
own(stopped, true, [ 'stops' ]).
own(refused(Agent, Reason), atom(Agent),
    ( named('refuses ~w', Agent), [ ': ' ], term_lines(Reason) )).
own(left(To), is_name(To), named('leaves for ~w', To)).
own(stayed(To), is_name(To), named('could not go to ~w', To)).
own(arrived(From, Seconds), ( atom(From), number(Seconds) ),
    ( named('comes from ~w', From), [ ', in ~4g s'-[Seconds] ] )).
own(cloned(Clone), is_name(Clone), named('has a clone, ~w', Clone)).
own(sent(To), atom(To), named('sends to ~w', To)).
own(sent(To, Message), atom(To),
    ( [ 'sends ' ], term_lines(Message), named(' to ~w', To) )).
own(received(From), atom(From), named('takes a message from ~w', From)).
own(received(From, Message), atom(From),
    ( [ 'takes ' ], term_lines(Message), named(' from ~w', From) )).
own(leave(Fact), true, ( [ 'leaves ' ], term_lines(Fact), [ ' here' ] )).
own(take(Fact), true, ( [ 'takes ' ], term_lines(Fact), [ ' up here' ] )).
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
    [ 'on_message/2 for ' ],
    term_lines(Message),
    [ ' from ~w '-[From] ],
    failed_last(Fault).

%   agent_at(+Agent, +Fault)//: the text is as "Agent x at beta (hop 3): ".

agent_at(Agent, Fault) -->
    { fault_parts(Fault, _, _, Address, Hops),
      atomic_list_concat([Host|_], @, Address)
    },
    [ 'Agent ~w at ~w (hop ~D): '-[Agent, Host, Hops] ].

%   An undefined predicate is reported without the module of the agent.

raised(error(existence_error(procedure, Agent:PI), Context), Agent) -->
    !,
    [ 'Unknown procedure: ' ],
    term_lines(PI),
    advised(Context).
raised(Error, _) -->
    error_lines(Error).

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
    { fault_parts(Fault, Goal, Where, _, _) },
    [ 'failed: the goal that failed last was ' ],
    goal_lines(Goal),
    clauses_lines(Where).

%   The goal is reported if the error names neither the problem nor the
%   predicate that raised it, or if the clause is not known.

goal_of(Error, Fault) -->
    { fault_parts(Fault, Goal, Where, _, _) },
    (   { Where == [] ; needs_goal(Error), \+ goal_in_clause(Goal, Where) }
    ->  [ ', at ' ],
        goal_lines(Goal)
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

goal_in_clause(Goal, [[at(Name/Arity, _)|_]|_]) :-
    callable(Goal),
    functor(Goal, Name, Arity).

raised_in(Fault) -->
    { fault_parts(Fault, _, Where, _, _) },
    clauses_lines(Where).

goal_lines((If->true)) -->
    !,
    goal_lines(once(If)).
goal_lines((If->_)) -->
    !,
    [ '( ' ], goal_lines(If), [ ' -> ... ) without else' ].
goal_lines((If*->_)) -->
    !,
    [ '( ' ], goal_lines(If), [ ' *-> ... ) without else' ].
goal_lines(Goal) -->
    goal_shown(Goal).

%   clauses_lines(+Where)//: the text names the clause of the goal and that of
%   its caller.

clauses_lines([]) -->
    [].
clauses_lines([Places|Callers]) -->
    [ ', in ' ],
    places_lines(Places),
    callers_lines(Callers).

callers_lines([]) -->
    [].
callers_lines([Places|_]) -->
    [ ', called from ' ],
    places_lines(Places).

places_lines([Place]) -->
    place_lines(Place).
places_lines([Place,Other|Places]) -->
    place_lines(Place),
    [ ' or ' ],
    places_lines([Other|Places]).

place_lines(at(PI, File:Line)) -->
    { file_base_name(File, Base) },
    [ '~q (~w:~d)'-[PI, Base, Line] ].
place_lines(at(PI, clause(N))) -->
    [ '~q, clause ~d'-[PI, N] ].
place_lines(at(PI, state)) -->
    [ '~q, a rule of its own'-[PI] ].
