:- module(tartarus_lives,
          [ life_begin/4,               % +Name, +Location, +Handler, +Tokens
            life_begin/6,               % +Name, +Location, +Handler, +Tokens,
                                        % +Payload, +Clauses
            life_end/1,                 % +Name
            life_elsewhere/2,           % +Name, +Life
            record/3,                   % ?Name, ?Handler, ?Location
            record_life/2,              % +Name, ?Life
            record_payload/2,           % +Name, -Indicators
            record_tokens/2,            % +Name, -Tokens
            record_static/2,            % +Name, ?Key
            set_payload/2,              % +Name, +Indicators
            set_tokens/2,               % +Name, +Tokens
            run_handler/4,              % +Name, +Handler, +Start, +When
            run_apart/1,                % :Goal
            save_agent/2,               % +Name, +File
            save_tartarus_state/1,      % +File
            load_tartarus_state/1       % +File
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(listing), [portray_clause/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module('../typhon/kernel/base/private', [private_open/4]).
:- use_module(clauses, [body/3, body_copy/2, body_erase/2, body_install/1]).
:- use_module(platform, [here/1, must/1, port_closed/1, print_problem/2]).

/** <module> Agents of this platform: records, threads, beginning and end

An agent consists of a record and of clauses, see module `clauses`.  The record
is facts of module `user`, since programs read them.

Record and clauses are added and removed together.  After an agent has moved,
its clauses stay here until its last thread here has ended, since the thread may
need them.  They no longer belong to the agent: if it comes back meanwhile, it
brings its own clauses.

Each call of a handler has a thread, which may read, sleep and loop; no other
thread ends it.  Goals that must wait for the end of the last thread of an agent
run in threads of their own.

Agents are saved as text: an agent as its clauses, a platform as its agents
without their tokens.

*Threading*: any thread; a mutex for beginning and end, and one for threads.
*/

:- dynamic left/3.                      % Name, Id, Indicators: clauses to erase

%!  life_begin(+Name, +Location, +Handler, +Tokens) is det.
%!  life_begin(+Name, +Location, +Handler, +Tokens, +Payload, +Clauses) is det.
%
%   Add an agent, with the template of its handler or with Clauses.  An agent of
%   that name ends.

life_begin(Name, Location, Handler, Tokens) :-
    with_mutex(tartarus_lives,
               ( anew(Name, Location, Handler, Tokens),
                 body_copy(Name, (Handler,3)) )).

life_begin(Name, Location, Handler, Tokens, Payload, Clauses) :-
    with_mutex(tartarus_lives,
               ( anew(Name, Location, Handler, Tokens),
                 set_payload(Name, Payload),
                 catch(body_install(Clauses), Ball,
                       ( life_end(Name), throw(Ball) )) )).

anew(Name, Location, Handler, Tokens) :-
    life_end(Name),
    sweep(Name, _),
    record_add(Name, Handler, Location, Tokens).

%!  life_end(+Name) is det.

life_end(Name) :-
    with_mutex(tartarus_lives, forget(Name, Indicators)),
    body_erase(Name, Indicators).

forget(Name, [(Handler,3)|Payload]) :-
    record(Name, Handler, _),
    !,
    record_payload(Name, Payload),
    forall(record_static(Name, Key), port_closed(Key)),
    record_remove(Name).
forget(_, []).

%!  life_elsewhere(+Name, +Life) is det.
%
%   Remove Name, which has moved to another platform.  It may have come back
%   already: then Life is not its present one, and it stays.

life_elsewhere(Name, Life) :-
    flag(tartarus_left, Id, Id+1),
    (   with_mutex(tartarus_lives, leave(Name, Life, Id))
    ->  when_through(Name,
                     with_mutex(tartarus_lives,
                                tartarus_lives:sweep(Name, Id)))
    ;   true
    ).

leave(Name, Life, Id) :-
    record_life(Name, Life),
    forget(Name, Indicators),
    assertz(left(Name, Id, Indicators)).

sweep(Name, Id) :-
    retract(left(Name, Id, Indicators)),
    !,
    body_erase(Name, Indicators),
    sweep(Name, Id).
sweep(_, _).

                /*******************************
                *           RECORDS            *
                *******************************/

:- dynamic                              % programs look at these
    user:agent_GUID/3,                  % Name, Handler, Location
    user:agent_payload/2,               % Name, [(Predicate,Arity), ...]
    user:agent_token/2.                 % Name, Tokens

:- dynamic
    static/2.                           % Name, Key of its port

%!  record(?Name, ?Handler, ?Location) is nondet.
%
%   The agents of this platform, the oldest first.

record(Name, Handler, Location) :-
    user:agent_GUID(Name, Handler, Location).

record_add(Name, Handler, Location, Tokens) :-
    set_tokens(Name, Tokens),
    set_payload(Name, []),
    assertz(user:agent_GUID(Name, Handler, Location)).

record_remove(Name) :-
    retractall(user:agent_GUID(Name, _, _)),
    retractall(user:agent_payload(Name, _)),
    retractall(user:agent_token(Name, _)),
    retractall(static(Name, _)).

%!  record_life(+Name, ?Life) is semidet.
%
%   Life identifies the stay of Name from now until it ends or moves: if it
%   comes back, it has another Life.

record_life(Name, Life) :-
    clause(user:agent_GUID(Name, _, _), true, Life0),
    !,
    Life = Life0.

record_location(Name, Location) :-
    user:agent_GUID(Name, _, Location),
    !.

%!  record_payload(+Name, -Indicators) is det.
%!  record_tokens(+Name, -Tokens) is det.
%!  set_payload(+Name, +Indicators) is det.
%!  set_tokens(+Name, +Tokens) is det.

record_payload(Name, Indicators) :-
    (   user:agent_payload(Name, Indicators0)
    ->  Indicators = Indicators0
    ;   Indicators = []
    ).

record_tokens(Name, Tokens) :-
    (   user:agent_token(Name, Tokens0)
    ->  Tokens = Tokens0
    ;   Tokens = []
    ).

set_payload(Name, Indicators) :-
    retractall(user:agent_payload(Name, _)),
    assertz(user:agent_payload(Name, Indicators)).

set_tokens(Name, Tokens) :-
    retractall(user:agent_token(Name, _)),
    assertz(user:agent_token(Name, Tokens)).

%!  record_static(+Name, ?Key) is semidet.
%
%   Name has a port of its own: store its Key if it is bound, else return it.

record_static(Name, Key) :-
    (   nonvar(Key)
    ->  assertz(static(Name, Key))
    ;   static(Name, Key)
    ).

                /*******************************
                *           THREADS            *
                *******************************/

:- meta_predicate
    run_apart(0),
    when_through(+, 0).

:- dynamic
    last/2.                     % Name, Thread: runs its handler, the newest

%!  run_handler(+Name, +Handler, +Start, +When) is det.
%
%   Call Handler(Name, Location, Start) in a new thread.  When is `now`, or
%   `in_turn`: after the last thread of Name, if it runs, has ended.  Failure is
%   not reported, and an error only under debug(tartarus(handler)).

run_handler(Name, Handler, Start, When) :-
    record_location(Name, Location),
    Goal =.. [Handler,Name,Location,Start],
    with_mutex(tartarus_lives,
               ( before(When, Name, Before),
                 thread_create(tartarus_lives:handle(Name, Before, Goal),
                               Thread, [detached(true)]),
                 asserta(last(Name, Thread)) )).

before(now, _, none).
before(in_turn, Name, Thread) :-
    (   last(Name, Thread0)
    ->  Thread = Thread0
    ;   Thread = none
    ).

handle(Name, Before, Goal) :-
    call_cleanup(
        ( await(Before),
          catch(ignore(user:Goal), Ball, handle_ball(Ball, Name)) ),
        through(Name)).

%   An abort must end the thread, since the end of the process aborts it.

handle_ball('$aborted', _) :-
    throw('$aborted').
handle_ball(unwind(Reason), _) :-
    throw(unwind(Reason)).
handle_ball(Ball, Name) :-
    debug(tartarus(handler), 'the handler of ~w raised ~p', [Name, Ball]).

through(Name) :-
    thread_self(Me),
    with_mutex(tartarus_lives, retractall(last(Name, Me))).

%!  run_apart(:Goal) is det.
%
%   Run Goal in a thread that is not joined.

run_apart(Goal) :-
    thread_create(ignore(Goal), _, [detached(true)]).

%   when_through(+Name, :Goal) is det.
%
%   Call Goal when the last thread of Name has ended, at once if none runs.

when_through(Name, Goal) :-
    with_mutex(tartarus_lives, before(in_turn, Name, Thread)),
    (   Thread == none
    ->  call(Goal)
    ;   run_apart(( tartarus_lives:await(Thread), Goal ))
    ).

await(Thread) :-
    thread_wait(\+ last(_, Thread), [wait_preds([last/2])]).

                /*******************************
                *            SAVING            *
                *******************************/

%!  save_agent(+Name, +File) is semidet.
%
%   Write the clauses of an agent to File, as listing/1 does.

save_agent(Name, File) :-
    body_of(Name, Indicators, Clauses),
    setup_call_cleanup(
        private_open(File, write, Out, [encoding(utf8)]),
        ( forall(member((Predicate,Arity), Indicators),
                 format(Out, ":- dynamic ~q/~d.~n", [Predicate, Arity])),
          nl(Out),
          forall(member(Clause, Clauses), written(Out, Clause)) ),
        close(Out)).

body_of(Name, Indicators, Clauses) :-
    (   record(Name, Handler, _)
    ->  record_payload(Name, Payload),
        Indicators = [(Handler,3)|Payload],
        body(Name, Indicators, Clauses)
    ;   print_problem('There is no agent ~w here', [Name]),
        fail
    ).

written(Out, (Head:-true)) :-
    !,
    portray_clause(Out, Head).
written(Out, Clause) :-
    portray_clause(Out, Clause).

%!  save_tartarus_state(+File) is det.
%!  load_tartarus_state(+File) is semidet.
%
%   Write the agents of the platform to File; read and run them, from `main`.

save_tartarus_state(File) :-
    setup_call_cleanup(
        private_open(File, write, Out, [encoding(utf8)]),
        forall(record(Name, Handler, _), save(Out, Name, Handler)),
        close(Out)).

save(Out, Name, Handler) :-
    body_of(Name, [_|Payload], Clauses),
    portray_clause(Out, agent(Name, Handler, Payload, Clauses)).

load_tartarus_state(File) :-
    must([ check(ls1, 'the file exists', ( ground(File), exists_file(File) )),
           check(ls2, 'a platform has been started', here(_)) ]),
    read_file_to_terms(File, Agents, [encoding(utf8)]),
    here(Here),
    forall(member(agent(Name, Handler, Payload, Clauses), Agents),
           ( life_begin(Name, Here, Handler, [], Payload, Clauses),
             run_handler(Name, Handler, main, now) )).
