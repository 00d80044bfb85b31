:- module(test_cluster, []).

% One study on many machines, as doc/studies.md shows it: with GNU parallel,
% here and over ssh, and with Slurm. The machines are this one.

:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/2]).

:- needs([cluster]).

:- use_module('../../lib/clusters', [with_slurm/1, with_sshd/1]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(yall)).

%   shown(+Mark, -Text): the block of the document that mentions Mark, for
%   any directory, and with one run instead of many.

shown(Mark, Text) :-
    project_file('doc/studies.md', File),
    read_file_to_string(File, Document, [encoding(utf8)]),
    split_blocks(Document, Blocks),
    member(Text0, Blocks),
    once(sub_string(Text0, _, _, _, Mark)),
    !,
    here(Text0, Text).

split_blocks(Document, Blocks) :-
    atomic_list_concat(Parts, '```', Document),
    findall(Block, ( member(Part, Parts), atom_concat('sh\n', Block, Part) ),
            Blocks).

here(Text0, Text) :-
    project_file('experiments/study.pl', Script),
    project_file('examples/studies/coverage.pl', Study),
    foldl([Old-New, T0, T]>>( atomic_list_concat(Parts, Old, T0),
                              atomic_list_concat(Parts, New, T) ),
          [ 'experiments/study.pl'-Script,
            'examples/studies/coverage.pl'-Study,
            '--runs 20'-'--runs 1 --set side=[2,3]',
            '--array=1-50'-'--array=1-3' ],
          Text0, Text).

%   commands(+Mark, -Before, -Command, -After): the line that mentions Mark.

commands(Mark, Before, Command, After) :-
    shown(Mark, Text),
    atomic_list_concat(Lines, '\n', Text),
    append(Before, [Command|After], Lines),
    once(sub_atom(Command, _, _, _, Mark)),
    !.

%   `swipl` is the program of this process, where it has that name.

shell(Dir, Lines, Output) :-
    atomic_list_concat(Lines, '\n', Text),
    current_prolog_flag(executable, Swipl),
    file_directory_name(Swipl, Bin),
    getenv('PATH', Path0),
    atomic_list_concat([Bin, Path0], :, Path),
    setup_call_cleanup(
        process_create(path(sh), ['-ec', Text],
                       [ cwd(Dir), stdin(null), stdout(pipe(Out)),
                         stderr(std), process(Pid),
                         environment(['PATH'=Path]) ]),
        read_string(Out, _, Output),
        close(Out)),
    process_wait(Pid, Status),
    assertion(Status-Output = exit(0)-_).

%   All four runs exist, and the command that shows them has made none.

all_there(Output) :-
    forall(member(Part, [ "conscientious     2     1",
                          "random            3     1",
                          "conscientious is faster" ]),
           assertion(once(sub_string(Output, _, _, _, Part)))).

%   The machine is reached by a port and a key of its own.

parallel_over_ssh(Output, Dir, Ssh) :-
    commands('parallel --sshlogin', [], Shown, _),
    atomic_list_concat([parallel|_], ' ', Shown),
    commands('parallel < ', Before, _, After),
    format(atom(Command), 'PARALLEL_SSH="~w" parallel --sshlogin 127.0.0.1 \c
< runs.txt', [Ssh]),
    append(Before, [Command|After], Lines),
    shell(Dir, Lines, Output).

slurm(Output, Dir) :-
    shown('#SBATCH', Script),
    format(atom(File), '~w/study.sh', [Dir]),
    write_file(File, Script),
    commands('parallel < ', Before, _, After),
    commands('sbatch ', [], Command, _),
    append(Before, [Command|After], Lines),
    shell(Dir, Lines, Output).

%   Some machines do not permit daemons.

starts(Goal) :-
    catch(call(Goal), error(timeout_error(_, _), _), fail),
    !.
starts(Goal) :-
    format(user_error, '% skipped: ~w does not start here~n', [Goal]),
    fail.

nothing(_).

%   A Prolog that is not installed may need environment variables that ssh does
%   not pass on.

prolog_there(Dir, Ssh) :-
    current_prolog_flag(executable, Swipl),
    format(atom(Command), '~w 127.0.0.1 ~w --version', [Ssh, Swipl]),
    process_create(path(sh), ['-c', Command],
                   [cwd(Dir), stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)).

:- begin_tests(parallel).

test(on_this_machine) :-
    with_tmp_dir(Dir,
        ( commands('parallel < ', Before, Command, After),
          append(Before, [Command|After], Lines),
          shell(Dir, Lines, Output) )),
    all_there(Output).
test(over_ssh, [condition(test_cluster:starts(with_sshd(prolog_there)))]) :-
    with_sshd(parallel_over_ssh(Output)),
    all_there(Output).

:- end_tests(parallel).

:- begin_tests(slurm, [condition(test_cluster:starts(with_slurm(nothing)))]).

test(array) :-
    with_slurm(slurm(Output)),
    all_there(Output).

:- end_tests(slurm).
