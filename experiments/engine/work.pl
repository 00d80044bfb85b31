:- module(study_work,
          [ runs_make/4,                % +Runs, +Root, +Options, -Failed
            with_workers/2,             % :Goal, -Failed
            free_worker/2,              % +Desk, -Worker
            assign/3,                   % +Worker, +Run, +Desk
            answer_within/3,            % +Seconds, -Run, -Outcome
            report/2,                   % +Outcome, +Run
            show/2                      % +Done, +Task
          ]).
:- use_module(library(aggregate), [aggregate/3, aggregate_all/3]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(solution_sequences), [distinct/2]).
:- use_module('../../prolog/typhon/kernel/base/names', [counted/3]).
:- use_module('../../prolog/typhon/kernel/base/monotonic',
              [monotonic_time/1, wait_within/2]).
:- use_module(estimate, [estimate/4, estimate_begin/1, estimate_ended/2]).
:- use_module(progress, [progress/3, progress_done/1]).
:- use_module(store,
              [ left_parts_remove/2, log_file/2, part_directory/3, part_fail/4,
                run_directory/3, run_done/3 ]).
:- use_module(studies, [study_call/2]).
:- use_module(watch, [watching/4]).
:- use_module(worker, [run_here/4]).

/** <module> Many runs on several processors

Workers are processes that get one run after the other on their standard
input, and answer each with a term on their standard output.  So a run does
not include the start of Prolog, and a crash does not affect other runs.

*Threading*: the main thread, which waits for any of the workers.  An exception
in it ends the workers: they get SIGTERM, and a thread kills those that still
run ten seconds later.
*/

:- meta_predicate with_workers(0, -).

:- multifile
    prolog:message//1.

:- dynamic
    worker/3,                   % Out, In, Pid: its streams
    busy/4,                     % Out, Run, Directory, Time when it began
    failed_by/1.                % Cause, of each run that failed

%!  runs_make(+Runs, +Root, +Options, -Failed:integer) is det.
%
%   Makes the missing runs of Runs; Failed is the number of failures. Partial
%   runs of killed sessions are removed.  Progress and failures are reported on
%   user_error.  Options:
%
%     - jobs(Count)
%       Number of processes at a time; default 2.
%     - logs(Boolean)
%       Whether the log of each run is kept; default `false`.

runs_make(Runs, Root, Options, Failed) :-
    option(jobs(Jobs), Options, 2),
    option(logs(Logs), Options, false),
    forall(distinct(Study, member(run(Study, _, _), Runs)),
           left_parts_remove(Root, Study)),
    exclude(run_done(Root, Logs), Runs, Missing),
    length(Missing, Total),
    estimate_begin(Missing),
    with_workers(make_missing(Missing, desk(Jobs, Root, Logs), Total), Failed).

%!  with_workers(:Goal, -Failed:integer) is det.
%
%   Call Goal, which assigns runs to workers, and end these.  A Desk is a term
%   desk(Jobs, Root, Logs).  Failed is the number of failures that Goal has
%   reported.

with_workers(Goal, Failed) :-
    retractall(failed_by(_)),
    catch(( call(Goal),
            dismiss ),
          Ball,
          ( end_workers,
            throw(Ball) )),
    report_counts,
    aggregate_all(count, failed_by(_), Failed).

%   A single run in real time is made in this process; if the study has
%   progress/3, its events are counted.

make_missing([Run], desk(_, Root, Logs), _) :-
    watched(Run, What, Total),
    !,
    run_directory(Root, Run, Directory),
    current_prolog_flag(pid, Pid),
    part_directory(Directory, Pid, Part),
    log_file(Part, Log),
    watching(Log, What, Total, run_here(Run, Root, [logs(Logs)], Outcome)),
    report(Outcome, Run).
make_missing(Runs, Desk, Total) :-
    make(Runs, Desk, Total, 0).

watched(run(Study, Case, _), What, Total) :-
    get_dict(clock, Case, Clock),
    number(Clock),
    study_call(Study, progress(Case, What, Total)),
    !.

%   make(+Runs, +Desk, +Total, +Done): a free worker gets the next run.

make([Run|Runs], Desk, Total, Done) :-
    free_worker(Desk, Worker),
    !,
    assign(Worker, Run, Desk),
    make(Runs, Desk, Total, Done).
make([], _, _, _) :-
    \+ busy(_, _, _, _),
    !,
    progress_done(user_error).
make(Runs, Desk, Total, Done) :-
    show_estimate(Done, Total, Desk),
    (   answer_within(0.5, Run, Outcome)
    ->  report(Outcome, Run),
        Done1 is Done + 1,
        show_estimate(Done1, Total, Desk)
    ;   Done1 = Done
    ),
    make(Runs, Desk, Total, Done1).

%!  report(+Outcome, +Run) is det.
%!  show(+Done:integer, +Task) is det.
%
%   Report how Run ended, and how far the Task is, Begin-Total.

report(failed(Directory, Cause), Run) :-
    !,
    (   failed_by(Cause)
    ->  true
    ;   print_message(error, study_run(Run, Directory, Cause))
    ),
    assertz(failed_by(Cause)).
report(_, _).

%   If many runs fail for the same reason, the first is reported, the others are
%   counted.

report_counts :-
    forall(( aggregate(count, failed_by(Cause), Count),
             Count > 1 ),
           print_message(error, study_runs(Count, Cause))).

show(Done, Begin-Total) :-
    (   Done > 0
    ->  monotonic_time(Now),
        Left is (Now - Begin)/Done*(Total - Done),
        Share is Done/Total,
        show(Done, Total, Share, Left)
    ;   show(Done, Total, 0, none)
    ).

%   The share of the work, not that of the runs, is shown: they differ in length.

show_estimate(Total, Total, _) :-
    !,
    show(Total, Total, 1, none).
show_estimate(Done, Total, desk(Jobs, _, _)) :-
    monotonic_time(Now),
    findall(Run-Since, ( busy(_, Run, _, Began), Since is Now - Began ), Busy),
    (   estimate(Busy, Jobs, Share0, Left)
    ->  Share is min(0.99, Share0),
        show(Done, Total, Share, Left)
    ;   show(Done, Total, 0, none)
    ).

show(Done, Total, Share, Left) :-
    left_text(Done-Total, Left, Text),
    format(atom(Line), '~d/~d runs~w', [Done, Total, Text]),
    progress(user_error, Share, Line).

left_text(Total-Total, _, '') :-
    !.
left_text(_, none, '') :-
    !.
left_text(_, Left0, Text) :-
    Left is round(Left0),
    Hours is Left // 3600,
    Minutes is Left mod 3600 // 60,
    Seconds is Left mod 60,
    format(atom(Text), ', ~d:~|~`0t~d~2+:~|~`0t~d~2+ left',
           [Hours, Minutes, Seconds]).

                /*******************************
                *            WORKERS           *
                *******************************/

%!  free_worker(+Desk, -Worker) is semidet.
%!  assign(+Worker, +Run, +Desk) is det.

free_worker(_, Out) :-
    worker(Out, _, _),
    \+ busy(Out, _, _, _),
    !.
free_worker(desk(Jobs, _, _), Out) :-
    aggregate_all(count, worker(_, _, _), Count),
    Count < Jobs,
    sig_atomic(worker_start(Out)).

%   Compiled arithmetic makes runs up to a tenth shorter, and does not change them.

worker_start(Out) :-
    current_prolog_flag(executable, Swipl),
    module_property(study_work, file(Here)),
    absolute_file_name(worker, File, [file_type(prolog), relative_to(Here)]),
    process_create(Swipl,
                   [ '-O', '-q', '-g', 'study_worker:work', '-t', 'halt(1)', File ],
                   [ stdin(pipe(In, [encoding(utf8)])),
                     stdout(pipe(Out, [encoding(utf8)])),
                     process(Pid) ]),
    assertz(worker(Out, In, Pid)).

%   If a worker has died, this shows when it does not answer.

assign(Out, Run, desk(_, Root, Logs)) :-
    Run = run(Study, Case, Seed),
    run_directory(Root, Run, Directory),
    dict_pairs(Case, _, Pairs),
    monotonic_time(Now),
    assertz(busy(Out, Run, Directory, Now)),
    worker(Out, In, _),
    catch(( format(In, '~k.~n', [make(Study, Pairs, Seed, Directory, Logs)]),
            flush_output(In) ),
          error(_, _),
          true).

%!  answer_within(+Limit, -Run, -Outcome) is semidet.
%
%   Outcome is `made` or failed(Directory, Cause).
%
%   On 9.2 an exception during wait_for_input/3 corrupts the stacks, so the
%   signal that raises it is delayed for a moment.

answer_within(Limit, Run, Outcome) :-
    findall(Out, busy(Out, _, _, _), Outs),
    sig_atomic(wait_for_input(Outs, Ready, Limit)),
    Ready = [Out|_],
    answer(Out, Answer),
    retract(busy(Out, Run, Directory, Began)),
    monotonic_time(Now),
    Seconds is Now - Began,
    estimate_ended(Run, Seconds),
    (   Answer = answer(Outcome)
    ->  true
    ;   worker(Out, _, Pid),
        worker_end(Out, Status),
        part_directory(Directory, Pid, Part),
        format(string(Why), 'Its process ended: ~p~n', [Status]),
        part_fail(Part, Directory, Why, Outcome)
    ),
    !.

%   Reads a whole line: the rest of a line would look like the next answer.

answer(Out, Answer) :-
    catch(( read_line_to_string(Out, Line),
            term_string(Answer, Line) ),
          error(_, _),
          Answer = nothing).

%   A worker ends when its input ends.

dismiss :-
    forall(worker(Out, _, _), worker_end(Out, _)).

worker_end(Out, Status) :-
    worker(Out, In, Pid),
    close(In, [force(true)]),
    process_wait(Pid, Status),
    close(Out, [force(true)]),
    retractall(worker(Out, _, _)).

%   Workers get SIGTERM, and are killed if they do not end.

end_workers :-
    retractall(busy(_, _, _, _)),
    signal_workers(term),
    thread_create(kill_later, Killer, [alias(study_work_killer)]),
    dismiss,
    thread_send_message(Killer, all_ended),
    thread_join(Killer).

kill_later :-
    thread_self(Me),
    (   wait_within(10, thread_get_message(Me, all_ended))
    ->  true
    ;   signal_workers(kill),
        thread_get_message(all_ended)
    ).

signal_workers(Signal) :-
    forall(worker(_, _, Pid),
           catch(process_kill(Pid, Signal), error(_, _), true)).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(study_runs(Count, Cause)) -->
    { counted(Count, run, Runs) },
    [ '~w failed: ~w'-[Runs, Cause] ].
prolog:message(study_run(run(Study, Case, Seed), Directory, Cause)) -->
    { file_base_name(Study, Name),
      dict_pairs(Case, _, Pairs) },
    [ '~w, seed ~w, ~p'-[Name, Seed, Pairs], nl,
      '~w'-[Cause], nl,
      'failed; see ~w/output'-[Directory] ].
