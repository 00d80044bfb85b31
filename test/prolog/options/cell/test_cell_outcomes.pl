:- module(test_cell_outcomes, []).
:- use_module('../../../lib/common').
:- needs([cells]).
:- use_module('../../../lib/cell_inmate').
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Outcomes and changes of the state that no cell should send

*Threading*: one test at a time.
*/

:- begin_tests(cell_outcomes).

test(forged_outcomes_are_rejected, Through == []) :-
    findall(Name-test_send(Frame)-ended(lost(cell(Reason))),
            frame(Name, Frame, Reason), Checks),
    with_inmates(through(Checks, Through)).

:- end_tests(cell_outcomes).

%   frame(-Name, -Frame, -Reason): the cell is ended for this Reason.

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
frame('tokens', outcome(done, none, ['$tokens'/1-['$tokens'([red])]]),
      violation(_)).
frame('another birth', outcome(done, none, ['$birth'/1-['$birth'(x)]]),
      violation(_)).
