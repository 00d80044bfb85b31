:- module(test_jobs, []).

% Runs in processes of their own: with a script that does what its first
% argument says.

:- use_module('../lib/common', [wait_for_end/3, wait_until/2, with_swipl/5,
                       with_tmp_dir/1, project_file/2]).
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(process)).
:- use_module(library(readutil)).
:- use_module('../../experiments/lib/jobs').

:- meta_predicate
    with_jobs(1),
    set_up(1, +).

%   Each job leaves the times of its begin and its end in --out, and a line
%   in the file `log` beside the script.

script('
:- initialization(main, main).
main([What, Last]) :-
    atom_concat(\'--out=\', Out, Last), !,
    main([What, \'--out\', Out]).
main([What, \'--out\', Out]) :-
    current_prolog_flag(pid, Pid),
    atom_concat(Out, \'/begun\', Begun),
    open(Begun, write, S), format(S, "~d.~n", [Pid]), close(S),
    source_file(main(_), File), file_directory_name(File, Dir),
    atom_concat(Dir, \'/log\', Log),
    note(Log, begin(What)),
    work(What, Pid),
    note(Log, end(What)).
note(Log, Term) :-
    open(Log, append, S), format(S, "~q.~n", [Term]), close(S).
work(exit, _) :- format("what it said~n"), halt(3).
work(kill, Pid) :-
    number_codes(Pid, Codes), atom_codes(Atom, Codes),
    atom_concat(\'kill -9 \', Atom, Command), shell(Command).
work(wait, _) :- sleep(100).
work(_, _).
').

with_jobs(Goal) :-
    with_tmp_dir(set_up(Goal)).

set_up(Goal, Dir) :-
    file(Dir, 'script.pl', Script),
    script(Text),
    setup_call_cleanup(open(Script, write, Out), write(Out, Text),
                       close(Out)),
    call(Goal, Dir).

file(Dir, Name, File) :-
    directory_file_path(Dir, Name, File).

job(Dir, What, job(What, Script, [What])) :-
    file(Dir, 'script.pl', Script).

run(Dir, Whats, N, Outcomes) :-
    maplist(job(Dir), Whats, Jobs),
    file(Dir, out, Root),
    file(Dir, messages, Messages),
    setup_call_cleanup(
        ( open(Messages, write, Err),
          stream_property(Old, alias(user_error)),
          set_stream(Err, alias(user_error))
        ),
        jobs_run(Jobs, [out(Root), jobs(N)], Outcomes),
        ( set_stream(Old, alias(user_error)),
          close(Err)
        )).

notes(Dir, Notes) :-
    file(Dir, log, Log),
    read_file_to_terms(Log, Notes, []).

left_in(Dir, Suffix, Found) :-
    format(atom(Pattern), '~w/out/*~w', [Dir, Suffix]),
    expand_file_name(Pattern, Files0),
    include(exists_directory, Files0, Files),
    length(Files, Found).

:- begin_tests(jobs).

test(made_once_and_kept, Outcomes == [made, made, made]-[kept, kept]) :-
    with_jobs(made_and_kept(Outcomes)).
test(one_at_a_time, Notes == [begin(a), end(a), begin(b), end(b)]) :-
    with_jobs(one_by_one(Notes)).
test(what_it_was, Facts = [job(a, _, [a]), seconds(_)]) :-
    with_jobs(described(Facts)).
test(failing, Outcomes-Said-Tries ==
              [failed(exit(3)), made]-"what it said\n"-2) :-
    with_jobs(failing(Outcomes, Said, Tries)).
test(killed, Outcomes == [failed(killed(9))]) :-
    with_jobs(run_some([kill], 1, Outcomes)).
test(failure_is_told, [true(once(sub_string(Text, _, _, _, "exit(3)")))]) :-
    with_jobs(told(Text)).
test(interrupted, Left-Outcomes == 0-[kept]) :-
    with_jobs(interrupted(Left, Outcomes)).
test(other_arguments_are_another_run, [true(A \== B)]) :-
    job_directory(job(n, 's.pl', [1]), d, A),
    job_directory(job(n, 's.pl', [2]), d, B).
test(place_of_script_does_not_matter, A == B) :-
    job_directory(job(n, '/x/s.pl', [1]), d, A),
    job_directory(job(n, '/y/s.pl', [1]), d, B).
test(no_number, error(type_error(_, 0))) :-
    with_jobs(run_some([a], 0, _)).

run_some(Whats, N, Outcomes, Dir) :-
    run(Dir, Whats, N, Outcomes).

made_and_kept(Made-Kept, Dir) :-
    run(Dir, [a, b, a], 2, Made),
    run(Dir, [a, b], 2, Kept),
    notes(Dir, Notes),
    length(Notes, 4),
    left_in(Dir, part, 0).

one_by_one(Notes, Dir) :-
    run(Dir, [a, b], 1, _),
    notes(Dir, Notes).

described(Facts, Dir) :-
    run(Dir, [a], 1, _),
    job(Dir, a, Job),
    file(Dir, out, Root),
    job_directory(Job, Root, Directory),
    file(Directory, 'job.pl', File),
    read_file_to_terms(File, Facts, []).

%   A run that failed is tried again.

failing(Outcomes, Said, Tries, Dir) :-
    run(Dir, [exit, a], 2, Outcomes),
    job(Dir, exit, Job),
    file(Dir, out, Root),
    job_directory(Job, Root, Directory),
    atom_concat(Directory, '.failed/output', Output),
    read_file_to_string(Output, Said, []),
    run(Dir, [exit, a], 2, [failed(exit(3)), kept]),
    notes(Dir, Notes),
    findall(x, member(begin(exit), Notes), Xs),
    length(Xs, Tries).

told(Text, Dir) :-
    run(Dir, [exit], 1, _),
    file(Dir, messages, File),
    read_file_to_string(File, Text, []).

%   A session in another process, in the middle of its second run.

interrupted(Left, Outcomes, Dir) :-
    session(Dir, Session),
    with_swipl([Session], Pid, _, _,
               ( wait_until(waiting(Dir, Child), 30),
                 process_kill(Pid, int),
                 wait_for_end(Pid, 20, exit(130))
               )),
    wait_until(\+ alive(Child), 20),
    left_in(Dir, part, Left),
    run(Dir, [a], 1, Outcomes).

session(Dir, Session) :-
    file(Dir, 'session.pl', Session),
    project_file('experiments/lib/jobs', Jobs),
    project_file('experiments/lib/signals', Signals),
    job(Dir, a, A),
    job(Dir, wait, Wait),
    file(Dir, out, Root),
    setup_call_cleanup(
        open(Session, write, Out),
        format(Out, ':- use_module(~q).~n:- use_module(~q).~n\c
:- initialization(main, main).~n\c
main(_) :- stopping_on_signals(jobs_run(~q, [out(~q), jobs(1)], _)).~n',
               [Jobs, Signals, [A, Wait], Root]),
        close(Out)).

waiting(Dir, Pid) :-
    format(atom(Pattern), '~w/out/wait*.part/begun', [Dir]),
    expand_file_name(Pattern, [File]),
    exists_file(File),
    catch(read_file_to_terms(File, [Pid], []), error(_, _), fail).

alive(Pid) :-
    format(atom(Directory), '/proc/~d', [Pid]),
    exists_directory(Directory).

:- end_tests(jobs).
