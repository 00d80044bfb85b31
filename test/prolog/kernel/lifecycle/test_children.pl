:- module(test_children, []).
:- use_module('../../../../app/packaging/parts', [installed/1]).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).

/** <module> Agents that create agents

*Threading*: one test at a time.
*/

%   made(+Specs, +Clauses, -Result, +Options): the result of an agent of
%   Clauses.

made(Specs, Clauses, Result) :-
    with_hosts(Specs, ( create(Clauses, A), agent_result(A, Result, 10) )).

child(Body, clauses([ (:- agent(child, [state([s/1])])), (main :- Body) ])).

%   refused(+Specs, +Create, -Formal): the error of an agent that calls Create.

refused(Specs, Create, Formal) :-
    made(Specs, [(main :- catch(Create, error(F, _), true), result(F))],
         Formal).

guarded([alpha-[policy(guarded), cell(none)]]).

%   invalid(-Specs, -Create, -Error)

invalid([alpha-[capacity(1)]], create(Child, _, []),
        move_refused(_, capacity)) :-
    child(true, Child).
invalid([alpha], create(_, _, []), instantiation_error).
invalid([alpha], create(Child, a, []), uninstantiation_error(_)) :-
    child(true, Child).
invalid([alpha], create(Child, _, [hots(alpha)]),
        domain_error(agent_option, hots(alpha))) :-
    child(true, Child).
invalid([alpha], create(Child, _, [host(nowhere)]), existence_error(host, _)) :-
    child(true, Child).
invalid(Guarded, create(Child, _, []), move_refused(_, policy(halt))) :-
    guarded(Guarded),
    child(halt, Child).
invalid(Guarded, create(Program, _, []),
        permission_error(call, sandboxed, _)) :-
    guarded(Guarded),
    member(Program, [ '/etc/passwd', library(lists), agents('../README'),
                      agents('/etc/passwd'), agents(a/'..'/b) ]).
invalid(Guarded, create(agents(no_such_program), _, []),
        existence_error(source_sink, _)) :-
    guarded(Guarded).

:- begin_tests(children).

test(invalid, [ forall(invalid(Specs, Create, Error)),
                true(subsumes_term(Error, F)) ]) :-
    refused(Specs, Create, F).
test(child_of_clauses, [ forall(( Specs = [alpha] ; guarded(Specs) )),
                         true(sub_atom(Id, 0, _, _, 'child.')) ]) :-
    child(( self(Id0), receive(P-hello), send(P, hi(Id0)) ), Child),
    made(Specs,
         [ (main :- create(Child, C, []), send(C, hello),
                    receive(C-hi(Id1)), result(Id1)) ],
         Id).
test(child_of_a_file,
     [ condition(installed(studies)), true(sub_atom(C, 0, _, _, 'alone.')) ]) :-
    made([alpha],
         [ (main :- create(agents(robots/alone), C0, []), result(C0)) ],
         C).
test(child_of_the_own_program_has_no_state_of_its_parent,
     [ forall(( Specs = [alpha] ; guarded(Specs) )), X == [7] ]) :-
    made(Specs,
         [ (main :- r(Parent), !, findall(N, s(N), Ns), send(Parent, Ns)),
           (main :- self(Me), assertz(s(1)),
                    create(self, C, [facts([s(7), r(Me)])]),
                    receive(C-X0), result(X0)) ],
         X).

test(child_on_another_host, true(sub_atom(H, 0, _, _, 'beta@'))) :-
    child(( here(H0), receive(P-_), send(P, H0) ), Child),
    made([alpha, beta],
         [ (main :- create(Child, C, [host(beta), name(bob)]), send(C, ask),
                    receive(C-H1), result(H1)) ],
         H).
test(several_in_one_goal, N == 5) :-
    child(( receive(P-_), send(P, 1) ), Child),
    made([alpha],
         [ (main :- forall(between(1, 5, _),
                           ( create(Child, C, []), send(C, go) )),
                    take(5, 0)),
           (take(0, N) :- !, result(N)),
           (take(Left, N) :- receive(_-1), N1 is N+1, L is Left-1,
                             take(L, N1)) ],
         N).
test(child_in_another_process, [true(Result == 42)]) :-
    child(( s(N), result(N) ), Child),
    no_leaks(with_peers([p1],
                 ( peer_host(p1, There),
                   with_hosts([alpha],
                       ( create([ (main :- create(Child, C,
                                                  [host(There), facts([s(42)])]),
                                           result(C)) ], A),
                         agent_result(A, C, 10),
                         agent_result(C, Result, 10),
                         agent_result(C, Result, 10) )) ))).
:- end_tests(children).

:- begin_tests(guarded_children).

%   A hundred are too many.

test(children_count_for_the_quota,
     [ forall(member(Quota-What-Error,
                     [ clones(3)-self-resource_error(clones),
                       owner(agents(3))-Child-move_refused(_, _) ])),
       true(Formal = Error) ]) :-
    child(sleep(100), Child),
    made([alpha-[policy(guarded), cell(none), quota([Quota])]],
         [ (main :- catch(many(100), error(F, _), true), result(F)),
           (many(0) :- !),
           (many(N) :- create(What, _, [facts([s(1)])]), N1 is N-1,
                       many(N1)) ],
         Formal).

:- end_tests(guarded_children).
