:- module(test_cell_policy, []).
:- use_module('../../../lib/common').
:- needs([cells]).
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/cell_inmate').
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module(library(typhon)).

/** <module> A request of a cell is decided as the same goal in an agent's body

The policy of the host refuses each word of the vocabulary and each service.
Agents that have all rights inside their cell ask for them by hand.

*Threading*: one test at a time.
*/

%   words(-PIs): what agents may call of the vocabulary and of the place.

words(PIs) :-
    findall(PI, ( typhon_mobile:vocabulary_word(_, PI) ; control_word(PI) ;
                  service(PI) ),
            PIs0),
    sort(PIs0, PIs).

control_word(Name/Arity) :-
    typhon_bodies:control(Head),
    functor(Head, Name, Arity),
    \+ memberchk(Name, [receive_until,sleep_until,'$fault']).

service(open_door/1).
service(shut/0).

goal(Name/Arity, Goal) :-
    functor(Goal, Name, Arity).

%   with_rules(+Rules, +Quotas, :Goal): call Goal while the host c has the
%   services and these rules.

:- meta_predicate with_rules(+, +, 0), in_rules(+, +, 0, +).

with_rules(Rules, Quotas, Goal) :-
    with_tmp_dir(in_rules(Rules, Quotas, Goal)).

in_rules(Rules, Quotas, Goal, Dir) :-
    directory_file_path(Dir, 'rules.pl', File),
    directory_file_path(Dir, 'place.pl', Place),
    written(File, [allow(call_with_depth_limit/3)|Rules]),
    findall((:- service(PI)), service(PI), Services),
    append(Services, [open_door(_), shut], Clauses),
    written(Place, Clauses),
    with_inmates([policy(File), consult(Place)], [seconds(60)|Quotas], Goal).

written(File, Terms) :-
    setup_call_cleanup(
        open(File, write, Out),
        forall(member(Term, Terms), format(Out, "~q.~n", [Term])),
        close(Out)).

refusing(PIs, Rules) :-
    findall(refuse(PI), member(PI, PIs), Rules).

refused(raised(permission_error(call, sandboxed, _))).

%   An inmate tells its result by a word, which is not refused then.

asked(PIs, Through) :-
    findall(PI-test_ask(Goal, _)-answer(Refused),
            ( member(PI, PIs), goal(PI, Goal), refused(Refused) ),
            Checks),
    through(Checks, Through).

told(PIs, Through) :-
    findall(PI-test_send(told([Goal]))
              -ended(raised(error(permission_error(call, sandboxed, _), _))),
            ( member(PI, PIs), goal(PI, Goal) ),
            Checks),
    through(Checks, Through).

%   written_out(+PIs, -Through): the words that an agent may write in its
%   program on c.

written_out(PIs, Through) :-
    findall(PI,
            ( member(PI, PIs),
              goal(PI, Goal),
              catch(( agent_create(clauses([ (:- agent(x, [])),
                                             (main :- Goal) ]), A, [host(c)]),
                      agent_join(A, Outcome, 60) ),
                    error(Formal, _), Outcome = raised(error(Formal, _))),
              Outcome \= raised(error(move_refused(_, policy(_)), _)) ),
            Through).

stop(PI, test_send(outcome(effect(Control, Hole, [Hole]), none, []))) :-
    member(PI-Control,
           [ (move/1)-move(nowhere), (move/1)-move(nowhere, []),
             (move/2)-move(nowhere, []), (clone/1)-clone(_),
             (clone/2)-clone(_, _),
             (sleep/1)-sleep(0), (sleep/1)-sleep_until(0),
             (receive/1)-receive(_), (receive/2)-receive(_, 0),
             (receive/2)-receive_until(_, 0, _), (dispose/0)-dispose ]).

:- begin_tests(cell_policy).

test(refused_words_and_services_are_refused_to_requests,
     [Asked,Told,Written] == [[],[],[]]) :-
    words(All),
    subtract(All, [result/1], PIs),
    refusing(PIs, Rules),
    with_rules(Rules, [],
               ( asked(PIs, Asked), told(PIs, Told),
                 written_out(PIs, Written) )).
test(withheld_words_are_refused_to_requests, Asked == []) :-
    with_rules([], [], asked([unseal/2, seal/3, deliver/1, undeliver/1],
                             Asked)).
test(allowed_words_and_services_are_answered, Outcomes = [solutions([_])]) :-
    with_rules([allow(seal/3), refuse(shut/0)], [],
               ( attempt(test_ask(open_door(x), A1), yes(test_ask(_, A1))),
                 attempt(test_ask(self(_), _), yes(test_ask(_, A2))),
                 attempt(test_ask(seal(_, _, _), _), yes(test_ask(_, A3))) )),
    A2 = solutions([self(_)]),
    A3 = raised(error(instantiation_error, _)),
    Outcomes = [A1].
test(refused_control_predicates_do_not_stop_an_agent,
     [ forall(stop(PI, Goal)),
       Outcome = ended(raised(error(permission_error(call, sandboxed, _), _)))
     ]) :-
    with_rules([refuse(PI)], [], attempt(Goal, Outcome)).
test(own_predicate_of_a_refused_name_permits_no_request,
     Answer = raised(error(permission_error(call, sandboxed, _), _))) :-
    with_rules([refuse(emit/1)], [],
               ( inmate(true, test_ask(emit(x), _), Clauses),
                 agent_create(clauses([(emit(_) :- true)|Clauses]), A,
                              [host(c)]),
                 agent_result(A, yes(test_ask(_, Answer)), 60) )).
test(requests_of_services_count_as_calls,
     Outcome = ended(raised(error(resource_error(calls(open_door/1)), _)))) :-
    with_rules([], [calls(open_door/1, 3)],
               attempt(forall(between(1, 20, _),
                              test_ask(open_door(x), _)), Outcome)).

:- end_tests(cell_policy).
