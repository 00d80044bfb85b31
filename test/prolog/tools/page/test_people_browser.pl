:- module(test_people_browser, []).
:- use_module('../../../lib/common').

:- needs([chromium, 'chromium-driver', 'axe-core']).

% The page for people in Chromium, as wide as a phone.

:- use_module('../../../lib/browser').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

:- meta_predicate with_person(+, -, -, 1).

%   with_person(+Options, -Browser, -Link, :Goal): call(Goal, Port) while the
%   page of anna is open.

with_person(Options, Browser, Link, Goal) :-
    no_leaks(with_browser(Browser,
                          ( browser_size(Browser, 360, 640),
                            opened(Options, Browser, Link, Goal) ))).

opened(Options, Browser, Link, Goal) :-
    free_port(Port),
    setup_call_cleanup(
        people_start([anna], [_-Link], [port(Port)|Options]),
        ( browser_open(Browser, Link),
          call(Goal, Port) ),
        ( people_stop, host_stop(anna) )).

asks(Body, Agent) :-
    agent_create(clauses([(:- agent(asks, [])), (main :- Body)]), Agent,
                 [host(anna)]).

%   sees(+Browser, +Selector, +Text): an element with exactly this text, soon.

sees(Browser, Selector, Text) :-
    format(string(Script),
           "return [...document.querySelectorAll(~q)].some(e => \c
            e.checkVisibility() && e.textContent === ~q)", [Selector, Text]),
    browser_wait(Browser, Script).

sees_none(Browser, Selector) :-
    format(string(Script), "return !document.querySelector(~q)", [Selector]),
    browser_wait(Browser, Script).

types(Browser, Selector, Text) :-
    browser_click(Browser, Selector),
    browser_keys(Browser, [Text]).

long("Donaudampfschifffahrtsgesellschaftskapitaenswitwenrentenanspruch").
markup("<img src=x onerror=globalThis.hit=1><b>bold</b> &amp; 'q' ~w").

:- begin_tests(people_browser).

test(person_answers_on_a_phone, Result == ["by boat", 12.5, Long]) :-
    long(Long),
    with_person([], Browser, _, answers(Browser, Result)).

answers(Browser, Result, _) :-
    long(Long),
    sees(Browser, "#empty", "No question at the moment. This page shows the \c
                             next one when it comes."),
    asks(( ask(Long, A), ask(number("How far?"), B), choose(Long, [walk,Long], C),
           result([A,B,C]) ), Agent),
    sees(Browser, "legend", Long),
    sees(Browser, "h1", "anna"),
    fits(Browser),
    types(Browser, "textarea", "by boat"),
    browser_click(Browser, "button"-"Send"),
    sees(Browser, "legend", "How far?"),
    types(Browser, "input", "far"),
    browser_click(Browser, "button"-"Send"),
    browser_run(Browser, "return document.querySelector('input').checkValidity()",
                Valid),
    assertion(Valid == false),
    browser_run(Browser, "document.querySelector('input').value = ''", _),
    types(Browser, "input", "12.5"),
    browser_keys(Browser, [enter]),
    sees(Browser, "button", "walk"),
    fits(Browser),
    browser_click(Browser, "button"-Long),
    agent_result(Agent, Result, 20),
    sees_none(Browser, "form").

%   Nothing is wider than the window, and fingers hit every field.

fits(Browser) :-
    browser_run(Browser,
                "return [document.documentElement.scrollWidth <= 360,
                         [...document.querySelectorAll('button, input, textarea')]
                         .every(e => e.getBoundingClientRect().height >= 44)]",
                Fits),
    assertion(Fits == [true, true]).

test(texts_of_agents_are_shown_as_text, Complaints == []) :-
    with_person([], Browser, _, text_only(Browser, Complaints)).

text_only(Browser, Complaints, _) :-
    markup(Text),
    asks(( show(Text), choose(Text, [Text], Choice), result(Choice) ), Agent),
    forall(member(Selector, ["legend", "button", ".note .text"]),
           sees(Browser, Selector, Text)),
    browser_click(Browser, "button"),
    agent_result(Agent, Text, 20),
    browser_run(Browser,
                "return [globalThis.hit === undefined,
                         document.querySelectorAll('main img, main b').length]",
                Found),
    assertion(Found == [true, 0]),
    browser_complaints(Browser, Complaints).

test(question_outlives_a_reload_and_its_answer_ends_it) :-
    with_person([], Browser, Link, reloaded(Browser, Link)).

reloaded(Browser, Link, _) :-
    asks(( ask("Name?", A), show(A), result(A) ), Agent),
    types(Browser, "textarea", "lost"),
    browser_open(Browser, Link),
    types(Browser, "textarea", "Anna"),
    browser_click(Browser, "button"),
    agent_result(Agent, "Anna", 20),
    browser_open(Browser, Link),
    sees(Browser, ".note .text", "Anna"),
    sees_none(Browser, "form").

test(answer_in_one_tab_ends_the_question_in_the_other) :-
    with_person([], Browser, Link, two_tabs(Browser, Link)).

two_tabs(Browser, Link, _) :-
    asks(( ask("Name?", A), receive(_-end), result(A) ), Agent),
    types(Browser, "textarea", "first"),
    browser_tabs(Browser, [First]),
    browser_tab(Browser, _),
    browser_size(Browser, 360, 640),
    browser_open(Browser, Link),
    types(Browser, "textarea", "second"),
    browser_click(Browser, "button"),
    sees_none(Browser, "form"),
    browser_goto_tab(Browser, First),
    sees_none(Browser, "form"),
    agent_send(Agent, end),
    agent_result(Agent, "second", 20).

%   What was typed is not lost, and can be sent by the next link.

test(revoked_link_is_reported_and_the_question_stays) :-
    with_person([], Browser, _, revoked(Browser)).

revoked(Browser, _) :-
    asks(( ask("Name?", A), result(A) ), Agent),
    types(Browser, "textarea", "Anna"),
    people_revoke(anna),
    Why = "This link is not valid, or no longer: ask for a new one",
    sees(Browser, "#state", Why),
    browser_click(Browser, "button"),
    sees(Browser, ".error", Why),
    browser_run(Browser, "return document.querySelector('textarea').value", Typed),
    assertion(Typed == "Anna"),
    people_start([anna], [_-Next], []),
    browser_open(Browser, Next),
    types(Browser, "textarea", "Anna"),
    browser_click(Browser, "button"),
    agent_result(Agent, "Anna", 20).

test(open_page_reports_the_end_of_its_link) :-
    with_person([seconds(8)], Browser, _, expired(Browser)).

expired(Browser, _) :-
    sees(Browser, "#state", "connected"),
    browser_wait(Browser,
                 "return document.querySelector('#state').textContent
                     .startsWith('This link is not valid')", 30).

test(page_connects_again) :-
    with_person([], Browser, _, away(Browser)).

away(Browser, Port) :-
    asks(( ask("Name?", A), result(A) ), Agent),
    types(Browser, "textarea", "Anna"),
    people_stop,
    sees(Browser, "#state", "no connection"),
    browser_click(Browser, "button"),
    sees(Browser, ".error", "Not sent: try again"),
    people_start([], [], [port(Port)]),
    sees(Browser, "#state", "connected"),
    browser_click(Browser, "button"),
    agent_result(Agent, "Anna", 20).

test(page_is_accessible) :-
    with_person([], Browser, _, accessible(Browser)).

accessible(Browser, _) :-
    Kinds = [text, choice([walk,boat])],
    asks(( show("A note"),
           forall(member(Kind, Kinds), person_ask("Where?", Kind, _)),
           person_ask(number("How far?"), text, _), receive(_-end) ), _),
    sees(Browser, "button", "boat"),
    sees(Browser, ".note .text", "A note"),
    browser_wait(Browser, "return document.querySelectorAll('form').length === 3"),
    forall(member(Theme, [light, dark]),
           ( browser_theme(Browser, Theme),
             browser_barriers(Browser, Problems),
             assertion(Problems == []) )).

:- end_tests(people_browser).
