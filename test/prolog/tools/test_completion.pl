:- module(test_completion, []).
:- use_module(library(plunit)).
:- use_module('../../../app/packaging/parts', [installed/1]).
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> Completion by the tab key at the top level

The hook is called as the line editors call it.
*/

%   completed(+Before, ?Completions), the cursor being at the end.

completed(Before, Completions) :-
    prolog:complete_input(Before, "", _, Completions).

%   on_tab(+Before, -Line): Line is the line if there is one completion.

on_tab(Before, Line) :-
    prolog:complete_input(Before, "", Delete, [Completion]),
    string_length(Delete, Length),
    sub_string(Before, 0, _, Length, Kept),
    string_concat(Kept, Completion, Line).

with_agents(Goal) :-
    with_hosts([alpha, beta],
               ( named(bob), named(tim), named(tim), call(Goal) )).

named(Name) :-
    create([on_message(_, _)], Agent, [name(Name), host(alpha)]),
    wait_state(Agent, resident).

:- begin_tests(completion).

test(hosts, [forall(member(Before-Line,
                           [ "host_stop(al"-"host_stop(alpha",
                             "remote(b"-"remote(beta",
                             "remote('b"-"remote('beta'",
                             "link(alpha, be"-"link(alpha, beta",
                             "unlink(al"-"unlink(alpha",
                             "agent_move(bob, a"-"agent_move(bob, alpha",
                             "agent_move(f('x)', [1,2]), a"-
                             "agent_move(f('x)', [1,2]), alpha",
                             "X == 0'a, host_stop(al"-"X == 0'a, host_stop(alpha",
                             "% don't\nhost_stop(al"-"% don't\nhost_stop(alpha",
                             "X = 'a\\'b', remote(b"-"X = 'a\\'b', remote(beta",
                             "agent_create(p, A, [host(al"-
                             "agent_create(p, A, [host(alpha" ])),
             Line == Completed]) :-
    with_agents(on_tab(Before, Completed)).
test(agents, [forall(member(Before-Line,
                            [ "agent_send(b"-"agent_send(bob",
                              "X = 1, agent_property(b"-
                              "X = 1, agent_property(bob",
                              "agent_send(at(b"-"agent_send(at(bob",
                              "payload_attach(b"-"payload_attach(bob",
                              "payload_detach(b"-"payload_detach(bob" ])),
              Line == Completed]) :-
    with_agents(on_tab(Before, Completed)).
test(agent_by_quoted_id) :-
    with_agents(( on_tab("agent_send('bo", Line),
                  string_concat(Line, ")", Text),
                  term_string(agent_send(Id), Text),
                  agent_property(Id, state(_)) )).
test(agents_of_one_name_are_completed_by_id) :-
    with_agents(( completed("agent_send(t", Texts),
                  length(Texts, Count),
                  forall(member(Text, Texts),
                         ( term_to_atom(Id, Text),
                           agent_property(Id, state(_)) )) )),
    assertion(Count == 2).
test(programs,
     [ condition(installed(studies)), Line == "agent_create(agents(sync/traveller" ]) :-
    on_tab("agent_create(agents(sync/tr", Line).
test(programs_of_a_folder, condition(installed(studies))) :-
    completed("agent_create(agents(sync/", Texts),
    subset(['sync/specialist', 'sync/traveller', 'sync/worker'], Texts),
    assertion(\+ memberchk('sync/operator', Texts)).
test(payloads, condition(installed(studies))) :-
    completed("[payloads([payloads(sieve/", Texts),
    assertion(memberchk('sieve/bits', Texts)).
test(networks, Line == Wanted) :-
    with_network(ring(2), [clock(virtual)], Network,
        on_tab("network_stop(n", Line)),
    format(string(Wanted), "network_stop(~w", [Network]).
test(other_text_is_completed_as_usual) :-
    with_agents(( completed("memberch", Texts),
                  completed("foo(bo", Others) )),
    assertion(memberchk(memberchk, Texts)),
    assertion(\+ memberchk(bob, Others) ; memberchk(body, Others)).
test(usual_completion_without_a_match) :-
    with_agents(completed("remote(memberch", Texts)),
    assertion(memberchk(memberchk, Texts)).

:- end_tests(completion).
