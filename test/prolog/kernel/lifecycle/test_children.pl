:- module(test_children, []).
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

%   refused(+Program, -Formal): the error of its creation on a guarded host.

refused(Program, Formal) :-
    made([alpha-[policy(guarded), cell(none)]],
         [ (main :- catch(create(Program, _, []), error(F, _), true),
                    result(F)) ],
         Formal).

:- begin_tests(children).

test(child_of_clauses, [true(X-Name == hi-child)]) :-
    child(( self(Id), receive(P-hello), send(P, hi(Id)) ), Child),
    made([alpha],
         [ (main :- create(Child, C, []), send(C, hello),
                    receive(C-hi(Id)), result(Id)) ],
         Id),
    sub_atom(Id, 0, _, _, 'child.'),
    Name = child,
    X = hi.
test(child_of_a_file, [true(Name == alone)]) :-
    made([alpha],
         [ (main :- create(agents(robots/alone), C, []), result(C)) ],
         C),
    sub_atom(C, B, 1, _, '.'), !,
    sub_atom(C, 0, B, _, Name).
test(child_of_the_own_program, X == got(7)) :-
    made([alpha],
         [ (main :- r(Parent), !, s(N), send(Parent, got(N))),
           (main :- self(Me), assertz(s(1)),
                    create(self, C, [facts([s(7), r(Me)])]),
                    receive(C-X), result(X)) ],
         X).
test(state_of_the_parent_is_not_inherited, X == []) :-
    made([alpha],
         [ (main :- r(Parent), !, findall(N, s(N), Ns), send(Parent, Ns)),
           (main :- self(Me), assertz(s(1)),
                    create(self, C, [facts([r(Me)])]),
                    receive(C-X), result(X)) ],
         X).
test(child_on_another_host, [true(Host == beta)]) :-
    child(( here(H), receive(P-_), send(P, H) ), Child),
    made([alpha, beta],
         [ (main :- create(Child, C, [host(beta), name(bob)]), send(C, ask),
                    receive(C-H), result(H)) ],
         Address),
    sub_atom(Address, 0, _, _, 'beta@'),
    Host = beta.
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
test(full_host, F = move_refused(_, capacity)) :-
    child(true, Child),
    made([alpha-[capacity(1)]],
         [ (main :- catch(create(Child, _, []), error(F, _), true),
                    result(F)) ],
         F).
test(unbound_program, F == instantiation_error) :-
    made([alpha],
         [ (main :- catch(create(_, _, []), error(F, _), true), result(F)) ],
         F).
test(bound_agent, F = uninstantiation_error(_)) :-
    child(true, Child),
    made([alpha],
         [ (main :- catch(create(Child, a, []), error(F, _), true),
                    result(F)) ],
         F).
test(wrong_option, F == domain_error(agent_option, hots(alpha))) :-
    child(true, Child),
    made([alpha],
         [ (main :- catch(create(Child, _, [hots(alpha)]), error(F, _), true),
                    result(F)) ],
         F).
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
test(no_such_host, F = existence_error(host, _)) :-
    child(true, Child),
    made([alpha],
         [ (main :- catch(create(Child, _, [host(nowhere)]), error(F, _),
                          true),
                    result(F)) ],
         F).

:- end_tests(children).

:- begin_tests(guarded_children).

test(child_of_clauses, X == hi) :-
    child(( receive(P-_), send(P, hi) ), Child),
    made([alpha-[policy(guarded), cell(none)]],
         [ (main :- create(Child, C, []), send(C, go), receive(C-X),
                    result(X)) ],
         X).
test(child_of_the_own_program, X == got) :-
    made([alpha-[policy(guarded), cell(none)]],
         [ (main :- r(Parent), !, send(Parent, got)),
           (main :- self(Me), create(self, C, [facts([r(Me)])]),
                    receive(C-X), result(X)) ],
         X).
test(children_are_checked, F = move_refused(_, policy(halt))) :-
    child(halt, Child),
    refused(Child, F).
test(no_files, [forall(member(Program, ['/etc/passwd', library(lists),
                                         agents('../README'),
                                         agents('/etc/passwd'),
                                         agents(a/'..'/b)])),
                F = permission_error(call, sandboxed, _)]) :-
    refused(Program, F).
test(missing_file, F = existence_error(source_sink, _)) :-
    refused(agents(no_such_program), F).
test(children_count_for_the_quota, [true(Formal == resource_error(clones))]) :-
    child(sleep(100), Child),
    made([alpha-[policy(guarded), cell(none), quota([clones(3)])]],
         [ (main :- catch(many(100, Child), error(F, _), true), result(F)),
           (many(0, _) :- !),
           (many(N, Child) :- create(self, _, [facts([r(child)])]),
                              N1 is N-1, many(N1, Child)) ],
         Formal).
test(agents_of_an_owner_are_limited, [true(Formal = move_refused(_, _))]) :-
    child(sleep(100), Child),
    made([alpha-[policy(guarded), cell(none), quota([owner(agents(3))])]],
         [ (main :- catch(many(100, Child), error(F, _), true), result(F)),
           (many(0, _) :- !),
           (many(N, Child) :- create(Child, _, []),
                              N1 is N-1, many(N1, Child)) ],
         Formal).

:- end_tests(guarded_children).
