:- module(test_fixtures,
          [ with_hosts/2,               % +Specs, :Goal
            capturing/2,                % :Goal, -Messages
            was_printed/2,              % +Kind, ?Message
            printed_message/2,          % +Kind, ?Message
            create/2,                   % +Clauses, -Agent
            create/3,                   % +Clauses, -Agent, +Options
            result_on/3,                % +Specs, +Clauses, -Result
            joined/2,                   % +Agent, -Outcome
            state_of/2,                 % +Agent, ?State
            fact_of/2,                  % +Agent, ?Fact
            facts/2,                    % +Agent, -Facts
            wait_state/2,               % +Agent, ?State
            is_watched/1,               % +Host
            address/2                   % +Host, -Address
          ]).

/** <module> Hosts and agents for tests

Hosts that run during a goal and leave nothing behind, agents from a list of
clauses, and captured messages.

*Threading*: one test at a time.
*/

:- use_module(common).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(pairs),
              [map_list_to_pairs/3, pairs_values/2]).
:- use_module(library(typhon)).

:- meta_predicate
    with_hosts(+, 0),
    capturing(0, -).

%!  with_hosts(+Specs, :Goal) is semidet.
%
%   Calls Goal once while the hosts of Specs, Name or Name-Options, are
%   running.  Nothing may be left afterwards.

with_hosts(Specs, Goal) :-
    no_leaks(setup_call_cleanup(
                 maplist(start, Specs),
                 once(Goal),
                 maplist(stop, Specs))).

start(Name-Options) :-
    !,
    host_start(Name, Options).
start(Name) :-
    host_start(Name).

%   A test may have stopped its hosts itself.

stop(Name-_) :-
    !,
    stop(Name).
stop(Name) :-
    catch(host_stop(Name), error(existence_error(host, _), _), true).

                /*******************************
                *           MESSAGES           *
                *******************************/

:- dynamic
    listens/0,
    heard/2.                            % Kind, Term

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(Term, Kind, _) :-
    listens,
    memberchk(Kind, [error,warning,informational]),
    assertz(heard(Kind, Term)).

%!  capturing(:Goal, -Messages) is semidet.
%
%   Calls Goal once.  Messages are the errors, warnings and notices that
%   all threads would have printed meanwhile, as Kind-Term.

capturing(Goal, Messages) :-
    setup_call_cleanup(
        ( retractall(heard(_, _)), assertz(listens) ),
        once(Goal),
        retractall(listens)),
    findall(Kind-Term, heard(Kind, Term), Messages).

%!  was_printed(+Kind, ?Message) is semidet.
%!  printed_message(+Kind, ?Message) is nondet.
%
%   Goals of capturing/2 can wait for a Message; enumerate the messages so
%   far.

was_printed(Kind, Message) :-
    heard(Kind, Message),
    !.

printed_message(Kind, Message) :-
    heard(Kind, Message).

                /*******************************
                *            AGENTS            *
                *******************************/

%!  create(+Clauses, -Agent) is det.
%!  create(+Clauses, -Agent, +Options) is det.
%
%   An agent of these clauses; s/1 and r/1 are its state.

create(Clauses, Agent) :-
    create(Clauses, Agent, []).

create(Clauses, Agent, Options) :-
    agent_create(clauses([(:- agent(test, [state([s/1, r/1])]))|Clauses]),
                 Agent, Options).

%!  result_on(+Specs, +Clauses, -Result) is semidet.
%
%   Result is that of an agent of Clauses, on the first of the hosts Specs.

result_on([Spec|Specs], Clauses, Result) :-
    ( Spec = Host-_ -> true ; Host = Spec ),
    with_hosts([Spec|Specs],
               ( create(Clauses, Agent, [host(Host)]),
                 agent_result(Agent, Result, 20) )).

%!  joined(+Agent, -Outcome) is det.
%
%   Outcome is the outcome of Agent, or `timeout` after a generous time.

joined(Agent, Outcome) :-
    agent_join(Agent, Outcome, 20).

state_of(Agent, State) :-
    agent_property(Agent, state(State)).

fact_of(Agent, Fact) :-
    agent_property(Agent, facts(Facts)),
    member(Fact, Facts).

%!  facts(+Agent, -Facts) is det.
%
%   The state of Agent, in the order of the names of its predicates.

facts(Agent, Facts) :-
    agent_property(Agent, facts(Facts0)),
    map_list_to_pairs(predicate_of, Facts0, Pairs0),
    keysort(Pairs0, Pairs),
    pairs_values(Pairs, Facts).

predicate_of(Clause, Name/Arity) :-
    ( Clause = (Head:-_) -> true ; Head = Clause ),
    functor(Head, Name, Arity).

%!  wait_state(+Agent, ?State) is det.

wait_state(Agent, State) :-
    wait_until(state_of(Agent, State), 10).

address(Host, Address) :-
    host_property(Host, address(Address)).

%!  is_watched(+Host) is semidet.
%
%   The process of Host sends events to a watch.

is_watched(Host) :-
    remote(Host, ( thread_property(_, alias(Alias)),
                   sub_atom(Alias, 0, _, _, typhon_event_sender) )).
