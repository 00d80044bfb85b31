:- module(study_worker,
          [ work/0,
            run_here/4                  % +Run, +Root, +Options, -Outcome
          ]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(option), [option/3]).
:- use_module(run, [run_again/4, run_make/4]).
:- use_module(signals, [stopping_on_signals/1]).
:- use_module(sources, [sources_changed/2, sources_hash/2]).
:- use_module(store,
              [ log_file/2, part_begin/1, part_directory/3, part_fail/4,
                part_install/3, part_remove/1, run_directory/3, run_done/3 ]).
:- use_module(studies, [study_load/2]).

/** <module> Making one run after another

*Threading*: the main thread.
*/

:- meta_predicate
    writing(+, 0),
    printing(+, 0).

:- multifile
    prolog:error_message//1.

%!  work is det.
%
%   Makes the runs that arrive on standard input, until it ends: terms
%   make(File, Pairs, Seed, Directory, Logs), for the study in File and the case
%   with Pairs.  The answer to each is answer(Outcome) on standard output.
%   Output of runs goes to the file `output`.

work :-
    stream_property(Answers, alias(user_output)),
    stream_property(Errors, alias(user_error)),
    errors_to(Errors),
    set_stream(Answers, encoding(utf8)),
    set_stream(user_input, encoding(utf8)),
    stopping_on_signals(answers(Answers)).

answers(Answers) :-
    repeat,
    read(user_input, Term),
    (   Term = make(File, Pairs, Seed, Directory, Logs)
    ->  study_load(File, Study),
        dict_pairs(Case, case, Pairs),
        make(run(Study, Case, Seed), Directory, Logs, writing, Outcome),
        format(Answers, '~k.~n', [answer(Outcome)]),
        flush_output(Answers),
        fail
    ;   halt
    ).

%!  run_here(+Run, +Root, +Options, -Outcome) is det.
%
%   Makes Run in this process, if it does not exist: Outcome is `kept`, `made`
%   or failed(Directory, Cause); the file `output` there has the reason.
%   Options has logs(Boolean).

run_here(Run, Root, Options, Outcome) :-
    option(logs(Logs), Options, false),
    (   run_done(Root, Logs, Run)
    ->  Outcome = kept
    ;   run_directory(Root, Run, Directory),
        make(Run, Directory, Logs, printing, Outcome)
    ).

%   make(+Run, +Directory, +Logs, +How, -Outcome): How calls a goal and
%   redirects or shows its output.

make(Run, Directory, Logs, How, Outcome) :-
    current_prolog_flag(pid, Pid),
    part_directory(Directory, Pid, Part),
    part_begin(Part),
    catch_with_backtrace(
        ( must_be_of(Run, Directory),
          call(How, Part, make_in(Run, Part)),
          must_be_unchanged(Run) ),
        Error, true),
    (   var(Error)
    ->  kept_log(Run, Logs, Kept),
        part_install(Part, Directory, Kept),
        Outcome = made
    ;   Error = stopped_by(_)
    ->  part_remove(Part),
        throw(Error)
    ;   explanation(Error, Why),
        part_fail(Part, Directory, Why, Outcome)
    ).

make_in(run(Study, Case, replay(Seed)), Part) :-
    !,
    log_file(Part, Log),
    run_again(Study, Case, Seed, Log).
make_in(run(Study, Case, Seed), Part) :-
    run_make(Study, Case, Seed, Part).

kept_log(run(_, _, replay(_)), _, true) :-
    !.
kept_log(_, Logs, Logs).

%   Checks that the sources are those of the sender's hash.

must_be_of(run(Study, _, _), Directory) :-
    sources_hash(Study, Hash),
    (   atom_concat(_, Hash, Directory)
    ->  true
    ;   throw(error(study_changed(Study), _))
    ).

must_be_unchanged(run(Study, _, _)) :-
    forall(sources_changed(Study, File),
           throw(error(study_changed(File), _))).

printing(_, Goal) :-
    call(Goal).

writing(Part, Goal) :-
    directory_file_path(Part, output, File),
    stream_property(Old, alias(user_error)),
    setup_call_cleanup(
        ( open(File, write, Out, [encoding(utf8), buffer(line)]),
          errors_to(Out) ),
        Goal,
        ( errors_to(Old),
          close(Out),
          ( size_file(File, 0) -> delete_file(File) ; true ) )).

errors_to(Stream) :-
    set_stream(Stream, alias(user_error)),
    set_stream(Stream, alias(user_output)),
    set_output(Stream).

explanation(Error, Why) :-
    phrase(prolog:translate_message(Error), Lines),
    with_output_to(string(Why),
                   print_message_lines(current_output, '', Lines)).

prolog:error_message(study_changed(File)) -->
    [ '~w, or a file it uses, has changed since this session began'-[File] ].
