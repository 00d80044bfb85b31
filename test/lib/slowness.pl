:- module(test_slowness,
          [ measure_slowness/0,
            slowness/1,                 % -Factor
            patience/2                  % +Seconds, -Longer
          ]).
:- use_module(library(terms), [mapsubterms/3]).

/** <module> How slow this machine is

The deadlines of tests are for a machine like that on which they were written,
and only end tests that hang. test/run.pl measures once how many times slower
this one is now, and hands a few times as much, for what it runs later, to its
suites in the environment, where it may also be given:

    TYPHON_SLOWNESS=4 swipl test/run.pl

Deadlines become that much longer: those of wait_until/2 and of all that is
built on it, and, when a suite is loaded, those that patient/4 lists, if they
are integers: a time that is tested itself is written as 10.0.  Where nothing was
measured, deadlines are as written.

*Threading*: any thread.
*/

%!  measure_slowness is det.
%
%   Set TYPHON_SLOWNESS for the processes that this one starts.

measure_slowness :-
    getenv('TYPHON_SLOWNESS', _),
    !.
measure_slowness :-
    get_time(Start),
    work(10 000 000),
    get_time(End),
    usual_time(Usual),
    busier(Times),
    Slowness is Times*max(1.0, (End-Start)/Usual),
    setenv('TYPHON_SLOWNESS', Slowness).

busier(4).                              % suites at a time, and their processes

%   By the clock, as other processes take the processor meanwhile; long enough
%   that they do.

work(0) :-
    !.
work(N) :-
    M is N-1,
    work(M).

usual_time(0.16).                       % of one of two free cores

%!  slowness(-Factor:float) is det.
%
%   At least 1.0.

slowness(Factor) :-
    getenv('TYPHON_SLOWNESS', Atom),
    atom_number(Atom, Number),
    Number > 1,
    !,
    Factor is float(Number).
slowness(1.0).

%!  patience(+Seconds, -Longer) is det.

patience(Seconds, Longer) :-
    slowness(Factor),
    Longer is Factor*Seconds.

                /*******************************
                *       WAITS OF SUITES        *
                *******************************/

%   patient(?Goal, ?Seconds, ?Longer, ?More): Longer is Goal with More in place of
%   Seconds.
%   Short ones, and the outcome `timeout`, are part of what is tested.

patient(agent_join(Agent, Outcome, S), S, agent_join(Agent, Outcome, L), L) :-
    Outcome \== timeout.
patient(agent_result(Agent, Result, S), S, agent_result(Agent, Result, L), L).
patient(thread_get_message(Queue, M, [timeout(S)]), S,
        thread_get_message(Queue, M, [timeout(L)]), L).
patient(endpoint_call(To, Kind, Term, Answer, S), S,
        endpoint_call(To, Kind, Term, Answer, L), L) :-
    nonvar(Answer).
patient(set_stream(Stream, timeout(S)), S, set_stream(Stream, timeout(L)), L).

:- dynamic system:goal_expansion/2.
:- multifile system:goal_expansion/2.

:- if(( slowness(Factor), Factor > 1 )).

%   In another process, a goal is data here.

longer(peer_do(Peer, Goal0), peer_do(Peer, Goal)) :-
    mapsubterms(longer, Goal0, Goal),
    Goal \== Goal0.
longer(Goal, Longer) :-
    patient(Goal, Seconds, Longer, More),
    integer(Seconds),                   % and More is none
    Seconds >= 5,
    patience(Seconds, More).

system:goal_expansion(Goal, Longer) :-
    longer(Goal, Longer),
    prolog_load_context(source, File),
    sub_atom(File, _, _, _, '/test/').

:- endif.
