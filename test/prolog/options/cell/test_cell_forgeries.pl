:- module(test_cell_forgeries, []).
:- use_module('../../../../app/packaging/parts', [installed/1]).
:- use_module('../../../lib/common').
:- needs([cells]).
:- use_module('../../../lib/cell_inmate').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).

/** <module> Requests that the gatekeeper refuses to an agent with all rights
inside its cell

*Threading*: one test at a time.
*/

:- begin_tests(cell_forgeries).

test(unacknowledged_acts_obey_the_rules, Through == []) :-
    made(act, Through).
test(requests_obey_the_rules, Through == []) :-
    made(request, Through).
test(frames_after_the_outcome_end_the_cell,
     [One,Next,After] = [ended(done), ended(lost(cell(violation(frame)))),
                         yes(true)]) :-
    with_inmates(maplist(attempt, [test_send(twice), true, true],
                         [One,Next,After])).

:- end_tests(cell_forgeries).

made(Kind, Through) :-
    findall(Name-Goal-Expected, check(Kind, Name, Goal, Expected), Checks),
    with_inmates(through(Checks, Through)).

%   check(?Kind, -Name, -Goal, -Expected)

check(request, Name, test_ask(Goal, _), Expected) :-
    request(Name, Goal, Expected0),
    (   nonvar(Expected0),
        Expected0 = ended(_)
    ->  Expected = Expected0
    ;   Expected = answer(Expected0)
    ).

check(act, Name, test_send(told([log(1),Goal,log(2)])),
      ended(raised(error(permission_error(call, sandboxed, _), _)))) :-
    request(Name, Goal, Expected),
    refused(Refused),
    Expected =@= Refused.
check(act, 'a new agent', test_send(told([create(self, _, [])])),
      ended(raised(error(permission_error(call, sandboxed, create(_, _, _)),
                         _)))).
check(act, 'an answer', test_send(told([sense(_)])),
      ended(raised(error(permission_error(call, sandboxed, sense(_)), _)))).

                /*******************************
                *           REQUESTS           *
                *******************************/

refused(raised(permission_error(call, sandboxed, _))).

request(Name, Goal, Expected) :-
    refused(Refused),
    member(Name-Goal,
           [ 'a goal of the system'-halt,
             'a shell'-shell(ls),
             'a goal of a module'-(user:halt),
             'a conjunction'-(self(_), halt),
             'a call'-call(halt),
             'all solutions'-findall(x, halt, _),
             'a goal that waits'-freeze(_, halt),
             'to deliver'-deliver(x),
             'to move a file'-attach('/etc/passwd'),
             'a payload elsewhere'-attach(payloads('../../etc/passwd')),
             'a payload by a list'-attach([payload(x)]),
             'a control predicate'-move(a),
             'another agent'-agent_send(a, b),
             'to end a host'-host_stop(c),
             'a private predicate'-'$set_source_module'(user),
             'a hook'-'typhon_gate:gate'(a, b, c, d),
             'a message of another sender'-send(a, b, c),
             'an order to another agent'-agent_dispose(target(agent)),
             'a goal on another host'-remote(x, true),
             'options of the host'-host_change(c, policy(trusted))
           ]),
    Expected = Refused.
request('a goal that is none', 1, ended(lost(cell(violation(frame))))).
request('a recipient of a bridge', send(fipa(x, []), hello),
        raised(permission_error(call, sandboxed, _))).
request('a recipient that is none', send("x", hello),
        raised(type_error(atom, _))).
request('a payload that is not attached', detach(x),
        raised(permission_error(call, sandboxed, _))).
request('a strategy that is none', next_host(halt, _),
        raised(domain_error(migration_strategy, _))) :-
    installed(migration).
request('a fact that calls', sense(user:halt), solutions([])).
request('an id of its own', create(clauses([(:- agent(x, [])), main]),
                                   'root.0@c@127.0.0.1:1', []),
        raised(uninstantiation_error(_))).
request('an id by its name', create(clauses([(:- agent(x, [])), main]), _,
                                    [name('root.0@c')]),
        raised(domain_error(agent_name, _))).
request('an owner by an option', create(clauses([(:- agent(x, [])), main]), _,
                                        [owner(root)]),
        raised(domain_error(agent_option, _))).
request('an owner in the state',
        create(clauses([ (:- agent(x, [state(['$owner'/1])])),
                         '$owner'(root), main ]), _, []),
        raised(move_refused(_, policy(_)))).
request('an owner as a fact',
        create(clauses([(:- agent(x, [])), main]), _,
               [facts(['$owner'(root)])]),
        raised(existence_error(state, _, _))).
request('a program of a file', create('/etc/passwd', _, []),
        raised(permission_error(call, sandboxed, _))).
request('payloads of a file',
        create(self, _, [payloads(['/etc/passwd'])]),
        raised(permission_error(call, sandboxed, _))).
request('to end another agent', dispose(target(agent)),
        raised(permission_error(call, sandboxed, _))).
request('to end with another agent', monitor(target(agent), [shared(true)]),
        raised(permission_error(call, sandboxed, _))).
