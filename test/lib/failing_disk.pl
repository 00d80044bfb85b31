:- module(failing_disk,
          [ disk_can_fail/0,
            disk_fails/1,               % +Call
            disk_heals/0,
            with_failing_disk/2         % -Environment, :Goal
          ]).

/** <module> Processes whose disk fails when tests say so

The library `failing_disk.c` lets calls of the system fail while the file named by
FAILING_DISK tells it to.

*Threading*: the main thread sets up; any thread of such a process lets its disk
fail.
*/

:- use_module(preloaded, [can_preload/1, with_preloaded/4]).

:- meta_predicate with_failing_disk(-, 0).

%!  disk_can_fail is semidet.

disk_can_fail :-
    can_preload(failing_disk).

%!  with_failing_disk(-Environment:list, :Goal) is semidet.
%
%   Run once(Goal), which starts processes with Environment.

with_failing_disk(Environment, Goal) :-
    with_preloaded(failing_disk, 'FAILING_DISK'=_, Environment, Goal).

%!  disk_fails(+Call) is det.
%!  disk_heals is det.
%
%   From now on Call, `fsync`-Errno or `write`-Errno, fails in this process; no
%   call fails any more.

disk_fails(Call-Errno) :-
    getenv('FAILING_DISK', File),
    atom_concat(File, '.new', New),
    setup_call_cleanup(open(New, write, Out),
                       format(Out, '~w ~d~n', [Call, Errno]),
                       close(Out)),
    rename_file(New, File).

disk_heals :-
    getenv('FAILING_DISK', File),
    delete_file(File).
