:- module(test_course, []).

% The exercises of doc/course: each solution passes its check, and a program
% with one mistake does not.

:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/2]).
:- use_module('../../doc/course/checks/course',
              [ exercise/2, exercise_verdict/3 ]).
:- use_module('../../doc/course/checks/first_agent', []).
:- use_module('../../doc/course/checks/stigmergy', []).
:- use_module('../../doc/course/checks/election', []).
:- use_module('../../doc/course/checks/contract_net', []).
:- use_module('../../doc/course/checks/ants', []).
:- use_module('../../doc/course/checks/faults', []).
:- use_module('../../doc/course/checks/supervision', []).
:- use_module('../../doc/course/checks/people', []).
:- use_module('../lib/fixtures', [capturing/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).

:- multifile course:criterion/3.

course:criterion(broken, broken, test_course:no_such_check).

solution(Exercise, File) :-
    format(atom(Relative), 'doc/course/solutions/~w.pl', [Exercise]),
    project_file(Relative, File).

%   The problems of a program; output for students is ignored.

wrongs(Exercise, File, Wrongs) :-
    no_leaks(capturing(findall(Text-Why, wrong(Exercise, File, Text, Why),
                               Wrongs), _)).

is_wrong(Exercise, File) :-
    no_leaks(capturing(wrong(Exercise, File, _, _), _)).

wrong(Exercise, File, Text, Why) :-
    exercise_verdict(Exercise, File, verdict(Text, Why)),
    Why \== ok.

                /*******************************
                *           MISTAKES           *
                *******************************/

%   mistake(?Exercise, -Right, -Wrong): of the text of its solution.

mistake(round, "subtract(Around, [From], [Next])", "Around = [Next|_]").
mistake(richest, "max_member", "min_member").
mistake(tally, "New is Old+N", "New = N").
mistake(claim, "leave_new(claimed)", "leave(claimed)").
mistake(forager, "        leave(stored(N)),\n", "").
mistake(brigade, "withdraw(need(water))", "true").
mistake(ring_leader, "Rank > Mine", "Rank < Mine").
mistake(leader, "->  dispose", "->  true").
mistake(contractor, "    leave(done(Task)),\n", "").
mistake(manager, "keysort(Bids, Sorted)", "Sorted = Bids").
mistake(shopper, "min_member", "max_member").
mistake(ant, "10/Cost**2", "1").
mistake(parcel, "max(", "min(").
mistake(fading_ant, "0.9*Old", "1.0*Old").
mistake(patrol, "visit(Hosts, Seen, More)", "More = [], Seen = []").
mistake(patient, "2*Pause", "1+Pause").
mistake(guard, "receive(_-Message, 5)", "receive(_-Message, 2)").
mistake(warden, "Agent-Outcome|Ends", "Agent-done|Ends").
mistake(foreman, ", follows(true)", "").
mistake(customer, "radius(inf)", "radius(1)").
mistake(speaker, "2*Most > Count", "2*Most >= Count").
mistake(speaker, "ballot(Hosts, [First,Second]", "ballot(Hosts, Names").
mistake(line, "keysort(Heights, Sorted)", "Sorted = Heights").
mistake(line, "show_places(Hosts, N1)", "show_places(Hosts, N)").

mistake(speaker, "show(speaker(Speaker))", "true").

%   Programs that come to the right result in another way than is asked for.

mistake(round, "    move(Host),\n", "").
mistake(richest, "neighbours(Hosts)", "neighbours([Host|_]), Hosts = [Host]").
mistake(claim, "leave(owner(Me)),", "true,").
mistake(forager, "search(60, 0)", "search(500, 0)").
mistake(forager, "search(60, 0)", "search(20, 0)").
mistake(brigade, "hops(Hops),", "Hops = 0,").
mistake(manager, "receive(Best-finished(Task)),", "").
mistake(manager, "Deadline is Now+5", "Deadline is Now+50").
mistake(shopper, "leave(done(Task)),", "true,").
mistake(patient, "Pause > 64", "Pause > 500").
mistake(patient, "Pause > 64", "Pause > 32").
mistake(guard, "receive(_-Message, 5)", "receive(_-Message, 50)").
mistake(patrol, "leave(patrolled)", "true").
mistake(warden, "forall(member(Agent, Agents), monitor(Agent))", "true").
mistake(foreman, "most(Restarts)", "most(Most), Restarts > Most").
mistake(customer, "monitor(Clerk),\n    send(Clerk, order(Thing)),",
        "forall(member(Other-_, [Clerk-_|More]), \c
                ( monitor(Other), send(Other, order(Thing)) )),").
mistake(customer, "receive(_-Message)",
        "(receive(_-Message, 20) -> true ; Message = late)").

%   Hosts with people offer these.

of_people(error(unknown_procedure(PI), _)) :-
    memberchk(PI, [choose/3, person_ask/3, show/1]).

mistaken(Exercise, Right-Wrong, Dir) :-
    solution(Exercise, Solution),
    read_file_to_string(Solution, Text, [encoding(utf8)]),
    atomic_list_concat(Parts, Right, Text),
    assertion(Parts = [_,_|_]),
    atomic_list_concat(Parts, Wrong, Changed),
    file_name_extension(Exercise, pl, Base),
    write_program(Dir, Base, Changed, File),
    is_wrong(Exercise, File).

write_program(Dir, Base, Text, File) :-
    directory_file_path(Dir, Base, File),
    file_directory_name(File, Parent),
    make_directory_path(Parent),
    write_file(File, Text).

                /*******************************
                *          THE COMMAND         *
                *******************************/

check(Arguments, Status, Out, Err) :-
    project_file('doc/course/check.pl', Program),
    run_swipl([Program, '--'|Arguments], [], Status, Out, Err).

hand_in(guard, Text) :-
    solution(guard, File),
    read_file_to_string(File, Text, [encoding(utf8)]).
hand_in(richest, ":- agent(richest, []).\nmain :- main.\n").
hand_in(tally, ":- agent(tally, []).\nmain :- shell('touch harmed').\n").

handed_in(Anna, Goal) :-
    with_tmp_dir(Dir, ( handed_in_at(Dir, Anna), call(Goal) )).

:- meta_predicate handed_in(-, 0).

handed_in_at(Dir, Anna) :-
    forall(hand_in(Exercise, Text),
           ( format(atom(Base), 'anna/~w.pl', [Exercise]),
             write_program(Dir, Base, Text, _) )),
    directory_file_path(Dir, anna, Anna).

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(course).

test(solutions_pass,
     [forall(exercise(Exercise, _)), true(Wrongs == []), nondet]) :-
    assertion(once(course:criterion(Exercise, _, _))),
    solution(Exercise, File),
    wrongs(Exercise, File, Wrongs).

test(solutions_give_no_warnings,
     [forall(exercise(Exercise, _)), true(Said == [])]) :-
    solution(Exercise, File),
    capturing(agent_check(File), Messages),
    findall(Message, ( member(Kind-Message, Messages),
                       memberchk(Kind, [warning, error]),
                       \+ of_people(Message) ),
            Said).

test(programs_with_a_mistake_fail,
     [forall(mistake(Exercise, Right, Wrong)), nondet]) :-
    with_tmp_dir(mistaken(Exercise, Right-Wrong)).

test(each_exercise_is_in_its_lesson, Missing == []) :-
    findall(Exercise,
            ( exercise(Exercise, Lesson),
              format(atom(Pattern), 'doc/course/~d-*.md', [Lesson]),
              project_file(Pattern, Absolute),
              expand_file_name(Absolute, [File]),
              read_file_to_string(File, Text, [encoding(utf8)]),
              format(string(Title), "**`~w.pl`**", [Exercise]),
              \+ sub_string(Text, _, _, _, Title) ),
            Missing).

test(hand_ins_are_marked_in_a_table) :-
    handed_in(Anna,
        ( findall(File, ( member(Base, ['guard.pl', 'tally.pl']),
                          directory_file_path(Anna, Base, File) ),
                  Files),
          check([ '--csv'|Files ], exit(1), Out, _),
          split_string(Out, "\n", "\r\n", [Header, Guard, Tally]),
          assertion(Header == "file,exercise,points,of"),
          assertion(sub_string(Guard, _, _, 0, "guard.pl,guard,4,4")),
          assertion(sub_string(Tally, _, _, 0, "tally.pl,tally,0,2")),
          assertion(\+ exists_file(harmed)) )).

test(lessons_have_two_mistakes_each, Few == []) :-
    findall(Lesson,
            ( between(1, 8, Lesson),
              findall(x, ( exercise(Exercise, Lesson),
                           mistake(Exercise, _, _) ), Mistakes),
              \+ Mistakes = [_,_|_] ),
            Few).
test(missing_file_is_no_mistake_of_a_program) :-
    check(['/no/such/round.pl'], Status, Out, Err),
    assertion(Status-Out == exit(2)-""),
    assertion(sub_string(Err, _, _, _, "There is no file /no/such/round.pl")).
test(mistake_in_a_check_is_its_own,
     [true(Found = itself(_)), nondet]) :-
    solution(round, File),
    exercise_verdict(broken, File, verdict(broken, Found)).
test(refused_program_is_a_mistake_of_it, true(string(Found))) :-
    with_tmp_dir(Dir,
        ( write_program(Dir, 'round.pl', "main :- foo(.\n", File),
          no_leaks(capturing(once(exercise_verdict(round, File,
                                                   verdict(_, Found))), _)) )).
test(endless_program_is_stopped) :-
    handed_in(Anna,
        ( check([Anna, '--only=richest', '--seconds=1'], Status, Out, _),
          assertion(Status == exit(1)),
          assertion(sub_string(Out, _, _, _, "FAIL  ends in time")) )).
test(a_program_that_fails_is_reported) :-
    handed_in(Anna,
        ( check([Anna, '--only=tally'], Status, Out, _),
          assertion(Status == exit(1)),
          assertion(sub_string(Out, _, _, _, "FAIL  answers with the sum")),
          assertion(sub_string(Out, _, _, _, "0 of 1 programs pass")) )).

:- end_tests(course).
