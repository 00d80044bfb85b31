:- module(test_made_once,
          [ made_once/3                 % +Name, :Make, -Dir
          ]).

/** <module> Folders that several suites read

*Threading*: the main thread.
*/

:- use_module(common, [make_tmp_dir/1]).
:- use_module(texts, [write_file/2]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).

:- meta_predicate made_once(+, 1, -).

%!  made_once(+Name, :Make, -Dir) is semidet.
%
%   Dir is the folder Name of the suites that test/run.pl runs, which the first
%   that asks for it makes by call(Make, Dir) while others wait.

made_once(Name, Make, Dir) :-
    folder(Run),
    directory_file_path(Run, Name, Dir),
    atom_concat(Dir, '.lock', Lock),
    atom_concat(Dir, '.made', Made),
    setup_call_cleanup(
        open(Lock, append, Stream, [lock(write)]),
        (   exists_file(Made)
        ->  true
        ;   call(Make, Dir),
            write_file(Made, "")
        ),
        close(Stream)).

:- dynamic own/1.

folder(Run) :-
    getenv('TYPHON_RUN', Run),
    !.
folder(Run) :-
    own(Run),
    !.
folder(Run) :-
    make_tmp_dir(Run),
    assertz(own(Run)),
    at_halt(delete_directory_and_contents(Run)).
