:- module(test_cell_forgeries, []).
:- use_module('../../../lib/common').
:- needs([cells]).
:- use_module('../../../lib/cell_inmate').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).

/** <module> What an agent with all rights inside its cell cannot say to the
gatekeeper

*Threading*: one test at a time.
*/

:- begin_tests(cell_forgeries).

test(no_frame_deceives_the_gatekeeper, Through == []) :-
    made(frame, Through).
test(no_act_without_an_answer_passes_the_rules, Through == []) :-
    made(act, Through).
test(no_request_passes_the_rules, Through == []) :-
    made(request, Through).
test(what_comes_after_the_outcome_ends_the_cell,
     [One,Next,After] = [ended(done), ended(lost(cell(violation(frame)))),
                         yes(true)]) :-
    with_inmates(maplist(attempt, [test_send(twice), true, true],
                         [One,Next,After])).

:- end_tests(cell_forgeries).

made(Kind, Through) :-
    findall(Name-Goal-Expected, check(Kind, Name, Goal, Expected), Checks),
    with_inmates(through(Checks, Through)).

check(frame, Name, test_send(What), ended(lost(cell(Reason)))) :-
    frame(Name, What, Reason).
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

frame('no term', text("garbage("), violation(syntax_error(_))).
frame('more than a term', text("told(0,[]). told(0,[])."),
      violation(syntax_error(end_of_file_expected))).
frame('a term and half of another', text("told(0,[]). told("),
      violation(syntax_error(end_of_file_expected))).
frame('a term and a comment', text("told(0,[]). % x"),
      violation(syntax_error(end_of_file_expected))).
frame('a term and a byte that is none', text("told(0,[]).\n\000\"),
      violation(syntax_error(end_of_file_expected))).
frame('nothing', text(""), violation(syntax_error(no_term))).
frame('a comment alone', text("% x"), violation(syntax_error(no_term))).
frame('an end that is none', text("end_of_file."),
      violation(syntax_error(no_term))).
frame('no end', bytes([0,0,0,9,0'a]), violation(_)).
frame('longer than any', bytes([255,255,255,255]),
      violation(syntax_error(frame_too_large))).
frame('a record', record(outcome(0, done, none, [])), violation(_)).
frame('half a record', text("\u0083\u0003\u0001"), violation(_)).
frame('too deep', deep(200 000), violation(_)).
frame('a number of many digits', digits("f(a7,", '7', 200 000),
      violation(syntax_error(long_number))).
frame('of base 36', digits("36'", 'z', 100 000),
      violation(syntax_error(long_number))).
frame('of digits with blanks between', digits("", '7 7', 100 000),
      violation(syntax_error(long_number))).
frame('another frame', frame(nonsense), violation(frame)).
frame('a variable', frame(_), violation(frame)).
frame('another turn', outcome_of(-1, done, none, []), violation(frame)).
frame('a turn that is a variable', outcome_of(_, done, none, []),
      violation(frame)).
frame('a request of another turn', frame(request(0, true)), violation(frame)).
frame('an outcome that there is not', outcome(over(seconds), none, []),
      violation(frame)).
frame('to be lost', outcome(lost(x), none, []), violation(frame)).
frame('held', outcome(held, none, []), violation(frame)).
frame('an abort', outcome(raised('$aborted'), none, []), violation(frame)).
frame('an unwinding', outcome(raised(unwind(halt(1))), none, []),
      violation(frame)).
frame('a control that is none', outcome(effect(halt, H, [H]), none, []),
      violation(frame)).
frame('a qualified control', outcome(effect(user:halt, H, [H]), none, []),
      violation(frame)).
frame('a control that is a variable', outcome(effect(_, H, [H]), none, []),
      violation(frame)).
frame('a fault made up', outcome(effect('$fault'(x), H, [H]), none, []),
      violation(frame)).
frame('a fault among its goals',
      outcome(effect(sleep(0), H, [H,'$fault'(x)]), none, []),
      violation(frame)).
frame('a hole that is bound', outcome(effect(sleep(0), halt, []), none, []),
      violation(frame)).
frame('goals that are no list', outcome(effect(sleep(0), H, [H|x]), none, []),
      violation(frame)).
frame('a list without end', outcome(effect(sleep(0), H, [H|_]), none, []),
      violation(frame)).
frame('goals that are none', outcome(effect(sleep(0), H, [H,1]), none, []),
      violation(frame)).
frame('a time that is none',
      outcome(effect(sleep_until(x), H, [H]), none, []), violation(frame)).
frame('changes that are no list', outcome(done, none, x), violation(frame)).
frame('a change that is none', outcome(done, none, [x]), violation(frame)).
frame('another owner', outcome(done, none, ['$owner'/1-['$owner'(root)]]),
      violation(_)).
frame('a result of its own',
      outcome(done, none, ['$legacy'/1-['$legacy'(result(1))]]), violation(_)).
frame('a memory that is a rule',
      outcome(done, none, ['$memory'/1-[('$memory'(_) :- halt)]]),
      violation(_)).
frame('clauses of another predicate', outcome(done, none, [goal/1-[other(1)]]),
      violation(frame)).
frame('a clause of a module',
      outcome(done, none, [goal/1-[(user:goal(1) :- halt)]]), violation(_)).
frame('a directive', outcome(done, none, [goal/1-[(:- halt)]]), violation(_)).
frame('a rule that the policy refuses',
      outcome(done, none, [goal/1-[(goal(_) :- shell(ls))]]), violation(_)).
frame('a predicate of the system',
      outcome(done, none, [halt/0-[halt]]), violation(_)).
frame('an arity that is none',
      outcome(done, none, [goal/(-1)-[]]), violation(frame)).
frame('an arity without end',
      outcome(done, none, [goal/100 000 000-[]]), violation(frame)).
frame('a name that is none', outcome(done, none, ["goal"/1-[]]),
      violation(frame)).
frame('acts that are no list', told(x), violation(frame)).
frame('an act that is none', told([1]), violation(frame)).
frame('an act that is a variable', told([_]), violation(frame)).
frame('to lack what it has, again and again', lacks(3), violation(frame)).
frame('the turn before', turn_by(-1), violation(frame)).
frame('the next turn', turn_by(1), violation(frame)).
frame('a limit that a cell does not look at', over(seconds), violation(frame)).
frame('a limit that is none', over(_), violation(frame)).
frame('tokens', outcome(done, none, ['$tokens'/1-['$tokens'([red])]]),
      violation(_)).
frame('another birth', outcome(done, none, ['$birth'/1-['$birth'(x)]]),
      violation(_)).
frame('a record of a clause', record((halt :- true)), violation(_)).
frame('a dictionary', text("told(0,[_{a:1}])."), violation(_)).
frame('an act of a turn that is over', frame(told(0, [log(x)])),
      violation(frame)).

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
             'an order to another agent'-agent_dispose(bait(agent)),
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
        raised(domain_error(migration_strategy, _))).
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
request('to end another agent', dispose(bait(agent)),
        raised(permission_error(call, sandboxed, _))).
request('to end with another agent', monitor(bait(agent), [shared(true)]),
        raised(permission_error(call, sandboxed, _))).
