:- module(test_cell_hosts, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/cell), [cells_list/1]).

% Which hosts have cells, also on machines that cannot have any.

:- begin_tests(cell_hosts).

test(without_bubblewrap_a_host_does_not_start,
     [ forall(member(Options, [[], [cell(owner)], [cell(host)]])),
       Formal-Hosts = cell_unavailable(_)-[b] ]) :-
    with_hosts([b],
               ( without_bubblewrap(host_start(c, [policy(guarded)|Options]),
                                    Formal),
                 findall(H, host_property(H, address(_)), Hosts) )).
test(without_bubblewrap_a_host_does_not_become_guarded,
     Formal-Reaches = cell_unavailable(_)-done) :-
    with_hosts([c], ( without_bubblewrap(host_change(c, policy(guarded)),
                                         Formal),
                      unguarded(c, Reaches) )).
test(error_without_bubblewrap_says_what_to_do) :-
    error_text(cell_unavailable('no such program: bwrap'), Text),
    forall(member(Part, [ "no such program: bwrap",
                          "apt install bubblewrap", "cell(none)" ]),
           assertion(sub_string(Text, _, _, _, Part))).
test(host_that_can_have_no_cells_warns_once,
     [ forall(member(Option-Why,
                     [ cell(none)-"it has cell(none)",
                       clock(virtual)-"its time is virtual",
                       quota([inferences(1 000 000)])-
                           "it has the quota inferences" ])),
       Outcome-Cells-Warned == done-[]-1 ]) :-
    Options = [policy(guarded),Option],
    capturing(( with_hosts([c-Options], ( outcome(c, [main], Outcome),
                                          cells_list(Cells) )),
                with_hosts([c-Options], true) ),
              Messages),
    findall(x, ( member(warning-Message, Messages),
                 message_text(Message, Text),
                 sub_string(Text, _, _, _, Why) ), Xs),
    length(Xs, Warned).
test(trusted_host_has_no_cells, error(existence_error(host_option, policy))) :-
    host_start(c, [cell(owner)]).
test(inferences_cannot_be_limited_in_cells,
     error(permission_error(limit, cell, inferences(9)))) :-
    host_start(c, [policy(guarded), cell(owner), quota([inferences(9)])]).
test(virtual_time_has_no_cells,
     error(permission_error(start, cell, clock(virtual)))) :-
    host_start(c, [policy(guarded), cell(owner), clock(virtual)]).

:- end_tests(cell_hosts).

:- meta_predicate without_bubblewrap(0, -).

%   The first host of a process needs other programs of the PATH.

without_bubblewrap(Goal, Formal) :-
    getenv('PATH', Path),
    setup_call_cleanup(
        setenv('PATH', '/nowhere'),
        catch(Goal, error(Formal, _), true),
        setenv('PATH', Path)).

outcome(Host, Clauses, Outcome) :-
    create(Clauses, A, [host(Host)]),
    agent_join(A, Outcome, 60).

%   A guarded host refuses this agent.

unguarded(Host, Outcome) :-
    outcome(Host, [(main :- nb_setval(test_cell_hosts, 1))], Outcome).

error_text(Formal, Text) :-
    message_text(error(Formal, _), Text).

