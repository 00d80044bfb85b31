:- module(test_people, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures', [capturing/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(thread), [concurrent_maplist/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/people),
              [invite/3, invited/2, person_answer/3, person_page/2, uninvite/1]).

/** <module> Agents ask people

*Threading*: one test at a time; agents run in workers.
*/

:- meta_predicate with_people(0), refused(0, -).

with_people(Goal) :-
    no_leaks(setup_call_cleanup(
                 ( host_start(desk),
                   host_start(anna, [people(true)]),
                   host_start(ben, [people(true)]) ),
                 once(Goal),
                 forall(member(Host, [anna, ben, desk]),
                        catch(host_stop(Host), error(existence_error(_, _), _),
                              true)))).

program(Name, Body, clauses([(:- agent(Name, [state([to/1])])), (main :- Body)])).

asking(Host, Body, Agent) :-
    program(asks, Body, Program),
    agent_create(Program, Agent, [host(Host)]).

%   asked(+Host, ?What, -Number): the person sees What, at the latest soon.

asked(Host, What, Number) :-
    wait_until(is_asked(Host, What, Number), 20).

is_asked(Host, What, Number) :-
    person_page(Host, Rows),
    member(asked(Number, _, What, Kind), Rows),
    Kind \== shown.

answers(Host, What, Given) :-
    asked(Host, What, Number),
    person_answer(Host, Number, Given).

refused(Goal, Formal) :-
    catch(( Goal, Formal0 = none ), error(Formal0, _), true),
    Formal = Formal0.

:- begin_tests(people).

test(agent_gets_the_answers_of_its_person) :-
    with_people(answered).

answered :-
    asking(anna, ( show(hello(X, X)), ask("Name?", A), ask(number("Age?"), N),
                   choose(best, [red, f(x), "f(x)"], B),
                   choose(best, [red, f(x), "f(x)"], C), result([A,N,B,C]) ),
           Agent),
    answers(anna, "Name?", "Anna"),
    answers(anna, number("Age?"), " 12.5 "),
    answers(anna, best, 2),
    asked(anna, best, Number),
    forall(member(Wrong, [0, 4, "2", 1.0]),
           assertion(\+ refused(person_answer(anna, Number, Wrong), none))),
    person_answer(anna, Number, 3),
    agent_result(Agent, ["Anna", 12.5, f(x), "f(x)"], 20),
    person_page(anna, [asked(_, Agent, hello(Y, Z), shown)]),
    Y == Z.

%   Texts that Prolog, or a browser, would read as something else.

test(texts_arrive_as_they_are, forall(member(Seed, [1,2])), Read == Given) :-
    set_random(seed(Seed)),
    findall(Text, ( between(1, 8, _), odd_text(Text) ), Given),
    with_people(told(Given, Read)).

odd_text(Text) :-
    findall(Part,
            ( between(1, 4, _),
              random_member(Part,
                            [ "halt.", "X", "f(X) :- X", "'", "\"", "\\", "\n",
                              "<script>alert(1)</script>", "&amp;", "~w", "[1]",
                              "\u00e4\u4e2d\U0001F600", "%", "\u202e", " ", "" ]) ),
            Parts),
    atomics_to_string(Parts, Text).

told(Given, Read) :-
    length(Given, Count),
    agent_create(clauses([ (:- agent(asks, [state([got/1])])),
                           (main :- loop(0, [])),
                           (loop(Count, Got) :- !, result(Got)),
                           (loop(N, Got) :- ask(N, A), N1 is N+1,
                                            loop(N1, [A|Got])) ]),
                 Agent, [host(anna)]),
    forall(nth(N, Given, Text), answers(anna, N, Text)),
    agent_result(Agent, Reversed, 20),
    reverse_of(Reversed, Read).

nth(N, List, Element) :-
    lists:nth0(N, List, Element).

reverse_of(List, Reversed) :-
    lists:reverse(List, Reversed).

test(numbers_are_numbers_of_people,
     Accepted == ["1", "-2.5", " 3 ", "1e3", "1.0e-3"]) :-
    findall(Text,
            ( member(Text, [ "1", "-2.5", " 3 ", "1e3", "1.0e-3", "", " ", "x", "1r3",
                             "0'a", "0x1f", "1 2", "inf", "1.0Inf", "1e999",
                             "a:-b", "--1", "1.", "99999999999999999999999999999\c
                                                   99999999999999999999" ]),
              refused(typhon_person_questions:must_be_number(Text, Number),
                      none),
              number(Number) ),
            Accepted).
test(of_several_answers_one_counts) :-
    with_people(forall(between(1, 5, _), raced)).

raced :-
    asking(anna, ( choose(who, [1,2,3,4,5,6,7,8], Who), receive(_-end),
                   result(Who) ), Agent),
    asked(anna, who, Number),
    numlist(1, 8, Givens),
    concurrent_maplist(one_of_them(Number), Givens, Outcomes),
    findall(Given, member(sent(Given), Outcomes), [First]),
    aggregate_all(count, member(existence_error(question, Number), Outcomes), 7),
    wait_until(agent_property(Agent, mailbox([])), 20),
    agent_send(Agent, end),
    agent_result(Agent, First, 20).

one_of_them(Number, Given, Outcome) :-
    catch(( person_answer(anna, Number, Given), Outcome = sent(Given) ),
          error(Outcome, _), true).

%   The agents are moved, or go on moving, while their questions wait.

test(answer_finds_its_agent, forall(member(Seed, [1,2]))) :-
    set_random(seed(Seed)),
    with_people(moved).

moved :-
    numlist(1, 12, Numbers),
    maplist(asks_and_moves, Numbers, Agents),
    findall(N-Number, ( member(N, Numbers), asked(anna, N, Number) ), Pairs),
    forall(member(Agent, Agents),
           ( random_member(Host, [anna, ben, desk]),
             agent_move(Agent, Host) )),
    forall(member(N-Number, Pairs), person_answer(anna, Number, N)),
    findall(Result, ( member(Agent, Agents), agent_result(Agent, Result, 20) ),
            Numbers).

asks_and_moves(N, Agent) :-
    random_between(0, 1, How),
    (   How =:= 0
    ->  Body = choose(N, Choices, Choice)
    ;   Body = ( person_ask(N, choice(Choices), Number), move(desk),
                 receive(people-answer(Number, given(Choice))) )
    ),
    numlist(1, 12, Choices),
    asking(anna, (Body, result(Choice)), Agent).

test(question_of_an_ended_agent_disappears) :-
    with_people(( asking(anna, ask(x, _), Agent),
                  asked(anna, x, Number),
                  agent_dispose(Agent),
                  refused(person_answer(anna, Number, "late"),
                          existence_error(_, _)),
                  person_page(anna, []) )).
test(host_that_stops_leaves_no_agent_waiting) :-
    with_people(( asking(anna, ( ask(x, _) -> result(yes) ; result(no) ), Agent),
                  asked(anna, x, _),
                  agent_move(Agent, desk, [wait(20)]),
                  host_stop(anna),
                  agent_result(Agent, no, 20) )).
test(other_hosts_have_no_such_services, Outcome = raised(error(
         existence_error(procedure, _:ask/2), _))) :-
    with_people(capturing(( asking(desk, ask(x, _), Agent),
                            agent_join(Agent, Outcome, 20) ), _)).

%   Names that a program or the place of another host has are theirs.

test(predicates_of_these_names_are_not_hidden, Results == [own, place]) :-
    with_people(( agent_create(clauses([ (:- agent(own, [])), ask(_, own),
                                         (main :- ask(x, A), result(A)) ]),
                               A, [host(anna)]),
                  typhon_host_place(desk, choose(_, _, place)),
                  asking(desk, ( choose(a, b, C), result(C) ), B),
                  findall(R, ( member(X, [A,B]), agent_result(X, R, 20) ),
                          Results) )).

typhon_host_place(Host, Fact) :-
    remote(Host, assertz(Fact)).

test(agent_cannot_wait_inside_a_goal_that_must_end,
     Outcome = raised(error(permission_error(call, control_predicate, ask/2),
                            _))) :-
    with_people(capturing(( asking(anna, findall(A, ask(x, A), _), Agent),
                            agent_join(Agent, Outcome, 20) ), _)).
test(what_a_person_could_not_read_is_an_error,
     Errors == [ domain_error(choices, []), type_error(list, a),
                 instantiation_error, resource_error(question_cells),
                 resource_error(question_cells), domain_error(question_kind, x),
                 resource_error(questions) ]) :-
    numlist(1, 3000, Long),
    Bodies = [ choose(a, [], _), choose(a, a, _), choose(a, [_], _),
               choose(a, Long, _), show(Long), person_ask(a, x, _),
               (person_ask(a, text, _), person_ask(a, text, _)) ],
    with_people(with_settings([typhon_person_questions:questions=1],
        findall(Formal,
                ( member(Body, Bodies),
                  asking(anna, ( catch(Body, error(F, _), true), result(F) ),
                         Agent),
                  agent_result(Agent, Formal, 20) ),
                Errors))).
test(long_answer_is_refused, Formal == resource_error(answer_characters)) :-
    with_people(( asking(anna, ask(x, _), _),
                  asked(anna, x, Number),
                  format(string(Long), '~`xt~2001|', []),
                  refused(person_answer(anna, Number, Long), Formal) )).
test(answer_that_cannot_be_sent_leaves_the_question) :-
    with_people(with_settings([typhon_mailbox:messages=1000],
        ( asking(anna, ask(x, _), Agent),
          asked(anna, x, Number),
          forall(between(1, 1000, N), agent_send(Agent, N)),
          refused(person_answer(anna, Number, "yes"),
                  resource_error(mailbox)),
          asked(anna, x, Number) ))).
test(question_counts_as_what_an_agent_says, Outcome = raised(error(resource_error(cells), _))) :-
    numlist(1, 200, Long),
    no_leaks(setup_call_cleanup(
                 host_start(anna, [people(true), quota([cells(100)])]),
                 capturing(( asking(anna, person_ask(Long, text, _), Agent),
                             agent_join(Agent, Outcome, 20) ), _),
                 host_stop(anna))).
test(last_twenty_remain_visible, Shown == Expected) :-
    numlist(6, 25, Expected),
    with_people(( asking(anna, ( forall(between(1, 25, N), show(N)) ), Agent),
                  agent_join(Agent, done, 20),
                  person_page(anna, Rows),
                  findall(N, member(asked(_, _, N, shown), Rows), Shown) )).
test(guarded_agents_ask_too,
     [condition(missing([cells], [])), Results == ["yes", refused]]) :-
    no_leaks(with_tmp_dir(Dir, guarded(Dir, Results))).

guarded(Dir, Results) :-
    atom_concat(Dir, '/rules', Rules),
    setup_call_cleanup(open(Rules, write, Out),
                       writeln(Out, 'refuse(ask/2).'), close(Out)),
    setup_call_cleanup(
        ( host_start(anna, [people(true), policy(guarded)]),
          host_start(ben, [people(true), policy(Rules)]) ),
        ( Body = ( catch(ask(x, A), error(permission_error(_, _, _), _),
                         A = refused), result(A) ),
          asking(anna, Body, Agent),
          answers(anna, x, "yes"),
          asking_or_refused(ben, Body, Refused),
          agent_result(Agent, Yes, 20),
          Results = [Yes, Refused] ),
        ( host_stop(ben), host_stop(anna) )).

asking_or_refused(Host, Body, Result) :-
    catch(( asking(Host, Body, Agent), agent_result(Agent, Result, 20) ),
          error(move_refused(_, policy(_)), _), Result = refused).

:- end_tests(people).

:- begin_tests(invitations).

test(token_opens_one_host_until_its_end) :-
    setup_call_cleanup(
        true,
        ( invite(anna, 100, Old), invite(anna, 100, New), invite(ben, 0, Late),
          findall(Host, ( member(Token, [Old, New, Late, '', anna]),
                          invited(Token, Host) ), [anna]),
          assertion(\+ clause(typhon_person_questions:invitation(_, New, _), _)),
          uninvite(anna),
          \+ invited(New, _) ),
        ( uninvite(anna), uninvite(ben) )).

:- end_tests(invitations).
