:- module(test_fake_agent,
          [ fake_agent/3,               % +Program, +Facts, +Tuples
            fake_at/1,                  % +Time
            fake_mail/1,                % +From-Message
            fake_reply/2,               % +To-Message, +From-Reply
            fake_dead/1,                % +Id
            fake_clone/1,               % +Answer
            fake_refusal/1,             % +Host
            fake_neighbours/1,          % +Hosts
            did/1,                      % -Acts
            did_just/1,                 % +Acts
            tuples/1,                   % -Tuples
            just_tuples/1,              % +Tuples
            fake_fact/1,                % +Fact
            fake_run/4,                 % +Before, +Goal, +Checks, -Wrong
            alike/2                     % ?Expected, +Term
          ]).
:- use_module(common, [project_file/2]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists)).
:- use_module(library(readutil)).
:- use_module(library(terms), [mapargs/3]).

/** <module> An agent on a simulated host

Agent programs become clauses of module fake_agent, which are called like any
others: the vocabulary of agents is that of module fake_host here. Nothing
moves or waits.  sleep/1 sets the clock forward; receive/2 finds a message or
fails, at the time until which it would have waited; clone/1 returns the
answer set by fake_clone/1, move/1 raises an error for hosts of
fake_refusal/1, next_host/2 always chooses `next`, and fake_reply/2 defines
answers to messages.  here/1 is `here` until the agent moves.

*Threading*: one agent at a time.
*/

:- dynamic
    fake_host:tuple/1,
    fake_host:did/1,
    fake_host:time/1,
    fake_host:mail/1,
    fake_host:reply/2,
    fake_host:dead/1,
    fake_host:answer/1,
    fake_host:refuses/1,
    fake_host:neighbours/1.

fake_host:leave(Fact) :- assertz(fake_host:tuple(Fact)).
fake_host:take(Fact)  :- retract(fake_host:tuple(Fact)), !.
fake_host:sense(Fact) :- fake_host:tuple(Fact).
fake_host:log(What)   :- assertz(fake_host:did(log(What))).
fake_host:self(me).
fake_host:hops(3).
fake_host:host_load(1).
fake_host:now(Time) :- fake_host:time(Time).
fake_host:next_host(_, next).
fake_host:emit(Problem, _)  :- assertz(fake_host:did(emit(Problem))).
fake_host:withdraw(Problem) :- assertz(fake_host:did(withdraw(Problem))).
fake_host:dispose :- throw(disposed).
fake_host:payload(_, _).               % the declaration of a payload

fake_host:send(Id, _) :-
    fake_host:dead(Id),
    throw(error(host_unreachable(nowhere), _)).
fake_host:send(Id, Message) :-
    assertz(fake_host:did(send(Id, Message))),
    (   retract(fake_host:reply(Id-Message, Mail))
    ->  fake_mail(Mail)
    ;   true
    ).

fake_host:here(Host) :-
    findall(To, fake_host:did(move(To)), Moves),
    last([here|Moves], Host).

fake_host:sleep(Seconds) :-
    pass(Seconds).

fake_host:receive(Message) :-
    retract(fake_host:mail(Message)),
    !.

fake_host:receive(Message, Seconds) :-
    (   retract(fake_host:mail(Message))
    ->  true
    ;   pass(Seconds),
        fail
    ).

fake_host:clone(Branch) :-
    (   retract(fake_host:answer(Answer))
    ->  true
    ;   Answer = parent(child)
    ),
    (   Answer = error(_, _)
    ->  throw(Answer)
    ;   Branch = Answer
    ).

fake_host:move(Host) :-
    (   fake_host:refuses(Host)
    ->  throw(error(move_refused(Host, capacity), _))
    ;   assertz(fake_host:did(move(Host)))
    ).

pass(Seconds) :-
    number(Seconds),
    !,
    retract(fake_host:time(Time0)),
    Time is Time0 + Seconds,
    assertz(fake_host:time(Time)).
pass(_).

%!  fake_agent(+Program, +Facts, +Tuples) is det.
%
%   An agent of Program, a file of the project, in module fake_agent, with
%   Facts beside its own, on a host with Tuples, at time 0.

fake_agent(Program, Facts, Tuples) :-
    forget,
    add_import_module(fake_agent, fake_host, start),
    project_file(Program, File),
    load_clauses(File),
    forall(member(Fact, Facts), assertz(fake_agent:Fact)),
    forall(member(Tuple, Tuples), assertz(fake_host:tuple(Tuple))),
    fake_at(0).

forget :-
    forall(( current_predicate(fake_agent:Name/Arity),
             functor(Head, Name, Arity),
             \+ predicate_property(fake_agent:Head, imported_from(_))
           ),
           retractall(fake_agent:Head)),
    forall(member(Head, [tuple(_), did(_), mail(_), reply(_, _), dead(_),
                         answer(_), refuses(_), neighbours(_)]),
           retractall(fake_host:Head)),
    fake_neighbours([]).

load_clauses(File) :-
    read_file_to_terms(File, Terms, []),
    forall(member(Term, Terms), load_clause(Term, File)).

load_clause((:- agent(_, Options)), _) :-
    !,
    forall(( member(state(PIs), Options), member(PI, PIs) ),
           dynamic(fake_agent:PI)).
load_clause((:- include(Name)), File) :-
    !,
    absolute_file_name(Name, Included,
                       [ relative_to(File), extensions([pl]),
                         access(read) ]),
    load_clauses(Included).
load_clause((:- discontiguous(_)), _) :-
    !.
load_clause((:- Directive), _) :-
    !,
    call(fake_agent:Directive).
load_clause(Clause, _) :-
    assertz(fake_agent:Clause).

%!  fake_at(+Time) is det.
%!  fake_mail(+Message) is det.
%!  fake_reply(+Sent, +Message) is det.
%!  fake_dead(+Id) is det.
%!  fake_clone(+Answer) is det.
%!  fake_refusal(+Host) is det.
%!  fake_neighbours(+Hosts) is det.
%
%   Set the clock; add a From-Message for the agent; add a Message that
%   arrives, once, when it has sent Sent, a To-Message; mark the process of Id
%   as gone; set the answer to the agent's next clone (an error is raised);
%   let Host refuse it; and set its neighbours, on any host.

fake_at(Time) :-
    retractall(fake_host:time(_)),
    assertz(fake_host:time(Time)).

fake_mail(Message) :-
    assertz(fake_host:mail(Message)).

fake_reply(Sent, Message) :-
    assertz(fake_host:reply(Sent, Message)).

fake_dead(Id) :-
    assertz(fake_host:dead(Id)).

fake_clone(Answer) :-
    assertz(fake_host:answer(Answer)).

fake_refusal(Host) :-
    assertz(fake_host:refuses(Host)).

fake_neighbours(Hosts) :-
    retractall(fake_host:neighbours(_)),
    assertz(fake_host:neighbours(Hosts)).

%!  did(-Acts) is det.
%!  did_just(+Acts) is semidet.
%!  tuples(-Tuples) is det.
%!  just_tuples(+Tuples) is semidet.
%
%   The actions of the agent, in order, and the tuples of the host. Two fail if
%   the list is another.

did(Acts) :-
    findall(Act, fake_host:did(Act), Acts).

did_just(Acts) :-
    did(All),
    All == Acts.

tuples(Tuples) :-
    findall(Tuple, fake_host:tuple(Tuple), Tuples).

just_tuples(Tuples) :-
    tuples(All),
    All == Tuples.

%!  fake_fact(+Fact) is det.
%
%   Fact is the only one of its name and arity that the agent has.

fake_fact(Fact) :-
    functor(Fact, Name, Arity),
    functor(General, Name, Arity),
    retractall(fake_agent:General),
    assertz(fake_agent:Fact).

%!  fake_run(+Before, +Goal, +Checks, -Wrong) is det.
%
%   Call the goals Before of this module, then Goal of the agent. Wrong are the
%   Checks that fail then: a goal of the agent, or Name=Expected, where Name is
%   `end` (of Goal: true, fail or what it raises; true if no check is about it),
%   `did`, `tuples`, `time`, or that of a fact with one argument.

fake_run(Before, Goal, Checks0, Wrong) :-
    maplist(call, Before),
    end_of(Goal, End),
    (   memberchk(end=_, Checks0)
    ->  Checks = Checks0
    ;   Checks = [end=true|Checks0]
    ),
    findall(Check, ( member(Check, Checks), \+ holds(Check, End) ), Wrong).

end_of(Goal, End) :-
    (   catch(fake_agent:Goal, End, true)
    ->  ( var(End) -> End = true ; true )
    ;   End = fail
    ).

holds(Name=Expected, End) :-
    !,
    once(( seen(Name, End, Value), alike(Expected, Value) )).
holds(Goal, _) :-
    once(fake_agent:Goal).

seen(end, End, End) :- !.
seen(did, _, Acts) :- !, did(Acts).
seen(tuples, _, Tuples) :- !, tuples(Tuples).
seen(time, _, Time) :- !, fake_host:time(Time).
seen(Name, _, Value) :-
    call(fake_agent:Name, Value).

%!  alike(?Expected, +Term) is semidet.
%
%   Term is an instance of Expected, whose numbers are those of Term to nine
%   digits.

alike(Expected, Term) :-
    (   number(Expected)
    ->  number(Term),
        abs(Expected-Term) =< 1.0e-9*max(1, abs(Term))
    ;   compound(Expected)
    ->  compound(Term),
        mapargs(alike, Expected, Term)
    ;   var(Expected)
    ->  Expected = Term
    ;   Expected == Term
    ).
