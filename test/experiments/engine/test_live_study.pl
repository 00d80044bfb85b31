:- module(test_live_study, []).
:- use_module('../../lib/common').

:- needs([page]).

% A study on a page: its parameters, one run, its measures while it runs.

:- use_module('../../lib/browser').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/pages').
:- use_module('../../lib/texts', [write_file/2]).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/live').
:- use_module('../../../experiments/engine/run', [run_log/5]).
:- use_module('../../../experiments/engine/studies', [study_call/2, study_load/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [last/2, member/2, memberchk/2]).
:- use_module(library(plunit)).

:- meta_predicate page(-, 0), page(+, -, 0).

study(Study) :-
    project_file('examples/studies/coverage.pl', File),
    study_load(File, Study).

page(Base, Goal) :-
    page([], Base, Goal).

page(Options, Base, Goal) :-
    study(Study),
    no_leaks(with_page([model(study_live:live(Study))|Options], Base, Goal)).

order(Base, Message) :-
    ask(Base, Message, Told),
    (   get_dict(error, Told, Error)
    ->  throw(error(page_said(Error), _))
    ;   true
    ).

model(Base, Message, Model) :-
    ask(Base, Message.put(ask, "model"), Told),
    Model = Told.answer.

begin(Base, Values) :-
    order(Base, _{do:"set_up", values:Values}).

finished(Base, Model) :-
    order(Base, _{do:"speed", speed:null}),
    order(Base, _{do:"go"}),
    wait_until(( model(Base, _{}, Now), Now.state \== "running" ), 60),
    model(Base, _{}, Model).

%   stubborn(+Request): a model whose run waits for ever, and catches all.

stubborn(about("Stubborn", [])).
stubborn(set_up([])).
stubborn(measures([])).
stubborn(end).
stubborn(run) :-
    repeat,
    catch(thread_get_message(never), _, true),
    fail.

:- begin_tests(live_study).

test(parameters_have_ranges, All == [ "seed"-1-100, "strategy"-["random","conscientious"],
                                      "side"-3-9, "limit"-1-200000 ]) :-
    page(Base, model(Base, _{}, Model)),
    findall(Shown, ( member(P, Model.parameters),
                     (   get_dict(values, P, Values)
                     ->  Shown = P.name-Values
                     ;   Shown = P.name-P.from-P.to
                     ) ), All).

%   The measures at the end are those of the study's own run with this seed.

test(same_measures_as_a_run, Live == Own) :-
    study(Study),
    page(Base, ( begin(Base, _{seed:"5", strategy:"conscientious", side:"5"}),
                 finished(Base, Model) )),
    assertion(Model.state == "finished"),
    last(Model.samples, [_, Rows]),
    study_cases(Study, [strategy-[conscientious], side-[5]], [Case]),
    with_tmp_dir(own_run(Study, Case, Log)),
    findall([Label, Text], ( study_call(Study, measure(Name, Log, Value)),
                              number(Value),
                              study_call(Study, label(Name, Label)),
                              format(string(Text), "~4f", [Value]) ), Own),
    findall([Label, Text], ( member([Label, Value], Rows),
                             format(string(Text), "~4f", [Value]) ), Live).

%   The thread that writes the log waits until it is asked to have written all.

test(measures_have_all_events_of_the_run, Measures == [said-100]) :-
    no_leaks(with_tmp_dir(talk(Measures))).

test(values_grow_while_it_runs) :-
    page(Base, ( begin(Base, _{side:"7"}),
                 model(Base, _{}, First),
                 step(Base, 40),
                 model(Base, _{run:First.run, since:First.count}, Later) )),
    assertion(First.samples = [[0.0, _]]),
    assertion(Later.state == "running"),
    Later.samples = [[Time, [[_, Hops]]]],
    assertion(( Time > 1, Hops > 3 )).

test(set_up_starts_anew) :-
    page(Base, ( begin(Base, _{}),
                 step(Base, 5),
                 model(Base, _{}, One),
                 begin(Base, _{side:"4"}),
                 model(Base, _{run:One.run, since:One.count}, Two),
                 ask(Base, _{ask:"survey"}, Told) )),
    assertion(Two.run \== One.run),
    assertion(Two.samples = [[0.0, _]]),
    assertion(memberchk(_{name:"side", value:"4", from:3, to:9, step:1},
                        Two.parameters)),
    length(Told.answer.hosts, 16).

test(run_that_catches_all_is_ended, true(Two \== One)) :-
    no_leaks(with_page([model(test_live_study:stubborn)], Base,
                       ( begin(Base, _{}),
                         model(Base, _{}, First),
                         begin(Base, _{}),
                         model(Base, _{}, Second) ))),
    One = First.run,
    Two = Second.run.

test(failure_is_shown) :-
    page(Base, ( begin(Base, _{side:"9", limit:"1"}), finished(Base, Model) )),
    assertion(Model.state == "failed"),
    assertion(Model.error \== "").

test(bad_value, error(page_said(_))) :-
    page(Base, begin(Base, _{side:"a("})).
test(network_cannot_start, error(page_said(_))) :-
    page(Base, begin(Base, _{side:"-1"})).
test(read_only, error(page_said(_))) :-
    page([read_only(true)], Base, begin(Base, _{})).
test(no_model, error(page_said(_))) :-
    no_leaks(with_page([], Base, begin(Base, _{}))).

%   In Chromium: slider, Set up, Go, a plot.

test(view) :-
    page(Base, with_browser(Browser,
                            ( browser_open(Browser, Base),
                              forall(clause(scene(Browser), Goal), Goal) ))).

:- end_tests(live_study).

:- public until_asked/0.

until_asked :-
    wait_until(( message_queue_property(Queue, size(_)),
                 thread_peek_message(Queue, call(flush, _)) ), 20).

talk(Measures, Dir) :-
    directory_file_path(Dir, 'talk.pl', File),
    write_file(File, "
:- use_module(library(typhon)).
:- use_module(library(aggregate)).
study(talk, \"An agent that logs\").
network(_, ring(1), []).
run(_, Network) :-
    network_property(Network, hosts([Host])),
    forall(( thread_property(Thread, alias(Alias)),
             sub_atom(Alias, 0, _, _, typhon_log_writer) ),
           thread_signal(Thread, test_live_study:until_asked)),
    agent_create(clauses([ (:- agent(talker)),
                           (main :- forall(between(1, 100, N), log(N))) ]),
                 Agent, [host(Host)]),
    agent_join(Agent, done, 100).
measure(said, Log, Count) :-
    aggregate_all(count,
                  ( member(event(_, _, _, N), Log.events), integer(N) ),
                  Count).
"),
    study_load(File, Study),
    setup_call_cleanup(live(Study, set_up([seed-1])),
                       ( live(Study, run), live(Study, measures(Measures)) ),
                       live(Study, end)).

step(Base, Count) :-
    forall(between(1, Count, _), order(Base, _{do:"step"})).

own_run(Study, Case, Log, Dir) :-
    directory_file_path(Dir, 'events.pl', File),
    run_log(Study, Case, 5, File, Log).

scene(Browser) :-
    browser_wait(Browser, "return document.querySelector('[aria-label=\"side, slider\"]')\c
        ?.max === '9'"),
    browser_run(Browser, "const s = document.querySelector('[aria-label=\"side, slider\"]');
        s.value = 6; s.dispatchEvent(new Event('input'))", _),
    browser_click(Browser, ".model-form button"-"Set up"),
    browser_wait(Browser, "return [...typhon.store.hosts.values()]\c
        .filter(h => h.state === 'running').length === 36 && \c
        typhon.app.run.now.state === 'paused'").
scene(Browser) :-
    browser_click(Browser, ".run-bar button"-"Step"),
    browser_click(Browser, ".run-bar button"-"Go"),
    browser_wait(Browser, "return document.querySelectorAll('.model-plots canvas')\c
        .length > 0 && typhon.app.views.get('model').samples.length > 2", 30).
scene(Browser) :-
    browser_size(Browser, 400, 800),
    browser_run(Browser, "return document.documentElement.scrollWidth", Width),
    assertion(Width =< 400).
scene(Browser) :-
    browser_complaints(Browser, Texts),
    assertion(Texts == []).
