:- module(test_transcript,
          [ transcript_differences/3,   % +Sessions, +Dir, -Differences
            transcript_differences/4,   % +Sessions, +Terminal, +Dir,
                                        % -Differences
            typed_in_terminal/3,        % +Queries, +Dir, -Outputs
            session_steps/2             % +Lines, -Steps
          ]).

/** <module> Compare transcripts in documents with the top level

A session is a block of a document: queries after `?- `, continued after `|`,
each followed by its output. The queries are typed at a top level that has
loaded library(typhon) and runs in a terminal.

Ports, marks of agents, numbers of threads and variables, and long floats are
not compared, nor are the bindings of `$Var`. A line `...` stands for any
lines. Reports (errors, and output of agents) may appear at any time of their
session.

*Threading*: a thread reads the output of the top level, as a wait on a stream
with a deadline may lose the beginning of a line.
*/

:- use_module(common).
:- use_module(library(apply),
              [ exclude/3, foldl/4, include/3, maplist/3, partition/4 ]).
:- use_module(library(dcg/basics), [digits//1, integer//1, string//1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [append/3, member/2, select/3, subtract/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

%!  transcript_differences(+Sessions, +Dir, -Differences:list) is det.
%!  transcript_differences(+Sessions, +Terminal, +Dir, -Differences:list) is
%!      det.
%
%   Sessions are pairs of a line number and the lines of a session; all are
%   typed at one top level in Dir. Differences are pairs of a line number and
%   the deviation from what the document shows. Terminal is terminal(Columns,
%   Colour), Colour a boolean; default is terminal(80, true).

transcript_differences(Sessions, Dir, Differences) :-
    transcript_differences(Sessions, terminal(80, true), Dir, Differences).

transcript_differences([], _, _, []) :-
    !.
transcript_differences(Sessions, Terminal, Dir, Differences) :-
    setup_call_cleanup(
        start_top_level(Terminal, Dir, Top),
        findall(Difference,
                ( member(Line-Lines, Sessions),
                  steps(Lines, Steps),
                  session(Steps, Line, Top, Difference) ),
                Differences),
        stop_top_level(Top)).

%!  typed_in_terminal(+Queries, +Dir, -Outputs:list) is det.
%
%   Outputs are, for each of Queries, texts, the lines that were printed for
%   it, without empty ones.

typed_in_terminal(Queries, Dir, Outputs) :-
    setup_call_cleanup(
        start_top_level(terminal(80, true), Dir, Top),
        maplist(ask(Top), Queries, Outputs),
        stop_top_level(Top)).

%!  session_steps(+Lines, -Steps:list) is det.
%
%   Steps are step(Goal, Expected) for each query in the lines of a session.

session_steps(Lines, Steps) :-
    steps(Lines, Steps).

steps([], []).
steps([Line|Lines], [step(Goal, Expected)|Steps]) :-
    string_concat("?- ", Begin, Line),
    !,
    goal(Begin, Lines, Goal, Lines1),
    (   append(Expected, [Next|Rest], Lines1),
        string_concat("?- ", _, Next)
    ->  steps([Next|Rest], Steps)
    ;   Expected = Lines1,
        Steps = []
    ).
steps([_|Lines], Steps) :-
    steps(Lines, Steps).

goal(Begin, Lines, Begin, Lines) :-
    string_concat(_, ".", Begin),
    !.
goal(Begin, [Line|Lines], Goal, Rest) :-
    string_concat("|", More, Line),
    string_concat(Begin, More, Goal0),
    goal(Goal0, Lines, Goal, Rest).

                /*******************************
                *          TOP LEVEL           *
                *******************************/

start_top_level(terminal(Columns, Colour), Dir,
                top(Pid, In, Queue, Reader, Dir)) :-
    current_prolog_flag(executable, Swipl),
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    directory_file_path(Library, 'typhon.pl', Typhon),
    project_file('test/lib/terminal.py', Terminal),
    project_file('test/lib/typed_queries.pl', Marks),
    format(atom(Set), 'set_prolog_flag(color_term,~w),\c
                      set_prolog_flag(toplevel_prompt,\'?- \')', [Colour]),
    python(Python),
    process_create(Python,
                   [ Terminal, Columns, Swipl, '-f', Marks, '-p', Path,
                     '-g', Set, Typhon ],
                   [ cwd(Dir), stdin(pipe(In, [encoding(utf8)])),
                     stdout(pipe(Out, [encoding(utf8)])), process(Pid) ]),
    message_queue_create(Queue),
    thread_create(read_lines(Out, Queue), Reader).

read_lines(Out, Queue) :-
    read_line_to_string(Out, Line),
    thread_send_message(Queue, line(Line)),
    (   Line == end_of_file
    ->  close(Out)
    ;   read_lines(Out, Queue)
    ).

stop_top_level(top(Pid, In, Queue, Reader, _)) :-
    catch(format(In, 'halt.~n', []), error(_, _), true),
    close(In, [force(true)]),
    wait_for_end(Pid, 10, Status),
    (   Status == timeout
    ->  process_kill(Pid, kill),
        process_wait(Pid, _)
    ;   true
    ),
    thread_join(Reader, _),
    message_queue_destroy(Queue).

%   ask(+Top, +Goal, -Lines): Lines are the output of Goal, and the reports
%   that came since the goal before.

ask(top(_, In, Queue, _, Dir), Goal, Lines) :-
    format(In, '~s~nnext.~n', [Goal]),
    flush_output(In),
    get_time(Now),
    Deadline is Now+60,
    lines_until("@@begin@@", Queue, Deadline, Goal, Before),
    lines_until("@@next@@", Queue, Deadline, Goal, Output),
    include(report, Before, Reports),
    exclude(empty, Output, Answer),
    append(Reports, Answer, Lines0),
    maplist(at_home(Dir), Lines0, Lines).

%   A part of the typed text may remain, or 10.1 may redraw it after a report.

empty(Line) :-
    string_concat(_, Line, "next."),
    !.
empty(Line) :-
    string_concat(_, "?- next", Line).

lines_until(Mark, Queue, Deadline, Goal, Lines) :-
    (   thread_get_message(Queue, line(Line0), [deadline(Deadline)])
    ->  true
    ;   throw(error(timeout_error(top_level, Goal), _))
    ),
    (   Line0 == Mark
    ->  Lines = []
    ;   Line0 == end_of_file
    ->  throw(error(existence_error(top_level, Goal), _))
    ;   without_echo(Line0, Goal, Line),
        Lines = [Line|More],
        lines_until(Mark, Queue, Deadline, Goal, More)
    ).

%   A report between two queries appears after the prompt, or in the middle of
%   the typed text.

without_echo(Line0, Goal, Line) :-
    (   string_concat("?- ", Line1, Line0)
    ->  true
    ;   Line1 = Line0
    ),
    (   report_begins(Begin),
        sub_string(Line1, Before, _, _, Begin),
        sub_string(Line1, 0, Before, _, Typed),
        member(Query, [Goal,"next."]),
        sub_string(Query, _, _, _, Typed)
    ->  sub_string(Line1, Before, _, 0, Line)
    ;   Line = Line1
    ).

report_begins("% ").
report_begins("ERROR:").
report_begins("Warning:").

at_home(Dir, Line0, Line) :-
    atomic_list_concat(Parts, Dir, Line0),
    atomic_list_concat(Parts, '/home/you', Line1),
    atom_string(Line1, Line).

                /*******************************
                *           SESSIONS           *
                *******************************/

%   session(+Steps, +Line, +Top, -Difference): answers must appear with their
%   goals, reports (errors, and output of agents) at any time.

session(Steps, Line, Top, Line:Difference) :-
    foldl(step(Top), Steps, []-[], Differences-Reports),
    findall(Report,
            ( member(step(_, Expected), Steps),
              member(Text, Expected), report(Text), comparable(Text, Report) ),
            Wanted),
    late_reports(Top, Wanted, Reports, 50, Missing, Surplus),
    (   member(Difference, Differences)
    ;   member(Report, Missing), Difference = missing(Report)
    ;   \+ ( member(step(_, Expected), Steps), memberchk("...", Expected) ),
        member(Report, Surplus), \+ by_others(Report),
        Difference = unexpected(Report)
    ).

%   A program that looks for an ended process of its own may connect to the
%   port of that process, which is ours now.

by_others(Report) :-
    sub_string(Report, _, _, _, "refused a client at 127.0.0.1: its cookie \c
                                 is not that of this process").

step(Top, step(Goal, Expected), Differences0-Reports0, Differences-Reports) :-
    wanted_answer(Goal, Expected, Wanted),
    answer(Goal, Wanted, Top, 100, Answer, New),
    append(Reports0, New, Reports),
    (   alike(Wanted, Answer)
    ->  Differences = Differences0
    ;   append(Differences0, [said(Goal, Answer, instead_of(Wanted))],
               Differences)
    ).

wanted_answer(Goal, Lines, Wanted) :-
    exclude(report, Lines, Answers),
    subtract(Answers, ["", "..."], Shown),
    answer_lines(Goal, Shown, Wanted).

%   A query may be repeated until the answer is as expected, since agents need
%   time.

answer(Goal, Wanted, Top, Tries, Answer, Reports) :-
    ask(Top, Goal, Lines),
    partition(report, Lines, Texts, Answers),
    maplist(comparable, Texts, Reports0),
    answer_lines(Goal, Answers, Answer0),
    (   \+ alike(Wanted, Answer0),
        Tries > 0,
        question(Goal)
    ->  pause,
        Tries1 is Tries-1,
        answer(Goal, Wanted, Top, Tries1, Answer, Reports1),
        append(Reports0, Reports1, Reports)
    ;   Answer = Answer0,
        Reports = Reports0
    ).

question(Goal) :-
    member(Begin, ["agents.", "hosts.", "agent_property(", "host_property(",
                   "network_property(", "remote(alpha, sense("]),
    string_concat(Begin, _, Goal),
    !.

pause :-
    catch(wait_until(fail, 0.1), error(timeout_error(_, _), _), true).

report(Line) :-
    report_begins(Begin),
    string_concat(Begin, _, Line),
    !.

late_reports(Top, Wanted, Reports, Tries, Missing, Surplus) :-
    foldl(cross_out, Wanted, []-Reports, Missing0-Surplus0),
    (   Missing0 \== [],
        Tries > 0
    ->  pause,
        ask(Top, "true.", Lines),
        include(report, Lines, Texts),
        maplist(comparable, Texts, New),
        append(Reports, New, Reports1),
        Tries1 is Tries-1,
        late_reports(Top, Wanted, Reports1, Tries1, Missing, Surplus)
    ;   Missing = Missing0,
        Surplus = Surplus0
    ).

cross_out(Wanted, Missing-Reports0, Missing-Reports) :-
    select(Wanted, Reports0, Reports),
    !.
cross_out(Wanted, Missing, [Wanted|Missing0]-Reports) :-
    Missing = Missing0-Reports.

                /*******************************
                *          COMPARING           *
                *******************************/

%   Without the bindings of $Var, and without the end of a line of bindings.

answer_lines(Goal, Lines0, Lines) :-
    exclude(repeats_variable(Goal), Lines0, Lines1),
    goals_joined(Lines1, Lines2),
    maplist(comparable, Lines2, Lines3),
    (   Lines3 == [],
        Lines0 \== []
    ->  Lines = ["true"]
    ;   Lines = Lines3
    ).

%   SWI-Prolog 10.1 lists a goal on several lines if the terminal is narrow.

goals_joined([Line,Next|Lines0], Lines) :-
    goal_continues(Line),
    !,
    string_concat(" ", Next, Text),
    string_concat(Line, Text, Joined),
    goals_joined([Joined|Lines0], Lines).
goals_joined([Line|Lines0], [Line|Lines]) :-
    !,
    goals_joined(Lines0, Lines).
goals_joined([], []).

goal_continues(Line) :-
    split_string(Line, "(", "", Opened),
    split_string(Line, ")", "", Closed),
    length(Opened, N),
    length(Closed, M),
    N > M.

repeats_variable(Goal, Line) :-
    split_string(Line, "=", " ", [Name, _|_]),
    string_concat("$", Name, Variable),
    sub_string(Goal, _, _, _, Variable),
    !.

%   alike(+Wanted, +Answer) is semidet: one of a thousand times has few digits.

alike(Wanted, Answer) :-
    maplist(alike_line, Wanted, Answer).

alike_line(Line, Line) :-
    !.
alike_line(Wanted, Answer) :-
    string_codes(Wanted, Codes0),
    string_codes(Answer, Codes),
    phrase(as(Codes0), Codes).

as([]) -->
    [].
as([0'F|Codes]) -->
    digits([_|_]), ".", digits([_|More]),
    { length(More, Count),
      Count < 3 },
    as(Codes).
as([Code|Codes]) -->
    [Code],
    as(Codes).

comparable(Line, Comparable) :-
    string_codes(Line, Codes0),
    phrase(general(Codes1), Codes0),
    string_codes(Comparable0, Codes1),
    split_string(Comparable0, "", " ,.", [Comparable]).

general(Codes) -->
    special(Text),
    !,
    { string_codes(Text, Special),
      append(Special, Rest, Codes) },
    general(Rest).
general([Code|Codes]) -->
    [Code],
    !,
    general(Codes).
general([]) -->
    [].

special("127.0.0.1:P") --> "127.0.0.1:", integer(_).
special(".M@")         --> ".", mark, ".", integer(_), "@".
special(" ")           --> " ", blanks_too.
special("")            --> "[Thread ", string(_), "] ".
special("(_")          --> "(_", integer(_).
special(",_")          --> ",_", integer(_).
special("ERROR: ")     --> "ERROR: Unhandled exception: ".
special("F")           --> digits([_|_]), ".", digits([_,_,_,_|_]), \+ letter.

letter --> [C], { code_type(C, alpha) }.

mark --> [C], { code_type(C, csymf) ; code_type(C, digit) }, !, mark_rest.

mark_rest --> [C], { code_type(C, alnum) }, !, mark_rest.
mark_rest --> [].

blanks_too --> " ", !, blanks_too.
blanks_too --> [].
