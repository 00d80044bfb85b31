:- module(test_preloaded,
          [ can_preload/1,              % +Name
            with_preloaded/4            % +Name, ?Variable, -Environment, :Goal
          ]).

/** <module> Processes with a library of test/lib in place of calls of the system

*Threading*: the main thread.
*/

:- use_module(common, [project_file/2, with_tmp_dir/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(process), [process_create/3]).

:- meta_predicate with_preloaded(+, ?, -, 0).

%!  can_preload(+Name) is semidet.
%
%   The library test/lib/Name.c can be compiled here.

can_preload(Name) :-
    catch(with_tmp_dir(test_preloaded:compiled(Name, _)), error(_, _), fail).

compiled(Name, Library, Dir) :-
    format(atom(Relative), 'test/lib/~w.c', [Name]),
    project_file(Relative, Source),
    directory_file_path(Dir, 'preloaded.so', Library),
    process_create(path(cc),
                   ['-shared', '-fPIC', '-o', Library, Source, '-ldl'],
                   [stderr(null)]).

%!  with_preloaded(+Name, ?Variable, -Environment:list, :Goal) is semidet.
%
%   Run once(Goal), which starts processes with Environment: they have loaded
%   the library Name. Variable=File is a variable that names a file to it.

with_preloaded(Name, Variable, Environment, Goal) :-
    with_tmp_dir(test_preloaded:preloaded(Name, Variable, Environment, Goal)).

preloaded(Name, Variable=File, Environment, Goal, Dir) :-
    compiled(Name, Library, Dir),
    directory_file_path(Dir, file, File),
    Environment = ['LD_PRELOAD'=Library, Variable=File],
    once(Goal).
