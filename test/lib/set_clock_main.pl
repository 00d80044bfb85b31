:- module(set_clock_main, [set_clock_main/0]).

/** <module> What happens when the time of day is set

    swipl -g set_clock_main test/lib/set_clock_main.pl -- Step Scenario ...

runs scenarios while the time of day is set by so many seconds, and prints a list
of terms Scenario-Result that test_set_clock.pl expects.  All waits for a second
are one scenario: they wait together, and the clock is set once.

*Threading*: a thread for each wait, and one that sets the clock.
*/

:- use_module(common).
:- use_module(set_clock).
:- use_module(library(lists), [append/3, last/2, member/2, nth1/3, numlist/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(random), [random_member/2]).
:- use_module(library(thread), [concurrent/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel), [agents_run/1]).
:- use_module(library(typhon/kernel/base/monotonic), [wait_within/2]).

set_clock_main :-
    current_prolog_flag(argv, [Text|Names]),
    atom_number(Text, Step),
    findall(Name-Result, ( member(Name, Names), clock_set(0),
                           scenario(Name, Step, Result) ),
            Results),
    format("~q.~n", [Results]),
    halt.

%   meanwhile(+Step, :Goal): the clock is set by Step 0.3 s after Goal began.

:- meta_predicate meanwhile(+, 0).

meanwhile(Step, Goal) :-
    thread_create(( sleep(0.3), clock_set(Step) ), Setter),
    call(Goal),
    thread_join(Setter).

:- meta_predicate lasts(+, 0, -).

%   Word says whether Goal, which is to wait for a second, waits so long, not
%   a step longer or shorter.  A loaded computer may add some seconds.

lasts(Step, Goal, Word) :-
    meanwhile(Step, lasts(Goal, Word)).

:- meta_predicate lasts(0, -).

lasts(Goal, Word) :-
    seconds_of(Goal, Seconds),
    (   Seconds < 0.9
    ->  Word = early(Seconds)
    ;   Seconds < 25
    ->  Word = in_time
    ;   Word = late(Seconds)
    ).

scenario(waits, Step, Results) :-
    ( python_waits -> Naps = [nap, long_nap] ; Naps = [] ),
    append([sleep, receive, join, agents_run], Naps, Waits),
    project_file('test/lib/python_functions.py', File),
    host_start(here),
    host_start(there),
    (   Naps == []
    ->  true
    ;   python_start(here, File, [timeout(20)]),
        python_start(there, File, [timeout(1)])
    ),
    findall(waited(Wait, _), member(Wait, Waits), Goals),
    length(Goals, Count),
    meanwhile(Step, concurrent(Count, Goals, [])),
    findall(Result, member(waited(_, Result), Goals), Results),
    host_stop(there),
    host_stop(here).
scenario(now, _, Back) :-
    host_start(here),
    numlist(1, 10, Rounds),
    foldl(later_than, Rounds, 0-0, _-Back),
    host_stop(here).
scenario(child, Step, Word) :-          % host time of the network is from 0
    host_start(here),
    clock_set(Step),
    network_start(ring(2), Network, [processes(2)]),
    network_property(Network, hosts(Hosts)),
    last(Hosts, Far),
    remote(Far, now(Time)),
    network_stop(Network),
    host_stop(here),
    ( Time > -1, Time < 25 -> Word = same ; Word = other(Time) ).
scenario(network, Step, Outcome-Word) :-
    lasts(Step, ( network_start(ring(4), Network, [processes(2)]),
                  network_property(Network, hosts([Host|_])),
                  agent_create(clauses([ (:- agent(walker, [])),
                                         (main :- walk(10)),
                                         (walk(0) :- !),
                                         (walk(N) :- neighbours(Hs),
                                                     random_member(H, Hs),
                                                     move(H), sleep(0.1),
                                                     N1 is N-1, walk(N1)) ]),
                               Agent, [host(Host)]),
                  agent_join(Agent, Outcome, 100) ),
          Word0),
    seconds_of(network_stop(Network), Seconds),
    ( Seconds < 25 -> Word = Word0 ; Word = late(Seconds) ).
scenario(chaos, Most, Outcomes) :-
    network_start(ring(4), Network, [processes(2)]),
    network_property(Network, hosts(Hosts)),
    thread_create(set_randomly(Most), Setter),
    findall(Agent,
            ( between(1, 12, I), nth1(At, Hosts, Host), At =:= I mod 4+1,
              agent_create(clauses([ (:- agent(walker, [state([sum/1])])),
                                     sum(0),
                                     (main :- walk(60)),
                                     (walk(0) :- !, sum(60)),
                                     (walk(N) :- neighbours(Hs),
                                                 random_member(H, Hs), move(H),
                                                 retract(sum(S)), S1 is S+1,
                                                 assertz(sum(S1)), rest(N),
                                                 N1 is N-1, walk(N1)),
                                     (rest(N) :- N mod 6 =:= 0, !, sleep(0.2)),
                                     (rest(N) :- N mod 6 =:= 1, !,
                                                 ( receive(_-x, 0.1) -> fail ; true )),
                                     rest(_) ]), Agent, [host(Host)]) ),
            Agents),
    findall(Outcome,
            ( member(Agent, Agents), agent_join(Agent, Outcome, 100) ),
            All),
    thread_send_message(Setter, stop),
    thread_join(Setter),
    network_stop(Network),
    sort(All, Outcomes).

%   wait(+Wait, -Outcome): a wait for a second.

wait(sleep, Outcome) :-
    waiter([(main :- sleep(1))], Agent),
    agent_join(Agent, Outcome, 100).
wait(receive, Outcome) :-
    waiter([(main :- ( receive(_-never, 1) -> fail ; true ))], Agent),
    agent_join(Agent, Outcome, 100).
wait(join, Outcome) :-
    waiter([(main :- receive(_-never))], Agent),
    agent_join(Agent, Outcome, 1).
wait(agents_run, done) :-
    agents_run(1).
wait(nap, Value) :-
    remote(here, nap(1, Value)).
wait(long_nap, Caught) :-
    catch(remote(there, nap(40, _)), error(Formal, _), true),
    functor(Formal, Caught, _).

waiter(Clauses, Agent) :-
    agent_create(clauses([(:- agent(waiter, []))|Clauses]), Agent,
                 [host(here)]).

waited(Wait, Outcome-Word) :-
    lasts(wait(Wait, Outcome), Word).

set_randomly(Most) :-
    thread_self(Me),
    (   wait_within(0.1, thread_get_message(Me, stop))
    ->  true
    ;   random_member(Part, [-1, -0.01, 0, 0.01, 1]),
        Seconds is Part*Most,
        clock_set(Seconds),
        set_randomly(Most)
    ).

%   later_than(+Round, +Last-Back, -Last-Back): Back is how far now/1 has gone
%   back.

later_than(Round, Last0-Back0, Last-Back) :-
    Seconds is 3600*(Round mod 3-1),
    clock_set(Seconds),
    numlist(1, 300, Times),
    foldl(reading, Times, Last0-Back0, Last-Back).

reading(_, Last-Back0, Now-Back) :-
    remote(here, now(Now)),
    Back is max(Back0, Last-Now).
