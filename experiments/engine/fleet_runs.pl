:- module(study_fleet_runs,
          [ fleet_runs/5                % +Fleet, +Runs, +Root, +Options, -Failed
          ]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2, nth1/3, same_length/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(socket), [gethostname/1]).
:- use_module('../../prolog/typhon',
              [ fleet_join/2, fleet_leave/1, work_done/4, work_keep/4,
                work_left/3, work_put/3, work_results/3, work_take/4 ]).
:- use_module('../../prolog/typhon/kernel/base/monotonic',
              [deadline/2, monotonic_time/1, wait_within/2]).
:- use_module(progress, [progress_done/1]).
:- use_module(sources, [text_hash/2]).
:- use_module(store,
              [ part_begin/1, part_directory/3, part_fail/4, part_install/3,
                run_directory/3, run_done/3 ]).
:- use_module(work,
              [ answer_within/3, assign/3, free_worker/2, report/2, show/2,
                with_workers/2 ]).

/** <module> Runs that are shared by the members of a fleet

All processes in which the same command runs put the same runs into one queue,
take runs from it, and get the results of all: a task is a run, and its result
has the files of the directory of the run.  The name of the queue has a hash of
the names of these directories, so processes with other sources or parameters do
not meet.  If the engine does not answer all is tried again.

*Threading*: the main thread, as in study_work.
*/

:- meta_predicate reached(0).

:- multifile prolog:message//1.

:- dynamic
    held/2,                     % Run, Work: a worker of this process makes it
    made_here/1,                % N
    out_of_reach/0.             % the engine, which was reported

%!  fleet_runs(+Fleet, +Runs, +Root, +Options, -Failed:integer) is det.
%
%   As runs_make/4, with others; Fleet is Name-Options as of fleet_join/2.

fleet_runs(Fleet-Engine, Runs, Root, Options, Failed) :-
    option(jobs(Jobs), Options, 2),
    option(logs(Logs), Options, false),
    gethostname(Machine),
    current_prolog_flag(pid, Pid),
    atomic_list_concat([Machine, Pid], :, Worker),
    Sweep = sweep(Fleet, Queue, Worker, Runs, desk(Jobs, Root, Logs)),
    retractall(held(_, _)),
    retractall(made_here(_)),
    retractall(out_of_reach),
    fleet_join(Fleet, Engine),          % not as a setup, where waits hang
    call_cleanup(( queue(1, Sweep, Queue),
                   with_workers(turns_to_the_end(Sweep), Failed) ),
                 fleet_leave(Fleet)).

%   A queue in which all runs have ended, some of them without a result, is
%   followed by another: all that come later find the way to it.

queue(Round, Sweep, Queue) :-
    Sweep = sweep(Fleet, _, _, Runs, desk(_, _, Logs)),
    names(Sweep, Names),
    format(string(Text), '~q', [Names-Logs]),
    text_hash(Text, Hash),
    atomic_list_concat([study, Hash, Round], -, This),
    reached(work_results(Fleet, This, Results)),
    (   same_length(Results, Runs),
        member(_-failed(_, _), Results)
    ->  forall(member(N-made(Files), Results),
               arrives(made(Files), N, Sweep)),
        Next is Round+1,
        queue(Next, Sweep, Queue)
    ;   reached(work_put(Fleet, This, Names)),
        Queue = This
    ).

names(sweep(_, _, _, Runs, desk(_, Root, _)), Names) :-
    findall(Name,
            ( member(Run, Runs),
              run_directory(Root, Run, Directory),
              file_base_name(Directory, Name) ),
            Names).

                /*******************************
                *             TURNS            *
                *******************************/

turns_to_the_end(Sweep) :-
    monotonic_time(Begin),
    turns(Sweep, Begin, Begin, true),
    progress_done(user_error).

%   turns(+Sweep, +Begin, +Due, +Asks): at the time Due, each second, it keeps
%   what is held.  If Asks is false there was no work for it.

turns(Sweep, Begin, Due0, Asks0) :-
    monotonic_time(Now),
    (   Now >= Due0
    ->  keep(Sweep, Begin),
        deadline(1, Due),
        Asks = true
    ;   Due = Due0,
        Asks = Asks0
    ),
    turn(Asks, Sweep, Next),
    (   Next == complete
    ->  true
    ;   turns(Sweep, Begin, Due, Next)
    ).

keep(Sweep, Begin) :-
    Sweep = sweep(Fleet, Queue, Worker, Runs, _),
    forall(held(_, Work),
           reached(ignore(work_keep(Fleet, Queue, Worker, Work)))),
    reached(work_left(Fleet, Queue, Left)),
    length(Runs, Total),
    Done is Total-Left,
    show(Done, Begin-Total).

%   turn(+Asks, +Sweep, -Next): Next is `complete`, or the next Asks.

turn(true, Sweep, Next) :-
    Sweep = sweep(Fleet, Queue, Worker, _, Desk),
    free_worker(Desk, Free),
    !,
    (   reached(work_take(Fleet, Queue, Worker, Work))
    ->  taken(Work, Free, Sweep, Next)
    ;   at_end(Sweep, Next)
    ).
turn(Asks, Sweep, Next) :-
    (   \+ held(_, _)
    ->  pause(0.1),
        Next = Asks
    ;   answer_within(0.1, Run, Outcome)
    ->  report(Outcome, Run),
        findall(Work, held(Run, Work), Works),
        forall(member(Work, Works), ended(Outcome, Run, Work, Sweep)),
        retractall(held(Run, _)),
        Next = true
    ;   Next = Asks
    ).

taken(none, _, _, false).
taken(Work, Free, Sweep, true) :-
    Work = work(_, N, _),
    Sweep = sweep(_, _, _, Runs, Desk),
    Desk = desk(_, Root, Logs),
    nth1(N, Runs, Run),
    assertz(made_here(N)),
    (   run_done(Root, Logs, Run)
    ->  ended(made, Run, Work, Sweep)
    ;   held(Run, _)                    % a lost queue was put again
    ->  assertz(held(Run, Work))
    ;   assertz(held(Run, Work)),
        assign(Free, Run, Desk)
    ).

ended(Outcome, Run, Work, sweep(Fleet, Queue, _, _, desk(_, Root, _))) :-
    run_directory(Root, Run, Directory),
    result(Outcome, Directory, Result),
    reached(work_done(Fleet, Queue, Work, Result)).

%   An engine that has lost the queue gets it again.

at_end(_, false) :-
    held(_, _),
    !.
at_end(Sweep, Next) :-
    Sweep = sweep(Fleet, Queue, _, Runs, _),
    reached(work_results(Fleet, Queue, Results)),
    (   same_length(Results, Runs)
    ->  forall(( member(N-Result, Results), \+ made_here(N) ),
               arrives(Result, N, Sweep)),
        Next = complete
    ;   names(Sweep, Names),
        reached(work_put(Fleet, Queue, Names)),
        Next = true
    ).

pause(Seconds) :-
    thread_self(Me),
    ignore(wait_within(Seconds, thread_get_message(Me, study_never))).

%   reached(:Goal): Goal asks the engine, until it answers.

reached(Goal) :-
    catch(( call(Goal) -> Answer = true ; Answer = false ),
          error(resource_error(fleet(Fleet)), _),
          Answer = none),
    (   Answer == none
    ->  (   out_of_reach
        ->  true
        ;   assertz(out_of_reach),
            print_message(warning, study_fleet(Fleet))
        ),
        pause(1),
        reached(Goal)
    ;   retractall(out_of_reach),
        Answer == true
    ).

                /*******************************
                *            RESULTS           *
                *******************************/

%   result(+Outcome, +Directory, -Result): Result is made(Files), of pairs of a
%   name and its bytes, or failed(Cause, Output).

result(made, Directory, made(Files)) :-
    findall(Name-Bytes,
            ( directory_member(Directory, File, []),
              exists_file(File),
              file_base_name(File, Name),
              read_file_to_string(File, Bytes, [type(binary)]) ),
            Files).
result(failed(Failed, Cause), _, failed(Cause, Output)) :-
    directory_file_path(Failed, output, File),
    read_file_to_string(File, Output, [type(binary)]).

%   arrives(+Result, +N, +Sweep): the run N, made elsewhere, is stored here.

arrives(Result, N, sweep(_, _, _, Runs, desk(_, Root, Logs))) :-
    nth1(N, Runs, Run),
    (   run_done(Root, Logs, Run)
    ->  true
    ;   run_directory(Root, Run, Directory),
        current_prolog_flag(pid, Pid),
        part_directory(Directory, Pid, Part),
        part_begin(Part),
        installed(Result, Run, Part, Directory, Logs)
    ).

installed(made(Files), _, Part, Directory, Logs) :-
    forall(member(Name-Bytes, Files), save(Part, Name, Bytes)),
    part_install(Part, Directory, Logs).
installed(failed(Cause, Output), Run, Part, Directory, _) :-
    save(Part, output, Output),
    part_fail(Part, Directory, "", failed(Failed, _)),
    report(failed(Failed, Cause), Run).

save(Part, Name0, Bytes) :-
    file_base_name(Name0, Name),        % never in another directory
    directory_file_path(Part, Name, File),
    setup_call_cleanup(
        open(File, write, Out, [type(binary)]),
        ( set_stream(Out, encoding(octet)),
          write(Out, Bytes) ),
        close(Out)).

prolog:message(study_fleet(Fleet)) -->
    [ 'The engine of the fleet ~w cannot be reached; it is asked again'-
      [Fleet] ].
