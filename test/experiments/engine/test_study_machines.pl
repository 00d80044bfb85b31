:- module(test_study_machines, []).

% Runs of a study on machines, and where there are none.

:- use_module('../../lib/common').

:- needs(['openssh-client', 'openssh-server', python3]).

:- use_module('../../lib/beside_machines', [machines_permitted/0]).
:- use_module('../../lib/study_files', [study_command/4, with_study_file/4]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, subtract/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

study([ 'study(toy, "A toy").',
        'fixed(hosts, 5, assumed("so")).',
        'network(Case, ring(N), []) :- N = Case.hosts.',
        'measure(hosts, Log, Count) :- length(Log.hosts, Count).',
        'measure(interfaces, Log, Count) :-',
        '    findall(I, ( member(H, Log.hosts), split_string(H, "@:", "", [_, I|_]) ),',
        '            Is),',
        '    sort(Is, Set), length(Set, Count).',
        'claim("at one interface", [], interfaces =:= 1).',
        'real([], [clock=50]).' ]).

on_machines(Machines, Status, Text) :-
    study(Lines),
    with_study_file(Lines, Dir, File,
        study_command(Dir, [ File, '--runs', 1, '--out', out, '--machines',
                             Machines ], Status, Text)).

%   words(+Text, -Words) is nondet: the words of a line.

words(Text, Words) :-
    split_string(Text, "\n", "", Lines),
    member(Line, Lines),
    split_string(Line, " ", " ", Words0),
    subtract(Words0, [""], Words).

%   A program python3 in front of the other ends as app/machines.py does where
%   machines are not permitted; Asked are its arguments.

without_machines(Text, Asked, Dir) :-
    directory_file_path(Dir, python3, Python),
    shell_script(Python, "echo \"$@\" > $0.asked; exit 69"),
    getenv('PATH', Path0),
    atomic_list_concat([Dir, Path0], :, Path),
    setup_call_cleanup(setenv('PATH', Path),
                       on_machines(3, exit(0), Text),
                       setenv('PATH', Path0)),
    atom_concat(Python, '.asked', File),
    read_file_to_string(File, Asked, []).

:- begin_tests(machines, [condition(machines_permitted)]).

test(run_on_three_machines, nondet) :-
    on_machines(3, exit(0), Text),
    words(Text, ["measure", "virtual", "on", "machines", "verdict"]),
    words(Text, ["hosts", "5", "5", "inside"]),
    words(Text, ["interfaces", "1", "3", "above"]),
    words(Text, [_, "one", "interface\"", "1", "of", "1", "0", "of", "1"]).

:- end_tests(machines).

:- begin_tests(no_machines).

test(delays_and_losses_grow_with_the_number, nondet) :-
    with_tmp_dir(without_machines(_, Asked)),
    sub_string(Asked, _, _, _, "--delay 0.5,1.0,1.5 --loss 0.1,0.2,0.3 3 ").
test(study_goes_on_without_them, nondet) :-
    with_tmp_dir(without_machines(Text, _)),
    once(sub_string(Text, _, _, _, "--machines: the runs on machines are")),
    words(Text, ["1", "5", "1"]).
test(machines_of_others_need_an_address, nondet) :-
    on_machines('mill,dale', exit(1), Text),
    sub_string(Text, _, _, _, "--bind ADDRESS").

:- end_tests(no_machines).
