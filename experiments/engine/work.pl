:- module(study_work,
          [ runs_make/4,                % +Runs, +Root, +Workers, -Outcomes
            run_here/3,                 % +Run, +Root, -Outcome
            work/0
          ]).
:- use_module(library(apply), [maplist/2, maplist/3, partition/4]).
:- use_module(library(filesex),
              [ delete_directory_and_contents/1, directory_file_path/3,
                make_directory_path/1
              ]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(progress, [progress/4, progress_done/1]).
:- use_module(run, [run_make/4]).
:- use_module(signals, [stopping_on_signals/1]).
:- use_module(store, [run_directory/5, run_done/4]).
:- use_module(studies, [study_call/2, study_load/2]).
:- use_module(watch, [watching/4]).

/** <module> Many runs on several processors

A run is a term run(Study, Case, Seed).  Workers are processes that are told
one run after the other on their standard input, as a term, and answer each
with one on their standard output.  So a run does not pay for the start of
Prolog, and one that crashes takes nothing with it.

A run is made in Directory.PID.part, which becomes Directory when it is
complete, and Directory.failed when it is not: then the file `output` there
says why.  Sessions that make the same run at once do not disturb each
other.

*Threading*: the caller waits for messages of one thread for each worker.
Whatever exception makes it leave, the workers are ended.
*/

:- multifile
    prolog:message//1.

%!  runs_make(+Runs, +Root, +Workers:integer, -Outcomes) is det.
%
%   Make what is not there yet of Runs, by so many processes at a time.
%   Outcomes are, in the order of Runs, `kept`, `made` or `failed`.
%   Progress is shown, and failures are told, on user_error.

runs_make(Runs, Root, Workers, Outcomes) :-
    partition(is_done(Root), Runs, _, Missing),
    make_missing(Missing, Root, Workers, Made),
    maplist(outcome(Made), Runs, Outcomes).

is_done(Root, run(Study, Case, Seed)) :-
    run_done(Root, Study, Case, Seed).

outcome(Made, Run, Outcome) :-
    (   member(Run1-Outcome0, Made),
        Run1 == Run
    ->  Outcome = Outcome0
    ;   Outcome = kept
    ).

make_missing([], _, _, []) :-
    !.
make_missing([Run], Root, _, [Run-Kind]) :-
    watched(Run, What, Total),
    !,
    part_directory(Run, Root, Part),
    directory_file_path(Part, 'events.pl', Log),
    watching(Log, What, Total, run_here(Run, Root, Outcome)),
    made(Run, Outcome, Kind).
make_missing(Runs, Root, Wanted, Made) :-
    length(Runs, Total),
    Workers is min(Wanted, Total),
    get_time(Begin),
    message_queue_create(Queue),
    numlist(1, Workers, Ids),
    setup_call_catcher_cleanup(
        maplist(worker_start(Queue), Ids, Threads),
        hand_out(Runs, desk(Queue, Root, Begin, Total), 0, Made),
        Catcher,
        ( maplist(worker_stop(Catcher), Threads),
          progress_done(user_error),
          message_queue_destroy(Queue) )).

%   hand_out(+Runs, +Desk, +Done, -Made): who asks gets the next.

hand_out(Runs, Desk, Done, Made) :-
    Desk = desk(Queue, Root, Begin, Total),
    show(Done, Total, Begin),
    (   Done == Total
    ->  Made = []
    ;   thread_get_message(Queue, Message),
        handle(Message, Root, Runs, Runs1, Made, Made1),
        ( Made1 == Made -> Done1 = Done ; Done1 is Done + 1 ),
        hand_out(Runs1, Desk, Done1, Made1)
    ).

handle(idle(Thread), Root, [Run|Runs], Runs, Made, Made) :-
    !,
    Run = run(Study, Case, Seed),
    run_directory(Root, Study, Case, Seed, Directory),
    thread_send_message(Thread, make(Run, Directory)).
handle(idle(_), _, [], [], Made, Made).
handle(ended(Run, Outcome), _, Runs, Runs, [Run-Kind|Made], Made) :-
    made(Run, Outcome, Kind).

made(_, made, made) :-
    !.
made(Run, Outcome, failed) :-
    print_message(error, study_run(Run, Outcome)).

%   watched(+Run, -What, -Total): a single run in real time is made here, and
%   its events that are What are counted meanwhile, if the study says so.

watched(run(Study, Case, _), What, Total) :-
    get_dict(clock, Case, Clock),
    number(Clock),
    study_call(Study, progress(Case, What, Total)),
    !.

show(Done, Total, Begin) :-
    time_left(Done, Total, Begin, Left),
    format(atom(Note), 'runs~w', [Left]),
    progress(user_error, Done, Total, Note).

%   As long as those that are done have taken on average.

time_left(Done, Total, _, '') :-
    ( Done =:= 0 ; Done =:= Total ),
    !.
time_left(Done, Total, Begin, Text) :-
    get_time(Now),
    Left is round((Now - Begin) / Done * (Total - Done)),
    Minutes is Left // 60,
    Seconds is Left mod 60,
    format(atom(Text), ', ~d:~|~`0t~d~2+ left', [Minutes, Seconds]).

                /*******************************
                *      A WORKER, FROM HERE     *
                *******************************/

%   A thread that owns a process, which ends when its input does.  Where the
%   thread waits for an answer that nobody wants any more the process is
%   killed.

:- dynamic worker_process/2.    % Thread, Pid

worker_start(Queue, Id, Thread) :-
    atom_concat(study_worker_, Id, Alias),
    thread_create(tend(Queue), Thread, [alias(Alias)]).

worker_stop(Catcher, Thread) :-
    thread_send_message(Thread, stop),
    (   Catcher == exit
    ->  true
    ;   forall(worker_process(Thread, Pid),
               catch(process_kill(Pid, term), error(_, _), true))
    ),
    thread_join(Thread, _).

tend(Queue) :-
    thread_self(Me),
    setup_call_cleanup(
        process_start(Me, Process),
        serve(Me, Queue, Process, Next),
        process_end(Me, Process)),
    (   Next == again
    ->  tend(Queue)
    ;   true
    ).

process_start(Me, process(Pid, In, Out)) :-
    current_prolog_flag(executable, Swipl),
    module_property(study_work, file(File)),
    process_create(Swipl, ['-g', 'study_work:work', '-t', 'halt(1)', File],
                   [ stdin(pipe(In, [encoding(utf8)])),
                     stdout(pipe(Out, [encoding(utf8)])),
                     process(Pid) ]),
    assertz(worker_process(Me, Pid)).

process_end(Me, process(Pid, In, Out)) :-
    retractall(worker_process(Me, Pid)),
    close(In, [force(true)]),
    process_wait(Pid, _),
    close(Out, [force(true)]).

serve(Me, Queue, Process, Next) :-
    thread_send_message(Queue, idle(Me)),
    thread_get_message(Me, Message),
    (   Message = make(Run, Directory)
    ->  told(Process, Run, Directory, Outcome),
        thread_send_message(Queue, ended(Run, Outcome)),
        (   Outcome = ended(_)
        ->  Next = again
        ;   serve(Me, Queue, Process, Next)
        )
    ;   Next = stop
    ).

%   A process that ends instead of answering has closed its pipe.

told(process(_, In, Out), run(Study, Case, Seed), Directory, Outcome) :-
    dict_pairs(Case, _, Pairs),
    catch(( format(In, '~k.~n', [make(Study, Pairs, Seed, Directory)]),
            flush_output(In),
            read(Out, Answer) ),
          error(Formal, _),
          Answer = Formal),
    (   Answer = answer(Outcome)
    ->  true
    ;   Outcome = ended(Answer)
    ).

                /*******************************
                *         IN A WORKER          *
                *******************************/

%!  work is det.
%
%   Make the runs that are told on standard input, until it ends.  What
%   runs print goes to standard error.

work :-
    stream_property(Answers, alias(user_output)),
    stream_property(Errors, alias(user_error)),
    set_stream(Errors, alias(user_output)),
    set_stream(user_input, encoding(utf8)),
    stopping_on_signals(answers(Answers)).

answers(Answers) :-
    repeat,
    read(user_input, Term),
    (   Term = make(Study, Pairs, Seed, Directory)
    ->  study_load(Study, _),
        dict_pairs(Case, case, Pairs),
        make_in(Directory, run(Study, Case, Seed), Outcome),
        format(Answers, '~k.~n', [answer(Outcome)]),
        flush_output(Answers),
        fail
    ;   halt
    ).

%!  run_here(+Run, +Root, -Outcome) is det.
%
%   Make Run in this process: Outcome is `made`, or failed(File) where File
%   says why.

run_here(Run, Root, Outcome) :-
    Run = run(Study, Case, Seed),
    run_directory(Root, Study, Case, Seed, Directory),
    make_in(Directory, Run, Outcome).

part_directory(run(Study, Case, Seed), Root, Part) :-
    run_directory(Root, Study, Case, Seed, Directory),
    part_of(Directory, Part).

part_of(Directory, Part) :-
    current_prolog_flag(pid, Pid),
    atomic_list_concat([Directory, Pid, part], '.', Part).

make_in(Directory, run(Study, Case, Seed), Outcome) :-
    part_of(Directory, Part),
    remove(Part),
    make_directory_path(Part),
    catch_with_backtrace(run_make(Study, Case, Seed, Part), Error, true),
    settle(Error, Directory, Part, Outcome).

settle(Error, Directory, Part, Outcome) :-
    atom_concat(Directory, '.failed', Failed),
    (   var(Error)
    ->  remove(Failed),
        install(Part, Directory),
        Outcome = made
    ;   Error = error(_, _)
    ->  remove(Failed),
        rename_file(Part, Failed),
        directory_file_path(Failed, output, File),
        explain(Error, File),
        Outcome = failed(File)
    ;   remove(Part),
        throw(Error)
    ).

%   Another session may have made it meanwhile.

install(Part, Directory) :-
    (   exists_directory(Directory)
    ->  remove(Part)
    ;   rename_file(Part, Directory)
    ).

explain(Error, File) :-
    phrase(prolog:translate_message(Error), Lines),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        ( print_message_lines(Out, '', Lines),
          nl(Out) ),
        close(Out)).

remove(Directory) :-
    (   exists_directory(Directory)
    ->  delete_directory_and_contents(Directory)
    ;   true
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(study_run(run(Study, Case, Seed), Outcome)) -->
    { file_base_name(Study, Name),
      dict_pairs(Case, _, Pairs) },
    [ '~w, seed ~w, ~p'-[Name, Seed, Pairs], nl ],
    why(Outcome).

why(failed(File)) -->
    [ 'failed; see ~w'-[File] ].
why(ended(Answer)) -->
    [ 'its process ended (~p)'-[Answer] ].
