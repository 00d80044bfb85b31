:- module(experiment_jobs,
          [ jobs_run/3,                 % +Jobs, +Options, -Outcomes
            job_directory/3             % +Job, +Root, -Directory
          ]).
:- use_module(progress, [progress/4, progress_done/1]).
:- use_module(library(apply), [maplist/3, partition/4]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(filesex),
              [ delete_directory_and_contents/1, directory_file_path/3,
                make_directory_path/1
              ]).
:- use_module(library(lists), [append/3, list_to_set/2, member/2,
                               memberchk/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).

/** <module> Many runs, each in a process of its own

A job is a term job(Name, Script, Arguments).  It is made by

    swipl Script -- Arguments --out Directory

in a directory of its own, whose name begins with Name and says no more
than that to people: the rest of it follows from Script and Arguments.  So
two experiments that need the same run make it once, and what has been
made is there when an interrupted experiment is begun again.

The process works in Directory.PID.part, PID being that of this process.
It becomes Directory when the process has ended with status 0, and
Directory.failed when it ended in any other way.  What it printed is in the
file `output` there, and what it was in the file `job.pl`:
job(Name, Script, Arguments), seconds(Real).  A run that failed is tried
again the next time.  Sessions that need the same run at the same time do
not disturb each other.

*Threading*: the caller waits; a thread for each process waits for its end.
Whatever exception makes the caller leave, the processes are ended first:
asked by SIGTERM, and killed if they are still there ten seconds later.
*/

:- multifile
    prolog:message//1.

:- dynamic
    child/2.                    % Queue, Pid

%!  jobs_run(+Jobs, +Options, -Outcomes) is det.
%
%   Make what is not there yet of Jobs.  Outcomes are the outcomes of Jobs
%   in their order: `kept` if it was there, `made`, or failed(Status) with
%   the status of process_wait/2.  Jobs that are the same are made once.
%   Options:
%
%     - out(Root)
%       The directory for the directories of the jobs.
%     - jobs(N)
%       So many processes at a time; default 3.
%
%   Progress is shown, and failures are told, on user_error.
%
%   @error type_error(positive_integer, N), and what process_create/3 throws

jobs_run(Jobs, Options, Outcomes) :-
    option(out(Root), Options),
    option(jobs(N), Options, 3),
    must_be(positive_integer, N),
    make_directory_path(Root),
    list_to_set(Jobs, Distinct),
    partition(job_made(Root), Distinct, Kept, Missing),
    make_all(Missing, N, Root, Made),
    findall(Job-kept, member(Job, Kept), KeptOutcomes),
    append(KeptOutcomes, Made, All),
    maplist(outcome(All), Jobs, Outcomes).

outcome(All, Job, Outcome) :-
    memberchk(Job-Outcome, All).

%!  job_directory(+Job, +Root, -Directory) is det.
%
%   Directory is where the finished Job is found below Root.

job_directory(job(Name, Script, Arguments), Root, Directory) :-
    file_base_name(Script, Base),
    format(string(Key), '~q', [Base-Arguments]),
    sha_hash(Key, Hash, []),
    hash_atom(Hash, Hex),
    sub_atom(Hex, 0, 8, _, Short),
    atomic_list_concat([Name, '-', Short], Directory0),
    directory_file_path(Root, Directory0, Directory).

job_made(Root, Job) :-
    job_directory(Job, Root, Directory),
    exists_directory(Directory).

                /*******************************
                *            MAKING            *
                *******************************/

%   The processes report to a queue.  stop/1 is no cleanup handler: in one
%   it could not wait with a deadline.

make_all([], _, _, []) :-
    !.
make_all(Jobs, N, Root, Outcomes) :-
    length(Jobs, Total),
    get_time(Begin),
    message_queue_create(Queue),
    catch(make(Jobs, made(Queue, N, Root, Begin, Total), 0, 0, Outcomes),
          Ball,
          ( stop(Queue),
            forall(( member(Job, Jobs), part(Job, Root, Part) ),
                   remove(Part)),
            throw(Ball)
          )),
    progress_done(user_error),
    message_queue_destroy(Queue).

%   make(+Jobs, +Setting, +Running, +Done, -Outcomes)

make([Job|Jobs], Setting, Running, Done, Outcomes) :-
    Setting = made(Queue, N, Root, _, _),
    Running < N,
    !,
    start(Queue, Root, Job),
    Running1 is Running + 1,
    make(Jobs, Setting, Running1, Done, Outcomes).
make([], _, 0, _, []) :-
    !.
make(Jobs, Setting, Running, Done, Outcomes) :-
    Setting = made(Queue, _, Root, Begin, Total),
    show(Done, Total, Running, Begin),
    (   thread_get_message(Queue, ended(Job, Status, Seconds), [timeout(1)])
    ->  settle(Status, Job, Seconds, Root, Outcome),
        Outcomes = [Job-Outcome|Rest],
        Running1 is Running - 1,
        Done1 is Done + 1,
        show(Done1, Total, Running1, Begin),
        make(Jobs, Setting, Running1, Done1, Rest)
    ;   make(Jobs, Setting, Running, Done, Outcomes)
    ).

show(Done, Total, Running, Begin) :-
    time_left(Done, Total, Begin, Left),
    format(atom(Note), 'runs, ~d at work~w', [Running, Left]),
    progress(user_error, Done, Total, Note).

%   As long as those that are done have taken on average.

time_left(0, _, _, '') :-
    !.
time_left(Done, Done, _, '') :-
    !.
time_left(Done, Total, Begin, Text) :-
    get_time(Now),
    Left is round((Now - Begin) / Done * (Total - Done)),
    Minutes is Left // 60,
    Seconds is Left mod 60,
    format(atom(Text), ', ~d:~|~`0t~d~2+ left', [Minutes, Seconds]).

                /*******************************
                *           PROCESSES          *
                *******************************/

start(Queue, Root, Job) :-
    Job = job(_, Script, Arguments),
    part(Job, Root, Part),
    remove(Part),
    make_directory_path(Part),
    append([Script, '--'|Arguments], ['--out', Part], Argv),
    get_time(Now),
    sig_atomic(( launch(Part, Argv, Pid),
                 assertz(child(Queue, Pid)) )),
    thread_create(wait_for(Queue, Job, Pid, Now), _, [detached(true)]).

launch(Part, Argv, Pid) :-
    current_prolog_flag(executable, Swipl),
    directory_file_path(Part, output, File),
    setup_call_cleanup(
        open(File, write, Out),
        process_create(Swipl, Argv,
                       [ stdin(null), stdout(stream(Out)),
                         stderr(stream(Out)), process(Pid)
                       ]),
        close(Out)).

wait_for(Queue, Job, Pid, Start) :-
    process_wait(Pid, Status),
    retractall(child(Queue, Pid)),
    get_time(Now),
    Seconds is Now - Start,
    catch(thread_send_message(Queue, ended(Job, Status, Seconds)),
          error(existence_error(_, _), _),
          true).

%   Another session may have made it meanwhile.

settle(exit(0), Job, Seconds, Root, made) :-
    !,
    part(Job, Root, Part),
    job_directory(Job, Root, Directory),
    failed_directory(Directory, Failed),
    remove(Failed),
    directory_file_path(Part, 'job.pl', File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        format(Out, '~q.~n~q.~n', [Job, seconds(Seconds)]),
        close(Out)),
    (   exists_directory(Directory)
    ->  remove(Part)
    ;   rename_file(Part, Directory)
    ).
settle(Status, Job, _, Root, failed(Status)) :-
    part(Job, Root, Part),
    job_directory(Job, Root, Directory),
    failed_directory(Directory, Failed),
    remove(Failed),
    rename_file(Part, Failed),
    print_message(error, experiment_job(Job, Status, Failed)).

part(Job, Root, Part) :-
    job_directory(Job, Root, Directory),
    current_prolog_flag(pid, Pid),
    atomic_list_concat([Directory, Pid, part], '.', Part).

failed_directory(Directory, Failed) :-
    atom_concat(Directory, '.failed', Failed).

remove(Directory) :-
    (   exists_directory(Directory)
    ->  delete_directory_and_contents(Directory)
    ;   true
    ).

%   Ends the processes that report to Queue, and waits for their end.

stop(Queue) :-
    signal_children(Queue, term),
    get_time(Now),
    Deadline is Now + 10,
    (   all_ended(Queue, Deadline)
    ->  true
    ;   signal_children(Queue, kill),
        Deadline1 is Deadline + 10,
        ignore(all_ended(Queue, Deadline1))
    ),
    progress_done(user_error),
    message_queue_destroy(Queue).

signal_children(Queue, Signal) :-
    forall(child(Queue, Pid),
           catch(process_kill(Pid, Signal), error(_, _), true)).

all_ended(Queue, _) :-
    \+ child(Queue, _),
    !.
all_ended(Queue, Deadline) :-
    get_time(Now),
    Now < Deadline,
    Left is min(0.2, Deadline - Now),
    ignore(thread_get_message(Queue, ended(_, _, _), [timeout(Left)])),
    all_ended(Queue, Deadline).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(experiment_job(job(Name, _, _), Status, Directory)) -->
    [ 'Run ~w ended with ~p; see ~w/output'-[Name, Status, Directory] ].
