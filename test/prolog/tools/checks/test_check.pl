:- module(test_check, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [message_text/2]).
:- use_module('../../../lib/fixtures').
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(readutil)).
:- use_module(library(typhon)).

/** <module> Tests of the messages of program checks

Programs are written to files; what the check and creation print is compared
by line and formal term, or as text.
*/

:- meta_predicate with_program(+, 1).

%   with_program(+Lines, :Goal): Goal(File) for an agent `a` of these lines,
%   with s/1 as its state; the first of Lines is the third of the file.

with_program(Lines, Goal) :-
    with_tmp_dir(test_check:in_dir(Lines, Goal)).

in_dir(Lines, Goal, Dir) :-
    directory_file_path(Dir, 'a.pl', File),
    write_program([':- agent(a, [state([s/1])]).', 'main :- p, q.'|Lines],
                  File),
    call(Goal, File).

write_program(Lines, File) :-
    setup_call_cleanup(open(File, write, Out, [encoding(utf8)]),
                       forall(member(Line, Lines),
                              format(Out, '~w~n', [Line])),
                       close(Out)).

%   found(+Lines, -Found): the problems that the check finds, as Line-Formal,
%   except calls of predicates that others must define.

found(Lines, Found) :-
    with_program(Lines, test_check:found_in(Found)).

found_in(Found, File) :-
    capturing(agent_check(File), Messages),
    findall(Line-Formal,
            ( member(_-error(Formal, at(Place, _, _)), Messages),
              line(Place, Line),
              Formal \= unknown_procedure(_) ),
            Found).

line(_:Line, Line).
line(file(_, Line, _, _), Line).

%   loses(+Text, -What): the choice points that a program with the clauses Text
%   and a predicate go/0 that can stop gives up.

loses(Text, What) :-
    found([Text, 'go :- move(a).'], Found),
    findall(L, member(_-L, Found), What).

creation_error(Error, File) :-
    with_hosts([alpha],
               catch(agent_create(File, _), Error, true)).

unknown_line(Line, File) :-
    capturing(agent_check(File), Messages),
    member(_-error(unknown_procedure(_), at(_:Line, _, _)), Messages),
    !.

creation_text(Lines, Text) :-
    with_program(Lines, test_check:creation_error(Error)),
    message_text(Error, Text).

printed(Lines, Text) :-
    with_program(Lines, test_check:printed_of(Text)).

printed_of(Text, File) :-
    capturing(agent_check(File), Messages),
    findall(T, ( member(_-Error, Messages), message_text(Error, T) ), Ts),
    atomic_list_concat(Ts, Text).

empty_file(Dir) :-
    directory_file_path(Dir, 'a.pl', File),
    write_program([], File),
    printed_of(Text, File),
    shows(Text, "there are no clauses: declaration").

shows(Text, Words) :-
    assertion(sub_string(Text, _, _, _, Words)).

severities(Kinds, File) :-
    capturing(agent_check(File), Messages),
    findall(Kind, member(Kind-error(_, _), Messages), Kinds).

payload_in(Found, File) :-
    write_program([':- payload(a, [provides([p/1])]).',
                   'p(X) :- r(X, Y).',
                   'r(_, L) :- member(X, L), move(X), assertz(m(X)), fail.',
                   ':- discontiguous t/0.', 't.', 'u.', 't.'],
                  File),
    found_in(Found, File).

warned([First,Second,Third], File) :-
    with_hosts([alpha],
               ( created(File, First),
                 created(File, Second),
                 write_program([':- agent(a, [state([s/1])]).',
                                'main :- s(X).', 's(1).'], File),
                 created(File, Third) )).

created(File, Count) :-
    capturing(( agent_create(File, Agent), joined(Agent, _) ), Messages),
    findall(x, member(warning-error(singletons(_), _), Messages), Found),
    length(Found, Count).

unknown_in(OptionLists, Found, File) :-
    with_hosts([alpha],
               findall(PIs, ( member(Options, OptionLists),
                              unknown_at_creation(File, Options, PIs) ),
                       Found)).

unknown_at_creation(File, Options, PIs) :-
    capturing(( agent_create(File, Agent, Options), joined(Agent, _) ),
              Messages),
    unknown_of(Messages, PIs).

unknown_of(Messages, PIs) :-
    findall(PI, ( member(warning-error(unknown_procedure(PI), _), Messages),
                  \+ memberchk(PI, [p/0, q/0]) ),
            PIs).

unknown_in_place([Before, After], File) :-
    with_hosts([alpha], unknown_at_creation(File, [], Before)),
    atom_concat(File, '.2.pl', Again),
    copy_file(File, Again),
    with_hosts([alpha],
               ( remote(alpha, assertz(temperature(3))),
                 unknown_at_creation(Again, [], After) )).

clauses_created :-
    create([(main :- member(H, [alpha]), move(H), true),
            (p :- member(H, [alpha, beta]), move(H), fail)], Agent),
    joined(Agent, done).

:- begin_tests(choice_points).

test(failure_driven_loop, L == [lost_choice(member/2, move/1, fail/0)]) :-
    loses('p :- neighbours(Hs), member(H, Hs), move(H), log(H), fail.', L).
test(loop_with_an_end, L == [lost_choice(member/2, go/0, false/0)]) :-
    loses('p :- ( member(H, [a,b]), log(H), go, false ; true ), log(x).', L).
test(state, L == [lost_choice(retract/1, move/1, fail/0)]) :-
    loses('p :- retract(s(H)), move(H), fail.', L).
test(search, L == [lost_choice(member/2, move/1, sense/1)]) :-
    loses('p :- neighbours(Hs), member(H, Hs), move(H), sense(gold).', L).
test(choice_point_in_a_condition, L == [lost_choice(between/3, go/0, (>)/2)]) :-
    loses('p :- ( between(1, 3, X), go, X > 2 -> true ; log(none) ).', L).
test(under_once, L == [lost_choice(select/3, move/1, (==)/2)]) :-
    loses('p :- once(( select(X, [a,b], _), move(X), X == b )).', L).
test(facts, L == [lost_choice(h/1, move/1, (\==)/2)]) :-
    loses('p :- h(X), catch(move(X), _, true), X \\== a. h(a). h(b).', L).
test(another_clause, L == [lost_choice(clause, receive/2, receive/2)]) :-
    loses('p :- receive(_-a, 5), log(a), p. p :- log(late).', L).
test(more_general_clause,
     L == [lost_choice(clause, move/1, take/1)]) :-
    loses('q(f(X)) :- move(X), take(gold). q(_).', L).
test(chosen_clause_before_fail,
     L == [lost_choice(clause, move/1, fail/0)]) :-
    loses('q(X) :- X > 3, move(a), fail. q(_) :- log(x).', L).
test(chosen_side_of_a_disjunction_before_fail,
     L == [lost_choice((;)/2, move/1, fail/0)]) :-
    loses('p(X) :- ( X > 3, move(a), fail ; log(x) ).', L).
test(other_side_of_a_disjunction,
     L == [lost_choice((;)/2, receive/2, receive/2)]) :-
    loses('p :- ( receive(_-a, 5) ; log(late) ).', L).
test(choice_point_in_a_rule_of_the_state,
     L == [lost_choice(repeat/0, move/1, fail/0)]) :-
    loses('s(X) :- repeat, move(X), fail.', L).

%   Correct programs, each with the reason.

fine('p :- retract(s(H)), !, move(H), p. p :- log(done).').  % cut
fine('p :- neighbours(Hs), member(H, Hs), move(H).').  % the first is enough
fine('p :- member(H, [a]), move(H), H == a.').               % there is no other
fine('p :- neighbours(Hs), member(H, Hs), !, move(H), sense(gold).').
fine('p :- member(H, [a,b]), once(s(H)), log(H), fail. p :- go.').
fine('p :- s(X), move(X), X > 3.').                          % may be one fact
fine('p :- ( receive(_-a, 5) -> true ; log(late) ).').       % travels
fine('p :- ( move(a), sense(gold) -> true ; log(none) ).').
fine('p :- go, member(X, [a,b]), s(X), X == b.').  % later choice points
fine('p :- go, ( s(X), log(X), fail ; true ).').
fine('p :- member(X, [a,b]), go, ( s(X), fail ; true ).').
fine('q(X) :- X > 3, move(a), s(X), X < 9. q(X) :- X =< 3, log(X).').
fine('q(X) :- X > 3, move(a), X < 9. q(_) :- log(x).').       % chosen
fine('q([]). q([H|T]) :- move(H), ( s(H) -> q(T) ; fail ).').
fine('q([H|T]) :- move(H), H \\== a, q(T). q([]).').         % other cases
fine('p :- s(X), ( X == a -> fail ; true ), move(X).').
fine('p :- ignore(( go, sense(gold) )). p :- log(x).').
fine('p :- go, fail.').                                      % fails on purpose

test(correct_programs_give_no_warning, [forall(fine(Text)), L == []]) :-
    loses(Text, L).
test(warning_suggests_a_fix) :-
    printed(['p :- member(H, [a,b]), move(H), fail.'], T1),
    shows(T1, "a.pl:3: move/1 gives up the choices of member/2: \c
               fail/0 does not come back to them"),
    shows(T1, "findall/3"),
    printed(['p :- receive(_-a, 5), p. p :- log(late).'], T2),
    shows(T2, "( Goal -> ... ; ... )").

:- end_tests(choice_points).

:- begin_tests(lint).

test(variables_that_occur_once, F == [4-singletons(['Y','Z'])]) :-
    found(['p.', 'q :- s(Y), s(_X), s(Z), s(_).'], F).
test(single_variable_in_a_grammar_rule, F == [3-singletons(['Y'])]) :-
    found(['g --> [Y], [].'], F).
test(discontiguous_clauses, F == [5-discontiguous(p/0)]) :-
    found(['p :- s(1).', 'q.', 'p.', 'q.', ':- discontiguous q/0.', 'p.'],
          F).
test(facts_of_the_state_may_be_discontiguous, F == []) :-
    found(['s(1).', 'p.', 's(2).', 'q.'], F).
test(undeclared_state, F == [3-undeclared_state(n/1)]) :-
    found(['p :- assertz(n(1)), retract(n(_)).', 'q :- n(1).'], F).
test(undeclared_state_is_reported_once, M == [warning]) :-
    with_program(['p :- assertz(n(1)), n(1).', 'q.'],
                 test_check:severities(M)).
test(payload, F == [2-singletons(['Y']),
                    3-lost_choice(member/2, move/1, fail/0)]) :-
    with_program([], test_check:payload_in(F)).

:- end_tests(lint).

:- begin_tests(errors).

test(all_syntax_errors, Lines == [3,5,7]) :-
    found(['p :- a b.', 'q.', 'r(X :- y.', 's(Z).', ':- include(nothing).'],
          Found0),
    exclude([_-singletons(_)]>>true, Found0, Found),
    findall(Line, member(Line-_, Found), Lines).
test(unterminated_clause, [true(F = [_-syntax_error(_)])]) :-
    found(['p :- "'], F).
test(creation_reports_all_errors) :-
    creation_text(['p :- a b.', 'q :- c d.', 'r :- e f.'], Text),
    shows(Text, "a.pl:3:7: Syntax error"),
    shows(Text, "a.pl:4:7: Syntax error"),
    shows(Text, "a.pl:5:7: Syntax error").
test(creation_reports_positions) :-
    creation_text(['p :- forall(s(X), move(X)).', 'q.', 'move(_).'], Text),
    shows(Text, "a.pl:5: No permission"),
    creation_text(['p :- forall(s(X), move(X)).', 'q.'], Text2),
    shows(Text2, "a.pl:3: No permission"),
    shows(Text2, "recursive predicate").
test(creation_reports_more_than_one) :-
    creation_text(['p :- forall(s(X), move(X)).', 'q :- \\+ move(a).'], Text),
    shows(Text, "a.pl:3: No permission"),
    shows(Text, "a.pl:4: No permission").

advice('setup_call_cleanup(true, move(a), true)', "cannot travel").
advice('with_mutex(m, move(a))', "cannot travel").
advice('\\+ move(a)', "( Goal -> fail ; true )").
advice('findall(X, move(X), _)', "recursive predicate").
advice('call_with_time_limit(3, move(a))', "receive/2").
advice('with_output_to(string(_), move(a))', "cannot travel").

test(advice_matches_the_problem, [forall(advice(Goal, Words))]) :-
    atomic_list_concat(['p :- ', Goal, '.'], Line),
    printed([Line, 'q.'], Text),
    shows(Text, Words),
    (   Words == "recursive predicate"
    ->  true
    ;   assertion(\+ sub_string(Text, _, _, _, "recursive"))
    ).

%   Similar predicates are suggested, else possible definitions.

unknown('recieve(_)', "recieve/1 (did you mean receive/1 or receive/2?").
unknown('clone', "clone/0 (did you mean clone/1 or clone/2?").
unknown('writln(x)', "writln/1 (did you mean writeln/1 or writeln/2?").
unknown('p(x)', "p/1 (did you mean p/0?").
unknown('hepler(_)', "hepler/1 (did you mean helper/1?").
unknown('temperature(_)', "temperature/1 (a place or a payload must offer").

test(calls_of_unknown_predicates, [forall(unknown(Goal, Words))]) :-
    atomic_list_concat(['p :- ', Goal, '.'], Line),
    printed([Line, 'q.', 'helper(_).'], Text),
    shows(Text, Words).
test(file_without_clauses) :-
    with_tmp_dir(test_check:empty_file).

:- end_tests(errors).

:- begin_tests(lines_of_goals).

%   Lines are those of the file, in which the first of these is the third.

at_line(['p :- true,', '    forall(member(H, [a]),', '           move(H)).',
         'q.'], 5).
at_line(['p :- move(a),', '    forall(true,', '           ( true, move(H) )),',
         '    log(H).', 'q.'], 5).
at_line(['p :- q,', '    assertz(', '        q).', 'q.'], 4).
at_line(['p :- q,', '    assertz(t(1)).', 'q.'], 4).
at_line(['p :- q,', '    atom(a), [x] = [Slip].', 'q.'], 4).
at_line(['p :- q, member(X, [a, b]),', '    log(X),', '    move(X),',
         '    fail.', 'q.'], 5).
at_line(['p --> [a],', '    { assertz(u(1)) }.', 'p :- q. q.'], 4).

test(problem_is_at_its_goal, [forall(at_line(Lines, Line)),
                              true(Found = [Line-_])]) :-
    found(Lines, Found).
test(unknown_procedure_is_at_its_goal, Line == 5) :-
    with_program(['p :- q,', '    log(a),', '    findall(X, reprot(X), _).',
                  'q.'], test_check:unknown_line(Line)).
test(raised_error_is_at_its_goal, Line == 4) :-
    with_program(['p :- q,', '    forall(true, move(a)).', 'q.'],
                 test_check:creation_error(Error)),
    Error = error(_, at(_:Line, _, _)).

:- end_tests(lines_of_goals).

:- begin_tests(creation).

%   Warnings are printed when the file is read, and again when it has changed.

test(program_is_warned_of_once_per_version, Counts == [1,0,1]) :-
    with_program(['p :- s(X).', 'q.'], test_check:warned(Counts)).
test(clauses_are_warned_of_once,
     Found == [lost_choice(member/2, move/1, fail/0)]) :-
    with_hosts([alpha],
               capturing(( clauses_created, clauses_created ), Messages)),
    findall(Formal, member(warning-error(Formal, _), Messages), Found).

%   Predicates that a program calls and does not define.

test(unknown_procedure_is_warned_of_once, Found == [[sleep/2], []]) :-
    with_program(['main :- sleep(1, now).'],
                 test_check:unknown_in([[], []], Found)).
test(place_may_define_it, Found == [[temperature/1], []]) :-
    with_program(['main :- temperature(_).'],
                 test_check:unknown_in_place(Found)).
test(payload_may_define_it, Found == [[]]) :-
    with_program(['main :- temperature(_).'],
                 test_check:unknown_in([[payloads([payload(
                     thermometer, [temperature/1], [temperature(3)])])]],
                     Found)).
test(attached_payload_may_define_it, Found == [[sleep/2]]) :-
    with_program(['main :- attach(x), temperature(_), sleep(1, now).'],
                 test_check:unknown_in([[]], Found)).
test(library_of_the_program_defines_it, Found == []) :-
    with_hosts([alpha],
               capturing(( create([(:- use_module(library(heaps))),
                                   (main :- empty_heap(_))], A),
                           joined(A, done) ), Messages)),
    unknown_of(Messages, Found).

:- end_tests(creation).

:- begin_tests(own_programs).

%   Each agent program and payload of the tree.

doubtful(File, Found) :-
    program_files(Files),
    member(File, Files),
    found_in(Found, File),
    Found \== [].

program_files(Files) :-
    findall(Dir, ( member(F, [agents, payloads, examples, experiments]),
                   project_file(F, Dir),
                   exists_directory(Dir) ), Dirs),
    findall(File,
            ( member(Dir, Dirs),
              directory_member(Dir, File,
                               [extensions([pl]), recursive(true)]),
              declares(File) ),
            Files).

declares(File) :-
    read_file_to_string(File, Text, [encoding(utf8)]),
    string_concat("\n", Text, Lines),
    member(Declaration, ["\n:- agent(", "\n:- payload("]),
    sub_string(Lines, _, _, _, Declaration),
    !.

test(own_programs_have_no_warnings, Found == []) :-
    program_files(Files),
    assertion(( length(Files, N), N > 5 )),
    findall(F-P, doubtful(F, P), Found).

:- end_tests(own_programs).
