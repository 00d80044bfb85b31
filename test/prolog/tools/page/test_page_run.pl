:- module(test_page_run, []).
:- use_module('../../../lib/common').

:- needs([page]).

% Virtual time under the control of a page.

:- use_module('../../../lib/browser').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/networks').
:- use_module('../../../lib/pages').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_between/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).

%   Three agents on a ring hop, sleep, and wait for messages with timeouts, some
%   of which become obsolete.

:- meta_predicate
    walk(+, -, 1),
    page(-, -, 0).

walk(Options, Network, Goal) :-
    with_network(ring(5), [ clock(virtual), seed(3), hop_time(uniform(1, 2))
                          | Options ], Network,
                 ( walker(Walker),
                   network_property(Network, hosts([A,B,C|_])),
                   findall(Agent, ( member(Host, [A,B,C]),
                                    agent_create(Walker, Agent, [host(Host)]) ),
                           Agents),
                   forall(member(Agent, Agents), agent_send(Agent, hello)),
                   call(Goal, Agents) )).

walker(clauses([ (:- agent(walker, [state([steps/1])])), steps(6),
                 (main :- retract(steps(N)), N > 0, !, N1 is N-1,
                          assertz(steps(N1)), next_host(random, Host),
                          move(Host), log(step(N)),
                          ( receive(_-hello, 50) -> true ; sleep(36) ), main),
                 main ])).

joined_all(Agents) :-
    forall(member(Agent, Agents), agent_join(Agent, done, 10 000)).

order(Base, What) :-
    order(Base, What, _{}).

order(Base, What, More) :-
    atom_string(What, Text),
    ask(Base, More.put(do, Text), Told),
    (   get_dict(error, Told, Error)
    ->  throw(error(page_said(Error), _))
    ;   true
    ).

run(Base, Run) :-
    ask(Base, _{ask:"run"}, Told),
    Run = Told.answer.

log_of(Dir, Name, Options, Goal, Text) :-
    atomic_list_concat([Dir, /, Name], File),
    walk([log(File)|Options], _, Goal),
    read_file_to_string(File, Text, []).

:- begin_tests(page_run).

%   However time is made to run, the log is the same.

test(steps_and_speeds_change_no_log) :-
    no_leaks(with_tmp_dir(test_page_run:same_logs)).

test(a_step_reaches_what_is_due_next, Times == [0.0,1.5,4.0,4.0]) :-
    page(Base, [A|_],
         ( agent_create(clauses([ (:- agent(sleeper)),
                                  (main :- sleep(1.5), sleep(2.5)) ]),
                        Agent, [host(A)]),
           time(Base, T0),
           findall(T, ( between(1, 3, _), order(Base, step), time(Base, T) ),
                   Later),
           agent_join(Agent, Outcome, 0) )),
    assertion(Outcome == done),
    Times = [T0|Later].

test(state, States == [none, paused, going, paused]) :-
    page(Base, _, findall(State,
                          ( member(What, [none, pause, go, step]),
                            ( What == none -> true ; order(Base, What) ),
                            state(Base, State) ),
                          States)).

%   At this speed time cannot come to the end of the sleep.

test(slow_time, true(Time < 1000)) :-
    page(Base, [A|_],
         ( agent_create(clauses([(:- agent(sleeper)), (main :- sleep(1.0e7))]),
                        _, [host(A)]),
           order(Base, speed, _{speed:0.1}),
           order(Base, go),
           wait_until(( time(Base, Now), Now > 0.02 ), 20),
           order(Base, pause),
           time(Base, Time),
           time(Base, Again) )),
    assertion(Time =:= Again).

test(orders_reach_agents_while_time_is_paused, Fact == got(word)) :-
    page(Base, [A|_],
         ( agent_create(clauses([ (:- agent(ear)),
                                  (main :- receive(_-Word),
                                           leave(got(Word))) ]),
                        Agent, [host(A)]),
           order(Base, step),
           agent_send(Agent, word),
           agent_join(Agent, done, 10),
           remote(A, take(Fact)) )).

test(speed_is_a_number, [ forall(member(Speed, [0, -1, "1", 1.0e300, []])),
                          error(page_said(_)) ]) :-
    page(Base, _, order(Base, speed, _{speed:Speed})).

test(real_time_cannot_be_controlled, Virtual == false) :-
    with_hosts([alpha],
               with_page([], Base,
                         ( run(Base, Run),
                           forall(member(What, ["go", "step"]),
                                  ( ask(Base, _{do:What}, Told),
                                    assertion(sub_string(Told.error, _, _, _,
                                                         "virtual")) )) ))),
    Virtual = Run.virtual.

%   A network that starts afterwards has no pace.

test(pause_ends_with_virtual_time) :-
    with_page([], Base,
              ( with_network(ring(2), [clock(virtual)], _, order(Base, pause)),
                with_network(ring(2), [clock(virtual)], Network,
                             network_advance(Network, 10)) )).

%   In Chromium the buttons do it; without the right they are disabled.

test(buttons) :-
    no_leaks(page(Base, _,
                  with_browser(Browser, ( browser_open(Browser, Base),
                                          forall(clause(scene(Browser), Goal),
                                                 Goal) )))).

test(read_only) :-
    with_network(ring(2), [clock(virtual)], _,
        with_page([read_only(true)], Base,
            with_browser(Browser,
                ( browser_open(Browser, Base),
                  browser_wait(Browser, "return document.querySelectorAll(\c
                      '.run-bar :disabled').length === 3") )))).

:- end_tests(page_run).

same_logs(Dir) :-
    log_of(Dir, free, [], joined_all, Free),
    forall(between(1, 6, Seed),
           ( set_random(seed(Seed)),
             log_of(Dir, Seed, [], by_page, Text),
             assertion(Text == Free) )).

by_page(Agents) :-
    with_page([], Base,
              ( controlled(Base),
                order(Base, speed, _{speed:null}),
                order(Base, go),
                joined_all(Agents) )).

controlled(Base) :-
    forall(between(1, 15, _),
           ( random_between(1, 4, Choice),
             control(Choice, Base) )).

control(1, Base) :- order(Base, go).
control(2, Base) :- order(Base, pause).
control(3, Base) :- order(Base, step).
control(4, Base) :- order(Base, speed, _{speed:200}).

page(Base, Hosts, Goal) :-
    with_network(ring(3), [clock(virtual), seed(1)], Network,
                 ( network_property(Network, hosts(Hosts)),
                   with_page([], Base, Goal) )).

time(Base, Time) :-
    run(Base, Run),
    Time = Run.time.

state(Base, State) :-
    run(Base, Run),
    atom_string(State, Run.state).

scene(Browser) :-
    browser_click(Browser, ".run-bar button"-"Go"),
    browser_wait(Browser, "return typhon.app.run.now.state === 'going'").
scene(Browser) :-
    browser_click(Browser, ".run-bar button"-"Pause"),
    browser_click(Browser, ".run-bar button"-"Step"),
    browser_wait(Browser, "return typhon.app.run.now.state === 'paused'").
scene(Browser) :-
    browser_run(Browser, "const s = document.querySelector('.run-bar input');
        s.value = 4; s.dispatchEvent(new Event('change'))", _),
    browser_wait(Browser, "return typhon.app.run.now.speed === null && \c
        document.querySelector('.run-speed').textContent === \c
            'as fast as it can'").
scene(Browser) :-
    browser_size(Browser, 400, 800),
    browser_run(Browser, "return document.documentElement.scrollWidth", Width),
    assertion(Width =< 400).
scene(Browser) :-
    browser_complaints(Browser, Texts),
    assertion(Texts == []).
