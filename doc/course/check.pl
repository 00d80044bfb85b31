:- module(course_check, []).

/** <module> Check and mark the programs of students

    swipl doc/course/check.pl -- round.pl        one program
    swipl doc/course/check.pl -- anna bert       all programs in folders
    swipl doc/course/check.pl -- --csv HAND-INS

A program is checked as the exercise whose name its file has.  Each program is
checked in a process of its own, on hosts with the policy `guarded`, and has a
minute.  The exit status is 0 if every criterion holds.

*Threading*: the main thread.
*/

:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module(checks/course, [criterion/3, exercise/2, exercise_verdict/3]).
:- use_module(checks/first_agent, []).
:- use_module(checks/stigmergy, []).
:- use_module(checks/election, []).
:- use_module(checks/contract_net, []).
:- use_module(checks/ants, []).
:- use_module(checks/faults, []).
:- use_module(checks/supervision, []).
:- use_module(checks/people, []).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(csv), [csv_write_stream/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(time), [alarm/4, remove_alarm/1]).

:- initialization(main, main).

:- public main/1.

opt_type(csv, csv, boolean).
opt_type(only, only, atom).
opt_type(seconds, seconds, natural).

opt_help(help(header), "Checks the exercises of the course\n").
opt_help(help(usage), " -- FILE | FOLDER ... [options]").
opt_help(csv, "Print a table of points, a line for each program [false]").
opt_help(only, "Check the programs of this exercise only").
opt_help(seconds, "Seconds of the processor that a check may take [60]").

opt_meta(only, 'EXERCISE').

main(['--inside', File]) :-
    !,
    check_here(File).
main(Argv) :-
    set_stream(user_output, encoding(utf8)),
    arguments(Argv, Names, Options),
    forall(member(Name, Names), must_be_there(Name)),
    hand_ins(Names, Options, Files),
    check_all(Files, Options).

must_be_there(Name) :-
    ( exists_file(Name) ; exists_directory(Name) ),
    !.
must_be_there(Name) :-
    format(user_error, 'There is no file ~w~n', [Name]),
    halt(2).

                /*******************************
                *            FILES             *
                *******************************/

hand_ins(Names, Options, Files) :-
    findall(File, ( member(Name, Names), hand_in(Name, Options, File) ),
            Files),
    (   Files == []
    ->  findall(E, exercise(E, _), Exercises),
        atomic_list_concat(Exercises, ' ', Text),
        format(user_error,
               'Nothing to check: programs are named after exercises: ~w~n',
               [Text]),
        halt(2)
    ;   true
    ).

hand_in(Name, Options, File) :-
    exists_directory(Name),
    !,
    exercise(Exercise, _),
    file_name_extension(Exercise, pl, Base),
    directory_file_path(Name, Base, File),
    exists_file(File),
    is_asked_for(Exercise, Options).
hand_in(File, Options, File) :-
    file_exercise(File, Exercise),
    is_asked_for(Exercise, Options).

is_asked_for(Exercise, Options) :-
    option(only(Only), Options, Exercise),
    Only == Exercise.

file_exercise(File, Exercise) :-
    file_base_name(File, Base),
    file_name_extension(Exercise, _, Base),
    exercise(Exercise, _).

                /*******************************
                *      A PROCESS FOR EACH      *
                *******************************/

check_all(Files, Options) :-
    maplist(checked(Options), Files, Rows),
    (   option(csv(true), Options)
    ->  findall(row(File, Exercise, Held, Of),
                member(row(File, Exercise, Held, Of, _), Rows), Lines),
        csv_write_stream(user_output,
                         [row(file, exercise, points, of)|Lines], [])
    ;   aggregate_all(count, ( member(row(_, _, N, N, _), Rows), N > 0 ),
                      Right),
        length(Rows, Count),
        format('~d of ~d programs pass~n', [Right, Count])
    ),
    (   member(row(_, _, _, _, Verdicts), Rows),
        member(verdict(_, itself(_)), Verdicts)
    ->  halt(2)
    ;   member(row(_, _, Held, Of, _), Rows),
        Held =\= Of
    ->  halt(1)
    ;   true
    ).

%   The process prints a term for each criterion; its messages go to the user.

checked(Options, File, row(File, Exercise, Held, Of, Verdicts)) :-
    file_exercise(File, Exercise),
    option(seconds(Seconds), Options, 60),
    verdicts_of(File, Seconds, Verdicts),
    aggregate_all(count, member(verdict(_, ok), Verdicts), Held),
    aggregate_all(count, criterion(Exercise, _, _), Of),
    forall(member(verdict(Text, itself(Why)), Verdicts),
           format(user_error, 'The check of ~w does not work (~w): ~w~n',
                  [File, Text, Why])),
    (   option(csv(true), Options)
    ->  true
    ;   report(File, Verdicts)
    ).

verdicts_of(File, Seconds, Verdicts) :-
    module_property(course_check, file(Here)),
    current_prolog_flag(executable, Swipl),
    Late is 100*Seconds,
    setup_call_cleanup(
        process_create(path(sh), [ '-c', 'ulimit -t "$0"; exec "$@"', Seconds,
                                   Swipl, Here, '--', '--inside', File ],
                       [stdin(null), stdout(pipe(Out)), process(Pid)]),
        setup_call_cleanup(
            alarm(Late, stopped(Pid), Alarm, [remove(false)]),
            ( read_verdicts(Out, Verdicts0),
              process_wait(Pid, Status) ),
            remove_alarm(Alarm)),
        close(Out)),
    (   Status == exit(0)
    ->  Verdicts = Verdicts0
    ;   ended_early(Status, Pid, Verdict),
        append(Verdicts0, [Verdict], Verdicts)
    ).

:- dynamic late/1.                      % Pid

stopped(Pid) :-
    assertz(late(Pid)),
    process_kill(Pid, kill).

%   A limit of processor time ends a process by SIGXCPU (24) or SIGKILL. On a
%   slow machine a check takes longer; that is no mistake of the program.

ended_early(killed(_), Pid, verdict('ends in time', itself(Text))) :-
    retract(late(Pid)),
    !,
    Text = "it has hardly got any time of the processor".
ended_early(killed(Signal), _,
            verdict('ends in time', "it was stopped")) :-
    memberchk(Signal, [9, 24]),
    !.
ended_early(Status, _, verdict('can be checked', itself(Text))) :-
    format(string(Text), "it ended with ~w", [Status]).

read_verdicts(In, Verdicts) :-
    catch(read_term(In, Term, []), error(_, _), Term = end_of_file),
    (   Term = verdict(_, _)
    ->  Verdicts = [Term|More],
        read_verdicts(In, More)
    ;   Verdicts = []
    ).

report(File, Verdicts) :-
    format('~w~n', [File]),
    forall(member(verdict(Text, Found), Verdicts), report_one(Text, Found)).

report_one(Text, ok) :-
    !,
    format('  ok    ~w~n', [Text]).
report_one(_, itself(_)) :-
    !.
report_one(Text, Why) :-
    format('  FAIL  ~w: ~w~n', [Text, Why]).

                /*******************************
                *          THE CHECK           *
                *******************************/

%   The output of the program goes to the stream of messages.

check_here(File) :-
    stream_property(Out, alias(user_output)),
    stream_property(Error, alias(user_error)),
    set_stream(Error, alias(user_output)),
    set_output(Error),
    file_exercise(File, Exercise),
    forall(exercise_verdict(Exercise, File, Verdict),
           ( format(Out, '~q.~n', [Verdict]),
             flush_output(Out) )).
