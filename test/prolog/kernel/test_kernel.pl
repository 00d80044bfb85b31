:- module(test_kernel, []).
:- use_module('../../lib/common').
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon/kernel/host)).
:- use_module(library(typhon/kernel/lifecycle)).
:- use_module(library(typhon/kernel/vocabulary), []).

/** <module> The kernel runs without options, which may be loaded later

This suite does not load library(typhon).

*Threading*: one test at a time.
*/

:- multifile prolog:message//1.

prolog:message(typhon(_)) --> [].       % the texts are among the tools

%   life(+Options, -Outcome): the outcome of an agent that acts, hops and
%   clones between two hosts of this process.

life(Options, Outcome) :-
    no_leaks(setup_call_cleanup(
                 ( host_start(a, Options), host_start(b, Options) ),
                 traveller(Outcome),
                 ( host_stop(a), host_stop(b) ))).

traveller(Outcome) :-
    host_address(b, B),
    agent_create(
        clauses([ (:- agent(traveller, [state([seen/1])])),
                  (main :- receive(_-go(Host)), home(Home), move(Host),
                           assertz(seen(Host)), leave(was(here)),
                           leave(was(there)), clone(Branch),
                           ( Branch = parent(_)
                           -> move(Home), log(back)
                           ;  true ))
                ]),
        Agent, [host(a)]),
    agent_send(Agent, go(B)),
    agent_join(Agent, Outcome, 10).

loaded(Option) :-
    source_file(File),
    atomic_list_concat([_,Path], '/prolog/typhon/options/', File),
    atomic_list_concat([Option|_], /, Path).

:- begin_tests(kernel).

test(no_option_is_loaded, Outcome-Options == done-[]) :-
    life([], Outcome),
    findall(Option, loaded(Option), Options).

%   In this order: loaded options remain for the next test.

test(options_load_later,
     [ forall(member(Path-Options,
                     [ quotas-[quota([hops(100), tuples(10)])],
                       virtual-[clock(virtual)],
                       trace-[] ])),
       Outcome == done ]) :-
    use_module(library(typhon/options/Path), []),
    life(Options, Outcome).
test(exceeded_quota,
     Outcome = raised(error(resource_error(tuples), _))) :-
    life([quota([tuples(1)])], Outcome).

:- end_tests(kernel).
