:- module(test_people_examples, []).

% The examples with people, in processes of their own; clients answer for the
% people, by the links that are printed.

:- use_module('../lib/common').
:- use_module('../lib/pages', [ask/3]).
:- use_module('../lib/texts', [file_lines/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

%   run_example(+Example, :Given, +Last, -Lines): the output, of which Last is
%   the line after which people do no more.

run_example(Example, Given, Last, Lines) :-
    with_tmp_dir(Dir, run_in(Dir, Example, Given, Last, Lines)).

run_in(Dir, Example, Given, Last, Lines) :-
    format(atom(Relative), 'examples/people/~w.pl', [Example]),
    project_file(Relative, Program),
    directory_file_path(Dir, out, Output),
    current_prolog_flag(executable, Swipl),
    setup_call_cleanup(
        ( open(Output, write, Out),
          process_create(Swipl, [Program, --, anna, ben, carla, '--port=0'],
                         [ stdin(pipe(In)), stdout(stream(Out)),
                           stderr(stream(Out)), process(Pid) ]) ),
        ( wait_until(links(Output, Links), 30),
          wait_until(answered(Links, Given, Output, Last), 60),
          nl(In),
          flush_output(In),
          wait_for_end(Pid, 30, Status) ),
        ( catch(stop_process(Pid), error(existence_error(process, _), _), true),
          close(In, [force(true)]),
          close(Out) )),
    assertion(Status == exit(0)),
    file_lines(Output, Lines).

links(Output, Links) :-
    file_lines(Output, Lines),
    findall(Name-Link,
            ( member(Line, Lines),
              split_string(Line, " ", "%:", ["", Name0, Link]),
              atom_string(Name, Name0) ),
            Links),
    Links = [_,_,_].

answered(Links, Given, Output, Last) :-
    forall(member(Name-Link, Links), answer_all(Name, Link, Given)),
    read_file_to_string(Output, Text, []),
    sub_string(Text, _, _, _, Last).

answer_all(Name, Link, Given) :-
    ask(Link, _{ask:"page"}, Page),
    forall(member(Question, Page.answer.questions),
           ( call(Given, Name, Question, Answer),
             ask(Link, _{do:"answer", number:Question.number, answer:Answer},
                 _) )).

%   What people of a class answer, and those who do chores.

of_class(Name, Question, Answer) :-
    (   Question.kind == "number"
    ->  memberchk(Name-Answer, [anna-"9", ben-"11", carla-"11"])
    ;   memberchk("lake", Question.choices)
    ->  memberchk(Name-Answer, [anna-1, ben-2, carla-2])
    ;   better(Question.choices, Answer)
    ).

better([A, B], Answer) :-
    Taste = ["juice", "water", "tea", "milk"],
    nth1(I, Taste, A),
    nth1(J, Taste, B),
    ( I < J -> Answer = 1 ; Answer = 2 ).

of_chores(Name, Question, Answer) :-
    (   Question.choices == ["yes", "no"]
    ->  memberchk(Name-Answer, [anna-2, ben-1, carla-2])
    ;   assertion(Question.choices == ["done"]),
        (   Question.text == "Please wipe the board."
        ->  assertion(Name == ben)
        ;   assertion(Question.text == "Please carry the table, both of you.")
        ),
        Answer = 1
    ).

:- begin_tests(people_examples).

test(class_votes_elects_and_sorts) :-
    run_example(class, test_people_examples:of_class, "Press Enter", Lines),
    assertion(memberchk("vote: [museum-2,lake-1]", Lines)),
    once(( member(Line, Lines),
           string_concat("speaker: carla@", _, Line) )),
    assertion(memberchk("order: [juice,water,tea,milk]", Lines)).
test(people_do_chores_that_fit) :-
    run_example(chores, test_people_examples:of_chores, "Press Enter", Lines),
    forall(member(Chore, [wipe, carry]),
           ( format(string(Line), "~w: done", [Chore]),
             assertion(memberchk(Line, Lines)) )).
test(lesson_shows_the_current_programs, Others == []) :-
    project_file('doc/course/8-people.md', Lesson),
    read_file_to_string(Lesson, Text, [encoding(utf8)]),
    findall(Name,
            ( member(Name, [vote, elect, order]),
              format(atom(Relative), 'examples/people/~w.pl', [Name]),
              project_file(Relative, File),
              read_file_to_string(File, Program, [encoding(utf8)]),
              format(string(Block), "```prolog~n~s```~n", [Program]),
              \+ sub_string(Text, _, _, _, Block) ),
            Others).

:- end_tests(people_examples).
