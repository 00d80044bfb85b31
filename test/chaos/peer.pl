:- module(chaos_peer, [peer/0, chaos_note/3]).

/** <module> The processes under attack

    swipl -g chaos_peer:peer test/chaos/peer.pl -- Options

takes terms ask(Tag, Goal) on standard input, runs once(Goal) in a thread
for each, and prints answer(Tag, Result): yes(Goal), `no` or
raised(Error).  Ends with its input.  Options:

    --ledger=File            where chaos_note/3 writes

*Threading*: one thread reads, each goal has a thread of its own.
*/

:- use_module('../lib/common', []).
:- use_module('../lib/peer_main', []).
:- use_module(library(typhon)).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, subtract/3]).
:- use_module(library(main), [argv_options/3]).
:- use_module(library(option), [option/2]).

:- dynamic
    ledger/1,                           % Stream
    mine/1.                             % Things there before any host

peer :-
    current_prolog_flag(argv, Argv),
    argv_options(Argv, _, Options),
    peer_main:set_up(Options),
    option(ledger(File), Options),
    open(File, append, Stream, [buffer(line)]),
    assertz(ledger(Stream)),
    serve,
    halt.

serve :-
    read_term(user_input, Term, []),
    (   Term = ask(Tag, Goal)
    ->  thread_create(answer(Tag, Goal), _, [detached(true)]),
        serve
    ;   true
    ).

answer(Tag, Goal) :-
    catch(( chaos_peer:Goal -> Result = yes(Goal) ; Result = no ),
          Ball,
          raised(Ball, Result)),
    with_mutex(chaos_answer,
               ( format('~k.~n', [answer(Tag, Result)]),
                 flush_output )).

raised(error(Formal, _), raised(Formal)) :-
    !.
raised(Ball, raised(Ball)).

                /*******************************
                *          THE LEDGER          *
                *******************************/

%!  chaos_note(+Agent, +Tick, +Event) is det.
%
%   A service of all hosts: records an action of an agent outside of it. The
%   line has been passed to the operating system when this returns, so it
%   survives the process.

chaos_note(Agent, Tick, Event) :-
    get_time(Now),
    ledger(Stream),
    format(Stream, '~k.~n', [e(Agent, Tick, Event, Now)]).

%   The process that ended an agent in doubt cannot know whether it continues.

:- multifile user:message_hook/3.

user:message_hook(typhon(ended_in_doubt(Id, _)), _, _) :-
    chaos_note(Id, 0, ended_in_doubt),
    fail.

                /*******************************
                *       WHAT IS ASKED FOR      *
                *******************************/

%   open_hosts(+Names, +Port, +Known): as many as there are Names.  The endpoint
%   listens at Port, and announces the port Known of the proxy before it.

open_hosts(Names, Port, Known) :-
    atom_concat('127.0.0.1:', Known, Address),
    findall(Thing, thing(Thing), Things),
    assertz(mine(Things)),
    forall(member(Name, Names),
           host_start(Name, [ port(Port), advertise(Address),
                              services([chaos_peer]) ])).

on_all_hosts(Goal) :-
    forall(host_property(Host, state(running)), remote(Host, Goal)).

%   census(-Agents): agent(Id, State, Hops, Facts) of the agents in this
%   process, without their ballast.

census(Agents) :-
    findall(Address, host_property(_, address(Address)), Addresses),
    findall(Id-Property, agent_property(Id, Property), All),
    findall(Id, member(Id-_, All), Ids0),
    sort(Ids0, Ids),
    findall(Agent,
            ( member(Id, Ids), described(Id, All, Addresses, Agent) ),
            Agents).

described(Id, All, Addresses, agent(Id, State, Hops, Facts)) :-
    memberchk(Id-host(Address), All),
    memberchk(Address, Addresses),
    memberchk(Id-state(State), All),
    memberchk(Id-hops(Hops), All),
    memberchk(Id-facts(Facts0), All),
    findall(Fact, ( member(Fact, Facts0), wanted(Fact) ), Facts).

wanted(me(_)).
wanted(tick(_)).
wanted(steps(_)).
wanted(token(_)).
wanted(said(_, _)).
wanted(heard(_)).

tuples(Tuples) :-
    findall(Found,
            ( host_property(Host, state(running)),
              remote(Host, findall(token(K), sense(token(K)), Found)) ),
            Lists),
    append(Lists, Tuples).

%   outcomes(+Ids, -Pairs): the outcomes of those of Ids that have ended. News
%   of the last ends may be under way: news are posted after pauses of up to
%   ten seconds.

outcomes(Ids, Pairs) :-
    get_time(Now),
    Deadline is Now+12,
    findall(Id-Outcome,
            ( member(Id, Ids), outcome(Id, Deadline, Outcome) ),
            Pairs).

outcome(Id, Deadline, Outcome) :-
    get_time(Now),
    Seconds is max(0.5, Deadline-Now),
    catch(agent_join(Id, Outcome, Seconds), error(Formal, _),
          Outcome = error(Formal)).

%   The stack of the timer, in kB.

timer_size(Size) :-
    catch(( thread_property(Timer, alias(Alias)),
            sub_atom(Alias, 0, _, _, typhon_timer_),
            thread_statistics(Timer, stack, Bytes),
            Size is Bytes//1024 ),
          error(_, _), Size = 0),
    !.
timer_size(0).

%   close_hosts(-Left): stop all hosts and return the threads and message
%   queues that are left after at most five seconds.

close_hosts(Left) :-
    findall(Host, host_property(Host, state(running)), Hosts),
    maplist(host_stop, Hosts),
    catch(test_common:wait_until(chaos_peer:left([]), 5),
          error(timeout_error(_, _), _), true),
    left(Left).

left(Left) :-
    garbage_collect_atoms,
    mine(Mine),
    findall(Thing, thing(Thing), Things),
    subtract(Things, Mine, Left0),
    thread_self(Me),
    findall(Text,
            ( member(Thing, Left0),
              Thing \== thread(Me),
              format(atom(Text), '~q', [Thing]) ),
            Left).

thing(thread(Thread)) :-
    thread_property(Thread, status(running)),
    \+ ( catch(thread_property(Thread, alias(Alias)),
               error(existence_error(thread, _), _), fail),
         memberchk(Alias, [gc,main,'__thread_pool_manager']) ).
thing(queue(Queue)) :-
    message_queue_property(Queue, size(_)).
